"""Exact states: every named one is sound, natural keys keep the tip on the floor, and wrong ones are refused."""

from __future__ import annotations

from fractions import Fraction

import mpmath
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from planar_scenes import SCENE_NAMES
from reference_law import DIGITS, Reference, dot, to_mp

from painleve.errors import InputError
from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Segment
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Coordinate, Parameter, make_scene
from painleve.mechanics.state import State, make_state

ROD, WORN, ARM = (load_scene(name) for name in SCENE_NAMES)
NAMED = [(name, state.name) for name in SCENE_NAMES for state in load_scene(name).states]
ANGLES = st.fractions(Fraction(1, 10), Fraction(3, 2), max_denominator=20)
SPEEDS = st.fractions(-3, 3, max_denominator=20)


def residuals(state: State) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf]:
    """(g, v_n, v_t) at 60 digits, evaluated from the scene's symbols by mpmath."""
    local = Reference(state.scene).at_state(state, [0.0] * len(state.q))
    u = mpmath.matrix([to_mp(x) for x in state.u])
    return local.g, dot(local.w_n, u), dot(local.H, u)


# --- sound states ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scene", "name"), NAMED)
def test_every_named_state_is_in_contact_with_a_tangential_velocity_to_60_digits(scene, name):
    with mpmath.workdps(DIGITS):
        g, v_n, v_t = residuals(make_state(load_scene(scene), name))
        assert abs(g) < mpmath.mpf(10) ** -55
        assert abs(v_n) < mpmath.mpf(10) ** -55
        assert abs(v_t) > 0.1


@given(ANGLES, SPEEDS, SPEEDS)
@settings(max_examples=25)
def test_the_rod_s_natural_keys_give_a_tip_that_slides_at_the_speed_asked_for(theta, slip, omega):
    state = make_state(ROD, keys={"theta": theta, "slip": slip, "omega": omega})
    with mpmath.workdps(DIGITS):
        g, v_n, v_t = residuals(state)
        assert max(abs(g), abs(v_n), abs(v_t - to_mp(slip))) < mpmath.mpf(10) ** -55
    assert (state.q[2], state.u[2]) == (sp.Rational(theta), sp.Rational(omega))


@given(ANGLES, ANGLES, SPEEDS)
@settings(max_examples=15)
def test_the_arm_s_natural_keys_give_a_tip_that_slides_at_the_speed_asked_for(phi1, phi2, slip):
    state = make_state(ARM, keys={"phi1": -phi1, "phi2": phi2 / 2, "slip": slip})
    with mpmath.workdps(DIGITS):
        g, v_n, v_t = residuals(state)
        assert max(abs(g), abs(v_n), abs(v_t - to_mp(slip))) < mpmath.mpf(10) ** -52


def test_the_default_rod_is_uniform_and_slides_by_pure_translation():
    state = make_state(ROD, "paradox")
    assert state.parameters["I"] == sp.Rational(1, 3)
    assert state.u == (-1, 0, 0)
    heavy = make_state(ROD, "paradox", parameters={"m": 3, "l": "1/2"})
    assert heavy.parameters["I"] == sp.Rational(1, 4)


def test_the_rod_s_critical_states_are_zeros_of_the_closed_form_of_gamma():
    """1 + 3 cos^2 - 3 mu sin cos = 0 <=> t^2 - 3 mu t + 4 = 0 with t = tan(theta)."""
    for name, mu in (("critical", 2), ("double_zero", sp.Rational(4, 3))):
        state = make_state(ROD, name)
        assert state.parameters["mu"] == mu
        t = sp.tan(state.q[2])
        assert sp.expand(t**2 - 3 * mu * t + 4) == 0
    assert sp.discriminant(sp.Symbol("t") ** 2 - 4 * sp.Symbol("t") + 4) == 0


# --- the arm's named states ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "first", "second", "ratio", "friction"),
    [
        ("isolated", Fraction(-1, 12), Fraction(1, 7), "0.98772", "0.61715"),
        ("approached", Fraction(-1, 3), Fraction(1, 8), "1.06183", None),
    ],
)
def test_the_arm_s_critical_states_have_the_half_angle_tangents_and_masses_of_section_6(
    name, first, second, ratio, friction
):
    state = make_state(ARM, name)
    for angle, tangent in zip(state.q, (first, second), strict=True):
        assert exact_sign(sp.tan(angle / 2) - sp.Rational(tangent)).sign is Sign.ZERO
    m2 = state.number(state.parameters["m2"] / state.parameters["m1"])
    assert f"{m2:.5f}" == ratio
    if friction is not None:
        assert f"{state.number(state.parameters['mu']):.5f}" == friction
    norm = sum(x**2 for x in state.u)
    assert exact_sign(norm - 1).sign is Sign.ZERO


