"""The library's scenes against closed forms, finite differences of positions, limits and other coordinates."""

from __future__ import annotations

import mpmath
import pytest
import sympy as sp
from planar_scenes import SCENE_NAMES as PLANAR
from reference_law import Reference, dot, gamma_squared, to_mp

from painleve.errors import InputError
from painleve.exact.parse import exact_number
from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Segment
from painleve.mechanics.library import SCENE_NAMES, load_scene
from painleve.mechanics.scene import Scene, make_scene
from painleve.mechanics.state import make_state, resolve_parameters
from painleve.theory.classification import Branch, classify
from painleve.theory.limit_set import limit_set

ROD, GENERAL, BODY, ELLIPSE = (load_scene(n) for n in ("slender_rod", "general_rod", "planar_body", "ellipse"))
OBSTACLE, ARM, LINKS = (load_scene(n) for n in ("rod_on_obstacle", "two_link_arm", "general_arm"))
MINIMAL, BEAD = load_scene("minimal"), load_scene("bead")
BRANCHES = {
    "sliding": Branch.NONE,
    "hilltop": Branch.NONE,
    "stoss": Branch.NONE,
    "paradox": Branch.NEGATIVE,
    "oblique": Branch.NEGATIVE,
    "isolated": Branch.CRITICAL_ISOLATED,
    "isolated_by_slope": Branch.CRITICAL_ISOLATED,
}
STEP = mpmath.mpf(10) ** -20


@pytest.fixture(autouse=True)
def fifty_digits():
    with mpmath.workdps(50):
        yield


def at(scene: Scene, expression: sp.Expr, **values: object) -> mpmath.mpf:
    """The value at coordinates and parameters, the rest by default."""
    given = {p.name: values[p.name] for p in scene.parameters if p.name in values}
    point = {p.symbol: resolve_parameters(scene, given)[p.name] for p in scene.parameters}
    point |= {c.symbol: exact_number(values.get(c.name, 0), where=c.name) for c in scene.coordinates}
    return to_mp(sp.sympify(expression).xreplace(point))


def close(left: mpmath.mpf, right: mpmath.mpf, digits: int = 35) -> bool:
    return bool(mpmath.almosteq(left, right, abs_eps=mpmath.mpf(10) ** -digits))


@pytest.mark.parametrize("scene", SCENE_NAMES)
def test_every_named_state_lies_in_the_branch_that_its_name_says(scene):
    for state in load_scene(scene).states:
        found = classify(make_state(load_scene(scene), state.name)).branch
        assert found is BRANCHES.get(state.name, Branch.CRITICAL_APPROACHED), (scene, state.name)


# --- rods and bodies -------------------------------------------------------------------------------------------------


def test_a_general_rod_with_alpha_three_is_the_slender_rod():
    general, rod = derive(GENERAL), derive(ROD)
    three = {GENERAL.parameter("alpha").symbol: sp.Integer(3)}
    uniform = {ROD.parameter("I").symbol: ROD.parameter("m").symbol * ROD.parameter("l").symbol ** 2 / 3}
    for mine, theirs in zip((*general.delassus, general.gamma), (*rod.delassus, rod.gamma), strict=True):
        assert sp.simplify(mine.xreplace(three) - theirs.xreplace(uniform)) == 0
    assert GENERAL.force == ROD.force


@pytest.mark.parametrize("alpha", ["1", "3/2", "3", "8", "40"])
def test_the_general_rod_s_least_critical_friction_found_by_searching_is_the_published_formula(alpha):
    value = sp.Rational(alpha)
    theta = ROD.q[2]
    friction = sp.lambdify(
        theta,
        derive(GENERAL).critical_friction.xreplace(
            {s: sp.Integer(1) for s in (GENERAL.parameter("m").symbol, GENERAL.parameter("l").symbol)}
            | {GENERAL.parameter("alpha").symbol: value}
        ),
        "mpmath",
    )
    grid = [mpmath.pi * k / 400 for k in range(1, 200)]
    best = min(grid, key=friction)
    stationary = mpmath.findroot(lambda s: mpmath.diff(friction, s), best)
    assert close(friction(stationary), to_mp(2 * sp.sqrt(1 + value) / value), 20)
    assert close(mpmath.tan(stationary) ** 2, to_mp(1 + value), 15)
    assert min(map(friction, grid)) >= friction(stationary)


