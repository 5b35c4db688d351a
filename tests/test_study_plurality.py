"""The jam law: its local map against brute force and closed forms, the singular point, and the study on little."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from figure_checks import assert_no_two_entries_share_a_mark
from numba import njit
from scipy.optimize import brentq
from scipy.special import rgamma

from painleve.core.jam_map import hops_from, jam_fraction, limit_law
from painleve.dynamics.genot_brogliato import find_friction, singular_point
from painleve.dynamics.modes import ContactPoint, Mode
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw
from painleve.store import labels_of
from studies.plurality.cases import SCHEMES, jam_cases
from studies.plurality.curves import law_curves
from studies.plurality.figures import DRAWINGS
from studies.plurality.initial_layer import sweep_initial_layer
from studies.plurality.jam_law import JamCase, measure_jam_law
from studies.plurality.report import report
from studies.plurality.scheme_choice import SchemeRun, sweep_schemes
from studies.plurality.step_sizes import StepWindow, sweep_step_sizes

PHASES = 4000


@pytest.mark.parametrize("ratio", [0.1, 0.37, 2 / 3, 0.95])
@pytest.mark.parametrize("strict", [True, False])
def test_without_drift_the_local_map_jams_as_often_as_the_law_says(ratio: float, strict: bool) -> None:
    assert jam_fraction(ratio, 0.0, strict=strict, phases=PHASES) == pytest.approx(
        1.0 / (1.0 + ratio) if strict else 1.0 - ratio, abs=2.0 / PHASES
    )
    assert limit_law(ratio, strict=strict) == (1.0 / (1.0 + ratio) if strict else 1.0 - ratio)


@pytest.mark.parametrize("ratio", [1.0, 1.3, 4.0])
def test_the_limit_is_zero_from_ratio_one_on_and_the_map_gets_there_as_the_drift_grows(ratio: float) -> None:
    assert limit_law(ratio, strict=True) == limit_law(ratio, strict=False) == 0.0
    if ratio > 1.0:
        assert jam_fraction(ratio, 10.0, strict=True, phases=500) == 0.0
        assert jam_fraction(ratio, 1e-6, strict=True, phases=PHASES) == pytest.approx(1 / (1 + ratio), abs=0.01)


@pytest.mark.parametrize(("ratio", "drift"), [(0.3, 0.05), (0.6, 0.4), (0.8, 2.0)])
def test_with_the_tip_kept_the_fraction_is_where_the_solved_recursion_changes_sign(ratio: float, drift: float) -> None:
    # b(X) = Gamma(X)/Gamma(X - r) + d (X - 1)/(1 - r), multiplied by 1/Gamma(X)
    def sign(X: float) -> float:
        return float(rgamma(X - ratio) + drift * (X - 1.0) / (1.0 - ratio) * rgamma(X))

    threshold = brentq(sign, ratio, 1.0 - 1e-12)
    assert jam_fraction(ratio, drift, strict=False, phases=PHASES) == pytest.approx(1.0 - threshold, abs=2.0 / PHASES)


@pytest.mark.parametrize(("ratio", "drift"), [(0.4, 0.1), (0.75, 0.5), (1.5, 0.05)])
def test_the_strict_map_is_the_flight_of_the_tip_between_contacts(ratio: float, drift: float) -> None:
    """Brute force: the tip's height by its polynomial in each flight, roots by NumPy, from uniform places far out."""
    rng, jams, count = np.random.default_rng(7), 0, 700
    for start in rng.uniform(15.0, 40.0, count) ** (1.0 / (1.0 + ratio)):
        x, beta = start, -(start**ratio) - drift * start / (1.0 - ratio)
        while True:
            # height/T = (1 + beta T + d T^2/3)/2, velocity beta T + d T^2/2
            roots = np.roots([drift / 3.0, beta, 1.0])
            back = roots[(np.abs(roots.imag) == 0.0) & (roots.real > 0.0)].real
            if len(back) == 0:
                break
            T = back.min()
            x, impulse = x - T, -(beta * T + drift * T * T / 2.0)
            if x < 0.0:
                jams += 1
                break
            beta += drift * T + ratio * impulse / x
            if beta >= 0.0:
                break
    expected = jam_fraction(ratio, drift, strict=True, phases=PHASES)
    assert abs(jams / count - expected) < 4.0 * math.sqrt(expected * (1.0 - expected) / count)


