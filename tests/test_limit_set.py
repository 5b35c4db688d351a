"""A(q, u-): u_tilde against a convex solver and 60 digits, the closed form of its impulse, and what moves with it."""

from __future__ import annotations

import clarabel
import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from planar_scenes import SCENE_NAMES
from reference_law import DIGITS, Reference, dot, law, norm, to_mp
from scipy import sparse

from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Segment
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Coordinate, StateKey, make_scene
from painleve.mechanics.state import State, make_state
from painleve.sets import LineSegment as Stretch
from painleve.sets import Points
from painleve.theory.limit_set import LimitSet, limit_set

NAMED = [(name, state.name) for name in SCENE_NAMES for state in load_scene(name).states if state.name != "stoss"]
KINDS = {"sliding": "point", "paradox": "pair"}
ROD, WORN, ARM = (load_scene(name) for name in SCENE_NAMES)


def limit_of(scene: str, name: str) -> LimitSet:
    return limit_set(make_state(load_scene(scene), name))


def projection(state: State) -> np.ndarray:
    """minimise the kinetic energy of u- + M^-1 r over impulses of the cone that keep it tangential (clarabel)."""
    local = Reference(state.scene).at_state(state, [0.0] * len(state.q))
    M = np.array(local.M.tolist(), dtype=float)
    E = np.column_stack([[float(x) for x in edge] for edge in local.edges()])
    u, response = np.array([float(to_mp(x)) for x in state.u]), np.linalg.solve(M, E)
    lifts = np.array([float(x) for x in local.lifts()])
    lifts[np.abs(lifts) < 1e-14] = 0.0  # gamma = 0 exactly at the critical states
    A = np.vstack([lifts, -np.eye(2)])
    settings_ = clarabel.DefaultSettings()
    settings_.verbose, settings_.tol_gap_abs, settings_.tol_gap_rel, settings_.tol_feas = False, 1e-13, 1e-13, 1e-13
    solver = clarabel.DefaultSolver(
        sparse.csc_matrix(np.triu(E.T @ response)),
        E.T @ u,
        sparse.csc_matrix(A),
        np.zeros(3),
        [clarabel.ZeroConeT(1), clarabel.NonnegativeConeT(2)],
        settings_,
    )
    return u + response @ np.array(solver.solve().x)


@pytest.mark.parametrize(("scene", "name"), NAMED)
def test_the_kind_of_a_is_point_pair_or_segment_as_gamma_is_positive_negative_or_zero(scene, name):
    limit = limit_of(scene, name)
    kind = KINDS.get(name, "segment")
    assert limit.kind == kind
    assert limit.gamma.sign is {"point": Sign.POSITIVE, "pair": Sign.NEGATIVE, "segment": Sign.ZERO}[kind]
    assert limit.critical == (kind == "segment")
    with mpmath.workdps(DIGITS):
        local = Reference(limit.state.scene).at_state(limit.state, [0.0] * len(limit.state.q))
        gamma = min(local.lifts()) / dot(local.w_n, local.w_n)
        assert abs(gamma - limit.gamma_value) <= 1e-15 * abs(gamma) + mpmath.mpf(10) ** -55


@pytest.mark.parametrize(("scene", "name"), NAMED)
def test_u_tilde_is_the_projection_that_an_interior_point_solver_finds(scene, name):
    limit = limit_of(scene, name)
    np.testing.assert_allclose(limit.u_plus, projection(limit.state), rtol=0, atol=1e-6)


@pytest.mark.parametrize(("scene", "name"), [n for n in NAMED if n[1] != "sliding"])
def test_u_tilde_is_the_limit_of_the_law_at_q_itself_as_the_normal_velocity_tends_to_zero(scene, name):
    """S(q, u- + delta n') with v_n = -delta tends to u_tilde, at 60 digits, with an error of the size of delta."""
    limit = limit_of(scene, name)
    with mpmath.workdps(DIGITS):
        local = Reference(limit.state.scene).at_state(limit.state, [0.0] * len(limit.state.q))
        u_tilde = [to_mp(x) for x in limit.u_tilde]
        for delta in (mpmath.mpf(10) ** -10, mpmath.mpf(10) ** -20):
            v = [to_mp(x) - delta * w for x, w in zip(limit.state.u, local.w_n, strict=True)]
            reached = law(local, v)
            assert norm([x - y for x, y in zip(reached, u_tilde, strict=True)]) < 10 * delta
        assert norm([x - to_mp(y) for x, y in zip(u_tilde, limit.state.u, strict=True)]) > 0.1


