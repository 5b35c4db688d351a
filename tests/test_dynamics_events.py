"""Event-driven and compliant contact, and jumps without collision on Glocker's rod."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from dynamics_scenes import block, slope
from scipy.integrate import solve_ivp

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, Ending
from painleve.dynamics.arc import ArcPoint
from painleve.dynamics.grid import make_grid
from painleve.dynamics.modes import ContactPoint, closed_modes
from painleve.dynamics.schemes import load_scheme
from painleve.dynamics.schemes.event_driven import _EventDrivenRun
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import as_start, make_start
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

ROD = load_scene("slender_rod")
STOSS = make_state(ROD, "stoss")


def test_the_smooth_slip_of_glockers_rod_reaches_45_degrees_at_the_published_instant() -> None:
    found = simulate(STOSS, scheme="event_driven", step=0.1, until=1.0)
    assert found.ending is Ending.INCONSISTENT
    assert "grows without bound" in found.sentence
    assert found.t[-1] == pytest.approx(0.81455, abs=5e-6)
    assert found.q[-1, 2] == pytest.approx(math.pi / 4, abs=1e-8)
    # The singular point has zero free normal acceleration too: spin^2 = gravity / (l sin theta). It is approached
    # along a curve whose tangent the eigenvalue ratio 2/3 makes slow, hence the wide bound.
    assert found.u[-1, 2] ** 2 == pytest.approx(10 / math.sin(math.pi / 4), rel=1e-3)


def test_the_slip_of_the_event_driven_method_is_the_reduced_equation_of_the_rod() -> None:
    found = simulate(STOSS, scheme="event_driven", step=0.05, until=0.5)

    def reduced(t: float, z: np.ndarray) -> list[float]:
        theta, spin = z
        force = (10 - spin**2 * math.sin(theta)) / (
            1 + 3 * math.cos(theta) ** 2 - 5 * math.sin(theta) * math.cos(theta)
        )
        return [spin, 3 * force * (5 / 3 * math.sin(theta) - math.cos(theta))]

    slow = solve_ivp(reduced, (0, 0.5), [math.radians(31), 0.0], rtol=1e-11, atol=1e-13, t_eval=[0.5])
    np.testing.assert_allclose(found.q[-1, 2], slow.y[0, -1], rtol=1e-8)
    np.testing.assert_allclose(found.u[-1, 2], slow.y[1, -1], rtol=1e-8)


@pytest.mark.parametrize(
    ("omega", "mu", "gamma_sign", "beta_sign", "modes"),
    [
        (0, "1/2", 1, -1, {ContactMode.SLIP_PLUS}),
        (5, "1/2", 1, 1, {ContactMode.FREE}),
        (0, "2", -1, -1, set()),
        (5, "2", -1, 1, {ContactMode.FREE, ContactMode.SLIP_PLUS}),
    ],
)
def test_slip_has_the_four_published_regimes(
    omega: int, mu: str, gamma_sign: int, beta_sign: int, modes: set[ContactMode]
) -> None:
    start = as_start(make_state(ROD, keys={"theta": "atan(2)", "omega": omega}, parameters={"mu": mu}))
    point = ContactPoint.at(start, 0.0, np.array(start.q), np.array(start.u))
    sine, cosine = 2 / math.sqrt(5), 1 / math.sqrt(5)
    assert math.copysign(1, 1 + 3 * cosine**2 - 3 * float(Fraction(mu)) * sine * cosine) == gamma_sign
    beta = -9.81 + omega**2 * sine
    assert point.beta_n == pytest.approx(beta, rel=1e-12)
    assert math.copysign(1, beta) == beta_sign
    assert set(closed_modes(point, -1)) == modes
    found = simulate(start, scheme="event_driven", step=1e-3, until=1e-3)
    expected = {0: Ending.INCONSISTENT, 1: Ending.REACHED_END, 2: Ending.INDETERMINATE}[len(modes)]
    assert found.ending is expected
    if expected is Ending.INDETERMINATE:
        assert found.sentence.endswith("(two: lift-off, slip_plus; at t = 0)")


def test_a_tip_at_rest_has_every_mode_that_solves_newtons_law() -> None:
    """Each mode is put back into M a = f + W lambda and Coulomb's law, and they are counted another way."""
    random, counts = np.random.default_rng(0), set()
    for _ in range(300):
        parameters = {
            "beta": random.uniform(-1.2, 1.2),
            "mu": random.uniform(0.1, 6.0),
            "weight": random.normal() * 5,
            "beat": random.normal() * 20,
            "drag": 0.0,
            "bend": 0.0,
        }
        start = make_start(block(), q={"x": 0, "y": 0}, parameters={k: float(v) for k, v in parameters.items()})
        point = ContactPoint.at(start, 0.5, np.array(start.q), np.array(start.u))
        modes = closed_modes(point, 0)
        counts.add(len(modes))
        for mode in modes:
            normal, tangential = point.force(mode)
            a_t, a_n = np.array(point.acceleration) + point.response(normal, tangential)
            assert normal >= 0.0
            assert a_n >= -1e-10
            assert abs(normal * a_n) < 1e-9
            assert abs(tangential) <= parameters["mu"] * normal + 1e-9
            assert (
                abs(a_t) < 1e-9
                or mode is ContactMode.FREE
                or tangential * a_t == pytest.approx(-parameters["mu"] * normal * abs(a_t), rel=1e-9)
            )
        assert len(modes) == solutions_by_friction_ratio(point, parameters["mu"])
    assert counts == {1, 3}  # an odd number, but where two of them merge