@pytest.mark.parametrize(("name", "sense"), [("isolated", -1), ("approached", 1)])
def test_mu_c_along_the_table_is_extremal_at_the_arm_s_critical_states(name, sense):
    """By bisection onto the table and plain values of mu_c beside the state: no derivative is taken."""
    state = make_state(ARM, name)
    reference = Reference(ARM)
    with mpmath.workdps(40):
        p = reference.parameters(state.parameters)
        phi1, phi2 = (to_mp(x) for x in state.q)
        depth = to_mp(state.parameters["depth"])

        def critical_friction(step: mpmath.mpf) -> mpmath.mpf:
            first = phi1 + step
            second = mpmath.acos(depth - mpmath.cos(first))  # phi2 > 0 on this side of the arm
            local = reference.at([first, second], p)
            Y = mpmath.lu_solve(local.M, local.w_n)
            return dot(local.w_n, Y) / abs(dot(local.H, Y))

        assert mpmath.almosteq(mpmath.acos(depth - mpmath.cos(phi1)), phi2)
        at = critical_friction(mpmath.mpf(0))
        assert abs(at - to_mp(state.parameters["mu"])) < mpmath.mpf(10) ** -35
        for size in (mpmath.mpf(10) ** -3, mpmath.mpf(10) ** -6):
            changes = [sense * (critical_friction(side * size) - at) for side in (-1, 1)]
            assert min(changes) > 0
            assert max(changes) < 100 * size**2, "mu_c is stationary"


# --- numbers ---------------------------------------------------------------------------------------------------------


def test_a_float_means_the_decimal_that_it_prints():
    state = make_state(ROD, keys={"theta": 0.1, "slip": -0.3}, parameters={"mu": 0.7})
    assert state.q[2] == sp.Rational(1, 10)
    assert state.parameters["mu"] == sp.Rational(7, 10)
    text = make_state(ROD, keys={"theta": "0.1", "slip": "-0.3"}, parameters={"mu": "0.7"})
    assert (state.q, state.u) == (text.q, text.u)


def test_single_components_override_what_the_keys_say():
    state = make_state(ROD, "paradox", keys={"x": "7/2", "u_x": "-3"})
    assert state.q[0] == sp.Rational(7, 2)
    assert state.u == (-3, 0, 0)


def test_numbers_are_rounded_from_enough_digits_that_cancellation_does_not_show():
    state = make_state(ROD, "critical")
    sine, tenth = sp.sin(state.q[2]), sp.Rational(1, 10)
    assert state.number(sine + tenth**25 - sp.sqrt(1 - sp.cos(state.q[2]) ** 2)) == 1e-25
    assert state.number(sine + tenth**300 - sp.sqrt(1 - sp.cos(state.q[2]) ** 2)) == 1e-300
    assert str(state.number(sine - sp.sqrt(1 - sp.cos(state.q[2]) ** 2))) == "0.0"


def test_a_state_shows_itself_in_one_short_line_and_so_does_what_holds_it():
    state = make_state(load_scene("slender_rod"), "critical")
    assert repr(state) == "State('slender_rod', 'critical')"
    assert repr(state.scene) == "Scene('slender_rod')"


# --- wrong states ----------------------------------------------------------------------------------------------------

