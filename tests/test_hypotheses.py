"""The hypotheses of Theorem 1 near a state: what is proved survives brute force, what is refuted fails at its point."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Mapping
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy as sp
from command_line import assert_refused, run_json
from hypothesis import given, settings
from hypothesis import strategies as st

from painleve import InputError, check_hypotheses, load_scene, make_scene, make_state
from painleve.cli import main
from painleve.mechanics.friction import Disc, Ellipse, Polygon, Section, Segment
from painleve.mechanics.library import SCENE_NAMES
from painleve.mechanics.scene import Coordinate, Scene
from painleve.mechanics.state import State
from painleve.theory.classification import Branch, classify
from painleve.theory.hypotheses.check import Applicability, HypothesesCheck
from painleve.theory.hypotheses.claims import Claim, ClaimKind, ClaimStatus, decide
from painleve.theory.hypotheses.region import Region
from painleve.theory.hypotheses.simplest import simplest_fraction

PLANE = tuple(Coordinate(name=name, unit="m", sentence=name) for name in ("x", "y"))
SPACE = (*PLANE, Coordinate(name="z", unit="m", sentence="z"))
X, Y, Z = (c.symbol for c in SPACE)
HALF = sp.Rational(1, 2)
PROVED, REFUTED, SUPPORTED, UNDECIDED = (
    ClaimStatus.PROVED,
    ClaimStatus.REFUTED,
    ClaimStatus.SUPPORTED,
    ClaimStatus.UNDECIDED,
)


def plane(
    *,
    M: object = ((1, 0), (0, 1)),
    g: sp.Expr = -Y,
    s: sp.Expr | None = X,
    mu: sp.Expr = HALF,
    minus: sp.Expr | None = None,
    at: Mapping[str, object] | None = None,
) -> State:
    """A point in the plane that rests on {g = 0}."""
    friction = None if s is None else Segment(minus=mu if minus is None else minus, plus=mu)
    scene = make_scene(
        name="plane",
        sentence="a point on a line",
        source="made for this test",
        coordinates=PLANE,
        parameters=(),
        inertia=sp.Matrix(M),
        constraint=g,
        tangential_displacements=() if s is None else (s,),
        friction=friction,
    )
    return make_state(scene, keys={"x": 0, "y": 0, "u_x": 0, "u_y": 0} | dict(at or {}))


def space(friction: Section) -> State:
    """A point in space at rest on the floor z = 0."""
    scene = make_scene(
        name="space",
        sentence="a point on a floor",
        source="made for this test",
        coordinates=SPACE,
        parameters=(),
        inertia=sp.eye(3),
        constraint=-Z,
        tangential_displacements=(X, Y),
        friction=friction,
    )
    return make_state(scene, keys=dict.fromkeys(("x", "y", "z", "u_x", "u_y", "u_z"), 0))


def statuses(found: HypothesesCheck) -> dict[str, ClaimStatus]:
    return {h.name: h.status for h in found.hypotheses}


# --- a second route: floating-point matrices at random points --------------------------------------------------------


def sample(state: State, radius: float, count: int = 300) -> np.ndarray:
    rng = np.random.default_rng(7)
    directions = rng.standard_normal((count, len(state.q)))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    lengths = radius * rng.uniform(size=count) ** (1 / len(state.q))
    return np.array([state.number(x) for x in state.q]) + directions * lengths[:, None]


def function(state: State, expressions: object) -> Callable[[np.ndarray], np.ndarray]:
    parameters = {p.symbol: state.parameters[p.name] for p in state.scene.parameters}
    compiled = sp.lambdify(state.scene.q, sp.Matrix(expressions).xreplace(parameters), "numpy")
    return lambda q: np.asarray(compiled(*q), dtype=float)


def violations(state: State, radius: float) -> dict[str, int]:
    """How many random configurations of the ball fail a hypothesis, by eigenvalues and singular values."""
    scene = state.scene
    M = function(state, scene.inertia)
    w = function(state, [[sp.diff(scene.contact.constraint, x)] for x in scene.q])
    H = function(state, scene.contact.tangents) if scene.contact.section.dimension else None
    sound = (
        function(state, [[c.expression] for c in scene.contact.section.conditions])
        if scene.contact.section.dimension
        else None
    )
    spans = function(state, spanning(scene)) if scene.contact.section.dimension else None
    count = dict.fromkeys(("H1", "H2", "H3", "H4", "H'4"), 0)
    for q in sample(state, radius):
        count["H1"] += np.linalg.eigvalsh(M(q)).min() <= 0
        count["H2"] += np.linalg.norm(w(q)) == 0
        if H is None:
            count["H4"] += 1
            continue
        generators = H(q) @ spans(q)
        rank = np.linalg.matrix_rank(generators)
        count["H3"] += sound(q).min() < 0 or np.linalg.matrix_rank(np.hstack([w(q), generators])) == rank
        count["H4"] += rank != 1
        count["H'4"] += isinstance(scene.contact.section, Polygon) and rank > 1
    return count


def spanning(scene: Scene) -> sp.Matrix:
    """Points of B that span it."""
    match scene.contact.section:
        case Segment(minus=minus, plus=plus):
            return sp.Matrix([[-minus, plus]])
        case Disc(mu=mu):
            return sp.diag(mu, mu)
        case Ellipse(mu_1=one, mu_2=other, angle=angle):
            c, s = sp.cos(angle), sp.sin(angle)
            return sp.Matrix([[c, -s], [s, c]]) * sp.diag(one, other)
        case Polygon(vertices=vertices):
            return sp.Matrix(vertices).T
    raise AssertionError(scene.contact.section)


def assert_consistent(state: State, found: HypothesesCheck) -> None:
    seen = violations(state, float(found.radius))
    assert {name: seen[name] for name, status in statuses(found).items() if status is PROVED and seen[name]} == {}


# --- the library -----------------------------------------------------------------------------------------------------

NAMED = [(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states]


@pytest.mark.parametrize(("scene", "name"), NAMED)
def test_what_is_proved_near_the_states_of_the_library_holds_at_every_sampled_configuration(scene, name):
    state = make_state(load_scene(scene), name)
    found = check_hypotheses(state)
    assert_consistent(state, found)
    assert {found[name].status for name in ("H1", "H2", "H3")} == {PROVED}
    assert PROVED in {found["H4"].status, found["H'4"].status}


@pytest.mark.parametrize(("scene", "name"), NAMED)
def test_the_theorem_applies_exactly_where_gamma_is_not_positive(scene, name):
    state = make_state(load_scene(scene), name)
    expected = Applicability.NOTHING if classify(state).branch is Branch.NONE else Applicability.APPLIES
    assert check_hypotheses(state).theorem is expected


def test_the_arm_refutes_h3_where_it_is_stretched_as_soon_as_the_ball_reaches_that():
    state = make_state(load_scene("two_link_arm"), "paradox")
    phi1, phi2 = (state.number(x) for x in state.q)
    reach = abs(phi1 - phi2) / np.sqrt(2)  # the distance from the line phi1 = phi2
    assert check_hypotheses(state, radius=float(np.floor(reach * 1000) / 1000))["H3"].status is PROVED
    found = check_hypotheses(state, radius=float(np.ceil(reach * 1000) / 1000))["H3"]
    assert found.status is REFUTED
    assert found.place is not None
    assert found.place.numbers[0] == pytest.approx(found.place.numbers[1], abs=1e-15)


@pytest.mark.parametrize(("theta", "status"), [("pi/2-1/9", PROVED), ("pi/2-1/10", REFUTED), ("3/2", REFUTED)])
def test_the_spatial_rod_loses_h1_as_soon_as_the_ball_touches_the_vertical(theta, status):
    found = check_hypotheses(make_state(load_scene("spatial_rod"), keys={"theta": theta}))["H1"]
    assert found.status is status
    if status is REFUTED:
        assert found.place is not None
        assert found.place.q[3] == sp.pi / 2


# --- refutations, each verified at its point -------------------------------------------------------------------------


def least_eigenvalue(state: State, found: HypothesesCheck) -> mpmath.mpf:
    place = found["H1"].place
    assert place is not None
    with mpmath.workdps(40):
        M = state.scene.inertia.xreplace(dict(zip(state.scene.q, place.q, strict=True))).evalf(40)
        return min(mpmath.eigsy(mpmath.matrix(M.tolist()), eigvals_only=True))


@pytest.mark.parametrize(
    "M",
    [
        ((1, 0), (0, 1 - 20 * X)),
        ((1, 20 * X), (20 * X, 1)),
        ((1, 0), (0, (X - sp.Rational(1, 30)) ** 2)),
        ((1, 0), (0, (X + Y - sp.sqrt(2) / 30) ** 2)),
        ((2, 1 + 15 * X), (1 + 15 * X, 2 + Y)),
        ((1, 0), (0, (X - sp.Rational(1, 30)) ** 2 + (Y - sp.Rational(1, 40)) ** 2)),
    ],
    ids=str,
)
def test_an_inertia_that_stops_being_positive_definite_in_the_ball_is_refuted_at_a_point_where_it_does(M):
    state = plane(M=M)
    found = check_hypotheses(state)
    assert found["H1"].status is REFUTED
    assert least_eigenvalue(state, found) <= 1e-30
    radius = np.linalg.norm(found["H1"].place.numbers)
    assert radius <= 0.1


def test_a_smaller_ball_leaves_a_refuting_point_out():
    state = plane(M=((1, 0), (0, 1 - 20 * X)))
    assert check_hypotheses(state, radius="0.0499")["H1"].status is PROVED
    assert check_hypotheses(state, radius="0.05")["H1"].status is REFUTED


@pytest.mark.parametrize(
    "entry",
    [
        2 + sp.Abs(X - sp.Rational(1, 50)),
        2 + sp.Max(X + Y - sp.sqrt(3) / 40, 0),
        3 - sp.exp(X) * sp.Abs(sp.sin(Y)),
        4 + sp.asin(sp.sin(40 * X)),
        4 + sp.exp(Y) * sp.acos(sp.cos(X - sp.Rational(1, 50))),
        4 + sp.cos(sp.asin(sp.sin(40 * X + Y))),
        2 + sp.asin(1 - X**2),
        2 + sp.acos(2 * (X + 1) / (1 + (X + 1) ** 2)),
        2 + sp.sqrt(1 - sp.sin(40 * X) ** 2),
        2 + sp.sqrt(2 - 2 * sp.cos(X)),
        2 + sp.sqrt(X**2 - 2 * X * Y + Y**2),
        2 + sp.sqrt(sp.Abs(20 * X - 1)),  # an infinite slope
        2 + sp.Piecewise((X, X > 0), (sp.sin(2 * X), True)),
    ],
    ids=str,
)
def test_a_kink_of_the_inertia_refutes_h1_where_one_sided_derivatives_differ(entry):
    found = check_hypotheses(plane(M=((1, 0), (0, entry))))["H1"]
    assert found.status is REFUTED
    assert found.place is not None
    slopes = set()
    with mpmath.workdps(30):
        f = sp.lambdify((X, Y), entry, "mpmath")
        q = [mpmath.mpf(sp.N(x, 30)) for x in found.place.q]
        h = mpmath.mpf(10) ** -12
        for direction in ((1, 0), (0, 1)):
            sides = [f(*(x + t * h * e for x, e in zip(q, direction, strict=True))) for t in (-1, 0, 1)]
            slopes.add(abs((sides[2] - sides[1]) - (sides[1] - sides[0])) / h > 0.1)
    assert True in slopes


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        (200 + 1 / (X - sp.Rational(1, 50)), "not bounded"),
        (2 + 1 / (X - sp.Rational(1, 50)) ** 2, "not bounded"),
        (2 + sp.tan(20 * X), "not bounded"),
        (2 + sp.sqrt(X + sp.Rational(1, 50)), "not real"),
        (20 + sp.log(X + sp.Rational(1, 50)), "not real"),
        (2 + sp.sqrt(X), "not real"),
        (5 + sp.asin(1 + X), "not real"),
        (2 + sp.sign(X - Y - sp.Rational(1, 70)), "not continuous"),
        (4 + sp.atan(sp.tan(40 * X)), "not continuous"),
        (4 + sp.atan(1 / (X - sp.Rational(1, 20))), "not continuous"),
        (4 + sp.Piecewise((X, 30 * X > 1), (0, True)), "not continuous"),
    ],
    ids=str,
)
def test_a_pole_a_jump_or_a_value_that_is_not_real_refutes_h1(entry, words):
    found = check_hypotheses(plane(M=((1, 0), (0, entry))))["H1"]
    assert found.status is REFUTED
    assert words in found.sentence


@pytest.mark.parametrize(
    "entry",
    [
        2 + X * sp.Abs(X),
        2 + sp.sqrt(X**2 + Y**2),
        2 + sp.Max(X, Y, 0),
        2 + X * sp.sqrt(sp.Abs(X)),
        2 + sp.asin(sp.sin(40 * X)) + sp.acos(sp.sin(40 * X)),
        2 + sp.Piecewise((X**2, X > 0), (X**3, True)),
    ],
    ids=str,
)
def test_what_structure_does_not_tell_is_left_undecided(entry):
    """The second and the third are not C^1, the others are."""
    assert check_hypotheses(plane(M=((1, 0), (0, entry))))["H1"].status is UNDECIDED


def test_singularities_outside_the_ball_do_no_harm():
    entry = 2 + sp.Abs(X - 1) + 1 / (Y + 2) + sp.log(1 + X) + sp.sqrt(X + HALF) + sp.asin(X) + sp.atan2(Y, 1 + X)
    entry += sp.asin(sp.sin(10 * X)) + sp.acos(sp.cos(X + HALF)) + sp.sqrt(2 + 2 * sp.cos(Y)) + sp.atan(sp.tan(X + Y))
    state = plane(M=((1, 0), (0, entry)))
    found = check_hypotheses(state)
    assert found["H1"].status is PROVED
    assert_consistent(state, found)


def test_a_zero_that_enclosures_cannot_tell_is_supported_by_a_count_of_points():
    found = check_hypotheses(plane(mu=1 - sp.cos(X - sp.sqrt(2) / 100)))["H3"]
    assert found.status is SUPPORTED
    assert "points" in found.sentence


@pytest.mark.parametrize(
    ("g", "at", "status"),
    [
        (-Y * (Y - sp.Rational(1, 20)) ** 2, {}, REFUTED),  # grad g and g vanish at y = 1/20
        (-Y - 15 * Y**2, {}, PROVED),  # grad g vanishes in the ball, but where g = 1/60
        (-Y + sp.Abs(X - sp.Rational(1, 20)), {"y": sp.Rational(1, 20)}, REFUTED),  # a kink
        (sp.Rational(1, 1600) - X**2 - Y**2, {"x": sp.Rational(1, 40)}, PROVED),
        ((40 * X + 1) * (40 * Y + 1), {"x": -sp.Rational(1, 40), "y": sp.Rational(1, 50)}, REFUTED),  # a corner
    ],
    ids=str,
)
def test_h2_asks_for_a_gradient_only_near_the_constraint(g, at, status):
    state = plane(g=g, at=at, s=X + 3 * Y)
    found = check_hypotheses(state)["H2"]
    assert found.status is status
    if status is REFUTED and found.place is not None and "kink" not in found.sentence:
        there = dict(zip((X, Y), found.place.q, strict=True))
        assert [sp.diff(g, x).xreplace(there) for x in (X, Y)] == [0, 0]
        assert g.xreplace(there) == 0


def test_a_coefficient_of_friction_that_turns_negative_refutes_h3_and_where_it_vanishes_h4():
    state = plane(mu=X + 1 / sp.sqrt(500))
    found = check_hypotheses(state)
    assert statuses(found) == {"H1": PROVED, "H2": PROVED, "H3": REFUTED, "H4": REFUTED, "H'4": PROVED}
    assert found["H3"].place is not None
    assert found["H4"].place is not None
    assert found["H3"].place.numbers[0] < -1 / np.sqrt(500)
    assert found["H4"].place.numbers[0] == pytest.approx(-1 / np.sqrt(500), abs=1e-15)
    assert "negative" in found["H3"].sentence


def test_one_sided_friction_spans_a_line_and_no_friction_does_not():
    assert check_hypotheses(plane(mu=HALF, minus=sp.Integer(0)))["H4"].status is PROVED
    assert check_hypotheses(plane(mu=X**2, minus=sp.Integer(0)))["H4"].status is REFUTED
    assert check_hypotheses(plane(mu=X**2, minus=HALF))["H4"].status is PROVED


def test_a_tangent_that_turns_parallel_to_the_normal_refutes_h3_there():
    found = check_hypotheses(plane(s=X - 20 * X**2 + Y))["H3"]  # H = (1 - 40 x, 1)
    assert found.status is REFUTED
    assert found.place is not None
    assert found.place.q[0] == sp.Rational(1, 40)


def test_a_frictionless_scene_refutes_h4_and_satisfies_the_other_as_it_is_worded():
    state = plane(s=None)
    found = check_hypotheses(state)
    assert statuses(found) == {"H1": PROVED, "H2": PROVED, "H3": PROVED, "H4": REFUTED, "H'4": PROVED}
    assert found.theorem is Applicability.NOTHING


# --- friction in space -----------------------------------------------------------------------------------------------

SQUARE = ((1, 0), (0, 1), (-1, 0), (0, -1))


@pytest.mark.parametrize(
    ("friction", "h3", "h4", "convex"),
    [
        (Disc(mu=HALF), PROVED, REFUTED, PROVED),
        (Disc(mu=HALF + X), PROVED, REFUTED, PROVED),
        (Disc(mu=X + sp.Rational(1, 50)), REFUTED, REFUTED, PROVED),
        (Disc(mu=0), PROVED, REFUTED, PROVED),
        (Ellipse(mu_1=1, mu_2=HALF, angle=X), PROVED, REFUTED, PROVED),
        (Ellipse(mu_1=1, mu_2=0, angle=X), PROVED, PROVED, PROVED),
        (Ellipse(mu_1=1, mu_2=X + sp.Rational(1, 50), angle=0), REFUTED, REFUTED, PROVED),
        (Polygon(vertices=SQUARE), PROVED, REFUTED, REFUTED),
        (Polygon(vertices=((1, 0), (0, 0), (-1, 0))), PROVED, PROVED, PROVED),
        (Polygon(vertices=((20 * X + HALF, 0), (0, 1), (-1, 0), (0, -1))), REFUTED, REFUTED, REFUTED),
        (Polygon(vertices=((1, 0), (HALF + 10 * X, HALF + 10 * X), (0, 1), (-1, -1))), REFUTED, REFUTED, REFUTED),
    ],
    ids=str,
)
def test_each_section_in_space_satisfies_the_hypotheses_that_its_shape_allows(friction, h3, h4, convex):
    state = space(friction)
    found = check_hypotheses(state)
    assert [found[name].status for name in ("H3", "H4", "H'4")] == [h3, h4, convex]
    assert_consistent(state, found)
    seen = violations(state, 0.1)
    assert [seen[name] > 0 for name in ("H3", "H4", "H'4")] == [s is REFUTED for s in (h3, h4, convex)]


# --- random scenes and random claims ---------------------------------------------------------------------------------

SMALL = st.fractions(-3, 3, max_denominator=8)


def polynomial(coefficients: list[Fraction]) -> sp.Expr:
    monomials = (1, X, Y, X**2, X * Y, Y**2)[: len(coefficients)]
    return sum(
        (sp.Rational(c.numerator, c.denominator) * m for c, m in zip(coefficients, monomials, strict=True)),
        sp.Integer(0),
    )


LINEAR = st.lists(SMALL, min_size=3, max_size=3).map(polynomial)
POLYNOMIALS = st.lists(SMALL, min_size=6, max_size=6).map(polynomial)


@pytest.mark.slow
@settings(max_examples=15)
@given(LINEAR, LINEAR, LINEAR, LINEAR, st.sampled_from(["1/10", "1/2"]))
def test_no_sample_of_a_random_scene_contradicts_what_is_proved_and_refuting_points_refute(p, r, s, t, radius):
    M = ((2 + X * p, X * r), (X * r, 3 + Y * p))
    state = plane(M=M, g=-Y + X * Y * s, s=X + Y * t, mu=1 + X * t + Y * s)
    found = check_hypotheses(state, radius=radius)
    assert_consistent(state, found)
    if found["H1"].status is REFUTED:
        assert least_eigenvalue(state, found) <= 1e-15
    for h in found.hypotheses:
        if h.place is not None:
            assert np.linalg.norm(h.place.numbers) <= float(Fraction(radius)) * (1 + 1e-12)


GRID = np.linspace(-1, 1, 41)


@pytest.mark.slow
@settings(max_examples=60)
@given(POLYNOMIALS, st.sampled_from(list(ClaimKind)), st.booleans())
def test_claims_about_polynomials_agree_with_a_fine_grid(p, kind, squared):
    expression = p**2 if squared else p
    region = Region(state=plane(), radius=Fraction(1))
    found = decide(region, Claim(kind=kind, expressions=(expression,)))
    value = sp.lambdify((X, Y), expression, "numpy")
    inside = [(x, y) for x, y in itertools.product(GRID, GRID) if x * x + y * y <= 1]
    values = np.array([float(value(x, y)) for x, y in inside])
    if found.status is PROVED:
        holds = {
            ClaimKind.POSITIVE: values > 0,
            ClaimKind.NONNEGATIVE: values >= -1e-12,
            ClaimKind.NONZERO: values != 0,
        }[kind]
        assert holds.all()
        if found.bound > 0:
            assert np.abs(values).min() >= found.bound * (1 - 1e-12)
    if found.status is REFUTED:
        assert found.place is not None
        there = sp.N(expression.xreplace(dict(zip((X, Y), found.place.q, strict=True))), 30)
        assert {
            ClaimKind.POSITIVE: there <= 1e-15,
            ClaimKind.NONNEGATIVE: there < 0,
            ClaimKind.NONZERO: abs(there) < 1e-15,
        }[kind]
    if kind is not ClaimKind.NONZERO and not squared and values.min() < -1e-3:
        assert found.status is REFUTED
    if not squared and values.min() > 0.05:
        assert found.status is PROVED


@given(st.fractions(-5, 5, max_denominator=60), st.fractions(0, 1, max_denominator=60))
def test_the_simplest_fraction_is_the_one_that_a_search_by_denominators_meets_first(low, width):
    found = simplest_fraction(low, low + width)
    assert low <= found <= low + width
    for denominator in range(1, found.denominator):
        assert -(-low.numerator * denominator // low.denominator) > (low + width) * denominator


# --- the command line ------------------------------------------------------------------------------------------------


def test_the_command_answers_for_one_state_or_for_all_named_ones(capsys):
    one = run_json(capsys, "check", "slender_rod", "--state", "paradox", "--radius", "1/4")
    assert one["radius"] == 0.25
    assert {name: h["status"] for name, h in one["hypotheses"].items()} == dict.fromkeys(
        ("H1", "H2", "H3", "H4", "H'4"), "proved"
    )
    assert one["theorem"]["status"] == "Theorem 1 applies"
    every = run_json(capsys, "check", "slender_rod")
    assert list(every["states"]) == [s.name for s in load_scene("slender_rod").states]
    assert main(["check", "spatial_rod", "--state", "theta=3/2"]) == 0
    text = capsys.readouterr().out
    assert "(H1) refuted" in text
    assert "theta = 1.570796327" in text
    assert main(["check", "two_link_arm", "--radius", "1"]) == 0
    assert "grad g is in Span D_1 at" in " ".join(capsys.readouterr().out.split())


def test_a_refuting_point_is_given_exactly_to_machines(capsys):
    answer = run_json(capsys, "check", "spatial_rod", "--state", "theta=3/2")
    place = answer["hypotheses"]["H1"]["place"]
    assert place["exact"]["theta"] == "pi/2"
    assert place["within"] == 0
    assert json.dumps(answer)


@pytest.mark.parametrize("radius", ["0", "-1", "nan", "inf", "sqrt(2)", "x", "1/0", ""])
def test_a_radius_that_is_not_positive_and_rational_gives_one_line(radius, capsys, tmp_path, monkeypatch):
    words = ["check", "slender_rod", "--state", "paradox", f"--radius={radius}"]
    assert "radius" in assert_refused(words, capsys, tmp_path, monkeypatch)


@pytest.mark.parametrize("radius", [0, -1, float("nan"), float("inf"), True])
def test_a_radius_that_makes_no_ball_is_refused_in_python(radius):
    with pytest.raises(InputError, match="radius"):
        check_hypotheses(plane(), radius=radius)
