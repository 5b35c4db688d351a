"""Derived scenes against the rod by hand, Lagrange's equations by another library, and limits that must agree."""

from __future__ import annotations

import pytest
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Segment
from painleve.mechanics.library import SCENE_NAMES, load_scene
from painleve.mechanics.scene import Coordinate, Parameter, Scene, make_scene

ROD, WORN, ARM = (load_scene(name) for name in ("slender_rod", "worn_tip_rod", "two_link_arm"))
x, y, theta = ROD.q
m, l, I, mu, gravity = ROD.p  # noqa: E741 (the field's letters)
sin, cos = sp.sin(theta), sp.cos(theta)
UNIFORM = {I: m * l**2 / 3}


def same(left: sp.Expr, right: sp.Expr) -> bool:
    return sp.simplify(sp.expand_trig(left - right)) == 0


# --- the rod by hand -------------------------------------------------------------------------------------------------


def test_the_rod_s_inertia_normal_tangent_and_force_are_those_of_a_free_rigid_body():
    d = derive(ROD)
    assert ROD.inertia == sp.diag(m, m, I)
    assert d.normal == sp.Matrix([0, 1, -l * cos])  # w_n = -grad g with g = l sin(theta) - y
    assert ROD.contact.tangents == sp.Matrix([1, 0, l * sin])  # the tip's abscissa is x - l cos(theta)
    assert ROD.force == sp.Matrix([0, -m * gravity, 0])
    assert d.gradient_squared == 1 + l**2 * cos**2


def test_the_rod_s_delassus_entries_are_those_derived_by_hand():
    d = derive(ROD)
    assert same(d.a, 1 / m + l**2 * cos**2 / I)
    assert same(d.couplings[0], -(l**2) * sin * cos / I)
    assert same(d.compliance[0], 1 / m + l**2 * sin**2 / I)
    assert d.normal_response.applyfunc(sp.simplify) == sp.Matrix([0, 1 / m, -l * cos / I])
    assert d.tangent_response.applyfunc(sp.simplify) == sp.Matrix([1 / m, 0, l * sin / I])


def test_the_uniform_rod_s_gamma_and_critical_friction_are_the_closed_forms():
    d = derive(ROD)
    gamma = (d.gamma * d.gradient_squared).subs(UNIFORM)
    assert same(gamma, (1 + 3 * cos**2 - 3 * mu * sp.Abs(sin * cos)) / m)
    t = sp.tan(theta)
    for inclination in (sp.Rational(1, 10), sp.Integer(1), sp.Rational(3, 2)):
        difference = d.critical_friction.subs(UNIFORM) - (t + 4 / t) / 3
        assert exact_sign(difference.subs({m: 1, l: 1, theta: inclination})).sign is Sign.ZERO


def test_the_uniform_rod_s_critical_friction_is_least_at_tan_theta_2_and_is_4_thirds_there():
    critical = derive(ROD).critical_friction.subs(UNIFORM | {m: 1, l: 1})
    at = sp.atan(2)
    assert exact_sign(critical.subs(theta, at) - sp.Rational(4, 3)).sign is Sign.ZERO
    t = sp.Symbol("t", positive=True)
    excess = sp.factor((t + 4 / t) / 3 - sp.Rational(4, 3))  # (t - 2)^2/(3 t) >= 0
    assert sp.simplify(excess - (t - 2) ** 2 / (3 * t)) == 0
    for other in (sp.Rational(1, 10), sp.Rational(11, 10), sp.Rational(6, 5), sp.Rational(3, 2)):
        assert exact_sign(critical.subs(theta, other) - sp.Rational(4, 3)).sign is Sign.POSITIVE


def test_the_rod_s_least_critical_friction_is_painleve_s_value_for_every_moment_of_inertia():
    """mu_P = 2 sqrt(1 + alpha)/alpha at tan theta = sqrt(1 + alpha), alpha = m l^2/I."""
    alpha = sp.Symbol("alpha", positive=True)
    critical = derive(ROD).critical_friction.subs({m: 1, l: 1, I: 1 / alpha})
    for number in (sp.Integer(1), sp.Integer(3), sp.Rational(7, 2)):
        at = sp.atan(sp.sqrt(1 + number))
        value = critical.subs(alpha, number)
        assert exact_sign(value.subs(theta, at) - 2 * sp.sqrt(1 + number) / number).sign is Sign.ZERO
        for nudge in (-sp.Rational(1, 50), sp.Rational(1, 50)):
            assert exact_sign(value.subs(theta, at + nudge) - value.subs(theta, at)).sign is Sign.POSITIVE