@pytest.mark.parametrize(("factor", "moves"), [(0.0, 0), (1.0, 0), (1 - 2**-30, 0), (1 + 2**-30, 1)])
def test_a_block_holds_up_to_the_limit_of_friction_and_slides_beyond_it(factor: float, moves: int) -> None:
    """On the limit itself, rounded as it comes, it holds; either way, with any mass."""
    for mass, mu, side in itertools.product(["1", "1/3", "1000"], ["1/2", "1/3", "sqrt(2)"], [1, -1]):
        force = f"{side}*({Fraction(factor)})*({mass})*({mu})*9.81"
        start = make_start(slope(), q={"x": 0, "y": 0}, parameters={"alpha": 0, "m": mass, "mu": mu, "F": force})
        found = simulate(start, scheme="event_driven", step=0.5, until=1.0)
        assert found.ending is Ending.REACHED_END
        way = moves * side * 2**-30 * start.p[2] * 9.81 / 2
        assert found.q[-1, 0] == pytest.approx(way, rel=1e-6, abs=1e-14)
        assert found.statistics["stick"] == (0 if moves else found.steps)


def test_a_block_on_ice_moves_with_any_force() -> None:
    for force in (0.0, 1e-12, -3.0):
        start = make_start(slope(), q={"x": 0, "y": 0}, parameters={"alpha": 0, "mu": 0, "F": force})
        found = simulate(start, scheme="event_driven", step=0.5, until=1.0)
        assert found.ending is Ending.REACHED_END
        assert found.q[-1, 0] == pytest.approx(force / 2, rel=1e-9)


def test_a_block_rests_on_a_slope_at_the_angle_of_friction() -> None:
    pushes = (("0", False), ("-1/2**30", True), ("1/2**30", False), ("2*9.81*sin(ALPHA)", False))
    for degrees, (push, moves) in itertools.product((1, 10, 30, 45, 60, 80, 89), pushes):
        alpha = f"({degrees}*pi/180)"
        start = make_start(
            slope(),
            q={"x": 0, "y": 0},
            parameters={"alpha": alpha, "m": 1, "mu": f"tan{alpha}", "F": push.replace("(ALPHA)", alpha)},
        )
        found = simulate(start, scheme="event_driven", step=0.25, until=1.0)
        assert found.ending is Ending.REACHED_END
        assert found.q[-1, 0] == pytest.approx(-(2.0**-31) * moves, rel=1e-4, abs=1e-13)


