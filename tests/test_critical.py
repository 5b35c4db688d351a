"""Critical states along curves: published values, examples of docs/theory.md, section 6, and independent scans."""

from __future__ import annotations

import json
from itertools import pairwise

import mpmath
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from painleve.cli import main
from painleve.errors import InputError
from painleve.exact.signs import Sign, exact_sign
from painleve.exact.zeros import ZeroStatus, find_zeros
from painleve.mechanics.derive import derive
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.classification import Branch, classify
from painleve.theory.critical import CriticalStates, Extremum, critical_states
from painleve.theory.neighbourhood import Neighbourhood

APPROACHED, ISOLATED, UNDECIDED = Neighbourhood.APPROACHED, Neighbourhood.ISOLATED, Neighbourhood.UNDECIDED
ROD, WORN, ARM, ELLIPSE, BODY, MINIMAL = (
    load_scene(n) for n in ("slender_rod", "worn_tip_rod", "two_link_arm", "ellipse", "planar_body", "minimal")
)
s = sp.Symbol("s", real=True)


def same(left: sp.Expr, right: object) -> bool:
    return exact_sign(left - sp.sympify(right)).sign is Sign.ZERO


def numbers(found: CriticalStates) -> tuple[list[float], list[float]]:
    return tuple([float(x.enclosure.mid()) for x in xs] for xs in (found.zeros, found.extrema))


# --- zeros of one function -------------------------------------------------------------------------------------------


@given(st.lists(st.fractions(-2, 2, max_denominator=9), min_size=1, max_size=5))
@settings(max_examples=30)
def test_all_zeros_of_a_polynomial_are_found_exactly_with_their_multiplicities(roots):
    """Its zeros are chosen first; up to multiplicity 4 each is told apart."""
    polynomial = sp.expand(sp.Mul(*((s - sp.Rational(r)) for r in roots)) * (s**2 + 1))
    found = find_zeros(polynomial, s, sp.Integer(-3), sp.Integer(3)).zeros
    expected = [(sp.Rational(r), roots.count(r)) for r in sorted(set(roots)) if roots.count(r) <= 4]
    assert [(z.place, z.multiplicity) for z in found if z.status is ZeroStatus.EXACT] == expected
    assert len(found) == len(set(roots))


@pytest.mark.parametrize(("place", "multiplicity"), [("-1", 3), ("1", 4), ("-17/9", 4), ("-15/8", 4)])
def test_a_zero_of_high_multiplicity_takes_the_undecided_parts_beside_it_along(place, multiplicity):
    """Balls decide some parts next to such a zero and not others, which are beside it without a touch."""
    polynomial = sp.expand((s - sp.Rational(place)) ** multiplicity * (s**2 + 1))
    (zero,) = find_zeros(polynomial, s, sp.Integer(-3), sp.Integer(3)).zeros
    assert (zero.place, zero.multiplicity, zero.rise) == (sp.Rational(place), multiplicity, 1)


@given(st.lists(st.integers(-5, 5), min_size=5, max_size=5), st.integers(1, 4))
@settings(max_examples=30)
def test_the_zeros_of_a_trigonometric_polynomial_are_those_of_a_fine_scan(c, k):
    """Signs on 1000 points between -3 and 3: they change where there is an odd number of zeros, and nowhere else."""
    sine, cosine = sp.sin(s), sp.cos(s)
    function = c[0] + c[1] * sine + c[2] * cosine + c[3] * sine * cosine + c[4] * sp.sqrt(k) * sine**2
    if not function.has(s):
        return
    found = find_zeros(function, s, sp.Integer(-3), sp.Integer(3)).zeros
    value = sp.lambdify(s, function, "mpmath")
    grid = [mpmath.mpf(-3) + mpmath.mpf(6) * i / 1000 for i in range(1001)]
    values = [value(x) for x in grid]
    odd = [float(z.enclosure.mid()) for z in found if z.multiplicity % 2 == 1]
    for (a, b), (left, right) in zip(pairwise(grid), pairwise(values), strict=True):
        if abs(left) > 1e-12 and abs(right) > 1e-12:
            inside = sum(a < x < b for x in odd)  # two in one cell of the scan leave its signs as they are
            assert inside % 2 == int(left * right < 0)
    for zero in found:
        if zero.place is not None:
            assert exact_sign(function.xreplace({s: zero.place})).sign is Sign.ZERO