@pytest.mark.parametrize("sense", [1, -1])
def test_the_band_of_paradoxes_ends_where_tan_theta_solves_the_quadratic(sense):
    tangent = (3 * mu + sense * sp.sqrt(9 * mu**2 - 16)) / 2
    for number in (sp.Rational(4, 3), sp.Integer(2), sp.Rational(5, 2)):
        gamma = derive(ROD).gamma.subs(UNIFORM).subs({m: 1, l: 1, theta: sp.atan(tangent)})
        assert exact_sign(gamma.subs(mu, number)).sign is Sign.ZERO


def test_the_worn_tip_s_critical_friction_has_second_derivative_25_thirds_and_third_75_halves():
    d = derive(WORN)
    at = {**dict.fromkeys(WORN.p, 1), WORN.p[2]: sp.Rational(1, 3), WORN.q[2]: sp.atan(2)}
    critical = d.critical_friction.subs(sp.Abs(d.couplings[0]), -d.couplings[0])
    derivatives = [sp.diff(critical, WORN.q[2], order) for order in (1, 2, 3)]
    for value, expected in zip(derivatives, (0, sp.Rational(25, 3), sp.Rational(75, 2)), strict=True):
        assert exact_sign(value.subs(at) - expected).sign is Sign.ZERO


# --- the arm by another library --------------------------------------------------------------------------------------


def lagrange_arm() -> LagrangesMethod:
    """Two uniform rods under gravity from their centres and moments of inertia, not from the energy of the scene."""
    m1, m2, l1, l2, _, _, weight = ARM.p
    angles = dynamicsymbols("alpha1 alpha2", real=True)
    elbow = sp.Matrix([l1 * sp.sin(angles[0]), -l1 * sp.cos(angles[0])])
    second = elbow + sp.Matrix([l2 * sp.sin(angles[1]), -l2 * sp.cos(angles[1])]) / 2
    time = dynamicsymbols._t
    kinetic, potential = sp.Integer(0), sp.Integer(0)
    for mass, length, centre, angle in ((m1, l1, elbow / 2, angles[0]), (m2, l2, second, angles[1])):
        speed = centre.diff(time)
        kinetic += mass * speed.dot(speed) / 2 + mass * length**2 / 12 * angle.diff(time) ** 2 / 2
        potential += mass * weight * centre[1]
    method = LagrangesMethod(kinetic - potential, angles)
    method.form_lagranges_equations()
    return method


def test_the_arm_s_inertia_and_force_with_gyroscopic_terms_are_those_of_lagrange_s_equations():
    method = lagrange_arm()
    angles, rates = list(method.q), list(method.u)
    names = dict(zip([*rates, *angles], [*ARM.u, *ARM.q], strict=True))
    M, f = (part.subs(names) for part in (method.mass_matrix, method.forcing))
    assert (M - ARM.inertia).applyfunc(lambda e: sp.simplify(sp.expand_trig(e))).is_zero_matrix
    assert (f - ARM.force).applyfunc(lambda e: sp.simplify(sp.expand_trig(e))).is_zero_matrix
    assert any(ARM.force.diff(u).has(*ARM.u) for u in ARM.u), "the force must hold terms in the velocities"


def test_the_arm_s_law_depends_on_both_angles_and_the_rod_s_on_its_inclination_alone():
    d, e = derive(ROD), derive(ARM)
    assert (d.shape, d.carried, d.idle) == ((2,), (1,), (0,))
    assert (e.shape, e.carried, e.idle) == ((0, 1), (), ())


# --- friction of other kinds -----------------------------------------------------------------------------------------


def block(friction: Segment | None, *parameters: Parameter) -> Scene:
    """A tilted block-like scene with constant, coupled inertia: M = [[2, 1], [1, 3]], g = -y, displacement x."""
    first, second = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in ("x", "y"))
    return make_scene(
        name="block",
        sentence="a block",
        source="a test",
        coordinates=(first, second),
        parameters=parameters,
        inertia=sp.Matrix([[2, 1], [1, 3]]),
        constraint=-second.symbol,
        tangential_displacements=() if friction is None else (first.symbol,),
        friction=friction,
    )