@njit
def jams_in_whole_steps(ratio: float, pull: float, drift: float, x: float) -> bool:
    """The strict test near the point, step by step: heights in c h^2, velocities in c h, x in h omega.

    The explicit update raises the tip by 1/2 at every step; b = -beta/c = pull x^r + ... pulls it back. Hops last whole
    numbers of steps, and a contact leaves the tip as far below the floor as it found it.
    """
    b, height = pull * x**ratio + drift * x / (1.0 - ratio), 0.0
    while b > 0.0:
        speed = 0.0
        while True:
            height += speed + 0.5
            speed -= b
            b -= drift
            x -= 1.0
            if height <= 0.0 and speed < 0.0:
                break
            if b < 0.0 < speed:
                return False
        if x < 0.0:
            return True
        b += ratio * speed / x
    return False


@njit
def count_jams_in_whole_steps(ratio: float, pull: float, drift: float, x: np.ndarray, h: np.ndarray) -> int:
    """Over starts x and step sizes h, both relative to where pull, drift and x are given."""
    count = 0
    for i in range(x.size):
        count += jams_in_whole_steps(ratio, pull * h[i] ** ratio, drift * h[i], x[i] / h[i])
    return count


@pytest.mark.parametrize(("ratio", "drift"), [(0.2, 0.01), (0.5, 0.04), (0.8, 0.1), (1.6, 0.01)])
def test_hops_of_whole_steps_jam_as_often_as_the_map_says_over_many_starts_and_steps(
    ratio: float, drift: float
) -> None:
    count, scale, shortest = 40_000, 1.0, 150.0  # shortest: steps of a hop at x_*, c/beta there
    while hops_from(ratio, drift, scale) < 40.0:
        scale *= 1.02
    random = np.random.default_rng(5)
    starts, h = scale * shortest * random.uniform(0.8, 1.2, count), random.uniform(0.81, 1.19, count)
    jams = count_jams_in_whole_steps(ratio, shortest ** (-1.0 - ratio), drift / shortest**2, starts, h)
    expected = jam_fraction(ratio, drift, strict=True)
    assert abs(jams / count - expected) < 4.0 * math.sqrt(expected * (1.0 - expected) / count)


@pytest.mark.parametrize(("ratio", "drift"), [(0.0, 0.1), (-1.0, 0.1), (1.0, 0.1), (0.5, -0.1), (math.nan, 0.1)])
def test_a_ratio_or_a_drift_without_a_map_is_refused_in_one_line(ratio: float, drift: float) -> None:
    with pytest.raises(InputError) as refused:
        jam_fraction(ratio, drift, strict=True)
    assert "\n" not in str(refused.value)


def test_glockers_rod_has_its_singular_point_at_45_degrees_with_ratio_two_thirds() -> None:
    point = singular_point(5 / 3)
    assert point.theta == pytest.approx(math.pi / 4, abs=1e-14)
    assert point.ratio == pytest.approx(2 / 3, abs=1e-14)


@pytest.mark.parametrize(("mass", "length"), [(1.0, 1.0), (0.3, 2.5)])
@pytest.mark.parametrize("alpha", [1.0, 3.0, 6.0])
@pytest.mark.parametrize("ratio", [0.3, 0.9, 1.7])
def test_the_ratio_is_that_of_the_eigenvalues_of_the_slip_near_the_point(
    alpha: float, ratio: float, mass: float, length: float
) -> None:
    """From the compiled scene: dbeta/dt = -r omega beta/x + D omega close to the point."""
    point = singular_point(find_friction(ratio, alpha=alpha), alpha=alpha, mass=mass, length=length)
    x, amplitude = 1e-4, 1e-2 * 1e-4 ** (-ratio) / 2
    amplitude += 2.0 * point.drift * x ** (1.0 - ratio) / abs(1.0 - ratio)
    start = point.start(distance=x, amplitude=amplitude, slip=-5.0)
    q, u = np.array(start.q), np.array(start.u)
    contact = ContactPoint.at(start, 0.0, q, u)
    force = contact.force(Mode.SLIP_PLUS)
    du = np.array(contact.acceleration) + contact.response(*force)
    tau = 1e-7
    ahead, behind = (ContactPoint.at(start, 0.0, q + s * tau * u, u + s * tau * du).beta_n for s in (1, -1))
    expected = -ratio * u[2] * contact.beta_n / x + point.drift * u[2]
    assert (ahead - behind) / (2 * tau) == pytest.approx(expected, rel=5e-3)
    assert contact.beta_n == pytest.approx(point.acceleration(x, amplitude), rel=1e-9)
    assert abs(contact.v_n) < 1e-12


