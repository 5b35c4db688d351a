"""Taylor coefficients as balls: against mpmath's Taylor series and exact derivatives, at points and over boxes."""

from __future__ import annotations

from functools import cache
from math import comb, factorial

import flint
import mpmath
import numpy as np
import pytest
import sympy as sp
from flint import arb
from hypothesis import given, settings
from hypothesis import strategies as st
from planar_scenes import SCENE_NAMES

from painleve.exact.balls import ball
from painleve.exact.jets import Jet, jets, monomials
from painleve.mechanics.derive import derive
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

X, Y = sp.symbols("x y", real=True)
DIGITS = 50
THIRD, FIFTH = (ball(sp.Rational(1, n), bits=320) for n in (3, 5))

ONE_VARIABLE = {
    "polynomial": 3 * X**5 - X**2 / 7 + 2,
    "quotient": (1 + X) / (2 - X**2),
    "negative powers": X**-3 + (1 + X) ** -2,
    "square root": sp.sqrt(1 + X),
    "rational powers": X ** sp.Rational(2, 3) + (1 + X) ** sp.Rational(-5, 4) + X ** sp.Rational(3, 2),
    "sine and cosine": sp.sin(3 * X) * sp.cos(X**2),
    "tangent": sp.tan(X) + sp.cot(X),
    "inverses": sp.atan(X) + sp.asin(X / 2) - sp.acos(X**2),
    "exponential and logarithm": sp.exp(-(X**2)) * sp.log(1 + X),
    "hyperbolic": sp.sinh(X) + sp.cosh(2 * X) * sp.tanh(X),
    "hyperbolic with circular": sp.cosh(X) * sp.sin(X) + sp.atan(sp.sinh(X)),
    "absolute value of something positive": sp.Abs(X + 1) * X,
    "absolute value of something negative": sp.Abs(X - 1) * sp.sin(X),
    "secant": sp.sec(X) + sp.csc(X),
    "shared parts": sp.sin(X) ** 2 / (1 + sp.sin(X) ** 2) + sp.sqrt(1 + sp.sin(X) ** 2),
}


def as_mp(value: arb) -> mpmath.mpf:
    """The midpoint, exactly (at a working precision that holds it)."""
    mantissa, exponent = value.mid().man_exp()
    return mpmath.ldexp(mpmath.mpf(int(mantissa)), int(exponent))


def contains(enclosure: arb, value: mpmath.mpf, error: mpmath.mpf) -> bool:
    """Whether the enclosure reaches within `error`, the other route's own, of the value."""
    lower, upper = as_mp(enclosure.lower()), as_mp(enclosure.upper())
    return lower - error <= value <= upper + error


@pytest.mark.parametrize("expression", ONE_VARIABLE.values(), ids=ONE_VARIABLE.keys())
def test_coefficients_in_one_variable_are_those_of_mpmath_at_50_digits(expression):
    order = 8
    (jet,) = jets([expression], [X], {X: THIRD}, order, bits=256)
    with mpmath.workdps(DIGITS + 25):
        expected = mpmath.taylor(sp.lambdify(X, expression, "mpmath"), mpmath.mpf(1) / 3, order)
        for power, value in enumerate(expected):
            found = jet.terms.get((power,), arb(0))
            assert float(found.rad()) < 1e-50 * (1.0 + abs(float(found.mid())))
            assert contains(found, value, mpmath.mpf(10) ** -DIGITS * (1 + abs(value)))


TWO_VARIABLES = {
    "product": X**2 * Y**3 - 4 * X * Y,
    "quotient": (X - Y) / (1 + X * Y),
    "rotation": sp.sin(X - 2 * Y) * sp.cos(X + Y),
    "distance": sp.sqrt(X**2 + Y**2),
    "root of a quotient": ((1 + X) / (1 + Y)) ** sp.Rational(1, 3),
    "tanh of a product": sp.tanh(X * Y) + sp.exp(X / Y),
}


@pytest.mark.parametrize("expression", TWO_VARIABLES.values(), ids=TWO_VARIABLES.keys())
def test_coefficients_in_two_variables_are_the_exact_mixed_derivatives_over_factorials(expression):
    order = 4
    (jet,) = jets([expression], [X, Y], {X: THIRD, Y: FIFTH}, order, bits=256)
    point = {X: sp.Rational(1, 3), Y: sp.Rational(1, 5)}
    for i, j in monomials(2, order):
        exact = sp.diff(expression, X, i, Y, j).xreplace(point) / (factorial(i) * factorial(j))
        assert jet.terms.get((i, j), arb(0)).overlaps(ball(exact, bits=256))


def test_other_symbols_are_constants_of_the_expansion():
    (jet,) = jets([sp.sin(Y) * X**2], [X], {X: arb(0), Y: FIFTH}, 3)
    assert set(jet.terms) >= {(2,)}
    assert jet.terms[(2,)].overlaps(FIFTH.sin())
    assert all(value == 0 for powers, value in jet.terms.items() if powers != (2,))


@pytest.mark.parametrize(("variables", "order"), [(1, 0), (1, 5), (2, 4), (3, 3), (4, 2)])
def test_monomials_are_all_of_their_degree_once_and_rise(variables, order):
    found = monomials(variables, order)
    assert len(set(found)) == len(found) == comb(variables + order, order)
    assert [sum(powers) for powers in found] == sorted(sum(powers) for powers in found)


