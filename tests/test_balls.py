"""Balls contain the values of expressions: against mpmath at 60 digits, at points and over wide boxes."""

from __future__ import annotations

from fractions import Fraction

import flint
import mpmath
import pytest
import sympy
from flint import arb, fmpq
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from painleve.exact.balls import ball, make_ball_function

X, Y = sympy.symbols("x y", real=True)
NUMBERS = [sympy.Rational(1, 3), sympy.Integer(-2), sympy.Rational(7, 5), sympy.pi, sympy.sqrt(2), sympy.E]
UNARY = [
    sympy.sin,
    sympy.cos,
    sympy.tan,
    sympy.cot,
    sympy.sec,
    sympy.csc,
    sympy.asin,
    sympy.acos,
    sympy.atan,
    sympy.exp,
    sympy.log,
    sympy.Abs,
    sympy.sign,
    sympy.sinh,
    sympy.cosh,
    sympy.tanh,
]
BINARY = [sympy.Add, sympy.Mul, sympy.Min, sympy.Max, sympy.atan2]
POWERS = [2, 3, 4, 5, -1, -2, -3, *(sympy.Rational(p, q) for p in (-3, -1, 1, 5) for q in (2, 3, 4))]


def _grown(inner: st.SearchStrategy) -> st.SearchStrategy:
    """Trees as written: sympy's own evaluation could change them, and can search for a sign without end."""
    one = st.tuples(st.sampled_from(UNARY), inner).map(lambda t: t[0](t[1], evaluate=False))
    two = st.tuples(st.sampled_from(BINARY), inner, inner).map(lambda t: t[0](t[1], t[2], evaluate=False))
    power = st.tuples(inner, st.sampled_from(POWERS)).map(lambda t: sympy.Pow(t[0], t[1], evaluate=False))
    return (one | two | power).filter(_is_tame)


def _is_tame(expr: sympy.Expr) -> bool:
    """No tower of exponentials, which mpmath would try to evaluate."""
    return sum(part.func in (sympy.exp, sympy.sinh, sympy.cosh) for part in sympy.preorder_traversal(expr)) <= 1


EXPRESSIONS = st.recursive(st.sampled_from([X, X, Y, *NUMBERS]), _grown, max_leaves=6)
FRACTIONS = st.fractions(-4, 4, max_denominator=50)
UNIT = st.fractions(-1, 1, max_denominator=20)


def as_arb(value: Fraction) -> arb:
    return arb(fmpq(value.numerator, value.denominator))


def box(middle: Fraction, radius: Fraction) -> arb:
    return arb(as_arb(middle), as_arb(radius))


def value_by_mpmath(expr: sympy.Expr, x: Fraction, y: Fraction) -> mpmath.mpf | mpmath.mpc | None:
    """Sixty digits by mpmath's own functions on 200 digits; None where mpmath divides by zero."""
    with mpmath.workdps(200):
        point = [mpmath.mpf(v.numerator) / v.denominator for v in (x, y)]
        try:
            return +mpmath.mpmathify(sympy.lambdify([X, Y], expr, "mpmath")(*point))
        except (ZeroDivisionError, ValueError, AttributeError, TypeError):  # the last two: not real under atan2 or Min
            return None


def contains(enclosure: arb, value: mpmath.mpf) -> bool:
    """Whether the ball meets the value known to 60 digits."""
    with flint.ctx.workprec(400):
        middle = arb(mpmath.nstr(value, 100))
        return enclosure.overlaps(arb(middle, (abs(middle) + arb(10) ** -50) * arb(10) ** -60))


def is_real(value: mpmath.mpf | mpmath.mpc) -> bool:
    return abs(mpmath.im(value)) <= mpmath.mpf(10) ** -100 * (1 + abs(value))


@given(EXPRESSIONS, FRACTIONS, FRACTIONS)
@settings(max_examples=400)
def test_a_ball_at_a_point_contains_the_value_that_mpmath_finds(expr: sympy.Expr, x: Fraction, y: Fraction) -> None:
    enclosure = ball(expr, {X: as_arb(x), Y: as_arb(y)})
    assume(enclosure.is_finite())  # NaN and infinite balls contain everything
    value = value_by_mpmath(expr, x, y)
    assume(value is not None)
    assert is_real(value)
    assert contains(enclosure, mpmath.re(value))