def test_the_amplitude_with_which_a_slip_arrives_depends_neither_on_mass_nor_on_length() -> None:
    """With time in units of sqrt(l) the slip is the same for every l, and K in beta = -K x^r - ... is in m/s^2."""
    mu = find_friction(0.5)
    plain, other = (
        singular_point(mu, mass=mass, length=length).amplitude_at_point(1e-2, 7.0)
        for mass, length in ((1.0, 1.0), (3.0, 0.2))
    )
    assert other == pytest.approx(plain, rel=1e-9)


def test_friction_below_the_critical_one_has_no_singular_point() -> None:
    with pytest.raises(InputError, match="mu_P"):
        singular_point(1.3)


def test_the_scheme_jams_as_often_as_the_map_says_where_the_map_leaves_out_little() -> None:
    point = singular_point(find_friction(0.5))
    cases = [
        JamCase(
            group="test", contact="strict", ratio=0.5, step=1e-6, count=2000, amplitude=point.amplitude_of(1e-6, 1.0)
        ),
        JamCase(
            group="test",
            contact="kept",
            ratio=0.5,
            step=1e-6,
            length=100.0,
            count=2000,
            amplitude=point.kept_drift(1e-6, 1.0) / 0.01,
        ),
    ]
    found = measure_jam_law(cases, seed=3)
    deviation = np.abs(found["fraction"] - found["local_map"]).values
    assert (found["effective_count"].values > 500).all()
    assert (deviation < 4.0 * np.sqrt(0.25 / found["effective_count"].values)).all()
    assert found["others"].values.tolist() == [0, 0]


STOSS = make_state(load_scene("slender_rod"), "stoss")
PARADOXES = {
    label: make_state(load_scene("slender_rod"), "paradox", keys={"omega": omega})
    for label, omega in (("inconsistent", "0"), ("indeterminate", "6"))
}


@pytest.fixture(scope="module")
def datasets() -> dict[str, xr.Dataset]:
    """Each part of the study on as little as shows its claim."""
    windows = [StepWindow(step=step, decades=1.0, count=100) for step in (1e-3, 1e-4)]
    windows.append(StepWindow(step=1e-3, decades=0.003, count=20))
    chosen = {("ratio", 0.2), ("drift", 1.2), ("approach", 0.5), ("vanishing", 1.4)}
    cases = [case for case in jam_cases(quick=True) if (case.group, case.ratio) in chosen]
    few = [replace(case, count=100) for case in cases]
    runs = [SchemeRun(scheme=scheme, step=1e-3) for scheme in (*SCHEMES, "event_driven")]
    followed = [(label, state, 0.05) for label, state in PARADOXES.items()]
    return {
        "step_sizes": sweep_step_sizes(STOSS, windows, until=1.0),
        "jam_law": measure_jam_law(few).assign(law_curves([1.2])),
        "initial_layer": sweep_initial_layer(PARADOXES, steps=[1e-4], ratios=[0.1, 1000.0], count=60),
        "scheme_choice": sweep_schemes(followed, runs),
    }


@pytest.fixture(scope="module")
def data(datasets: dict[str, xr.Dataset]) -> dict[str, Any]:
    return dict(report(datasets).data)


def test_both_outcomes_are_found_in_every_decade(data: dict[str, Any]) -> None:
    wide = [row for row in data["decades"] if row["decades"] == 1.0]
    assert len(wide) == 4
    for row in wide:
        assert 0.0 < row["interval"][0] < row["interval"][1] < 1.0


def test_jumps_tend_to_the_exact_instant(data: dict[str, Any]) -> None:
    assert data["instant"] == pytest.approx(0.81455, abs=5e-6)
    for contact in ("strict", "kept"):
        late = {r["step"]: r["largest_delay"] for r in data["decades"] if r["contact"] == contact and r["decades"] == 1}
        assert late[1e-4] < 0.5 * late[1e-3]