def test_a_transcendental_zero_is_enclosed_and_a_double_one_without_closed_form_is_left_undecided():
    (zero,) = find_zeros(sp.cos(s) - s, s, sp.Integer(0), sp.Integer(1)).zeros
    assert zero.status is ZeroStatus.ENCLOSED
    with mpmath.workdps(40):
        assert abs(float(zero.enclosure.mid()) - mpmath.findroot(lambda x: mpmath.cos(x) - x, 0.7)) < 1e-16
    assert zero.enclosure.rad() < 1e-20
    (zero,) = find_zeros((sp.cos(s) - s) ** 2, s, sp.Integer(0), sp.Integer(1)).zeros
    assert zero.status is ZeroStatus.UNDECIDED
    assert zero.enclosure.contains(find_zeros(sp.cos(s) - s, s, sp.Integer(0), sp.Integer(1)).zeros[0].enclosure)


def test_a_function_too_large_for_a_closed_form_is_searched_all_the_same():
    (zero,) = find_zeros(s**301 - 2, s, sp.Integer(0), sp.Integer(2)).zeros
    assert (zero.status, zero.multiplicity) == (ZeroStatus.ENCLOSED, 1)
    assert abs(float(zero.enclosure.mid()) - 2 ** (1 / 301)) < 1e-15


def test_two_zeros_a_millionth_apart_are_told_apart_and_a_near_miss_is_none():
    near = sp.Rational(1, 10**12)
    pair = find_zeros((s - sp.Rational(1, 3)) ** 2 - near, s, sp.Integer(0), sp.Integer(1)).zeros
    assert [z.place for z in pair] == [sp.Rational(1, 3) - sp.sqrt(near), sp.Rational(1, 3) + sp.sqrt(near)]
    assert find_zeros((s - sp.Rational(1, 3)) ** 2 + near, s, sp.Integer(0), sp.Integer(1)).zeros == ()


def test_zeros_at_the_ends_count_and_intervals_on_which_there_is_no_value_are_named():
    zeros = find_zeros(sp.sin(s), s, -sp.pi, sp.pi).zeros
    assert [z.place for z in zeros] == [-sp.pi, 0, sp.pi]
    found = find_zeros(sp.sqrt(1 - s**2) - s, s, sp.Integer(-2), sp.Integer(2))
    assert [z.place for z in found.zeros] == [sp.sqrt(2) / 2]
    ends = sorted((float(x.lower()), float(x.upper())) for x in found.outside)
    assert ends == [pytest.approx((-2, -1), abs=1e-6), pytest.approx((1, 2), abs=1e-6)]


# --- the rod ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("mu", ["2", "5/3", "3/2", "sqrt(2)"])
def test_the_rod_s_band_edges_and_least_critical_friction_are_the_published_ones_exactly(mu):
    """tan(theta) = (3 mu -+ sqrt(9 mu^2 - 16))/2; mu_c = 4/3 at tan(theta) = 2."""
    found = critical_states(ROD, "theta", parameters={"mu": mu})
    value = sp.sympify(mu)
    edges = [(3 * value + sign * sp.sqrt(9 * value**2 - 16)) / 2 for sign in (-1, 1)]
    assert [x.status for x in found.zeros] == [ZeroStatus.EXACT] * 2
    for x, edge in zip(found.zeros, edges, strict=True):
        assert same(sp.tan(x.place), edge)
        assert x.kind is APPROACHED
        assert same(x.friction, value)
        assert classify(make_state(ROD, keys={"theta": x.place}, parameters={"mu": mu})).branch is (
            Branch.CRITICAL_APPROACHED
        )
    (least,) = found.extrema
    assert found.least is least
    assert (least.place, least.friction, least.extremum) == (sp.atan(2), sp.Rational(4, 3), Extremum.MINIMUM)
    assert least.kind is APPROACHED
    assert found.unresolved == ()


def test_at_the_least_friction_the_two_edges_are_one_double_zero_and_below_it_there_is_none():
    (zero,) = critical_states(ROD, "theta", parameters={"mu": "4/3"}).zeros
    assert (zero.place, zero.status, zero.kind) == (sp.atan(2), ZeroStatus.EXACT, APPROACHED)
    below = critical_states(ROD, "theta", parameters={"mu": "4/3 - 1e-9"})
    assert below.zeros == ()
    assert below.unresolved == ()
    assert len(critical_states(ROD, "theta", parameters={"mu": "4/3 + 1e-9"}).zeros) == 2


@pytest.mark.parametrize(
    ("k", "kind"), [("2", APPROACHED), ("416/100", APPROACHED), ("417/100", ISOLATED), ("6", ISOLATED)]
)
def test_the_worn_rod_s_critical_state_changes_its_kind_at_25_6(k, kind):
    found = critical_states(WORN, "theta", parameters={"k": k})
    (zero,) = [x for x in found.zeros if x.place is not None]
    assert (zero.place, zero.kind) == (sp.atan(2), kind)
    assert all(x.kind is APPROACHED for x in found.zeros if x is not zero)
    assert found.unresolved == ()
    assert found.extrema[0].kind is UNDECIDED  # mu depends on theta: it cannot be set to mu_c


