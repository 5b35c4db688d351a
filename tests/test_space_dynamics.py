"""Trajectories with friction in space, against closed forms, the plane, the limit set and an accurate integration."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from command_line import assert_refused, run_json
from dynamics_scenes import space_block
from scipy.integrate import solve_ivp

import painleve
from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, MemberOutcome
from painleve.dynamics.ensemble import run_ensemble
from painleve.dynamics.proposition1 import check_proposition1
from painleve.dynamics.schemes import SCHEME_NAMES
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import Start, make_start
from painleve.mechanics.derive import derive
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.sweep.trajectories import trajectory_dataset
from painleve.theory.limit_set import limit_set

ROD = load_scene("spatial_rod")
SECTIONS = ("ellipse", "kite")  # of the block; the rod has a disc
IN_SPACE = ("contact_dynamics", "moreau_jean")
MARGINS = ("membership", "dissipation", "norm_bound")


def random_start(section: str, seed: int, **fixed: float) -> Start:
    """A block: gamma takes both signs, contacts open and close; every fifth has no friction in one direction."""
    random = np.random.default_rng(seed)
    parameters = {
        "beta": random.uniform(-0.6, 0.6),
        "c": random.uniform(-0.5, 0.5),
        "bend": random.uniform(-0.2, 0.2),
        "mu": random.uniform(0.0, 4.0),
        "nu": random.uniform(0.0, 3.0) if seed % 5 else 0.0,
        "angle": random.uniform(-3.0, 3.0),
        "weight": random.uniform(1.0, 20.0),
        "drag": random.uniform(0.0, 2.0),
        "beat": random.uniform(-10.0, 10.0),
    } | fixed
    q = {"x": random.normal(), "y": random.normal(), "z": random.choice([0.0, random.uniform(0.0, 0.3)])}
    u = {"x": random.normal(0.0, 2.0), "y": random.normal(0.0, 2.0), "z": random.normal(0.0, 0.3)}
    return make_start(
        space_block(section),
        q={k: float(x) for k, x in q.items()},
        u={k: float(x) for k, x in u.items()},
        parameters={k: float(x) for k, x in parameters.items() if x != 0.0},
    )


def random_rod(seed: int) -> Start:
    """A rod with its tip on the floor or above it, in any direction, and not yet upright: there M is singular."""
    random = np.random.default_rng(seed)
    theta, lift = random.uniform(0.2, 1.2), random.choice([0.0, random.uniform(0.0, 0.05)])
    q = {"x": 0.0, "y": 0.0, "z": math.sin(theta) + float(lift), "theta": theta, "phi": random.uniform(-3.0, 3.0)}
    u = {c.name: random.normal(0.0, 1.0) for c in ROD.coordinates}
    return make_start(ROD, q=q, u=u, parameters={"mu": random.uniform(0.2, 3.0), "gravity": random.uniform(1.0, 20.0)})


@pytest.mark.parametrize("section", [*SECTIONS, "disc"])
def test_proposition_1_holds_at_every_step_of_random_scenes(section: str) -> None:
    signs, branches = set(), set()
    for seed in range(40):
        start = random_rod(seed) if section == "disc" else random_start(section, seed)
        found = simulate(start, step=5e-4 if section == "disc" else 4e-3, until=0.2 if section == "disc" else 1.6)
        assert found.proposition1 is not None
        for margin in MARGINS:
            assert getattr(found.proposition1, margin).shape == (400,)
            assert found.proposition1.worst(margin)[0] <= 1e-13
        signs |= {bool(s) for s in found.contact_quantities()["gamma"][found.branch != ContactMode.FREE] < 0.0}
        branches |= {int(b) for b in found.branch}
    assert signs == {True, False}
    assert branches == {ContactMode.FREE, ContactMode.STICK, ContactMode.SLIP}


@pytest.mark.parametrize("width", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
def test_rounding_does_not_take_an_impulse_out_of_a_thin_ellipse(width: float) -> None:
    for seed in range(1, 12):
        found = simulate(random_start("ellipse", seed, nu=width), step=4e-3, until=1.6)
        assert found.proposition1 is not None
        assert found.proposition1.worst("membership")[0] <= 1e-13


@pytest.mark.parametrize("section", SECTIONS)
def test_the_margins_of_proposition_1_notice_a_wrong_step(section: str) -> None:
    start = random_start(section, 3, weight=10.0, mu=0.5, nu=0.3, bend=0.0)
    found = simulate(start, step=1e-2, until=1.0)
    slips = np.flatnonzero(found.branch == ContactMode.SLIP)
    i = int(slips[len(slips) // 2])
    for wrong in ([0.0, 0.0, -1e-6], [1e-6, 0.0, 0.0], [-1e-6, 0.0, 0.0]):
        u = found.u.copy()
        u[i] += wrong
        sticks = found.branch == ContactMode.STICK
        margins = check_proposition1(start, found.t, np.full(100, 1e-2), found.q, u, sticks, 0.0)
        if margins.membership[i - 1] > 1e-8:
            break
    else:
        pytest.fail("no change of the velocity was noticed")
    assert found.proposition1 is not None
    assert found.proposition1.membership[i - 1] < 1e-14


@pytest.mark.parametrize("section", SECTIONS)
def test_the_impulses_are_in_the_tangents_of_the_scene_and_in_its_section(section: str) -> None:
    start = random_start(section, 11, bend=0.0)
    values = {p.name: x for p, x in zip(start.scene.parameters, start.p, strict=True)}
    found, h = simulate(start, step=1e-3, until=1.0), 1e-3
    B, c, mu, nu, angle = (values[n] for n in ("beta", "c", "mu", "nu", "angle"))
    M = np.linalg.inv([[1.0, 0.0, B], [0.0, 1.0, c], [B, c, 1.0]])
    t, u = found.t[1:], found.u[:-1]
    f = np.stack(
        [
            -values["drag"] * u[:, 0] + values["beat"] * np.sin(3 * t),
            values["beat"] * np.cos(2 * t),
            np.full(len(t), -values["weight"]),
        ],
        axis=1,
    )
    expected = (found.u[1:] - u) @ M - h * f  # the momentum along x, y and z; grad g is -z
    np.testing.assert_allclose(found.r[1:], expected[:, [2, 0, 1]], atol=1e-13)
    normal, first, second = found.r.T
    if section == "kite":  # |r_t| in the norm of which the section is the unit ball
        reach = np.maximum(first / mu, -first / (2 * mu)) + abs(second) / nu
    else:
        along, across = np.cos(angle) * first + np.sin(angle) * second, np.cos(angle) * second - np.sin(angle) * first
        reach = np.hypot(along / mu, across / nu)
    assert (reach <= normal * (1.0 + 1e-10) + 1e-15).all()
    slips = found.branch == ContactMode.SLIP
    assert slips.sum() > 50
    np.testing.assert_allclose(reach[slips], normal[slips], rtol=1e-10)


@pytest.mark.parametrize(("scheme", "section"), [(s, b) for s in IN_SPACE for b in SECTIONS])
def test_a_contact_takes_energy_and_never_gives_any(scheme: str, section: str) -> None:
    taken = 0.0
    for seed in range(100, 110):
        found = simulate(random_start(section, seed), scheme=scheme, step=2e-3, until=0.6, monitor=False)
        work = found.contact_work()
        scale = found.contact_quantities()["kinetic_energy"].max() - work[-1]
        assert np.diff(work).max() <= 1e-14 * scale
        taken -= work[-1]
        idle = simulate(
            random_start(section, seed, bend=0.0, weight=0.0, drag=0.0, beat=0.0),
            scheme=scheme,
            step=2e-2,
            until=2.0,
            monitor=False,
        )
        energy = idle.contact_quantities()["kinetic_energy"]
        assert np.diff(energy).max() <= 1e-14 * energy[0]  # M is constant: nothing else changes it
    assert taken > 1.0


@pytest.mark.parametrize(("state", "keys"), [("paradox", {}), ("sliding", {}), ("sliding", {"slip": "-2"})])
@pytest.mark.parametrize("scheme", IN_SPACE)
def test_a_rod_in_its_vertical_plane_moves_as_the_rod_in_the_plane(scheme: str, state: str, keys: dict) -> None:
    options = {"scheme": scheme, "step": 1e-3, "until": 0.4}
    space = simulate(make_state(ROD, state, keys=keys), **options)
    signs = {"slip": sp.Integer(-1) * sp.sympify(int(keys.get("slip", 1)))}
    friction = {"mu": "2" if state == "paradox" else "1/2"}
    plane = simulate(
        make_state(load_scene("slender_rod"), keys={"theta": "atan(2)"} | signs, parameters=friction), **options
    )
    np.testing.assert_allclose(space.q[:, [0, 2, 3]], plane.q, atol=1e-11)
    np.testing.assert_allclose(space.u[:, [0, 2, 3]], plane.u, atol=1e-11)
    np.testing.assert_allclose(space.r[:, :2], plane.r, atol=1e-11)
    assert not space.q[:, [1, 4]].any()
    np.testing.assert_array_equal(space.change, plane.change)
    slips = np.isin(plane.branch, (ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS))
    np.testing.assert_array_equal(space.branch, np.where(slips, ContactMode.SLIP, plane.branch))


def test_the_azimuth_turns_the_trajectory() -> None:
    here = simulate(make_state(ROD, "oblique"), step=1e-3, until=0.3)
    there = simulate(make_state(ROD, "oblique", keys={"phi": "atan(3/4)"}), step=1e-3, until=0.3)
    turn = np.array([[0.8, 0.6], [-0.6, 0.8]])
    for mine, turned in ((here.q, there.q), (here.u, there.u)):
        np.testing.assert_allclose(turned[:, :2], mine[:, :2] @ turn, atol=1e-10)
        np.testing.assert_allclose(turned[:, 2:4], mine[:, 2:4], atol=1e-10)
    np.testing.assert_allclose(there.q[:, 4] - here.q[:, 4], math.atan(0.75), atol=1e-10)
    np.testing.assert_allclose(there.r[:, 1:], here.r[:, 1:] @ turn, atol=1e-10)
    assert [j.kind for j in here.jumps] == [j.kind for j in there.jumps] == [Change.JUMP_WITHOUT_COLLISION]


@pytest.mark.parametrize(
    ("section", "direction", "friction"),
    [
        ("ellipse", 0.4, 0.3),
        ("ellipse", 0.4 + math.pi / 2, 0.5),
        ("kite", 0.0, 0.6),
        ("kite", math.pi, 0.3),
        ("kite", math.pi / 2, 0.5),
    ],
)
def test_a_sliding_point_mass_stops_after_the_way_of_constant_friction(
    section: str, direction: float, friction: float
) -> None:
    gravity, speed = 10.0, 2.0
    start = make_start(
        space_block(section),
        q={"x": 0, "y": 0, "z": 0},
        u={"x": speed * math.cos(direction), "y": speed * math.sin(direction)},
        parameters={"mu": 0.3, "nu": 0.5, "angle": 0.4, "weight": gravity},
    )
    way = np.array([math.cos(direction), math.sin(direction)]) * speed**2 / (2 * friction * gravity)
    errors = []
    for h in (1e-3, 1e-4):
        found = simulate(start, step=h, until=1.0, monitor=False)
        assert np.abs(found.u[-1]).max() < 1e-15
        errors.append(np.linalg.norm(found.q[-1, :2] - way))
        assert errors[-1] < 2 * speed * h
        assert not found.jumps
    assert errors[1] < errors[0] / 5


@pytest.mark.parametrize(("state", "ends_in"), [("paradox", ContactMode.STICK), ("oblique", ContactMode.SLIP)])
def test_from_an_approach_the_scheme_jumps_to_where_the_limit_set_says(state: str, ends_in: ContactMode) -> None:
    exact = make_state(ROD, state)
    limit = limit_set(exact)
    names = [c.name for c in ROD.coordinates]
    q = {n: exact.number(x) for n, x in zip(names, exact.q, strict=True)}
    u = {n: exact.number(x) for n, x in zip(names, exact.u, strict=True)}
    gaps = []
    for approach in (1e-4, 1e-6, 1e-8):
        start = make_start(ROD, q=q, u=u | {"z": -approach}, parameters=exact.parameters)
        found = simulate(start, step=1e-3 * approach, until=1e-3 * approach)
        assert found.branch[1] == ends_in
        gaps.append(np.linalg.norm(found.u[1] - limit.u_plus))
    assert gaps[0] < 2e-3
    assert gaps[1] == pytest.approx(1e-2 * gaps[0], rel=1e-2)  # gamma < 0: in proportion to the approach
    assert gaps[2] == pytest.approx(1e-4 * gaps[0], rel=1e-2)
    assert np.linalg.norm(limit.jump) > 0.1
    (jump,) = simulate(exact, step=1e-5, until=1e-3).jumps
    assert jump.kind is Change.JUMP_WITHOUT_COLLISION
    assert jump.gamma == pytest.approx(limit.gamma_value, rel=1e-12)
    np.testing.assert_allclose(jump.u_plus, limit.u_plus, atol=2e-3)


def slip_motion(start: Start) -> Callable[[float, np.ndarray], np.ndarray]:
    """d(q, u)/dt of a slip under the law of least energy: a s + b is opposite to the slip, |s| = mu.

    Where the contact goes on, the normal velocity stays zero; the projection has u_t along the outer normal of the
    conic a |r_t|/mu + b.r_t = nu, taken with the other sign.
    """
    d = derive(start.scene)
    numbers = {s.symbol: x for s, x in zip(start.scene.parameters, start.p, strict=True)}
    u = sp.Matrix(start.scene.u)
    drift = (u.T * d.normal.jacobian(start.scene.q) * u)[0, 0]
    parts = (start.scene.inertia, start.scene.force, d.normal, start.scene.contact.tangents, drift)
    functions = [sp.lambdify([*start.scene.q, *start.scene.u], sp.sympify(e).xreplace(numbers)) for e in parts]
    mu = float(sp.sympify(start.scene.contact.section.mu).xreplace(numbers))

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        M, f, w, H, drift_n = (np.asarray(function(*y), float) for function in functions)
        w, W = w.ravel(), np.linalg.inv(M)
        a, b, slip = w @ W @ w, H.T @ W @ w, H.T @ y[len(w) :]
        along, size = slip @ b * mu, slip @ slip
        k = (math.sqrt(along**2 + size * (a**2 - mu**2 * b @ b)) - along) / size
        s = -mu * (k * slip + mu * b) / a
        normal = -(w @ W @ f.ravel() + drift_n) / (a + b @ s)
        assert normal > 0.0
        return np.concatenate([y[len(w) :], W @ (f.ravel() + normal * (w + H @ s))])

    return rate


def test_a_smooth_slide_in_space_converges_with_first_order() -> None:
    start = make_start(
        ROD,
        q={"x": 0, "y": 0, "z": "sin(atan(2))", "theta": "atan(2)", "phi": 0},
        u={"x": 3, "y": 2, "phi": 1},
        parameters={"mu": "1/2"},
    )
    exact = solve_ivp(slip_motion(start), (0.0, 0.25), [*start.q, *start.u], method="DOP853", rtol=1e-12, atol=1e-12)
    for scheme in IN_SPACE:
        errors = []
        for h in (1e-3, 1e-4):
            found = simulate(start, scheme=scheme, step=h, until=0.25, contact_tolerance=0.1, monitor=False)
            assert (found.branch[1:] == ContactMode.SLIP).all()
            errors.append(np.abs(np.concatenate([found.q[-1], found.u[-1]]) - exact.y[:, -1]).max())
        assert math.log10(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.02)
        assert errors[1] < 1e-3


def test_the_members_of_an_ensemble_are_trajectories() -> None:
    ensemble = run_ensemble(make_state(ROD, "oblique"), step=1e-3, count=8, until=0.05, spread=1.0, keep=True)
    assert ensemble.counts[MemberOutcome.JUMP] == 8
    for h, time in zip(ensemble.members.step, ensemble.members.time, strict=True):
        (jump, *_) = simulate(make_state(ROD, "oblique"), step=float(h), until=0.05).jumps
        assert jump.time == time
    sliding = run_ensemble(make_state(ROD, "sliding"), step=1e-3, count=8, until=0.05, ball=1e-3)
    assert sliding.counts[MemberOutcome.JUMP] == 0


def test_a_trajectory_in_space_is_stored_and_drawn(tmp_path) -> None:
    found = simulate(make_state(ROD, "oblique"), step=1e-3, until=0.2)
    data = found.to_xarray()
    assert {"v_n", "v_t1", "v_t2", "r_n", "r_t1", "r_t2"} <= set(data)
    np.testing.assert_array_equal(data["r_t2"], found.r[:, 2])
    names = dict(zip(data["branch"].flag_values, data["branch"].flag_meanings.split(), strict=True))
    assert names[int(data["branch"][-1])] in ("slip", "stick", "free")
    painleve.save(trajectory_dataset(found), tmp_path / "space.h5")
    np.testing.assert_array_equal(painleve.load(tmp_path / "space.h5")["v_t1"], data["v_t1"])
    labels = {line.get_label() for axis in found.plot().axes for line in axis.lines}
    assert any("v_{t1}" in label for label in labels)
    assert any("v_{t2}" in label for label in labels)
    assert "contact point, tangential $v_t$" not in labels


def test_simulate_steps_the_rod_in_space(capsys) -> None:
    answer = run_json(capsys, "simulate", "spatial_rod", "--state", "oblique", "--step", "1e-3", "--until", "1")
    assert answer["steps"] == 1000
    assert answer["coordinates"] == ["x", "y", "z", "theta", "phi"]
    assert answer["jumps"][0] == {"time": 0.001, "kind": "jump_without_collision", "gamma": pytest.approx(-1 / 6)}
    assert max(answer["proposition1"].values()) < 1e-13
    assert answer["statistics"]["slip"] > 0


@pytest.mark.parametrize("scheme", [s for s in SCHEME_NAMES if s not in IN_SPACE])
@pytest.mark.parametrize("command", ["simulate", "ensemble"])
def test_other_schemes_refuse_friction_in_space(command, scheme, capsys, tmp_path, monkeypatch) -> None:
    words = [command, "spatial_rod", "--state", "sliding", "--step", "1e-3", "--until", "1", "--scheme", scheme]
    more = ["--count", "5", "--spread", "1"] if command == "ensemble" else []
    line = assert_refused([*words, *more], capsys, tmp_path, monkeypatch)
    assert f"{scheme} does not step friction in space, which scene spatial_rod has" in line
    assert "contact_dynamics, moreau_jean" in line