def test_a_block_drawn_to_and_fro_sticks_and_slides_when_the_force_passes_the_limit() -> None:
    """beat sin(3 t) against the friction 1.25: it sticks until sin(3 t) = 1/2, and the slip is an integral."""
    start = make_start(block(), q={"x": 0, "y": 0}, parameters={"mu": 0.25, "weight": 10, "beat": 2.5})
    found = simulate(start, scheme="event_driven", step=0.01, until=0.5)
    begins = math.asin(0.5) / 3
    moving = np.flatnonzero(found.branch == ContactMode.SLIP_MINUS)
    assert found.t[moving[0] - 1] == pytest.approx(begins, abs=1e-9)
    t = found.t[moving]
    exact = 2.5 * (np.cos(3 * begins) - np.cos(3 * t)) / 3 - 1.25 * (t - begins)
    np.testing.assert_allclose(found.u[moving, 0], exact, atol=1e-8)


def test_a_body_at_rest_without_weight_stays_free() -> None:
    found = simulate(make_start(block(), q={"x": 0, "y": 0}), scheme="event_driven", step=0.1, until=1.0)
    assert found.ending is Ending.REACHED_END
    assert not found.q.any()


def solutions_by_friction_ratio(point: ContactPoint, mu: float) -> int:
    """Lift-off, and the sign changes along lambda_t = s lambda_n, s in [-mu, mu], of a_t with a_n = 0 kept."""
    count = int(point.beta_n >= 0.0)
    (b_nn, b_nt), b_tt = (point.a, point.b), point.C

    def tangential(s: float) -> tuple[float, float]:
        normal = -point.beta_n / (b_nn + b_nt * s)
        return normal, point.beta_t + (b_nt + b_tt * s) * normal

    for s, sign in ((mu, -1.0), (-mu, 1.0)):
        normal, a_t = tangential(s)
        count += normal > 0.0 and sign * a_t > 0.0
    root = (b_nn * point.beta_t - b_nt * point.beta_n) / (b_tt * point.beta_n - b_nt * point.beta_t)  # a_t(s) = 0
    return count + int(abs(root) <= mu and tangential(root)[0] > 0.0)


@pytest.mark.parametrize(
    ("scene", "state"),
    [
        ("slender_rod", "critical"),
        ("slender_rod", "double_zero"),
        ("worn_tip_rod", "approached"),
        ("worn_tip_rod", "isolated"),
        ("two_link_arm", "approached"),
        ("two_link_arm", "isolated"),
    ],
)
def test_no_contact_force_is_made_of_a_gamma_that_is_zero_but_for_rounding(scene: str, state: str) -> None:
    found = simulate(make_state(load_scene(scene), state), scheme="event_driven", step=1e-3, until=0.1)
    assert found.ending is Ending.INCONSISTENT
    assert found.t[-1] < 1e-12


def test_a_slip_that_ends_sticks_and_stays() -> None:
    start = make_start(block(), q={"x": 0, "y": 0}, u={"x": 2}, parameters={"mu": 0.25, "weight": 10})
    found = simulate(start, scheme="event_driven", step=0.1, until=3.0)
    assert found.ending is Ending.REACHED_END
    assert found.q[-1, 0] == pytest.approx(2.0**2 / (2 * 0.25 * 5.0), rel=1e-9)
    assert abs(found.u[-1, 0]) < 1e-12
    # the impulses are what the floor gave: it carried the weight for three seconds
    assert found.r[:, 0].sum() == pytest.approx(5.0 * 3.0, rel=1e-9)
    assert found.r[:, 1].sum() == pytest.approx(-2.0, rel=1e-9)