def test_a_frictionless_scene_has_gamma_a_and_no_tangential_quantities():
    d = derive(block(None))
    assert d.a == sp.Rational(2, 5)  # the (y, y) entry of the inverse of M
    assert d.gamma == d.a
    assert (d.couplings.shape, d.compliance.shape, dict(d.edge_compliance)) == ((0, 1), (0, 0), {})
    assert d.critical_friction is None
    assert d.tangent_response.shape == (2, 0)
    assert d.delassus == sp.Matrix([[d.a]])


def test_an_asymmetric_section_takes_the_lesser_of_its_two_ends():
    low, high = (
        Parameter(name=n, unit="1", sentence="coefficient", default="1", range="nonnegative") for n in ("low", "high")
    )
    d = derive(block(Segment(minus=low.symbol, plus=high.symbol), low, high))
    a, b = sp.Rational(2, 5), -sp.Rational(1, 5)
    assert (d.a, d.couplings[0], d.compliance[0]) == (a, b, sp.Rational(3, 5))
    assert d.critical_friction is None  # one number cannot say it
    for minus, plus in ((0, 1), (3, 1), (1, 3), (5, 0)):
        at = {low.symbol: minus, high.symbol: plus}
        s = (-minus, plus)
        assert d.gamma.subs(at) == min(a + b * end for end in s)
        assert (d.edge_compliance[-1].subs(at), d.edge_compliance[1].subs(at)) == tuple(a + b * end for end in s)


def test_gamma_of_an_equal_section_is_the_same_written_with_one_symbol_or_two():
    low, high = (
        Parameter(name=n, unit="1", sentence="coefficient", default="1", range="nonnegative") for n in ("low", "high")
    )
    two = derive(block(Segment(minus=low.symbol, plus=high.symbol), low, high)).gamma
    one = derive(block(Segment(minus=low.symbol, plus=low.symbol), low, high)).gamma
    for number in (0, 1, 3):
        assert two.subs({low.symbol: number, high.symbol: number}) == one.subs(low.symbol, number)


def test_where_b_vanishes_everywhere_no_friction_is_critical():
    first, second = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in ("x", "y"))
    mu_ = Parameter(name="mu", unit="1", sentence="coefficient", default="1", range="nonnegative")
    scene = make_scene(
        name="particle",
        sentence="a particle",
        source="a test",
        coordinates=(first, second),
        parameters=(mu_,),
        inertia=sp.eye(2),
        constraint=-second.symbol,
        tangential_displacements=(first.symbol,),
        friction=Segment(minus=mu_.symbol, plus=mu_.symbol),
    )
    d = derive(scene)
    assert d.critical_friction == sp.oo
    assert d.gamma == 1


@pytest.mark.parametrize("name", SCENE_NAMES)
def test_gamma_is_the_least_over_a_fine_grid_of_the_section_of_what_the_paper_defines(name):
    """gamma = min over w in D_1 of <n, M^-1 (n + w)>, with n normalised and D_1 = H s/|grad g|."""
    scene = load_scene(name)
    d = derive(scene)
    point = {s: sp.Rational(3 * i + 2, 7) for i, s in enumerate((*scene.q, *scene.p))}
    M, n, H = (sp.Matrix(e).xreplace(point).evalf(30) for e in (scene.inertia, d.normal, scene.contact.tangents))
    size = n.norm()
    values = [(n.T * M.LUsolve(n + H * s))[0] / size**2 for s in section_grid(scene.contact.section, point)]
    gamma = d.gamma.xreplace(point).evalf(30)
    spread = max(values) - min(values)
    # the ends of a segment are on the grid; on a circle of 2000 points the least is missed by a millionth of the spread
    missed = 0 if scene.contact.section.dimension < 2 else spread * 3e-6
    assert -1e-25 * max(map(abs, values)) <= min(values) - gamma <= missed + 1e-25 * max(map(abs, values))


def section_grid(friction, point):
    if not friction.dimension:
        return [sp.zeros(0, 1)]
    if isinstance(friction, Segment):
        minus, plus = (e.xreplace(point).evalf(30) for e in (friction.minus, friction.plus))
        return [sp.Matrix([-minus + (plus + minus) * j / 10]) for j in range(11)]
    circle = [sp.Matrix([sp.cos(t), sp.sin(t)]).evalf(30) for t in (2 * sp.pi * j / 2000 for j in range(2000))]
    E = friction.map.xreplace(point).evalf(30)
    return [E * sigma for sigma in circle]