@pytest.mark.parametrize(
    ("product", "exact"),
    [
        (1 / (X * Y), Fraction(1, 6)),
        (-1 / (X * Y), Fraction(-1, 6)),
        (-X * Y, Fraction(-6)),
        (-X / Y, Fraction(-2, 3)),
        (1 / (X**2 * Y**3), Fraction(1, 108)),
        (-3 * X / (5 * Y**2), Fraction(-2, 15)),
        (-1 / X**2, Fraction(-1, 4)),
    ],
)
def test_products_and_quotients_have_their_sign_with_and_without_a_numerator(product: sympy.Expr, exact: Fraction):
    found = ball(product, {X: arb(2), Y: arb(3)})
    assert found.overlaps(arb(exact.numerator) / exact.denominator)
    assert found.rad() < 1e-30


@given(
    EXPRESSIONS,
    FRACTIONS,
    FRACTIONS,
    st.fractions(0, 3, max_denominator=20),
    st.lists(st.tuples(UNIT, UNIT), max_size=3),
)
@settings(max_examples=200)
def test_a_ball_over_a_wide_box_contains_the_values_at_points_of_the_box(
    expr: sympy.Expr, x: Fraction, y: Fraction, radius: Fraction, offsets: list[tuple[Fraction, Fraction]]
) -> None:
    enclosure = ball(expr, {X: box(x, radius), Y: box(y, radius)}, bits=64)
    assume(enclosure.is_finite())
    for s, t in [*offsets, (Fraction(1), Fraction(-1)), (Fraction(-1), Fraction(1)), (Fraction(0), Fraction(0))]:
        value = value_by_mpmath(expr, x + s * radius, y + t * radius)
        if value is not None:
            assert is_real(value)
            assert contains(enclosure, mpmath.re(value))


@pytest.mark.parametrize(
    ("expr", "interval", "image"),
    [
        (X**2, (-1, 2), (0, 4)),
        (X**2, (1, 3), (1, 9)),
        (X**4, (-2, 1), (0, 16)),
        (sympy.Abs(X), (-1, 2), (0, 2)),
        (sympy.sqrt(X**2 + 1), (-1, 2), (1, sympy.sqrt(5))),
        (sympy.sin(X), (0, 3), (0, 1)),
        (sympy.cos(X), (-1, 1), (sympy.cos(1), 1)),
        (sympy.exp(X), (0, 1), (1, sympy.E)),
        (sympy.Max(X, 0), (-1, 1), (0, 1)),
    ],
)
def test_wide_balls_are_nearly_the_exact_image(expr: sympy.Expr, interval: tuple, image: tuple) -> None:
    """Centred balls cannot hug an interval and get some slack; squares and absolute values get none below zero."""
    low, high = interval
    enclosure = ball(expr, {X: arb(low).union(arb(high))}, bits=64)
    assert enclosure.lower() <= ball(sympy.sympify(image[0])).lower()
    assert enclosure.upper() >= ball(sympy.sympify(image[1])).upper()
    assert float(enclosure.lower()) >= float(image[0]) - 0.4
    assert float(enclosure.upper()) <= float(image[1]) + 0.4
    if expr.func in (sympy.Abs, sympy.Pow):
        assert enclosure.lower() >= 0


@pytest.mark.parametrize(
    ("expr", "value"),
    [
        (sympy.sqrt(X), arb(0.5, 1)),
        (sympy.sqrt(X), arb(-1)),
        (sympy.root(X, 3), arb(-8)),
        (sympy.log(X), arb(1, 2)),
        (sympy.asin(X), arb(0.5, 1)),
        (1 / X, arb(0, 1)),
        (sympy.tan(X), arb(1.5, 1)),
        (X + 1, arb.nan()),
        (X**2, arb.nan()),
        (sympy.Abs(X), arb.nan()),
        (sympy.Min(X, 0), arb.nan()),
        (sympy.CRootOf(sympy.Symbol("z") ** 3 - 2, 1) * X, arb(1)),
    ],
)
def test_where_an_expression_may_be_undefined_or_not_real_its_ball_is_nan(expr: sympy.Expr, value: arb) -> None:
    assert not ball(expr, {X: value}).is_finite()