def test_a_planar_body_s_critical_friction_is_that_of_its_contact_point_s_offset():
    """mu_c = (I/m + X^2)/|X Y| with (X, Y) the turned offset, computed with complex numbers."""
    for theta, xi, eta in ((0.3, -0.7, -0.2), (2.0, 0.4, -0.9), (-1.0, 0.1, 0.5)):
        values = {"theta": sp.Rational(str(theta)), "xi": str(xi), "eta": str(eta), "m": "3/2", "I": "2/7"}
        offset = mpmath.mpc(str(xi), str(eta)) * mpmath.expj(mpmath.mpf(str(theta)))
        X, Y = offset.real, offset.imag
        expected = (mpmath.mpf(2) / 7 / mpmath.mpf("1.5") + X**2) / abs(X * Y)
        assert close(at(BODY, derive(BODY).critical_friction, **values), expected)


def test_a_planar_body_that_touches_with_the_end_of_its_axis_is_the_rod():
    length = ROD.parameter("l").symbol
    offset = {BODY.parameter("xi").symbol: -length, BODY.parameter("eta").symbol: sp.Integer(0)}
    assert BODY.inertia == ROD.inertia
    for left, right in ((BODY.contact.constraint, ROD.contact.constraint), (derive(BODY).gamma, derive(ROD).gamma)):
        assert sp.simplify(left.xreplace(offset) - right) == 0
    assert (BODY.contact.tangents.xreplace(offset) - ROD.contact.tangents).applyfunc(sp.simplify).is_zero_matrix


def test_the_planar_body_s_law_is_the_same_in_the_coordinates_of_its_contact_point():
    """Coordinates (contact x, contact height, theta): a full M, g = -height; a, b, C and the limit set agree."""
    x, y, theta = BODY.coordinates
    m, xi, eta, inertia = (BODY.parameter(n).symbol for n in ("m", "xi", "eta", "I"))
    X = xi * sp.cos(theta.symbol) - eta * sp.sin(theta.symbol)
    Y = xi * sp.sin(theta.symbol) + eta * sp.cos(theta.symbol)
    centre = (x.velocity + Y * theta.velocity, y.velocity - X * theta.velocity)
    mu = BODY.parameter("mu").symbol
    other = make_scene(
        name="by_contact",
        sentence="a body",
        source="a test",
        coordinates=BODY.coordinates,
        parameters=BODY.parameters,
        constraint=-y.symbol,
        tangential_displacements=(x.symbol,),
        kinetic_energy=m * (centre[0] ** 2 + centre[1] ** 2) / 2 + inertia * theta.velocity**2 / 2,
        friction=Segment(minus=mu, plus=mu),
        keys=BODY.keys,
        placement={"theta": theta.symbol},
        velocity={"x": BODY.keys[1].symbol},
    )
    for mine, theirs in zip(derive(other).delassus, derive(BODY).delassus, strict=True):
        assert sp.simplify(mine - theirs) == 0
    mine, theirs = (limit_set(make_state(s, keys={"theta": "atan(2/11)"}, parameters={"mu": 2})) for s in (BODY, other))
    assert exact_sign(mine.multiplier - theirs.multiplier).sign is Sign.ZERO
    assert exact_sign(mine.tangential[0] - theirs.tangential[0]).sign is Sign.ZERO


# --- the ellipse -----------------------------------------------------------------------------------------------------


def ellipse_point(phi: mpmath.mpf, x: mpmath.mpf, y: mpmath.mpf, theta: mpmath.mpf) -> mpmath.mpc:
    """The material point of parameter phi on the rim, semi-axes 1 and 1/2."""
    return mpmath.mpc(x, y) + mpmath.expj(theta) * mpmath.mpc(mpmath.cos(phi), mpmath.sin(phi) / 2)