def test_the_worn_rod_s_other_edges_are_enclosed_where_a_root_finder_sees_them():
    found = critical_states(WORN, "theta", parameters={"k": 6})
    first, _, last = (float(x.enclosure.mid()) for x in found.zeros)
    state = make_state(WORN, keys={"theta": 1}, parameters={"k": 6})
    gamma = sp.lambdify(
        WORN.q[2], derive(WORN).gamma.xreplace({p.symbol: state.parameters[p.name] for p in WORN.parameters}), "mpmath"
    )
    for place in (first, last):
        assert abs(mpmath.findroot(gamma, place) - place) < 1e-14


@pytest.mark.parametrize("alpha", ["1", "3", "8"])
def test_a_general_rod_s_least_friction_is_the_published_formula(alpha):
    found = critical_states(load_scene("general_rod"), "theta", parameters={"alpha": alpha})
    a = sp.Rational(alpha)
    assert same(found.least.friction, 2 * sp.sqrt(1 + a) / a)
    assert same(sp.tan(found.least.place), sp.sqrt(1 + a))


def test_a_planar_body_s_minima_are_the_rod_s_turned_by_its_offset():
    found = critical_states(BODY, "theta", low=0, high="pi/2")
    assert [x.place for x in found.extrema] == [sp.atan(sp.Rational(2, 11)), sp.atan(2)]
    assert all(same(x.friction, sp.Rational(4, 3)) for x in found.extrema)


def test_in_space_the_rod_has_the_edges_of_the_plane():
    found = critical_states(load_scene("spatial_rod"), "theta", parameters={"mu": 2})
    assert [x.place for x in found.zeros] == [sp.atan(3 - sp.sqrt(5)), sp.atan(3 + sp.sqrt(5))]
    assert found.least.place == sp.atan(2)
    assert found.unresolved == ()


# --- the ellipse and the minimal scene -------------------------------------------------------------------------------


def test_the_ellipse_with_a_heavy_core_has_an_isolated_critical_state_between_two_approached_ones():
    core = {"B": "sqrt(2)/2", "I": "3/100", "mu": "7*sqrt(3)/25"}
    found = critical_states(ELLIPSE, "theta", parameters=core)
    kinds = [(x.extremum, x.kind) for x in found.extrema]
    assert kinds == [(Extremum.MINIMUM, APPROACHED), (Extremum.MAXIMUM, ISOLATED), (Extremum.MINIMUM, APPROACHED)]
    assert found.extrema[1].place == sp.pi / 6
    assert [x.kind for x in found.zeros] == [APPROACHED, ISOLATED, APPROACHED]
    assert same(sp.tan(found.extrema[0].place) ** 2, 4 - sp.sqrt(61) / 2)


def test_the_kind_by_enclosures_alone_agrees_with_exact_arithmetic():
    """The same heavy core with a transcendental number in it: its extrema have no closed form."""
    core = {"B": "sqrt(2)/2", "I": "3/100 + exp(-30)"}
    found = critical_states(ELLIPSE, "theta", parameters=core)
    assert [x.status for x in found.extrema] == [ZeroStatus.ENCLOSED] * 3
    assert [x.kind for x in found.extrema] == [APPROACHED, ISOLATED, APPROACHED]
    assert abs(float(found.extrema[1].enclosure.mid()) - mpmath.pi / 6) < 1e-9


def test_along_the_floor_the_minimal_scene_s_maximum_is_approached_from_penetration():
    """gamma = y^2 - x^2: a maximum of mu_c along the floor, and yet not isolated."""
    found = critical_states(MINIMAL, "x", parameters={"mu": 1})
    (maximum,) = found.extrema
    assert (maximum.place, maximum.extremum, maximum.kind) == (0, Extremum.MAXIMUM, APPROACHED)
    (other,) = critical_states(MINIMAL, "x", parameters={"mu": 1, "beta_yy": 1}).extrema
    assert other.kind is ISOLATED


# --- the arm along the table -----------------------------------------------------------------------------------------


def test_the_arm_along_the_table_has_the_known_maximum_and_it_is_isolated():
    """Equal unit links at the depth 1.95: phi1 = -0.163, phi2 = 0.272, mu = 0.5964."""
    found = critical_states(ARM, "phi1", low="-1/4", high="0")
    (maximum,) = [x for x in found.extrema if x.extremum is Extremum.MAXIMUM]
    phi1 = float(maximum.enclosure.mid())
    assert (maximum.status, maximum.kind) == (ZeroStatus.ENCLOSED, ISOLATED)
    assert f"{phi1:.3f}" == "-0.163"
    assert f"{float(mpmath.acos(1.95 - mpmath.cos(phi1))):.3f}" == "0.272"
    assert f"{float(maximum.friction_enclosure.mid()):.4f}" == "0.5964"
    assert found.changing == ()