@pytest.mark.parametrize(("scene", "name"), [n for n in NAMED if n[1] != "sliding"])
def test_after_the_jump_the_tip_is_at_rest_exactly(scene, name):
    limit = limit_of(scene, name)
    state, d = limit.state, derive(limit.state.scene)
    for direction in (d.normal, state.scene.contact.tangents):
        speed = sum(state.exact(w) * x for w, x in zip(direction, limit.u_tilde, strict=True))
        assert exact_sign(speed).sign is Sign.ZERO


@pytest.mark.parametrize(("scene", "name"), [n for n in NAMED if n[1] != "sliding"])
def test_the_jump_s_impulse_is_lambda_tilde_rho(scene, name):
    """lambda = -v_t s*/(rho.G rho) with rho = (1, s*), s* = -a/b; and u_tilde = u- + lambda M^-1 W rho."""
    limit = limit_of(scene, name)
    with mpmath.workdps(DIGITS):
        local = Reference(limit.state.scene).at_state(limit.state, [0.0] * len(limit.state.q))
        Y_n, Y_t = mpmath.lu_solve(local.M, local.w_n), mpmath.lu_solve(local.M, local.H)
        a, b, C = dot(local.w_n, Y_n), dot(local.w_n, Y_t), dot(local.H, Y_t)
        u = mpmath.matrix([to_mp(x) for x in limit.state.u])
        s = -a / b
        multiplier = -dot(local.H, u) * s / (a + 2 * b * s + C * s**2)
        tiny = mpmath.mpf(10) ** -50
        assert multiplier > 0
        assert abs(to_mp(limit.multiplier) - multiplier) < tiny
        assert abs(to_mp(limit.tangential[0]) - s * multiplier) < tiny
        u_tilde = u + (Y_n + s * Y_t) * multiplier
        assert norm([x - to_mp(y) for x, y in zip(u_tilde, limit.u_tilde, strict=True)]) < tiny
        if limit.critical:  # then rho is an edge of the cone
            assert abs(abs(s) - (local.plus if limit.edge == 1 else local.minus)) < tiny
            assert mpmath.sign(s) == limit.edge


@pytest.mark.parametrize(("scene", "name"), [n for n in NAMED if n[1] != "sliding"])
def test_a_slip_in_the_other_sense_or_none_leaves_nothing_indeterminate(scene, name):
    named = load_scene(scene).state(name)
    opposite = f"-({named.keys.get('slip', '-1')})"
    for slip in (opposite, "0"):
        limit = limit_set(make_state(load_scene(scene), name, keys={"slip": slip}))
        assert limit.kind == "point"
        assert limit.u_tilde == limit.state.u
        assert limit.multiplier == 0
        assert not limit.critical
        if slip == opposite:  # about zero the solver's energy gap says little of the velocity
            np.testing.assert_allclose(projection(limit.state), limit.u_minus, rtol=0, atol=1e-6)


def test_the_rod_s_jump_at_the_double_zero_is_the_one_computed_by_hand():
    """m = l = 1, tan = 2, v_t = -1: a = 8/5, b = -6/5, C = 17/5, a C - b^2 = 4, r = v_t (b, -a)/4 = (3, 4)/10,
    du = M^-1 W r = (r_t, r_n, 3 (-cos r_n + sin r_t)) = (2/5, 3/10, 3/(2 sqrt 5))."""
    limit = limit_of("slender_rod", "double_zero")
    assert (limit.multiplier, *limit.tangential) == (sp.Rational(3, 10), sp.Rational(2, 5))
    expected = (-sp.Rational(3, 5), sp.Rational(3, 10), 3 / (2 * sp.sqrt(5)))
    assert all(exact_sign(x - y).sign is Sign.ZERO for x, y in zip(limit.u_tilde, expected, strict=True))


def test_the_arm_in_the_plane_of_its_two_angles_jumps_to_rest():
    for name in ("paradox", "isolated", "approached"):
        assert all(exact_sign(x).sign is Sign.ZERO for x in limit_of("two_link_arm", name).u_tilde)


# --- what A does not depend on, and how it scales --------------------------------------------------------------------

SHIFTS = st.fractions(-5, 5, max_denominator=9)


@given(SHIFTS, SHIFTS)
@settings(max_examples=10)
def test_a_horizontal_translation_changes_nothing(shift, speed):
    """x is a coordinate on which nothing depends: A moves with nothing but the velocities given."""
    there = limit_set(make_state(ROD, "paradox", keys={"x": shift}))
    here = limit_of("slender_rod", "paradox")
    assert there.kind == here.kind
    assert there.u_tilde == here.u_tilde