@pytest.mark.parametrize("angle", ["0.4", "1.3", "-0.7", "2.5"])
def test_g_and_h_of_the_ellipse_are_those_of_its_lowest_point_searched_on_the_rim(angle):
    """The lowest point is found on the rim; H is the finite difference of the position of that material point."""
    x, y, theta = mpmath.mpf("0.3"), mpmath.mpf("0.9"), mpmath.mpf(angle)
    grid = [2 * mpmath.pi * k / 300 for k in range(300)]
    start = min(grid, key=lambda phi: ellipse_point(phi, x, y, theta).imag)
    slope = lambda phi: mpmath.re(mpmath.expj(theta) * mpmath.mpc(-mpmath.sin(phi), mpmath.cos(phi) / 2) * -1j)  # noqa: E731
    phi = mpmath.findroot(slope, start)
    values = {"x": "3/10", "y": "9/10", "theta": angle}
    assert close(at(ELLIPSE, ELLIPSE.contact.constraint, **values), -ellipse_point(phi, x, y, theta).imag)
    for j, q in enumerate(ELLIPSE.q):
        shift = [STEP if i == j else mpmath.mpf(0) for i in range(3)]
        ahead = ellipse_point(phi, x + shift[0], y + shift[1], theta + shift[2])
        behind = ellipse_point(phi, x - shift[0], y - shift[1], theta - shift[2])
        change = (ahead - behind) / (2 * STEP)
        assert close(at(ELLIPSE, ELLIPSE.contact.tangents[j], **values), change.real, 25)
        assert close(at(ELLIPSE, sp.diff(ELLIPSE.contact.constraint, q), **values), -change.imag, 25)


def test_an_ellipse_with_equal_axes_is_a_disc_which_has_no_paradox():
    equal = {ELLIPSE.parameter("B").symbol: ELLIPSE.parameter("A").symbol}
    assert sp.simplify(derive(ELLIPSE).couplings[0].xreplace(equal)) == 0
    state = make_state(ELLIPSE, keys={"theta": "2/3"}, parameters={"B": 1, "mu": 1000})
    assert exact_sign(state.exact(derive(ELLIPSE).gamma) - 1).sign is Sign.ZERO


def test_a_flat_ellipse_tends_to_the_rod_of_four_times_its_inertia():
    """I = m A^2/4, so alpha = 4; the difference is of the order of B^2."""
    rod = at(GENERAL, derive(GENERAL).critical_friction, theta="4/5", alpha="4")
    differences = [
        at(ELLIPSE, derive(ELLIPSE).critical_friction, theta="4/5", B=sp.Rational(1, 10**n)) - rod for n in (3, 6)
    ]
    assert abs(differences[0]) < 1e-5
    assert mpmath.almosteq(differences[0] / differences[1], mpmath.mpf(10) ** 6, rel_eps=1e-4)


def test_the_heavy_core_has_a_maximum_of_mu_c_at_its_isolated_state_and_a_minimum_at_its_approached_one():
    """Plain values of (I/m + h'^2)/(h |h'|), with h' by finite differences of the support function."""
    core, semi = mpmath.mpf(3) / 100, mpmath.mpf(1) / 2
    h = lambda s: mpmath.sqrt(mpmath.sin(s) ** 2 + semi * mpmath.cos(s) ** 2)  # noqa: E731
    friction = lambda s: (core + mpmath.diff(h, s) ** 2) / abs(h(s) * mpmath.diff(h, s))  # noqa: E731
    for name, sense in (("isolated", -1), ("approached", 1)):
        state = make_state(ELLIPSE, name)
        theta, mu = to_mp(state.q[2]), to_mp(state.parameters["mu"])
        assert close(friction(theta), mu, 20)
        for step in (mpmath.mpf("1e-3"), mpmath.mpf("1e-5")):
            assert min(sense * (friction(theta + side * step) - mu) for side in (-1, 1)) > 0.1 * step**2