def test_the_extrema_of_mu_c_along_the_table_are_those_of_a_scan():
    found = critical_states(ARM, "phi1")
    state = make_state(ARM, keys={"phi1": 0})
    parameters = {p.symbol: state.parameters[p.name] for p in ARM.parameters}
    friction = sp.lambdify(ARM.q, derive(ARM).critical_friction.xreplace(parameters), "mpmath")
    edge = float(mpmath.acos(0.95))
    grid = [edge * (2 * i / 4000 - 1) for i in range(1, 4000)]
    values = [friction(x, mpmath.acos(1.95 - mpmath.cos(x))) for x in grid]
    inner = range(1, len(grid) - 1)
    turning = [grid[i] for i in inner if (values[i] - values[i - 1]) * (values[i + 1] - values[i]) < 0]
    finite = [x for x in turning if friction(x, mpmath.acos(1.95 - mpmath.cos(x))) < 10]
    assert [float(x.enclosure.mid()) for x in found.extrema] == pytest.approx(finite, abs=2 * edge / 2000)


def test_an_exact_critical_state_of_the_arm_is_found_by_its_closed_form_along_its_own_table():
    named = ARM.state("isolated")
    given = dict(named.parameters) | {"depth": "143/145 + 24/25"}
    found = critical_states(ARM, "phi1", low="-1/5", high="-1/8", parameters=given)
    (maximum,) = found.extrema
    assert (maximum.status, maximum.kind, maximum.extremum) == (ZeroStatus.EXACT, ISOLATED, Extremum.MAXIMUM)
    assert same(sp.tan(maximum.place / 2), sp.Rational(-1, 12))
    assert same(maximum.friction, sp.sympify(named.parameters["mu"]))
    (zero,) = found.zeros
    assert (zero.place, zero.kind) == (maximum.place, ISOLATED)


def test_where_the_depth_goes_with_the_arm_nothing_is_claimed_of_states_that_are_only_enclosed():
    found = critical_states(ARM, "phi1", low="-1/2", high="-1/10", keys={"phi2": "1/4"}, parameters={"mu": "3/5"})
    assert found.changing == ("depth",)
    assert found.zeros
    assert {x.kind for x in (*found.zeros, *found.extrema) if x.status is ZeroStatus.ENCLOSED} <= {UNDECIDED}


# --- wrong questions, and the command --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scene", "along", "given", "message"),
    [
        ("slender_rod", "psi", {}, "no state key 'psi' to go along; keys: theta, slip, omega"),
        ("slender_rod", "theta", {"low": 1, "high": 1}, "the interval from 1 to 1 of theta is empty"),
        ("slender_rod", "theta", {"low": "pi/2", "high": 0}, "from pi/2 to 0 of theta is empty"),
        ("slender_rod", "theta", {"keys": {"theta": 1}}, "theta is given, and so cannot vary"),
        ("slender_rod", "slip", {"keys": {"theta": 1}}, "slip .m/s. has no interval of its own"),
        ("slender_rod", "slip", {"keys": {"theta": 1}, "low": 0, "high": 1}, "gamma does not depend on slip"),
        ("slender_rod", "theta", {"low": "nan"}, "'nan' is not a finite number"),
        ("slender_rod", "theta", {"name": "nowhere"}, "no state 'nowhere'"),
        ("bead", "x", {}, "scene bead has no friction: gamma is positive and mu_c infinite everywhere"),
        ("ellipse", "theta", {"parameters": {"B": 1}}, "mu_c is infinite everywhere along theta"),
    ],
)
def test_a_wrong_question_is_answered_with_one_clear_line(scene, along, given, message):
    with pytest.raises(InputError, match=message) as caught:
        critical_states(load_scene(scene), along, **given)
    assert str(caught.value).isprintable()


def test_the_command_answers_people_and_machines(capsys):
    words = ["critical", "slender_rod", "--along", "theta", "--set", "mu=2"]
    assert main(words) == 0
    text = capsys.readouterr().out
    assert "least friction of a paradox on this curve: 4/3 = 1.333333333, at theta = atan(2) = 1.107148718" in text
    assert main([*words, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert [x["exact"] for x in answer["zeros"]] == ["atan(3 - sqrt(5))", "atan(sqrt(5) + 3)"]
    assert answer["least"]["critical_friction_exact"] == "4/3"
    assert answer["least"]["kind"] == "approached"
    assert answer["ends"] == [None, None]
    assert answer["status"] == "all found"


def test_the_command_refuses_in_one_line(capsys):
    assert main(["critical", "slender_rod", "--along", "theta", "--from", "1", "--to", "1"]) == 2
    assert capsys.readouterr().err == "painleve: the interval from 1 to 1 of theta is empty\n"