@pytest.mark.parametrize(
    "coefficients", [[5, -7, 2, -1], [1, 0, 0, -2], [1, 0, -4, 1], [1, -2, -5, 7, 1], [2, 0, -9, 0, 3]]
)
def test_the_real_roots_of_a_polynomial_are_numbered_as_sympy_numbers_them(coefficients: list[int]) -> None:
    polynomial = sympy.Poly(coefficients, X)
    for root in polynomial.real_roots():
        enclosure = ball(root, bits=256)
        with mpmath.workdps(110):
            assert contains(enclosure, mpmath.mpf(str(sympy.N(root, 110))))
        assert float(enclosure.rad()) < 1e-70


def test_a_root_of_a_reducible_polynomial_is_the_root_of_its_factor() -> None:
    product = sympy.Poly((X**3 - X - 1) * (X**3 - 4 * X + 1), X)
    roots = [product.real_roots()[i] for i in range(4)]
    values = [float(ball(root).mid()) for root in roots]
    assert values == sorted(values)
    for root in roots:
        assert ball(product.as_expr().subs(X, root)).contains(arb(0))


@pytest.mark.parametrize("bits", [64, 256, 1024])
def test_precision_is_what_was_asked_for_and_the_global_one_is_put_back(bits: int) -> None:
    before = flint.ctx.prec
    assert ball(sympy.sqrt(2) * sympy.pi, bits=bits).rel_accuracy_bits() > bits - 8
    with pytest.raises(ValueError, match="no value for the symbol y"):
        ball(X + Y, {X: arb(1)}, bits=bits)
    assert flint.ctx.prec == before


SHARING = [
    (X + Y) * sympy.sin(X + Y) + sympy.sin(X + Y) ** 2,
    X * Y * sympy.exp(Y) - 3 * X * Y / (1 + X**2),
    -((X - 2 * Y) ** 3) / sympy.sqrt(1 + (X - 2 * Y) ** 2) + sympy.pi / 7,
    1 / (2 + sympy.cos(X) * sympy.cos(Y)) ** 2 - sympy.cos(X) * sympy.cos(Y) / (X**2 * Y**4 + 5),
    sympy.Rational(4, 3) - sympy.sqrt(2),
]


@given(FRACTIONS, FRACTIONS, st.fractions(0, 1, max_denominator=20), UNIT, UNIT)
@settings(max_examples=40)
def test_a_compiled_function_encloses_each_of_its_expressions(
    x: Fraction, y: Fraction, radius: Fraction, s: Fraction, t: Fraction
) -> None:
    enclosures = make_ball_function(SHARING, [X, Y], bits=100)([box(x, radius), box(y, radius)])
    for expr, enclosure in zip(SHARING, enclosures, strict=True):
        value = value_by_mpmath(expr, x + s * radius, y + t * radius)
        assert value is not None
        assert contains(enclosure, value)


def test_a_compiled_function_can_be_called_again_with_other_balls() -> None:
    function = make_ball_function([X * Y + sympy.sin(X)], [X, Y])
    for x, y in ((1, 2), (3, 5), (1, 2)):
        assert function([arb(x), arb(y)])[0].contains(ball(x * y + sympy.sin(x), bits=256))


def test_a_compiled_function_asks_for_one_ball_an_argument() -> None:
    with pytest.raises(ValueError, match="expected 2 balls, not 1"):
        make_ball_function([X + Y], [X, Y])([arb(1)])


@pytest.mark.parametrize(
    "expr", [sympy.gamma(X), X**Y, sympy.Float("0.1") + X, sympy.oo, sympy.zoo, sympy.nan, sympy.I * X], ids=str
)
def test_what_has_no_ball_arithmetic_is_refused(expr: sympy.Expr) -> None:
    with pytest.raises(TypeError, match="no ball arithmetic"):
        ball(expr, {X: arb(1), Y: arb(1)})