@pytest.mark.parametrize("exponent", range(4, 13))
def test_a_slip_on_a_curved_constraint_ends_in_sticking_at_every_tolerance(exponent: int) -> None:
    """What the arc has drifted off the constraint, of the size of the tolerance, is no lift-off."""
    keys = {"phi1": "-1/2", "phi2": "3/5", "slip": "-1"}
    state = make_state(load_scene("two_link_arm"), keys=keys, parameters={"mu": "2/5"})
    rtol = 10.0**-exponent
    options = {"rtol": rtol, "atol": 1e-2 * rtol}
    found = simulate(state, scheme="event_driven", step=0.1, until=0.6, options=options)
    tight = simulate(state, scheme="event_driven", step=0.1, until=0.6, options={"rtol": 1e-13, "atol": 1e-15})
    assert found.ending is Ending.REACHED_END
    assert set(found.branch[1:]) == {ContactMode.SLIP_PLUS, ContactMode.STICK}
    assert np.abs(found.q[-1] - tight.q[-1]).max() < 100 * rtol
    assert np.abs(found.u[-1]).max() < 1e-12


def test_a_hop_far_shorter_than_a_step_lands_where_the_parabola_does() -> None:
    start = make_start(block(), q={"x": 0, "y": 0}, u={"x": 1, "y": "1e-9"}, parameters={"weight": 10, "mu": "1/4"})
    found = simulate(start, scheme="event_driven", step=0.1, until=0.2)
    assert found.ending is Ending.REACHED_END
    (jump,) = found.jumps
    assert jump.kind is Change.FRICTIONAL_IMPACT
    assert jump.time == pytest.approx(2 * 1e-9 / 10, rel=1e-6)
    assert found.u[-1, 0] == pytest.approx(1 - 0.25 * 5 * 0.2, rel=1e-8)
    assert found.q[-1, 1] == pytest.approx(0.0, abs=1e-15)


def test_a_tip_that_left_the_floor_below_its_level_lands_where_it_left_it() -> None:
    """Arcs of contact drift: where one ends with g > 0, no root of g tells of the landing."""
    start = make_start(block(), q={"x": 0, "y": 0}, u={"x": 1, "y": 1}, parameters={"weight": 10, "mu": "1/4"})
    depth, options = 1e-6, load_scheme("event_driven").settings(0.0, None)
    run = _EventDrivenRun(start, make_grid(0.0, 0.01, 0.5), options, lambda covered: None)
    run.place = ArcPoint(0.0, np.array([0.0, -depth, 1.0, 1.0, 0.0, 0.0]))
    found = run.go()
    (jump,) = found.jumps
    assert jump.time == pytest.approx(0.2, rel=1e-9)
    assert found.contact_quantities()["g"].max() == pytest.approx(depth, rel=1e-9)


def test_a_rod_falls_hits_and_slides_in_closed_form() -> None:
    start = make_start(ROD, q={"x": 0, "y": 2, "theta": "pi/4"}, u={"x": -1}, parameters={"mu": "1/2"})
    found = simulate(start, scheme="event_driven", step=0.1, until=0.55)
    height = 2 - math.sin(math.pi / 4)
    arrival, speed = math.sqrt(2 * height / 9.81), math.sqrt(2 * height * 9.81)
    (jump,) = found.jumps
    assert jump.kind is Change.FRICTIONAL_IMPACT
    assert jump.time == pytest.approx(arrival, rel=1e-9)
    np.testing.assert_allclose(jump.u_minus, [-1, -speed, 0], atol=1e-8)
    w, H, inverse = np.array([0, 1, -math.sqrt(0.5)]), np.array([1, 0, math.sqrt(0.5)]), np.diag([1, 1, 3])
    W = np.column_stack([w, H])
    stick = -np.linalg.solve(W.T @ inverse @ W, W.T @ [-1, -speed, 0])
    s = np.clip(stick[1] / stick[0], -0.5, 0.5)
    impulse = speed / (w @ inverse @ (w + s * H))
    np.testing.assert_allclose(jump.u_plus, [-1, -speed, 0] + inverse @ (w + s * H) * impulse, atol=1e-8)