# --- the obstacle ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("theta", "psi"), [("3/5", "1/3"), ("-2/5", "1"), ("1", "-3/4")])
def test_on_an_obstacle_the_rod_is_that_of_a_flat_floor_turned_with_the_tangent(theta, psi):
    parameters = {"R": "5/2", "mu": "7/5"}
    turned = make_state(OBSTACLE, keys={"theta": theta, "psi": psi}, parameters=parameters)
    flat = make_state(ROD, keys={"theta": sp.Rational(theta) + sp.Rational(psi)}, parameters={"mu": "7/5"})
    mine, theirs = ([*derive(s.scene).delassus, derive(s.scene).gamma] for s in (turned, flat))
    for one, other in zip(map(turned.exact, mine), map(flat.exact, theirs), strict=True):
        assert close(to_mp(one), to_mp(other))


def test_an_obstacle_of_huge_radius_is_the_flat_floor_and_the_difference_falls_like_its_curvature():
    values = {"x": "1/2", "y": "3/4", "theta": "4/5"}
    for mine, theirs in (
        (OBSTACLE.contact.constraint, ROD.contact.constraint),
        (derive(OBSTACLE).gamma, derive(ROD).gamma),
    ):
        flat = at(ROD, theirs, **values)
        near, far = (at(OBSTACLE, mine, R=sp.Integer(10) ** n, **values) - flat for n in (6, 12))
        assert 0 < abs(near) < 1e-5
        assert mpmath.almosteq(near / far, mpmath.mpf(10) ** 6, rel_eps=1e-4)


def test_off_the_surface_the_obstacle_s_cone_is_that_of_the_true_distance_and_the_unit_tangent():
    """Finite differences of positions in complex numbers; g and H carry one positive factor, and H is no gradient."""
    q = [mpmath.mpf(s) for s in ("0.7", "1.2", "0.9")]
    tip = lambda x, y, theta: mpmath.mpc(x, y + 2) - mpmath.expj(theta)  # noqa: E731 (from the obstacle's centre)
    names = {c.name: str(v) for c, v in zip(OBSTACLE.coordinates, ("0.7", "1.2", "0.9"), strict=True)}
    factor, tangent = abs(tip(*q)) / 2, -1j * tip(*q) / abs(tip(*q))
    for j, symbol in enumerate(OBSTACLE.q):
        ahead, behind = ([v + side * STEP * (i == j) for i, v in enumerate(q)] for side in (1, -1))
        velocity = (tip(*ahead) - tip(*behind)) / (2 * STEP)
        along, distance = (velocity * mpmath.conj(tangent)).real, (abs(tip(*ahead)) - abs(tip(*behind))) / (2 * STEP)
        assert close(at(OBSTACLE, OBSTACLE.contact.tangents[j], **names), factor * along, 25)
        assert close(at(OBSTACLE, sp.diff(OBSTACLE.contact.constraint, symbol), **names), -factor * distance, 25)
    assert mpmath.sign(at(OBSTACLE, OBSTACLE.contact.constraint, **names)) == mpmath.sign(2 - abs(tip(*q)))
    curl = sp.diff(OBSTACLE.contact.tangents[0], OBSTACLE.q[1]) - sp.diff(OBSTACLE.contact.tangents[1], OBSTACLE.q[0])
    assert abs(at(OBSTACLE, curl, **names)) > 0.1


# --- arms ------------------------------------------------------------------------------------------------------------


def test_the_general_arm_of_default_links_is_the_uniform_arm():
    m1, m2, l1, l2 = (ARM.parameter(n).symbol for n in ("m1", "m2", "l1", "l2"))
    c1, c2, I1, I2 = (LINKS.parameter(n).symbol for n in ("c1", "c2", "I1", "I2"))
    half = sp.Rational(1, 2)
    uniform = {c1: half, c2: half, I1: m1 * l1**2 / 12, I2: m2 * l2**2 / 12}
    for left, right in (
        (LINKS.inertia, ARM.inertia),
        (LINKS.force, ARM.force),
        (LINKS.contact.tangents, ARM.contact.tangents),
    ):
        assert (left.xreplace(uniform) - right).applyfunc(sp.simplify).is_zero_matrix
    assert LINKS.contact.constraint == ARM.contact.constraint
    table = {n: v for n, v in make_state(LINKS, keys={"phi1": "-1/6"}).parameters.items() if n in ("c1", "c2", "I1")}
    assert table == {"c1": half, "c2": half, "I1": sp.Rational(1, 12)}