@given(
    st.sampled_from(sorted(ONE_VARIABLE)),
    st.fractions(-1, 1, max_denominator=40),
    st.integers(0, 4),
    st.sampled_from([sp.Rational(1, n) for n in (1000, 50, 12)]),
)
@settings(max_examples=80)
def test_the_jet_of_a_wide_ball_encloses_the_scaled_derivatives_all_over_it(name, share, order, radius):
    """Exact derivatives at a point of the ball [1/3 - r, 1/3 + r], evaluated as a ball of their own."""
    (jet,) = wide_jet(name, radius)
    point = sp.Rational(1, 3) + sp.Rational(share) * radius
    value = ball(derivative(name, order), {X: ball(point, bits=256)}, bits=256) / factorial(order)
    assert value.is_finite()
    found = jet.terms.get((order,), arb(0))
    assert found.is_nan() or found.overlaps(value)
    if radius < sp.Rational(1, 50):
        assert float(found.rad()) < 1.0 + abs(float(value.mid())), "an enclosure of everything would prove nothing"


@cache
def derivative(name: str, order: int) -> sp.Expr:
    smooth = ONE_VARIABLE[name].replace(sp.Abs, lambda e: e if e.subs(X, sp.Rational(1, 3)) > 0 else -e)
    return sp.diff(smooth, X, order)


@cache
def wide_jet(name: str, radius: sp.Rational) -> list[Jet]:
    wide = arb(THIRD, ball(radius))
    return jets([ONE_VARIABLE[name]], [X], {X: wide}, 4, bits=128)


BOX = sp.Rational(1, 40)
BOXED = sp.sqrt(X**2 + Y**2) * sp.sin(3 * X)


@cache
def taylor_form(order: int) -> list[tuple[tuple[int, ...], arb]]:
    """Coefficients at (1/3, 1/5) below the order, over the whole box at the order."""
    (narrow,) = jets([BOXED], [X, Y], {X: THIRD, Y: FIFTH}, order - 1)
    (wide,) = jets([BOXED], [X, Y], {X: arb(THIRD, ball(BOX)), Y: arb(FIFTH, ball(BOX))}, order)
    return [(p, (wide if sum(p) == order else narrow).terms.get(p, arb(0))) for p in monomials(2, order)]


@given(st.fractions(-1, 1, max_denominator=30), st.fractions(-1, 1, max_denominator=30))
@settings(max_examples=60)
def test_a_wide_jet_of_highest_degree_bounds_the_remainder_of_the_taylor_polynomial(s, t):
    offsets = BOX * sp.Rational(s), BOX * sp.Rational(t)
    h, k = (ball(x, bits=128) for x in offsets)
    taylor = sum((c * h ** p[0] * k ** p[1] for p, c in taylor_form(4)), arb(0))
    point = {X: ball(sp.Rational(1, 3) + offsets[0], bits=128), Y: ball(sp.Rational(1, 5) + offsets[1], bits=128)}
    assert taylor.overlaps(ball(BOXED, point, bits=128))
    assert float(taylor.rad()) < 1e-3, "an enclosure of everything would prove nothing"


@pytest.mark.parametrize(
    ("expression", "reason"),
    [
        (sp.Abs(X - Y), r"no Taylor expansion of \|.\| at zero"),
        (sp.Min(X, Y + 1), "no Taylor expansion for Min"),
        (X**Y, "no Taylor expansion for the exponent y"),
        (sp.sign(X), "no Taylor expansion for sign"),
    ],
)
def test_a_function_that_is_not_analytic_there_is_refused(expression, reason):
    with pytest.raises(ValueError, match=reason):
        jets([expression], [X, Y], {X: THIRD, Y: THIRD}, 3)


def test_the_working_precision_of_the_process_is_put_back_even_after_a_failure():
    before = (flint.ctx.prec, flint.ctx.cap)
    with pytest.raises(ValueError, match="no Taylor expansion"):
        jets([sp.sign(X)], [X], {X: THIRD}, 3, bits=777)
    jets([sp.sin(X)], [X], {X: THIRD}, 30, bits=777)
    assert (flint.ctx.prec, flint.ctx.cap) == before


@pytest.mark.parametrize(("scene", "name"), [(s, n.name) for s in SCENE_NAMES for n in load_scene(s).states])
def test_at_an_exact_state_what_vanishes_there_is_zero_to_60_digits(scene, name):
    """g, and where the state is critical the compliance of its edge; at the double zero its first derivative too."""
    state = make_state(load_scene(scene), name)
    d = derive(state.scene)
    values = {s: ball(v, bits=320) for s, v in state.substitution.items()}
    g, plus = jets([state.scene.contact.constraint, d.edge_compliance.get(1, d.a)], state.scene.q, values, 2, bits=320)
    assert abs(float(g.constant().abs_upper())) < 1e-60
    if name in ("critical", "double_zero", "approached", "isolated"):
        compliances = [plus, jets([d.edge_compliance[-1]], state.scene.q, values, 2, bits=320)[0]]
        least = min(compliances, key=lambda jet: float(jet.constant().mid()))
        assert float(least.constant().abs_upper()) < 1e-60
        slopes = [float(least.terms.get(p, arb(0)).abs_upper()) for p in monomials(len(state.q), 1)[1:]]
        assert (np.max(slopes) < 1e-60) == (scene != "two_link_arm" and name != "critical")