PARADOX = "paradox"
WRONG = {
    "no theta": (ROD, None, {}, {}, "needs theta .inclination, rad.; give theta=EXPRESSION or a named state: sliding"),
    "unknown key": (
        ROD,
        PARADOX,
        {"zeta": 1},
        {},
        r"no state key 'zeta' \(did you mean theta\?\); keys: theta",
    ),
    "unknown state": (
        ROD,
        "paradise",
        {},
        {},
        r"no state 'paradise' \(did you mean paradox\?\); named states: sl",
    ),
    "unknown parameter": (ROD, PARADOX, {}, {"nu": 1}, "no parameter 'nu'; it has m, l, I, mu, gravity"),
    "above the floor": (ROD, PARADOX, {"y": 1}, {}, r"off the constraint: g\(q\) = -0.105573 and must be exactly 0"),
    "a little below": (ROD, PARADOX, {"y": "2/sqrt(5)-1e-30"}, {}, r"off the constraint: g\(q\) = 1e-30"),
    "not tangential": (ROD, PARADOX, {"u_y": "1/1000"}, {}, "not tangential: <u-, -grad g.q.> = 0.001 and must"),
    "not tangential by 1e-40": (ROD, PARADOX, {"u_y": "1e-40"}, {}, "not tangential: <u-, -grad g.q.> = 1e-40"),
    "negative friction": (ROD, PARADOX, {}, {"mu": "-1/10"}, "parameter mu = -1/10 must be zero or positive"),
    "no mass": (ROD, PARADOX, {}, {"m": 0}, "parameter m = 0 must be positive"),
    "negative inertia": (ROD, PARADOX, {}, {"I": "1 - sqrt(2)"}, "parameter I = 1 - sqrt.2. must be positive"),
    "not a number": (ROD, PARADOX, {}, {"mu": float("nan")}, "parameter mu: nan is not a finite number"),
    "not a number, as text": (ROD, PARADOX, {"theta": "nan"}, {}, "state key theta: 'nan' is not a finite number"),
    "infinite": (ROD, PARADOX, {"slip": float("-inf")}, {}, "state key slip: -inf is not a finite number"),
    "a symbol": (ROD, PARADOX, {"slip": sp.Symbol("s")}, {}, "expected a number, but 's' contains s"),
    "a true value": (ROD, PARADOX, {"slip": True}, {}, "a truth value is not a number"),
    "negative where it is worn": (
        WORN,
        None,
        {"theta": "atan(2)"},
        {"theta_0": 0, "k": -5},
        "coefficient of friction is -4.79556 there",
    ),
    "a straight arm": (ARM, None, {"phi1": "1/3", "phi2": "1/3"}, {}, "u_phi1 is not finite at this state"),
    "a table elsewhere": (ARM, PARADOX, {}, {"depth": 1}, r"off the constraint: g\(q\) = 0.946207"),
    "hostile text": (ROD, PARADOX, {"theta": "__import__('os')"}, {}, "state key theta: "),
}


@pytest.mark.parametrize(("scene", "name", "keys", "parameters", "message"), WRONG.values(), ids=WRONG.keys())
def test_a_wrong_state_is_refused_in_one_line_that_says_what_and_by_how_much(scene, name, keys, parameters, message):
    with pytest.raises(InputError, match=message) as caught:
        make_state(scene, name, keys=keys, parameters=parameters)
    assert str(caught.value).isprintable()


def particle(**changes):
    """A particle in the plane above the floor y = 0, at (0, 0)."""
    x, y = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in ("x", "y"))
    c = Parameter(name="c", unit="1", sentence="a constant", default="1", range="real")
    parts = {
        "name": "particle",
        "sentence": "a particle",
        "source": "a test",
        "coordinates": (x, y),
        "parameters": (c,),
        "inertia": sp.diag(c.symbol, 1),
        "constraint": -y.symbol,
        "tangential_displacements": (x.symbol,),
        "friction": Segment(minus=1, plus=1),
    }
    return make_scene(**(parts | {k: v(x.symbol, y.symbol) for k, v in changes.items()}))


def test_a_state_where_the_scene_is_singular_is_refused():
    with pytest.raises(InputError, match="M is not positive definite there"):
        make_state(particle(), parameters={"c": 0})
    with pytest.raises(InputError, match="M is not positive definite there"):
        make_state(particle(), parameters={"c": -1})
    with pytest.raises(InputError, match="grad g vanishes there"):
        make_state(particle(constraint=lambda x, y: x * y))
    with pytest.raises(InputError, match=r"do not vary independently of g there \(H3\)"):
        make_state(particle(tangential_displacements=lambda x, y: (y + x**2,)))


def test_gamma_is_positive_negative_or_zero_as_the_names_of_the_states_say():
    expected = {"sliding": Sign.POSITIVE, "paradox": Sign.NEGATIVE, "stoss": None}
    for scene, name in NAMED:
        state = make_state(load_scene(scene), name)
        sign = exact_sign(state.exact(derive(state.scene).gamma)).sign
        wanted = expected.get(name, Sign.ZERO)
        assert wanted is None or sign is wanted, (scene, name)


def test_friction_on_one_coordinate_is_refused_whatever_the_configuration_and_says_what_helps():
    x = Coordinate(name="x", unit="rad", sentence="angle")
    scene = make_scene(
        name="brake",
        sentence="a hinged rod on a board that does not move",
        source="a test",
        coordinates=(x,),
        parameters=(),
        inertia=sp.Matrix([[1]]),
        constraint=sp.cos(x.symbol) - sp.Rational(1, 2),
        tangential_displacements=(sp.sin(x.symbol),),
        friction=Segment(minus=1, plus=1),
    )
    for angle in ("pi/3", "-pi/3"):
        with pytest.raises(
            InputError, match=r"needs 2 coordinates at least.*this scene has 1: no configuration can do"
        ):
            make_state(scene, keys={"x": angle})