def test_the_general_arm_s_inertia_is_that_of_two_point_masses_on_each_link():
    """Point masses m/2 at c -+ r of the length have the centre c and the inertia m (r l)^2: energies of positions."""
    t = sp.Symbol("t")
    angles = [sp.Function(n)(t) for n in ("f", "g")]
    m, l = sp.symbols("m1 m2", positive=True), sp.symbols("l1 l2", positive=True)  # noqa: E741
    c, r = sp.symbols("c1 c2", real=True), sp.symbols("r1 r2", positive=True)
    down = [sp.Matrix([sp.sin(a), -sp.cos(a)]) for a in angles]
    energy = 0
    for side in (-1, 1):
        first = (c[0] + side * r[0]) * l[0] * down[0]
        second = l[0] * down[0] + (c[1] + side * r[1]) * l[1] * down[1]
        energy += sum(mass / 4 * (p.diff(t).T * p.diff(t))[0] for mass, p in ((m[0], first), (m[1], second)))
    u = sp.symbols("u_1 u_2")
    energy = energy.xreplace({a.diff(t): v for a, v in zip(angles, u, strict=True)})
    energy = energy.xreplace(dict(zip(angles, LINKS.q, strict=True)))
    inertias = {LINKS.parameter(f"I{i + 1}").symbol: m[i] * (r[i] * l[i]) ** 2 for i in range(2)}
    difference = sp.hessian(sp.expand(energy), u) - LINKS.inertia.xreplace(inertias)
    assert difference.applyfunc(sp.simplify).is_zero_matrix


def test_mu_c_of_the_general_arm_along_the_table_has_a_maximum_at_its_isolated_state():
    state = make_state(LINKS, "isolated")
    reference, p = Reference(LINKS), None
    p = reference.parameters(state.parameters)
    depth, phi1 = to_mp(state.parameters["depth"]), to_mp(state.q[0])

    def friction(first: mpmath.mpf) -> mpmath.mpf:
        local = reference.at([first, mpmath.acos(depth - mpmath.cos(first))], p)
        Y = mpmath.lu_solve(local.M, local.w_n)
        return dot(local.w_n, Y) / abs(dot(local.H, Y))

    at_state = friction(phi1)
    assert close(at_state, to_mp(state.parameters["mu"]), 30)
    for step in (mpmath.mpf("1e-3"), mpmath.mpf("1e-5")):
        assert max(friction(phi1 + side * step) for side in (-1, 1)) < at_state - step**2


def test_without_its_second_angle_the_arm_reaches_for_the_table_at_the_depth_given():
    state = make_state(ARM, keys={"phi1": "-1/6"})
    assert state.parameters["depth"] == sp.Rational(39, 20)
    assert exact_sign(sp.cos(state.q[1]) + sp.cos(sp.Rational(1, 6)) - sp.Rational(39, 20)).sign is Sign.ZERO
    assert make_state(ARM, keys={"phi1": "-1/6"}, parameters={"depth": "19/10"}).q[1] > state.q[1]
    with pytest.raises(InputError, match=r"state key phi2 by default: .* is not known to be real and finite"):
        make_state(ARM, keys={"phi1": 1})


# --- the bead and the minimal scene ----------------------------------------------------------------------------------


