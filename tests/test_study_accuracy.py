"""The baseline is a fair one, and the two studies of accuracy, on little, say what their datasets hold."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from figure_checks import assert_no_two_entries_share_a_mark

from painleve.asymptotics.certify.method import CertifyOptions
from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.member import make_member
from painleve.asymptotics.methods import METHODS
from painleve.asymptotics.optimise import OptimiseOptions
from painleve.asymptotics.sample import SampleOptions
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw
from painleve.sets import Cloud, excess
from painleve.theory.limit_set import limit_set
from studies.benchmark.naive import naive_distance, naive_members, point_distances, uniform_ball
from studies.benchmark.work_precision import RUN_OUTCOMES, DistanceEffort, sweep_work_precision
from studies.parts import Report
from studies.speed_accuracy.figures import DRAWINGS as SPEED_DRAWINGS
from studies.speed_accuracy.report import report as speed_report
from studies.where_methods_fail.facts import bound_facts, rounding_facts
from studies.where_methods_fail.figures import DRAWINGS as FAIL_DRAWINGS
from studies.where_methods_fail.measure import near_cases
from studies.where_methods_fail.near_critical import NearCase, sweep_near_critical
from studies.where_methods_fail.report import report as fail_report
from studies.where_methods_fail.rounding import sweep_rounding
from studies.where_methods_fail.sampled_bound import sweep_sampled_bound


def limit(scene: str, state: str):
    return limit_set(make_state(load_scene(scene), state))


STATES = [make_state(load_scene("slender_rod"), name) for name in ("paradox", "double_zero")]
LITTLE = DistanceEffort(
    samples=(1000,), naive_samples=(1000,), widths=(1e-3,), reference_width=1e-3, repetitions=1, patience=0.0
)
HARD = make_state(load_scene("slender_rod"), "double_zero")


@pytest.fixture(scope="module")
def measured() -> xr.Dataset:
    return sweep_work_precision(STATES, eps=1e-3, effort=LITTLE)


@pytest.fixture(scope="module")
def told(measured: xr.Dataset) -> Report:
    return speed_report({"speed_accuracy": measured})


@pytest.fixture(scope="module")
def bounds() -> xr.Dataset:
    return sweep_sampled_bound(HARD, eps=[1e-1, 1e-3, 1e-6], samples=[10**3, 10**5])


@pytest.fixture(scope="module")
def rounding() -> xr.Dataset:
    return sweep_rounding(HARD, eps=[1e-2, 1e-5, 1e-9, 1e-13], members=12, samples=1000)


@pytest.fixture(scope="module")
def near() -> xr.Dataset:
    methods = {"optimise": OptimiseOptions(), "sample": SampleOptions(samples=2000)}
    enclosing = {"certify": CertifyOptions(width=0.5)}
    return sweep_near_critical(near_cases(), eps=[1e-1, 1e-4, 1e-8], methods=methods, isolated=enclosing)


@pytest.mark.parametrize(("scene", "state"), [("slender_rod", "critical"), ("worn_tip_rod", "paradox")])
def test_the_naive_law_is_the_law_wherever_doubles_suffice(scene, state):
    A, random = limit(scene, state), np.random.default_rng(1)
    problem = make_local_problem(A)
    dq, dv = (uniform_ball(random, 60, 3, 0.05) for _ in range(2))
    plain = naive_members(A, dq, dv)
    exact = [make_member(problem, q, v) for q, v in zip(dq, dv, strict=True)]
    assert len({m.branch for m in exact}) >= 2
    assert [m.branch for m in exact] == plain.branch.tolist()
    np.testing.assert_allclose(plain.values - A.u_minus, [m.offset for m in exact], rtol=0.0, atol=1e-11)
    assert point_distances(A, plain.values) == pytest.approx([sum(m.distance) / 2 for m in exact], rel=1e-9, abs=1e-13)


def test_the_naive_distances_are_those_of_the_sets_room_but_for_the_grid():
    A = limit("slender_rod", "critical")
    forward, backward = naive_distance(A, 0.1, samples=3000, seed=5)
    random = np.random.default_rng(5)
    dq, dv = (uniform_ball(random, 3000, 3, 0.1) for _ in range(2))
    cloud = Cloud(naive_members(A, dq, dv).values)
    assert forward == pytest.approx(excess(cloud, A.point_set).bounds.lower, rel=1e-12)
    exact = excess(A.point_set, cloud).bounds.upper
    assert exact - A.point_set.length / 2000 <= backward <= exact


def test_uniform_points_of_a_ball_have_the_moments_of_the_uniform_law():
    x = uniform_ball(np.random.default_rng(2), 200_000, 3, 2.0)
    assert np.linalg.norm(x, axis=1).max() <= 2.0 * (1 + 1e-15)
    # E |x|^2 = R^2 d/(d + 2), and the same for every coordinate
    np.testing.assert_allclose(np.mean(x**2, axis=0), 4.0 * 0.6 / 3.0, rtol=0.02)


def test_a_gap_is_put_exactly_on_both_sides_of_the_critical_value():
    case = NearCase(scene=load_scene("slender_rod"), keys={}, parameter="mu", critical="4/3", exponents=(2, 30))
    assert [gap for gap, _ in case.values()] == [-1e-30, -1e-2, 1e-30, 1e-2]
    branches = [
        limit_set(make_state(case.scene, keys={"theta": "atan(2)"}, parameters={"mu": exact})).kind
        for _, exact in case.values()
    ]
    assert branches == ["point", "point", "pair", "pair"]


def test_every_method_is_measured_and_every_run_is_in_the_table(measured: xr.Dataset, told: Report) -> None:
    assert {str(name).split(",")[0] for name in measured["series"].values} == {*METHODS, "naive NumPy"}
    rows = rows_of(told)
    assert len(rows) == measured.sizes["state"] * measured.sizes["run"]
    body = told.table.split("\n\n")[0].splitlines()[2:]
    assert [line.split()[-1] for line in body] == [row["outcome"] for row in rows]


def rows_of(told: Report, name: str = "rows") -> list[dict[str, Any]]:
    found: Any = told.data[name]
    return found


def test_sampled_values_bound_d_H_from_their_side_and_mislead_at_the_hard_state_only_by_being_read(
    told: Report,
) -> None:
    """A misleading run is a true bound: at `double_zero` it lies above the enclosure, for it bounds e(A, A_eps)."""
    misleading = [r for r in rows_of(told) if (r["state"], r["outcome"]) == ("slender_rod double_zero", "misleading")]
    assert {r["method"].split(",")[0] for r in misleading} == {"naive NumPy", "sample"}
    (reference,) = [r for r in rows_of(told, "references") if r["state"] == "slender_rod double_zero"]
    assert all(r["value"] > 2 * (reference["d_H"] + reference["half_width"]) for r in misleading)


def test_optimise_and_certify_agree_within_what_certify_proves(told: Report) -> None:
    resolved = {r["state"]: r["half_width"] / r["d_H"] for r in rows_of(told, "references")}
    seen = set()
    for row in rows_of(told):
        if row["method"] == "certify":
            assert row["error"] <= row["proved"] + resolved[row["state"]]
        if row["method"] == "optimise":
            assert row["error"] <= 1.01 * resolved[row["state"]] + 1e-9
        seen.add(row["method"])
    assert {"certify", "optimise"} <= seen


def test_outcomes_are_the_codes_that_their_errors_deserve(measured: xr.Dataset) -> None:
    misleading = measured["outcome"].values == 1 + RUN_OUTCOMES.index("misleading")
    value, reference = measured["value"].values, measured["reference"].values[:, None]
    np.testing.assert_array_equal(misleading, (value > 2 * reference) | (value < reference / 2))


def test_the_sampled_bound_at_the_hard_state_grows_while_witnesses_shrink(bounds: xr.Dataset) -> None:
    assert np.all(np.diff(bounds["sampled_upper"].values[-1]) > 0.0)
    assert np.all(np.diff(bounds["witnessed_upper"].values) < 0.0)
    # without a single slip the members near u- and u_tilde leave the middle of A uncovered
    assert bounds["slips"].values[0, -1] == 0
    assert bounds["sampled_upper"].values[0, -1] == pytest.approx(bounds["half_jump"].item(), rel=1e-5)
    told = bound_facts(bounds)
    assert (told["least_at_eps"], told["smallest_eps"], told["samples"]) == (1e-1, 1e-6, 10**5)


def test_plain_doubles_lose_gamma_like_the_inverse_square_of_eps_and_the_toolkit_does_not(rounding: xr.Dataset) -> None:
    eps = rounding["eps"].values
    gamma = rounding["plain_error_median"].sel(quantity="gamma").values
    slope = np.diff(np.log10(gamma[:2])) / np.diff(np.log10(eps[:2]))
    assert slope == pytest.approx(-2.0, abs=0.4)
    assert np.all(rounding["wrong_sign"].values[eps < 2e-8] > 0.2)
    assert np.all(rounding["kept_error_farthest"].values < 1e-9)
    assert rounding_facts(rounding)["sign_lost_from_eps"] == 1e-9


def test_d_H_is_that_of_the_wrong_side_until_eps_resolves_the_gap(near: xr.Dataset) -> None:
    one = near.isel(case=0)
    gap, eps, read = one["gap"].values, one["eps"].values, one["distance_as_read"].values
    np.testing.assert_array_equal(read, np.fmax(one["excess_Aeps_A_lower"], one["excess_A_Aeps_upper"]))
    for i in np.flatnonzero(gap < 0.0):
        assert np.all(read[i][eps > -10 * gap[i]] > 0.5)  # as if gamma were 0: the whole jump
        assert np.all(read[i][eps < -gap[i] / 10] < 0.5)
    for i in np.flatnonzero(gap > 0.0):
        resolved = eps < np.sqrt(gap[i]) / 10
        assert np.all(read[i][resolved] < 3.0 * eps[resolved])


def test_at_isolated_states_the_excess_of_A_is_proved_large_only_once_eps_resolves_the_gap(near: xr.Dataset) -> None:
    dataset = near.isel(case=1)
    gap, eps, half = dataset["gap"].values, dataset["eps"].values, dataset["half_jump"].values
    for i in np.flatnonzero(gap > 0.0):
        one = dataset.isel(value=i)
        lower, upper = one["excess_A_Aeps_lower"].values, one["excess_A_Aeps_upper"].values
        assert np.all(lower <= upper)
        assert np.all(lower[eps < 0.1 * gap[i]] > 0.9 * half[i])
        # the third derivative of mu_c, 75/2, makes gamma positive further than about 2 gap/3 from arctan 2
        assert np.all(lower[eps > 2.0 * gap[i]] < 0.9 * half[i])


def test_advice_is_the_fastest_run_that_is_good_enough(
    measured: xr.Dataset, bounds: xr.Dataset, rounding: xr.Dataset, near: xr.Dataset
) -> None:
    parts = {"sampled_bound": bounds, "rounding": rounding, "near_critical": near, "methods_1e-03": measured}
    report = fail_report(parts)
    for state, row in zip(measured["state"].values, rows_of(report, "methods"), strict=True):
        one = measured.sel(state=state)
        for choice, good in ((row["number"], one["error"] <= 1e-2), (row["proof"], one["proved"] <= 1e-3)):
            assert choice["seconds"] == float(one["seconds"].where(good).min())
            assert choice["method"] in report.table


@pytest.mark.parametrize("name", ["bounds", "rounding", "near"])
def test_no_two_entries_of_a_legend_share_a_mark(name: str, request: pytest.FixtureRequest) -> None:
    assert_no_two_entries_share_a_mark(draw(request.getfixturevalue(name), FAIL_DRAWINGS))


def test_every_panel_of_the_rounding_study_has_one_quantity_and_a_title(rounding: xr.Dataset) -> None:
    figure = draw(rounding, FAIL_DRAWINGS)
    assert [axis.get_title("left")[:3] for axis in figure.axes] == ["(a)", "(b)", "(c)", "(d)"]
    assert not any(";" in axis.get_ylabel() for axis in figure.axes)


def test_speed_against_accuracy_is_drawn_with_the_branch_in_words(measured: xr.Dataset) -> None:
    figure = draw(measured, SPEED_DRAWINGS)
    assert_no_two_entries_share_a_mark(figure)
    assert figure.axes[0].get_title("left") == "slender rod paradox: γ < 0"