@given(st.fractions(1, 10, max_denominator=9))
@settings(max_examples=10)
def test_the_limit_set_is_positively_homogeneous_in_the_velocity(factor):
    for name in ("paradox", "double_zero"):
        one, other = (limit_set(make_state(ROD, name, keys={"slip": slip})) for slip in (-1, -factor))
        assert one.kind == other.kind
        scaled = [sp.Rational(factor) * x for x in one.u_tilde]
        assert all(exact_sign(x - y).sign is Sign.ZERO for x, y in zip(scaled, other.u_tilde, strict=True))


@pytest.mark.parametrize("mu", ["2", "5/2", "100"])
def test_at_gamma_below_zero_u_tilde_does_not_depend_on_the_friction(mu):
    assert (
        limit_set(make_state(ROD, "paradox", parameters={"mu": mu})).u_tilde
        == limit_of("slender_rod", "paradox").u_tilde
    )


@pytest.mark.parametrize(("nudge", "kind"), [("-1e-40", "point"), ("0", "segment"), ("1e-40", "pair")])
def test_the_sign_of_gamma_is_decided_at_a_critical_friction_and_1e_40_beside_it(nudge, kind):
    assert limit_set(make_state(ROD, "double_zero", parameters={"mu": f"4/3 + {nudge}"})).kind == kind


# --- A as a set ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scene", "name"), NAMED)
def test_a_as_a_set_has_u_minus_and_u_tilde_as_its_ends(scene, name):
    limit = limit_of(scene, name)
    A = limit.point_set
    if limit.kind == "segment":
        assert isinstance(A, Stretch)
        ends = np.array([A.start, A.end])
    else:
        assert isinstance(A, Points)
        ends = np.asarray(A.members)
    expected = [limit.u_minus] if limit.kind == "point" else [limit.u_minus, limit.u_plus]
    assert np.array_equal(ends, expected)
    np.testing.assert_allclose(limit.jump, limit.u_plus - limit.u_minus, rtol=0, atol=1e-15)
    assert limit.ends.kind == ("pair" if limit.kind == "segment" else limit.kind)
    assert limit.ends.u_tilde == limit.u_tilde


# --- other sections --------------------------------------------------------------------------------------------------


def one_sided(minus: str, plus: str, slip: int) -> LimitSet:
    """g = -y and M^-1 = [[4, 1], [1, 1]]: a = b = 1, C = 4; gamma = min(1 - minus, 1 + plus)."""
    x, y = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in ("x", "y"))
    scene = make_scene(
        name="one_sided",
        sentence="a scene",
        source="a test",
        coordinates=(x, y),
        parameters=(),
        inertia=sp.Matrix([[4, 1], [1, 1]]).inv(),
        constraint=-y.symbol,
        tangential_displacements=(x.symbol,),
        friction=Segment(minus=sp.Rational(minus), plus=sp.Rational(plus)),
        keys=(StateKey(name="slip", unit="m/s", sentence="slip"),),
        velocity={"x": sp.Symbol("slip", real=True)},
    )
    return limit_set(make_state(scene, keys={"slip": slip}))


@pytest.mark.parametrize(
    ("minus", "plus", "slip", "kind", "edge"),
    [
        ("1/2", "9", 1, "point", 0),
        ("1", "0", 1, "segment", -1),
        ("1", "9", -1, "point", -1),
        ("2", "0", 1, "pair", -1),
        ("2", "9", 1, "pair", -1),
        ("0", "9", 1, "point", 0),
    ],
)
def test_of_an_asymmetric_section_only_the_end_that_opposes_b_matters(minus, plus, slip, kind, edge):
    limit = one_sided(minus, plus, slip)
    assert (limit.kind, limit.edge if limit.gamma.sign is not Sign.POSITIVE else 0) == (kind, edge)
    np.testing.assert_allclose(projection(limit.state), limit.u_plus, rtol=0, atol=1e-6)


def test_without_friction_a_is_a_point():
    x, y = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in ("x", "y"))
    scene = make_scene(
        name="smooth",
        sentence="a scene",
        source="a test",
        coordinates=(x, y),
        parameters=(),
        inertia=sp.eye(2),
        constraint=-y.symbol,
    )
    limit = limit_set(make_state(scene, keys={"u_x": 3}))
    assert (limit.kind, limit.edge, limit.gamma.sign) == ("point", 0, Sign.POSITIVE)