def test_the_bead_s_equations_are_newton_s_on_the_parabola():
    """M du = f + lambda w_n on the wall, against the closed equation of motion and the pressure along the normal."""
    x, w = BEAD.q
    u_x, u_w = BEAD.u
    m, kappa, gravity = BEAD.p
    acceleration = -(kappa**2 * x * u_x**2 + gravity * kappa * x) / (1 + kappa**2 * x**2)
    on_wall = {w: 0, u_w: 0}
    residual = (BEAD.inertia * sp.Matrix([acceleration, 0]) - BEAD.force).xreplace(on_wall)
    assert sp.simplify(residual[0]) == 0
    # Newton in the plane: the wall's force along y is m (gravity + y'') with y = kappa x^2/2
    height = kappa * (u_x**2 + x * acceleration)
    assert sp.simplify(residual[1] - m * (gravity + height)) == 0


def test_gamma_of_the_minimal_scene_is_the_polynomial_of_its_coefficients():
    for x, y in ((sp.Rational(1, 3), sp.Rational(-1, 5)), (sp.Rational(2, 7), sp.Rational(1, 4))):
        beta = 1 + x - y / 2 + 2 * x**2 - 3 * y**2
        values = {"beta_x": "1", "beta_y": "-1/2", "beta_xx": "2", "beta_yy": "-3", "mu": "3/2", "A": "9", "N": "2"}
        assert close(at(MINIMAL, derive(MINIMAL).gamma, x=x, y=y, **values), to_mp(2 - abs(beta) * sp.Rational(3, 2)))


@pytest.mark.parametrize("name", ["approached", "isolated", "isolated_by_slope", "crossing"])
def test_the_minimal_scene_s_neighbours_by_brute_force_are_those_of_its_branch(name):
    state = make_state(MINIMAL, name)
    reference = Reference(MINIMAL)
    p = reference.parameters(state.parameters)
    isolated = classify(state).branch is Branch.CRITICAL_ISOLATED
    for size in (mpmath.mpf("1e-2"), mpmath.mpf("1e-5")):
        cloud = [[size * i / 10, -size * j / 10] for i in range(-10, 11) for j in range(11) if (i, j) != (0, 0)]
        values = [gamma_squared(reference.at(q, p)) for q in cloud]
        assert (max(values) > 0) is not isolated


# --- tangents instead of displacements -------------------------------------------------------------------------------


def test_tangents_of_the_wrong_shape_or_beside_displacements_are_refused():
    x, y = BEAD.coordinates
    parts = {
        "name": "block",
        "sentence": "a block",
        "source": "a test",
        "coordinates": (x, y),
        "parameters": (),
        "inertia": sp.eye(2),
        "constraint": -y.symbol,
        "friction": Segment(minus=1, plus=1),
    }
    assert make_scene(**parts, tangents=sp.Matrix([1, 0])).contact.tangents == sp.Matrix([1, 0])
    with pytest.raises(InputError, match="H has 3 rows; it needs 2, one for each coordinate"):
        make_scene(**parts, tangents=sp.Matrix([1, 0, 0]))
    with pytest.raises(InputError, match="give tangential displacements or their gradients H, not both"):
        make_scene(**parts, tangents=sp.Matrix([1, 0]), tangential_displacements=(x.symbol,))


NEW = [(n, s.name) for n in SCENE_NAMES if n not in PLANAR for s in load_scene(n).states]


@pytest.mark.parametrize(("scene", "name"), NEW)
def test_every_named_state_is_in_contact_with_a_tangential_velocity_to_45_digits(scene, name):
    state = make_state(load_scene(scene), name)
    q, u = ([to_mp(x) for x in values] for values in (state.q, state.u))
    p = [to_mp(state.parameters[x.name]) for x in state.scene.parameters]
    gradient = [sp.diff(state.scene.contact.constraint, x) for x in state.scene.q]
    g, *w = sp.lambdify([*state.scene.q, *state.scene.p], [state.scene.contact.constraint, *gradient], "mpmath")(*q, *p)
    assert abs(g) < mpmath.mpf(10) ** -45
    assert abs(dot(mpmath.matrix(w), mpmath.matrix(u))) < mpmath.mpf(10) ** -45
    assert max(map(abs, u)) > 0.1
