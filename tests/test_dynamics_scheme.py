"""The fixed-step schemes against closed forms, a slow reference, an event-driven integration and Proposition 1."""

from __future__ import annotations

import math

import numpy as np
import pytest
from dynamics_scenes import Reference, block
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, Ending
from painleve.core.sections import segment
from painleve.core.stepping import SteppingMethod
from painleve.dynamics.proposition1 import check_proposition1
from painleve.dynamics.schemes import SCHEME_NAMES, load_scheme
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import as_start, make_start
from painleve.dynamics.trajectory import Trajectory
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

STICK = ContactMode.STICK
STEPPED = ("contact_dynamics", "moreau_jean", "stewart_trinkle", "anitescu_potra", "schatzman_paoli")
ROD = load_scene("slender_rod")
SLIDING = {"beta": 0.0, "bend": 0.0, "mu": 0.25, "weight": 10.0}


def random_case(seed: int) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Parameters, q and u of a block: gamma takes both signs, contacts open and close."""
    random = np.random.default_rng(seed)
    parameters = {
        "beta": float(random.uniform(-0.7, 0.7)),
        "bend": float(random.uniform(-0.6, 0.6)),
        "mu": float(random.uniform(0.0, 4.0)),
        "weight": float(random.uniform(1.0, 20.0)),
        "drag": float(random.uniform(0.0, 2.0)),
        "beat": float(random.uniform(-10.0, 10.0)),
    }
    q = {"x": float(random.normal()), "y": float(random.choice([0.0, random.uniform(0.0, 0.3)]))}
    return parameters, q, {"x": float(random.normal(0.0, 2.0)), "y": float(random.normal(0.0, 0.3))}


@pytest.mark.parametrize("frictional", [True, False])
def test_every_step_is_that_of_the_paper_worked_out_slowly(frictional: bool) -> None:
    scene, contacts = block(frictional=frictional), 0
    for seed in range(16):
        parameters, q, u = random_case(seed)
        h = np.random.default_rng(seed).uniform(0.5, 1.5, 150) * 5e-3
        start = make_start(scene, q=q, u=u, parameters=parameters)
        found = simulate(start, step=h, until=float(h.sum()), monitor=False)
        slow = Reference(scene, parameters)
        for i, length in enumerate(h):  # step by step: S is discontinuous, and rounding must not choose the path
            expected = slow.step(found.t[i], length, found.q[i], found.u[i])
            np.testing.assert_allclose(found.q[i + 1], expected[0], rtol=1e-14, atol=1e-14)
            np.testing.assert_allclose(found.u[i + 1], expected[1], rtol=1e-9, atol=1e-11)
        contacts += int((found.branch != ContactMode.FREE).sum())
    assert contacts > 200


@pytest.mark.parametrize("frictional", [True, False])
def test_proposition_1_holds_at_every_step_of_random_scenes(frictional: bool) -> None:
    signs = set()
    for seed in range(100, 160):
        parameters, q, u = random_case(seed)
        start = make_start(block(frictional=frictional), q=q, u=u, parameters=parameters)
        found = simulate(start, step=4e-3, until=2.0)
        assert found.proposition1 is not None
        for margin in ("membership", "dissipation", "norm_bound"):
            values = getattr(found.proposition1, margin)
            assert values.shape == (500,)
            assert found.proposition1.worst(margin)[0] == values.max() <= 1e-13
        signs |= {bool(s) for s in found.contact_quantities()["gamma"][found.branch != ContactMode.FREE] < 0.0}
    assert signs == ({True, False} if frictional else {False})


def test_the_margins_of_proposition_1_notice_a_wrong_step() -> None:
    start = make_start(block(), q={"x": 0, "y": 0}, u={"x": 1}, parameters=SLIDING)
    found = simulate(start, step=1e-2, until=0.3)
    u = found.u.copy()
    u[7] += [0.0, 1e-6]
    wrong = check_proposition1(start, found.t, np.full(30, 1e-2), found.q, u, found.branch == STICK, 0.0)
    assert found.proposition1.worst("membership")[0] < 1e-15
    assert wrong.worst("membership")[0] > 1e-8
    assert wrong.worst("membership")[1] in (7, 8)


def test_free_fall_is_the_sum_of_an_arithmetic_series() -> None:
    h, n = 0.01, 60
    start = make_start(ROD, q={"x": 0, "y": 9, "theta": 1}, u={"x": 1, "y": 2, "theta": 3})
    found = simulate(start, step=h, until=h * n)
    i = np.arange(n + 1)
    fall = -9.81 * h**2 * i * (i - 1) / 2
    np.testing.assert_allclose(
        found.q, np.array([0, 9, 1]) + np.outer(i * h, [1, 2, 3]) + np.outer(fall, [0, 1, 0]), rtol=1e-13
    )
    assert (found.branch == ContactMode.FREE).all()
    assert not found.r.any()
    assert found.steps == n


@pytest.mark.parametrize("scheme", STEPPED)
def test_an_impact_without_friction_takes_the_normal_velocity_alone(scheme: str) -> None:
    theta, y = math.pi / 3, 2.0
    start = make_start(ROD, q={"x": 0, "y": y, "theta": "pi/3"}, u={"x": 1}, parameters={"mu": 0})
    found = simulate(start, scheme=scheme, step=1e-5, until=0.6)
    speed = math.sqrt(2 * 9.81 * (y - math.sin(theta)))
    (jump, *later) = found.jumps
    assert jump.time == pytest.approx(speed / 9.81, abs=3e-5)
    w, inverse = np.array([0.0, 1.0, -math.cos(theta)]), np.diag([1.0, 1.0, 3.0])
    u = np.array([1.0, -speed, 0.0])
    expected = u - inverse @ w * (w @ u) / (w @ inverse @ w)
    after = found.u[jump.index + (3 if scheme in ("stewart_trinkle", "schatzman_paoli") else 0)]
    np.testing.assert_allclose(after, expected, atol=2e-3)
    # A scheme that meets the gap itself may spread the impact over two steps, one does not hit twice.
    assert len(later) <= (1 if scheme in ("stewart_trinkle", "schatzman_paoli") else 0)


@pytest.mark.parametrize("scheme", STEPPED)
def test_a_fall_with_friction_ends_as_the_closed_form_of_the_impact(scheme: str) -> None:
    start = make_start(block(), q={"x": 0, "y": "1/2"}, u={"x": 3}, parameters={**SLIDING, "weight": 10, "mu": 0.25})
    found = simulate(start, scheme=scheme, step=1e-4, until=0.5)
    # mass 1/2 in y arrives with sqrt(2 * 10 * 1/2): r_n = mass * speed, r_t = -mu r_n, and then mu * weight / 2 brakes
    arrival, impulse = math.sqrt(0.1), math.sqrt(10.0) / 2
    expected = 3 - 0.25 * impulse - 0.25 * 5.0 * (0.5 - arrival)
    assert found.u[-1, 0] == pytest.approx(expected, abs=2e-3)
    assert found.jumps[0].kind is Change.FRICTIONAL_IMPACT
    assert found.jumps[0].time == pytest.approx(arrival, abs=2e-4)


@pytest.mark.parametrize("scheme", STEPPED)
def test_a_slipping_block_stops_where_coulomb_says_and_without_a_jump(scheme: str) -> None:
    start = make_start(block(), q={"x": 0, "y": 0}, u={"x": 2}, parameters=SLIDING)
    found = simulate(start, scheme=scheme, step=1e-3, until=2.0)
    deceleration = 0.25 * 5.0  # mu times the force that presses it to the floor, mass 1 along it
    stop = 2.0 / deceleration
    moving = found.t < stop - 0.01
    np.testing.assert_allclose(found.u[moving, 0], 2.0 - deceleration * found.t[moving], atol=5e-3)
    np.testing.assert_allclose(found.u[found.t > stop + 0.01, 0], 0.0, atol=1e-12)
    assert found.q[-1, 0] == pytest.approx(2.0**2 / (2 * deceleration), abs=5e-3)
    assert found.jumps == ()


def errors(scheme: str, start, reference: Trajectory, steps: list[float], until: float) -> np.ndarray:
    """|u - u_reference| at the end, for each step size."""
    return np.array(
        [
            np.abs(simulate(start, scheme=scheme, step=h, until=until, monitor=False).u[-1] - reference.u[-1]).max()
            for h in steps
        ]
    )


@pytest.mark.parametrize("scheme", STEPPED)
def test_every_scheme_is_of_order_one_on_smooth_sliding(scheme: str) -> None:
    start = make_state(ROD, keys={"theta": "pi/3", "slip": -3, "omega": 1}, parameters={"mu": "3/10"})
    until = 0.1
    reference = simulate(start, scheme="event_driven", step=until, until=until, options={"rtol": 1e-12})
    assert reference.ending is Ending.REACHED_END
    assert reference.statistics["stick"] == 0
    found = errors(scheme, start, reference, [1e-4, 1e-5], until)
    assert math.log10(found[0] / found[1]) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(("scheme", "order"), [(s, load_scheme(s).order) for s in STEPPED])
def test_every_scheme_has_its_stated_order_where_nothing_touches(scheme: str, order: int) -> None:
    start = make_start(load_scene("two_link_arm"), q={"phi1": 1, "phi2": 2}, u={"phi1": 2, "phi2": -3})
    reference = simulate(start, scheme="event_driven", step=0.2, until=0.2, options={"rtol": 1e-12})
    found = errors(scheme, start, reference, [2e-3, 1e-3], 0.2)
    assert math.log2(found[0] / found[1]) == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("scheme", STEPPED)
def test_stewarts_rod_sticks_at_once_and_turns_about_its_tip(scheme: str) -> None:
    m, inertia, h = 2.0, 1.0, 1e-2
    start = make_start(
        ROD, q={"x": 0, "y": "sin(pi/4)", "theta": "pi/4"}, u={"x": -1}, parameters={"m": 2, "I": 1, "mu": 1000}
    )
    found = simulate(start, scheme=scheme, step=h, until=0.5)
    # The impulse acts at the tip: the angular momentum about it is kept; then a compound pendulum.
    spin = m * math.sin(math.pi / 4) / (inertia + m)
    pendulum = solve_ivp(
        lambda t, z: [z[1], -m * 9.81 * math.cos(z[0]) / (inertia + m)],
        (0, 0.5),
        [math.pi / 4, spin],
        rtol=1e-10,
        atol=1e-12,
    )
    assert found.q[-1, 2] == pytest.approx(pendulum.y[0, -1], abs=0.05)
    assert [j.kind for j in found.jumps] == [Change.JUMP_WITHOUT_COLLISION]
    assert found.jumps[0].time <= 2 * h + 1e-12
    assert found.jumps[0].gamma < 0.0


def test_given_steps_that_are_equal_are_constant_steps() -> None:
    start = make_state(ROD, "sliding")
    constant = simulate(start, step=2.0**-9, until=0.5)
    given = simulate(start, step=[2.0**-9] * 300, until=0.5)
    np.testing.assert_array_equal(constant.q, given.q)
    np.testing.assert_array_equal(constant.t, given.t)


def test_the_contact_tolerance_makes_contact_at_that_distance() -> None:
    start = make_start(block(), q={"x": 0, "y": "1/100"}, u={"y": -1}, parameters=SLIDING)
    strict = simulate(start, step=1e-3, until=5e-3)
    wide = simulate(start, step=1e-3, until=5e-3, contact_tolerance=0.0095)
    assert not strict.jumps
    assert wide.jumps[0].time == pytest.approx(1e-3)
    assert wide.q[-1, 1] == pytest.approx(0.009, abs=1e-4)


def test_the_step_compiled_and_in_python_are_the_same_function() -> None:
    motion, start = block_motion()
    for code in range(5):
        arguments = (SteppingMethod(code, 0.5, 0.0), 0.0, 1e-2, start.q, start.u, start.p)
        compiled, plain = motion.step(*arguments), motion.step.py_func(*arguments)
        for x, y in zip(compiled, plain, strict=True):
            np.testing.assert_allclose(x, y, rtol=1e-15, atol=1e-15)


def block_motion():
    start = make_start(
        block(),
        q={"x": 1, "y": 0},
        u={"x": -2, "y": -1},
        parameters={"beta": 0.5, "bend": 0.3, "mu": 2, "weight": 3, "drag": 1},
    )
    return start.motion, start


def test_the_contact_problem_agrees_with_all_its_modes_tried_one_by_one() -> None:
    random, several = np.random.default_rng(3), 0
    for _ in range(3000):
        L = random.normal(size=(2, 2))
        G = L @ L.T + 1e-2 * np.eye(2)
        a, b, C = G[0, 0], G[0, 1], G[1, 1]
        minus, plus = random.uniform(0.1, 5.0, 2)
        v_n, v_t, bias = random.normal(size=3)
        rows = np.array([0, 0, 0, 0, 0, a, a + plus * b, 0, 0, 0, 0, b, C, a - minus * b, plus, minus])
        solutions = []
        if v_n + bias >= 0:
            solutions.append((0.0, 0.0))
        r = -np.linalg.solve(G, [v_n + bias, v_t])
        if r[0] > 0 and -minus * r[0] <= r[1] <= plus * r[0]:
            solutions.append(tuple(r))
        for s in (plus, -minus):
            r_n = -(v_n + bias) / (a + b * s)
            if r_n > 0 and (v_t + (b + C * s) * r_n) * s < 0:
                solutions.append((r_n, s * r_n))
        for function in (segment.impulse, segment.impulse.py_func):
            found, _ = function(rows, 2, (v_n, v_t), bias)
            np.testing.assert_allclose(found, min(solutions, key=np.linalg.norm), rtol=1e-9, atol=1e-12)
        assert segment.solutions(rows, 2, v_n + bias, v_t) == len(solutions)
        several += len(solutions) > 1
    assert several > 50


@pytest.mark.parametrize("scheme", STEPPED)
def test_steps_whose_problem_has_several_solutions_are_counted(scheme: str) -> None:
    # gamma < 0 and a force that lifts: lift-off, slip and sticking all solve it
    lifting = make_state(ROD, keys={"theta": "atan(2)"}, parameters={"mu": 2, "gravity": -10})
    tests_contact = load_scheme(scheme).tests_contact
    found = simulate(lifting, scheme=scheme, step=1e-3, until=1e-3, contact_tolerance=1e-4 if tests_contact else 0.0)
    assert found.statistics["steps_with_several_solutions"] == 1
    assert found.branch[1] == ContactMode.FREE
    sliding = simulate(make_state(ROD, "sliding"), scheme=scheme, step=1e-3, until=0.1)
    assert sliding.statistics["steps_with_several_solutions"] == 0


def test_the_record_says_what_the_formulas_say() -> None:
    found = simulate(make_state(ROD, "stoss"), step=1e-2, until=0.5)
    table = found.to_xarray()
    theta, y = found.q[:, 2], found.q[:, 1]
    np.testing.assert_allclose(table.g, np.sin(theta) - y, atol=1e-14)
    gamma = (1 + 3 * np.cos(theta) ** 2 - 5 * np.abs(np.sin(theta) * np.cos(theta))) / (1 + np.cos(theta) ** 2)
    np.testing.assert_allclose(table.gamma, gamma, rtol=1e-12)
    np.testing.assert_allclose(table.v_t, found.u[:, 0] + np.sin(theta) * found.u[:, 2], rtol=1e-12)
    np.testing.assert_allclose(table.v_n, found.u[:, 1] - np.cos(theta) * found.u[:, 2], atol=1e-12)
    np.testing.assert_allclose(table.kinetic_energy, (found.u**2 @ [1, 1, 1 / 3]) / 2, rtol=1e-13)
    assert all(v.attrs["long_name"] for v in table.data_vars.values())
    assert table.u_theta.attrs["units"] == "rad/s"
    assert (
        table.branch.attrs["flag_meanings"].split()[int(table.branch[20])] == ContactMode(int(found.branch[20])).label
    )


def test_a_stored_jump_is_the_impulse_of_its_step() -> None:
    found = simulate(make_state(ROD, "paradox"), step=1e-3, until=0.1)
    (jump,) = found.jumps
    h = found.t[jump.index] - found.t[jump.index - 1]
    free = found.u[jump.index - 1] + h * np.array([0, -9.81, 0])
    np.testing.assert_allclose(jump.u_minus, free, atol=1e-13)
    assert jump.as_dict() == {"time": jump.time, "kind": "jump_without_collision", "gamma": jump.gamma}


BAD = [
    ({"step": 0.0, "until": 1.0}, "step: 0.0 must be a positive number"),
    ({"step": math.nan, "until": 1.0}, "step: nan must be a positive number"),
    ({"step": 1e-3, "until": -1.0}, "until: -1.0 must be zero or a positive number"),
    ({"step": 1e-9, "until": 1.0}, "too many to keep"),
    ({"step": 1e-300, "until": 1e300}, "too many to keep"),
    ({"step": [0.1, -0.1], "until": 0.1}, "every given step must be a positive number"),
    ({"step": [0.1, 0.1], "until": 1.0}, "give more steps"),
    ({"step": 0.1, "until": 1.0, "scheme": "leapfrog"}, "no 'leapfrog'; choose one of contact_dynamics"),
    ({"step": 0.1, "until": 1.0, "contact_tolerance": -1.0}, "contact_tolerance: -1.0 must be zero"),
    ({"step": 0.1, "until": 1.0, "scheme": "stewart_trinkle", "contact_tolerance": 0.1}, "leave it at 0"),
    ({"step": 0.1, "until": 1.0, "options": {"theta": 0.5}}, "no option 'theta'"),
    ({"step": 0.1, "until": 1.0, "scheme": "moreau_jean", "options": {"theta": 2.0}}, "between 0 and 1"),
]


@pytest.mark.allow_fp_errors
@pytest.mark.parametrize(("arguments", "words"), BAD)
def test_bad_input_is_refused_in_one_line(arguments: dict, words: str) -> None:
    with pytest.raises(InputError, match=r".*") as refusal:
        simulate(make_state(ROD, "sliding"), **arguments)
    assert words in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_a_start_inside_the_floor_is_refused_and_a_rounded_contact_is_not() -> None:
    with pytest.raises(InputError, match=r"not admissible: g\(q\) = 0\.1 is positive beyond rounding"):
        make_start(block(), q={"x": 0, "y": "-1/10"})
    assert abs(as_start(make_state(ROD, "stoss")).rows[0]) < 1e-15
    with pytest.raises(InputError, match="the start needs q of y"):
        make_start(block(), q={"x": 0})
    with pytest.raises(InputError, match="no coordinate 'z'"):
        make_start(block(), q={"x": 0, "y": 1}, u={"z": 1})
    with pytest.raises(InputError, match="M is not positive definite"):
        make_start(block(), q={"x": 0, "y": 1}, parameters={"beta": 2})


@pytest.mark.allow_fp_errors
def test_a_motion_that_leaves_the_numbers_ends_with_a_reason() -> None:
    start = make_start(block(), q={"x": 0, "y": 1}, u={"x": 1}, parameters={"drag": 1e9})
    found = simulate(start, step=1.0, until=1000.0)
    assert found.ending is Ending.NOT_FINITE
    assert np.isfinite(found.u).all()
    assert 1 < found.steps < 1000
    assert found.as_dict()["status"] == "not_finite"


def test_every_listed_scheme_says_where_it_comes_from() -> None:
    for name in SCHEME_NAMES:
        scheme = load_scheme(name)
        assert scheme.name == name
        assert scheme.order >= 1
        assert len(scheme.source) > 20


def implicit_steps(q: np.ndarray, u: np.ndarray, h: float) -> list[tuple[ContactMode, np.ndarray]]:
    """Every (branch, u1) of the position-level step of Glocker's rod, m = l = 1, I = 1/3, mu = 5/3, gravity 10.

    Each branch leaves one unknown, the new angle; roots of g(q1) = 0 are sought on a fine grid of it.
    """
    v, inverse, mu = u - [0.0, 10.0 * h, 0.0], np.array([1.0, 1.0, 3.0]), 5 / 3

    def step(angle: float, branch: ContactMode) -> tuple[np.ndarray, float, float]:
        turn = (angle - q[2]) / h - v[2]
        normal, tangent = inverse * [0.0, 1.0, -math.cos(angle)], inverse * [1.0, 0.0, math.sin(angle)]
        if branch is ContactMode.STICK:
            H = tangent / inverse
            A = [[H @ normal, H @ tangent], [normal[2], tangent[2]]]
            r_n, r_t = np.linalg.solve(A, [-H @ v, turn])
        else:
            s = mu if branch is ContactMode.SLIP_PLUS else -mu
            r_n = turn / (normal[2] + s * tangent[2])
            r_t = s * r_n
        return v + normal * r_n + tangent * r_t, r_n, r_t

    def gap(angle: float, branch: ContactMode) -> float:
        return float(math.sin(angle) - q[1] - h * step(angle, branch)[0][1])

    found = [(ContactMode.FREE, v)] if math.sin(q[2] + h * v[2]) <= q[1] + h * v[1] else []
    for branch in (ContactMode.STICK, ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS):
        angles = q[2] + h * np.linspace(-60.0, 60.0, 4001)
        signs = np.sign([gap(angle, branch) for angle in angles])
        for i in np.flatnonzero(signs[1:] != signs[:-1]):
            root = brentq(gap, angles[i], angles[i + 1], args=(branch,), xtol=1e-16)
            u1, r_n, r_t = step(root, branch)
            slip = u1[0] + math.sin(root) * u1[2]
            if r_n > 0.0 and abs(r_t) <= mu * r_n * (1 + 1e-12) and (branch is ContactMode.STICK or slip * r_t < 0.0):
                found.append((branch, u1))
    return found


@pytest.mark.parametrize("h", [1.0143e-4, 1.01886e-4])
def test_the_position_level_scheme_finds_the_one_solution_of_its_step_close_to_the_edge_of_a_paradox(h: float) -> None:
    state = make_state(load_scene("slender_rod"), "stoss")
    found = simulate(state, scheme="schatzman_paoli", step=h, until=0.86, monitor=False)
    assert found.ending is Ending.REACHED_END
    for t in (0.80, 0.8133):  # rounding of g is worth 1/p times more velocity there: p is about 0.03
        i = int(np.searchsorted(found.t, t))
        ((branch, u1),) = implicit_steps(found.q[i], found.u[i], h)
        assert found.branch[i + 1] == branch == ContactMode.SLIP_PLUS
        np.testing.assert_allclose(found.u[i + 1], u1, rtol=0.0, atol=1e-8)


def test_where_the_step_of_the_position_level_scheme_has_several_solutions_the_tip_is_left_free() -> None:
    found = simulate(
        make_state(load_scene("slender_rod"), "stoss"), scheme="schatzman_paoli", step=1e-3, until=0.83, monitor=False
    )
    i = int(np.searchsorted(found.t, 0.8155))
    assert {b for b, _ in implicit_steps(found.q[i], found.u[i], 1e-3)} == {
        ContactMode.FREE,
        ContactMode.STICK,
        ContactMode.SLIP_PLUS,
    }
    assert found.branch[i + 1] == ContactMode.FREE
    assert found.statistics["steps_with_several_solutions"] > 0
