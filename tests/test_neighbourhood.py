"""The kind of a critical state: each argument against brute force, gamma on a fine cloud of touching and penetrating
neighbours at 50 digits."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath
import pytest
import sympy as sp
from reference_law import Reference, gamma_squared, to_mp

from painleve.mechanics.friction import Segment
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Coordinate, Parameter, Scene, StateKey, make_scene
from painleve.mechanics.state import State, make_state
from painleve.theory.limit_set import limit_set
from painleve.theory.neighbourhood import Neighbourhood, neighbours

APPROACHED, ISOLATED, UNDECIDED = Neighbourhood.APPROACHED, Neighbourhood.ISOLATED, Neighbourhood.UNDECIDED
X, Y = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in ("x", "y"))
x, y = X.symbol, Y.symbol
RADII = [mpmath.mpf(10) ** -n for n in (2, 4, 6)]


def minimal(height: sp.Expr, gamma: sp.Expr) -> Scene:
    """The minimal scene (docs/theory.md, section 6.2) with g = height(x) - y and M^-1 = [[4, 1], [1, 1]], and friction
    such that gamma |grad g|^2 is the given function."""
    compliance = sp.Matrix([[4, 1], [1, 1]])
    w_n, H = sp.Matrix([-sp.diff(height, x), 1]), sp.Matrix([1, 0])
    a, b = (w_n.T * compliance * w_n)[0], (w_n.T * compliance * H)[0]
    mu = sp.cancel((a - gamma) / b)
    return make_scene(
        name="minimal",
        sentence="a minimal scene",
        source="a test",
        coordinates=(X, Y),
        parameters=(),
        inertia=compliance.inv(),
        constraint=height - y,
        tangential_displacements=(x,),
        friction=Segment(minus=mu, plus=mu),
        keys=(StateKey(name="slip", unit="m/s", sentence="slip", default="1"),),
        velocity={"x": sp.Symbol("slip", real=True)},
    )


def coupled(beta: sp.Expr) -> Scene:
    """The same with a flat floor: M^-1 = [[4, beta], [beta, 1]], mu = 1, g = -y, gamma = 1 - |beta|."""
    return make_scene(
        name="coupled",
        sentence="a minimal scene",
        source="a test",
        coordinates=(X, Y),
        parameters=(),
        inertia=sp.Matrix([[4, beta], [beta, 1]]).inv(),
        constraint=-y,
        tangential_displacements=(x,),
        friction=Segment(minus=1, plus=1),
        keys=(StateKey(name="slip", unit="m/s", sentence="slip", default="1"),),
        velocity={"x": sp.Symbol("slip", real=True)},
    )


def half_ball(height: sp.Expr, r: mpmath.mpf) -> Iterator[list[mpmath.mpf]]:
    """Offsets of size about r with g >= 0: a fan of directions, and points as near to the floor as r^2 and r^3."""
    floor = sp.lambdify(x, height, "mpmath")
    for i in range(-12, 13):
        along = r * i / 12
        for depth in (0, r**3, *(r**2 * j / 8 for j in range(1, 40, 3)), *(r * j / 12 for j in range(1, 13))):
            yield [along, floor(along) - depth]


def kind_by_brute_force(scene: Scene, height: sp.Expr, gamma: sp.Expr) -> Neighbourhood:
    """Approached if gamma > 0 somewhere on every half-ball tried, isolated if nowhere on the smallest two."""
    value, reference = sp.lambdify([x, y], gamma, "mpmath"), Reference(scene)
    largest = []
    with mpmath.workdps(50):
        for r in RADII:
            cloud = [q for q in half_ball(height, r) if q != [0, 0]]
            for q in cloud[::90]:  # the formula is what the scene has
                assert mpmath.almosteq(gamma_squared(reference.at(q, [])), value(*q), abs_eps=mpmath.mpf(10) ** -45)
            largest.append(max(value(*q) for q in cloud))
    if all(value > 0 for value in largest):
        return APPROACHED
    assert all(value <= 0 for value in largest[1:])
    return ISOLATED


FLAT = sp.Integer(0)
# Machin's zero, which exact_sign does not know.
NOTHING = 4 * sp.atan(sp.Rational(1, 5)) - sp.atan(sp.Rational(1, 239)) - sp.pi / 4
DECIDED = {
    "gamma grows along the floor": (FLAT, x, APPROACHED, "not parallel"),
    "gamma grows along the floor, against a slope into it": (FLAT, x + 5 * y, APPROACHED, "not parallel"),
    "kappa < 0": (FLAT, -y, APPROACHED, "kappa < 0"),
    "kappa < 0 against a negative form": (FLAT, -y - 100 * x**2, APPROACHED, "kappa < 0"),
    "kappa > 0, form negative": (FLAT, y - x**2, ISOLATED, "kappa > 0.*negative definite"),
    "kappa > 0, form positive": (FLAT, y + x**2, APPROACHED, "kappa > 0.*positive in some"),
    "kappa > 0, form barely positive": (FLAT, y + x**2 / 8, APPROACHED, "kappa > 0.*positive in some"),
    "kappa > 0, form negative but for the floor's curvature": (x**2, y - x**2 / 2, APPROACHED, "positive in some"),
    "kappa > 0, form positive but for the floor's curvature": (-(x**2), y + x**2 / 2, ISOLATED, "negative definite"),
    "kappa > 0, mixed terms drop out": (FLAT, y + 7 * x * y + 5 * y**2 - x**2, ISOLATED, "negative definite"),
    "kappa > 0, gamma constant along the floor": (FLAT, y, ISOLATED, "negative definite"),  # x drops out
    "kappa > 0, gamma zero along a curved floor": (x**2, y - x**2, UNDECIDED, "semidefinite"),
    "kappa = 0, negative definite": (FLAT, -(x**2) - x * y - y**2, ISOLATED, "gradgamma = 0.*negative definite"),
    "kappa = 0, positive definite": (FLAT, x**2 + y**2, APPROACHED, "positive in some"),
    "kappa = 0, the case of beta = 1 + x^2 - y^2: only penetration is positive": (
        FLAT,
        y**2 - x**2,
        APPROACHED,
        "positive in some",
    ),
    "kappa = 0, a saddle": (FLAT, x * y, APPROACHED, "positive in some"),
    "kappa = 0, negative form on a curved floor": (x**2, -(x**2) - y**2, ISOLATED, "negative definite"),
    "kappa = 0, semidefinite": (FLAT, -((x + y) ** 2), UNDECIDED, "semidefinite"),
    "one coordinate, negative": (FLAT, -(x**2), ISOLATED, "negative definite"),
    "one coordinate, order three": (FLAT, x**3, APPROACHED, "order 3, odd"),
    "one coordinate, order four": (FLAT, x**4, APPROACHED, "order 4, positive"),
    "one coordinate, order four, negative": (FLAT, x**5 - x**4, ISOLATED, "order 4, negative"),
    "one coordinate, order seven": (FLAT, -(x**7), APPROACHED, "order 7, odd"),
    "one coordinate, odd, and the floor sees no other": (FLAT, y**3, UNDECIDED, "do not decide"),
    "one coordinate, odd, and an even order above it that must not be asked": (
        FLAT,
        y**3 + y**4,
        UNDECIDED,
        "not decide",
    ),
    "one coordinate, an undecided order and a positive one above it": (
        FLAT,
        NOTHING * x**3 + x**4,
        UNDECIDED,
        "not decide",
    ),
    "one coordinate, order eight": (FLAT, x**8, APPROACHED, "order 8, positive"),
    "one coordinate, order eight, negative": (FLAT, -(x**8), ISOLATED, "order 8, negative"),
    "one coordinate, order nine": (FLAT, x**9, UNDECIDED, "do not decide"),
    "one coordinate, order ten": (FLAT, -(x**10), UNDECIDED, "do not decide"),
    "not smooth": (FLAT, -sp.Abs(x), UNDECIDED, "not smooth"),
}


@pytest.mark.parametrize(("height", "gamma", "kind", "reason"), DECIDED.values(), ids=DECIDED.keys())
def test_each_argument_decides_what_brute_force_sees_or_says_that_it_does_not(height, gamma, kind, reason):
    scene = minimal(height, gamma)
    limit = limit_set(make_state(scene))
    assert (limit.kind, limit.edge) == ("segment", -1)
    found = neighbours(limit.state, limit.edge)
    assert found.kind is kind, found.reason
    assert all(part in found.reason.replace("grad gamma", "gradgamma") for part in reason.split(".*"))
    if kind is not UNDECIDED:
        assert kind_by_brute_force(scene, height, gamma) is kind


@pytest.mark.parametrize(
    ("beta", "kind", "reason"),
    [
        (1 + x**2 - y**2, APPROACHED, "positive in some direction"),
        (1 + x**2 + y**2, ISOLATED, "negative definite"),
        (1 - y + x**2, ISOLATED, "kappa > 0"),
        (1 - y - x**2, APPROACHED, "kappa > 0"),
        (1 + y, APPROACHED, "kappa < 0"),
        (1 + x, APPROACHED, "not parallel"),
        (sp.Integer(1), ISOLATED, "zero everywhere"),
        (-1 - x**2 + y**2, APPROACHED, "positive in some direction"),
    ],
)
def test_the_minimal_scene_shows_any_kind_that_its_coupling_asks_for(beta, kind, reason):
    scene = coupled(beta)
    limit = limit_set(make_state(scene, keys={"slip": int(sp.sign(beta.subs({x: 0, y: 0})))}))
    assert limit.kind == "segment"
    found = neighbours(limit.state, limit.edge)
    assert found.kind is kind
    assert reason in found.reason
    assert kind_by_brute_force(scene, FLAT, 1 - sp.Abs(beta)) is kind


def test_a_singular_coefficient_of_friction_is_undecided_and_not_an_error():
    """|(x, y)| has no gradient at the origin, though no |.| is written."""
    for gamma in (-sp.sqrt(x**2 + y**2), -((x**2) ** sp.Rational(3, 4))):
        scene = minimal(FLAT, gamma)
        limit = limit_set(make_state(scene))
        assert neighbours(limit.state, limit.edge).kind is UNDECIDED


# --- the worn tip ----------------------------------------------------------------------------------------------------


def gamma_beside(state: State, r: mpmath.mpf) -> list[mpmath.mpf]:
    """gamma |grad g|^2 at theta - r and theta + r, at the working precision; the floor is kept at g = 0 by y."""
    reference = Reference(state.scene)
    p = reference.parameters(state.parameters)
    theta = to_mp(state.q[2])
    return [gamma_squared(reference.at([0, mpmath.sin(theta + s), theta + s], p)) for s in (-r, r)]


@pytest.mark.parametrize(
    ("k", "kind", "signs"),
    [
        ("2", APPROACHED, [1, 1]),
        ("0", APPROACHED, [1, 1]),
        ("25/6 - 1e-20", APPROACHED, [1, 1]),
        ("25/6", APPROACHED, [-1, 1]),
        ("25/6 + 1e-20", ISOLATED, [-1, -1]),
        ("4467/1000", ISOLATED, [-1, -1]),
        ("6", ISOLATED, [-1, -1]),
    ],
)
def test_the_worn_tip_is_isolated_exactly_above_25_sixths(k, kind, signs):
    """At k = 25/6 order three decides: gamma > 0 on one side."""
    limit = limit_set(make_state(load_scene("worn_tip_rod"), "approached", parameters={"k": k}))
    found = neighbours(limit.state, limit.edge)
    assert found.kind is kind
    assert ("order 3" in found.reason) == (k == "25/6")
    with mpmath.workdps(120):
        for exponent in (22, 25):
            seen = [int(mpmath.sign(value)) for value in gamma_beside(limit.state, mpmath.mpf(10) ** -exponent)]
            assert seen == signs


def test_just_above_the_threshold_a_small_ball_is_needed_to_see_that_the_worn_tip_is_isolated():
    """docs/theory.md, section 6.3: at k = 4.467 and eps = 0.1, 29 % of the configurations still have gamma > 0."""
    state = make_state(load_scene("worn_tip_rod"), "approached", parameters={"k": "4467/1000"})
    with mpmath.workdps(30):
        positive = [gamma_beside(state, mpmath.mpf(10) ** -2 * i / 4)[1] > 0 for i in range(1, 41)]
    assert positive[-1]
    assert not positive[0]


# --- the two-link arm ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "kind"), [("isolated", ISOLATED), ("approached", APPROACHED)])
def test_the_arm_s_critical_states_are_what_gamma_on_a_fine_cloud_of_admissible_neighbours_shows(name, kind):
    """phi2 is solved from phi1 and g >= 0, so that the cloud reaches the thin wedge beside the table."""
    limit = limit_set(make_state(load_scene("two_link_arm"), name))
    found = neighbours(limit.state, limit.edge)
    assert found.kind is kind
    assert "kappa > 0" in found.reason
    reference = Reference(limit.state.scene)
    with mpmath.workdps(60):
        p = reference.parameters(limit.state.parameters)
        phi1, depth = to_mp(limit.state.q[0]), to_mp(limit.state.parameters["depth"])
        for r in (mpmath.mpf(10) ** -3, mpmath.mpf(10) ** -6):
            values = []
            for i in range(-10, 11):
                for g in (0, r**3, *(r**2 * j / 20 for j in range(1, 30, 6)), *(r * j / 20 for j in range(1, 20, 6))):
                    first = phi1 + r * i / 10
                    if i or g:
                        local = reference.at([first, mpmath.acos(depth + g - mpmath.cos(first))], p)
                        values.append(gamma_squared(local))
            assert (max(values) > 0) == (kind is APPROACHED)


def test_only_the_edge_that_is_critical_is_asked():
    """With b > 0 gamma is attained on s = -mu: the other edge has compliance 2 and no say."""
    minus = Parameter(name="minus", unit="1", sentence="friction", default="1", range="nonnegative")
    scene = make_scene(
        name="one_sided",
        sentence="a scene",
        source="a test",
        coordinates=(X, Y),
        parameters=(minus,),
        inertia=sp.Matrix([[4, 1 + x**2], [1 + x**2, 1]]).inv(),
        constraint=-y,
        tangential_displacements=(x,),
        friction=Segment(minus=minus.symbol, plus=1 + sp.Abs(y)),
        keys=(StateKey(name="slip", unit="m/s", sentence="slip", default="1"),),
        velocity={"x": sp.Symbol("slip", real=True)},
    )
    limit = limit_set(make_state(scene))
    assert limit.edge == -1
    assert neighbours(limit.state, limit.edge).kind is ISOLATED