def test_stiffer_compliant_contacts_come_closer_to_the_rigid_slide() -> None:
    state = make_state(ROD, keys={"theta": "pi/3", "slip": -3, "omega": 1}, parameters={"mu": "3/10"})
    rigid = simulate(state, scheme="event_driven", step=0.1, until=0.1)
    distances = []
    for stiffness in (1e4, 1e6):
        soft = simulate(state, scheme="compliant", step=0.05, until=0.1, options={"stiffness": stiffness})
        assert soft.ending is Ending.REACHED_END
        distances.append(np.abs(soft.q[-1] - rigid.q[-1]).max())
    assert distances[1] < distances[0] / 20  # the penetration is weight/stiffness: a hundredth
    assert distances[1] < 1e-4


def test_a_compliant_contact_sticks_fast_where_the_rigid_one_has_no_acceleration() -> None:
    found = simulate(make_state(ROD, "paradox"), scheme="compliant", step=0.01, until=0.05)
    quantities = found.contact_quantities()
    assert quantities["v_t"][0] == pytest.approx(-1.0)
    assert abs(quantities["v_t"][-1]) < 0.05
    assert found.jumps == ()


@pytest.mark.parametrize("name", ["stiffness", "damping_ratio", "slip_speed", "rtol"])
def test_compliant_options_must_be_positive(name: str) -> None:
    with pytest.raises(InputError, match=f"scheme compliant: {name} = -1.0 must be a positive number"):
        simulate(STOSS, scheme="compliant", step=0.1, until=0.1, options={name: -1.0})


def test_the_jump_of_glockers_rod_has_no_collision_and_does_not_shrink_with_the_step() -> None:
    sizes, approaches, steps = [], [], (1e-3, 1e-4, 1e-5)
    for h in steps:
        for factor in np.linspace(0.9, 1.1, 12):
            found = simulate(STOSS, step=float(h * factor), until=0.85, monitor=False)
            jumps = [j for j in found.jumps if j.kind is Change.JUMP_WITHOUT_COLLISION]
            if jumps:
                jump = jumps[0]
                w = np.array([0.0, 1.0, -math.cos(found.q[jump.index, 2])])
                sizes.append(np.linalg.norm(jump.u_plus - jump.u_minus))
                approaches.append(abs(w @ jump.u_minus))
                assert found.branch[jump.index] == ContactMode.STICK
                assert found.jumps[0] is jump
                break
    assert len(sizes) == len(steps)
    assert min(sizes) > 5.0
    assert approaches[0] > 20 * approaches[2]


def test_ordinary_sliding_has_no_jump_at_any_step_size() -> None:
    state = make_state(ROD, keys={"theta": "pi/3", "slip": -3, "omega": 1}, parameters={"mu": "3/10"})
    for h in (1e-2, 1e-3, 1e-4):
        assert simulate(state, step=h, until=0.3, monitor=False).jumps == ()


def test_a_collision_is_told_from_a_jump_without_one_although_gamma_is_negative() -> None:
    start = make_start(ROD, q={"x": 0, "y": 2, "theta": "atan(2)"}, u={"x": -1}, parameters={"mu": 2})
    (jump, *_) = simulate(start, step=1e-3, until=0.6).jumps
    assert jump.kind is Change.FRICTIONAL_IMPACT
    assert jump.gamma < 0.0
    (tangential,) = simulate(make_state(ROD, "paradox"), step=1e-3, until=0.1).jumps
    assert tangential.kind is Change.JUMP_WITHOUT_COLLISION
    (smooth,) = simulate(
        make_start(block(frictional=False), q={"x": 0, "y": 1}, u={"x": 1}, parameters={"weight": 10}),
        step=1e-3,
        until=1.0,
    ).jumps
    assert smooth.kind is Change.IMPACT