def test_chi_square_counts_the_effective_members_and_where_the_map_has_no_jam_none_is_seen(
    datasets: dict[str, xr.Dataset], data: dict[str, Any]
) -> None:
    jams = datasets["jam_law"]
    strict = labels_of(jams["contact"]) == "strict"
    p, f, n = (jams[name].values for name in ("local_map", "fraction", "effective_count"))
    inside = (p > 0.0) & (p < 1.0)
    for contact, chosen in (("strict", strict & inside), ("kept", ~strict & inside)):
        fit = data["fits"][contact]
        terms = [(f[i] - p[i]) ** 2 * n[i] / (p[i] * (1.0 - p[i])) for i in np.flatnonzero(chosen)]
        assert fit["chi_square"] == pytest.approx(sum(terms), rel=1e-12)
        assert fit["degrees"] == len(terms) >= 2
        assert fit["p_value"] > 1e-3
        assert fit["jams_where_the_map_has_none"] == 0
    assert (p == 0.0).any()


def test_small_errors_leave_one_end_of_A_and_large_ones_reach_both(data: dict[str, Any]) -> None:
    rows = {(r["state"], r["ratio"]): r for r in data["layer"]}
    assert rows["inconsistent", 0.1]["fraction"] == 1.0
    assert rows["indeterminate", 0.1]["fraction"] == 0.0
    for state in ("inconsistent", "indeterminate"):
        last = rows[state, 1000.0]
        assert 0.0 < last["lower"] < last["upper"] < 1.0
        assert last["excess_of_A"] < 0.25 < 0.5 < rows[state, 0.1]["excess_of_A"]


def test_every_scheme_jumps_at_the_inconsistent_state_and_event_driven_integration_stops(data: dict[str, Any]) -> None:
    choices = {(r["state"], r["run"]): r["choice"] for r in data["choices"]}
    assert len(choices) == 2 * (len(SCHEMES) + 1)
    for (state, run), choice in choices.items():
        if run == "event_driven":
            assert choice == "stops"
        elif state == "inconsistent":
            assert choice == "jump"


def test_the_limit_law_that_is_drawn_is_the_law_with_its_fall_at_one() -> None:
    curves = xr.Dataset(law_curves([0.5]))
    r, law = curves["law_ratio"].values, curves["limit_law"].values
    below = r < 1.0
    np.testing.assert_allclose(law[0, below], 1.0 / (1.0 + r[below]), rtol=1e-12)
    np.testing.assert_allclose(law[1, below], 1.0 - r[below], rtol=1e-12)
    assert (law[:, ~below] == 0.0).all()
    assert r[below].max() == pytest.approx(1.0, abs=1e-15)
    drift, fraction = curves["map_drift"].values, curves["map_fraction"].values[0]
    assert fraction[0] == pytest.approx(jam_fraction(0.5, float(drift[0]), strict=True, phases=PHASES), abs=2e-3)


@pytest.mark.parametrize("name", ["step_sizes", "jam_law", "initial_layer"])
def test_no_two_entries_of_a_legend_share_a_mark(name: str, datasets: dict[str, xr.Dataset]) -> None:
    assert_no_two_entries_share_a_mark(draw(datasets[name], DRAWINGS))


def test_every_panel_of_the_jam_law_has_its_legend_and_states_r(datasets: dict[str, xr.Dataset]) -> None:
    figure = draw(datasets["jam_law"], DRAWINGS)
    assert all(axis.get_legend() is not None for axis in figure.axes)
    assert figure.axes[0].get_xlabel() == "ratio of the eigenvalues $r$"
    assert "local map, $r$ = 1.2" in [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    assert "$r$ = 0.5" in figure.axes[2].get_title("left")


def test_step_sizes_of_the_initial_layer_stand_beside_each_other() -> None:
    layers = sweep_initial_layer(PARADOXES, steps=[1e-3, 1e-4], ratios=[0.1], count=4)
    for axis in draw(layers, DRAWINGS).axes:
        x = [float(line.get_xdata()[0]) for line in axis.get_lines() if len(line.get_xdata()) == 1]
        assert min(x) < 0.1 < max(x)
        assert max(x) / min(x) < 2.0
