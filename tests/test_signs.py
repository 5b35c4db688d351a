"""Signs of constants: zeros are proved, tiny numbers are not taken for zero, and nothing takes long."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from fractions import Fraction

import flint
import mpmath
import pytest
import sympy
from flint import arb
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from sympy import Rational, acos, asin, atan, atan2, cos, cosh, cot, exp, log, pi, root, sin, sinh, sqrt, tan, tanh

from painleve.exact import signs
from painleve.exact.balls import ball
from painleve.exact.signs import Sign, _size, exact_sign

SECONDS = 30.0  # of the processor: what is unbounded takes hours, what is bounded far less on any machine
X = sympy.Symbol("x")
CUBIC = sympy.CRootOf(5 * X**3 - 7 * X**2 + 2 * X - 1, 0)
QUADRATIC = sympy.CRootOf(X**2 - 6 * X + 4, 0)  # 3 - sqrt(5), where the rod with mu = 2 is critical


def edge(mu: sympy.Expr, theta: sympy.Expr) -> sympy.Expr:
    """gamma of the uniform slender rod with m = 1 (docs/theory.md, section 6)."""
    return 1 + 3 * cos(theta) ** 2 - 3 * mu * sin(theta) * cos(theta)


def critical_friction(theta: sympy.Expr) -> sympy.Expr:
    return (tan(theta) + 4 * cot(theta)) / 3


ZEROS = {
    "the rod at mu = 2": edge(2, atan(3 - sqrt(5))),
    "the rod at mu = 2, as a root of a polynomial": edge(2, atan(QUADRATIC)),
    "the rod at the double zero": edge(Rational(4, 3), atan(2)),
    "the rod at mu = mu_c(1)": edge(critical_friction(sympy.Integer(1)), sympy.Integer(1)),
    "the rod at mu = mu_c(0.731)": edge(critical_friction(Rational(731, 1000)), Rational(731, 1000)),
    "the rod at mu = mu_c(pi/7)": edge(critical_friction(pi / 7), pi / 7),
    "critical friction of the rod": critical_friction(sympy.Integer(1)) - (1 + 3 * cos(1) ** 2) / (3 * sin(1) * cos(1)),
    "Pythagoras": sin(1) ** 2 + cos(1) ** 2 - 1,
    "Pythagoras at two angles that no small unit measures": sin(Rational(7311, 10**4)) ** 2
    + cos(Rational(7311, 10**4)) ** 2
    - sin(Rational(4173, 10**4)) ** 2
    - cos(Rational(4173, 10**4)) ** 2,
    "difference of angles": sin(3) * cos(2) - cos(3) * sin(2) - sin(1),
    "difference of rational angles": sin(Rational(435, 1000))
    - sin(Rational(163, 1000)) * cos(Rational(272, 1000))
    - cos(Rational(163, 1000)) * sin(Rational(272, 1000)),
    "half an angle": cos(Rational(1, 2)) ** 2 - (1 + cos(1)) / 2,
    "sum of three angles": sin(1 + sqrt(2) + pi**2) / 3
    - (sin(1) * cos(sqrt(2) + pi**2) + cos(1) * sin(sqrt(2) + pi**2)) / 3,
    "an angle plus an inverse": sin(1 + atan(2)) - (sin(1) + 2 * cos(1)) / sqrt(5),
    "nested square roots": sqrt(2) + sqrt(3) - sqrt(5 + 2 * sqrt(6)),
    "cube roots (Ramanujan)": root(root(2, 3) - 1, 3)
    - (root(Rational(1, 9), 3) - root(Rational(2, 9), 3) + root(Rational(4, 9), 3)),
    "twice atan": cos(2 * atan(Rational(1, 7))) - Rational(24, 25),
    "sum of doubled angles": sin(2 * atan(Rational(1, 7)) - 2 * atan(Rational(1, 12)))
    - (Rational(7, 25) * Rational(143, 145) - Rational(24, 25) * Rational(24, 145)),
    "half of atan": tan(atan(2) / 2) - (sqrt(5) - 1) / 2,
    "cosine of half an atan": cos(atan(2) / 2) ** 2 - (1 + 1 / sqrt(5)) / 2,
    "sine of a quarter of an acos": 2 * sin(acos(Rational(1, 3)) / 4) ** 2 + cos(acos(Rational(1, 3)) / 2) - 1,
    "twice asin": sin(2 * asin(Rational(1, 3))) - 4 * sqrt(2) / 9,
    "three times acos": cos(3 * acos(Rational(1, 3))) - (Rational(4, 27) - 1),
    "atan2": sin(2 * atan2(3, -4)) + Rational(24, 25),
    "atan of an unknown": cos(2 * atan(sin(1))) - (1 - sin(1) ** 2) / (1 + sin(1) ** 2),
    "its own polynomial": 5 * CUBIC**3 - 7 * CUBIC**2 + 2 * CUBIC - 1,
    "a rational function reduced by the polynomial": (CUBIC**4 + 1) / (CUBIC - 2)
    - (7 * CUBIC**3 / 5 - 2 * CUBIC**2 / 5 + CUBIC / 5 + 1) / (CUBIC - 2),
    "tangent of a root": tan(2 * atan(CUBIC)) * (1 - CUBIC**2) - 2 * CUBIC,
    "hyperbola": cosh(1) ** 2 - sinh(1) ** 2 - 1,
    "hyperbolic tangent": tanh(2) - 2 * tanh(1) / (1 + tanh(1) ** 2),
    "binomial of e": (exp(1) + 1) ** 2 - exp(2) - 2 * exp(1) - 1,
    "absolute value": sympy.Abs(sin(4)) + sin(4),
    "absolute value of a hidden zero": sympy.Abs(sqrt(2) + sqrt(3) - sqrt(5 + 2 * sqrt(6)), evaluate=False),
    "root of a hidden zero": sympy.Pow(sqrt(2) + sqrt(3) - sqrt(5 + 2 * sqrt(6)), Rational(1, 2), evaluate=False),
    "plain zero": sympy.Integer(0),
}


@pytest.mark.parametrize("name", ZEROS)
def test_a_zero_is_proved(name: str) -> None:
    signed = exact_sign(ZEROS[name])
    assert signed.sign is Sign.ZERO, signed.reason
    assert signed.value == 0.0


@pytest.mark.parametrize("name", [name for name in ZEROS if name != "root of a hidden zero"])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_zero_moved_by_a_thousand_bits_is_not_taken_for_zero(name: str, sign: int) -> None:
    moved = exact_sign(sympy.Add(ZEROS[name], Rational(sign, 2**1500), evaluate=False))
    assert moved.sign in (Sign.UNDECIDED, Sign.POSITIVE if sign > 0 else Sign.NEGATIVE)


def conjugate_power(n: int) -> sympy.Expr:
    """(sqrt(2) - 1)^n as a + b sqrt(2) with huge a and b: nearly all of it cancels."""
    a, b = 1, 0
    for _ in range(n):
        a, b = 2 * b - a, a - b
    return a + b * sqrt(2)


@pytest.mark.parametrize("n", [10, 500, 2000, 2001, 20000])
def test_a_number_near_its_separation_bound_keeps_its_sign(n: int) -> None:
    small = conjugate_power(n)
    assert exact_sign(small).sign is Sign.POSITIVE
    assert exact_sign(-small).sign is Sign.NEGATIVE
    assert exact_sign(small - conjugate_power(n + 1) - sqrt(2) * conjugate_power(n + 1)).sign is Sign.ZERO


@pytest.mark.parametrize(
    ("expr", "sign"),
    [
        (exp(pi * sqrt(163)) - 640320**3 - 744, Sign.NEGATIVE),  # -7.5e-13
        (edge(2, atan(2)), Sign.NEGATIVE),
        (edge(Rational(4, 3), atan(2) + Rational(1, 10**40)), Sign.POSITIVE),
        (exp(-2000), Sign.POSITIVE),
        (-pi, Sign.NEGATIVE),
        (sympy.Integer(7), Sign.POSITIVE),
        (5 * CUBIC**3 - 7 * CUBIC**2 + 2 * CUBIC - 1 - Rational(1, 10**400), Sign.NEGATIVE),
    ],
)
def test_a_number_that_is_not_zero_has_its_sign_proved(expr: sympy.Expr, sign: Sign) -> None:
    assert exact_sign(expr).sign is sign


def power_of_unit(k: int, n: int) -> sympy.Expr:
    """(2^(1/k) - 1)^n as a sum of k terms with huge coefficients.

    A unit of its field of degree k: it is as small as its conjugates are large, (2^(1/k) + 1)^n at most.
    """
    coefficients = [1] + [0] * (k - 1)
    for _ in range(n):
        shifted = [2 * coefficients[-1], *coefficients[:-1]]
        coefficients = [x - y for x, y in zip(shifted, coefficients, strict=True)]
    return sympy.Add(*(c * root(2, k) ** j for j, c in enumerate(coefficients)))


@pytest.mark.parametrize(("k", "n"), [(3, 600), (3, 3000), (4, 700), (5, 500), (7, 450)])
def test_a_number_far_below_the_sizes_that_cancel_in_it_keeps_its_sign(k: int, n: int) -> None:
    """More than 1024 bits below one, by the product of k - 1 conjugates and not by one of them."""
    small = power_of_unit(k, n)
    assert exact_sign(small).sign is Sign.POSITIVE
    assert exact_sign(-small / 3).sign is Sign.NEGATIVE
    assert exact_sign(small - power_of_unit(k, n + 1) - (2 - root(2, k)) * small).sign is Sign.ZERO


@pytest.mark.parametrize("k", [2, 3, 5])
@pytest.mark.parametrize(
    "coefficients", [(2, 1, -2), (8, -7, 4, -1), (1024, 3, -1), (2**30, 1, -5, 2, -1), (2**12, -5)]
)
def test_the_size_of_a_root_bounds_all_of_its_conjugates(coefficients: tuple[int, ...], k: int) -> None:
    """Of the root of a number with the denominator L, a power of two, times L: an algebraic integer."""
    polynomial = sympy.Poly(coefficients, X)
    base = sympy.CRootOf(polynomial, polynomial.count_roots() - 1)
    size = _size(sympy.Pow(base, Rational(1, k), evaluate=False), {})
    roots = flint.fmpz_poly(list(coefficients[::-1])).complex_roots()
    largest = max(float(abs(value).mid()) for value, _ in roots)
    assert 2**size.lower == coefficients[0]
    assert size.lower + math.log2(largest) / k <= size.upper + 1e-9


DYADIC = st.integers(1, 40).flatmap(lambda n: st.integers(0, 6).map(lambda k: Rational(n, 2**k)))
SUMS = st.recursive(
    DYADIC | st.integers(2, 30).map(sqrt),
    lambda inner: st.one_of(
        st.lists(inner, min_size=2, max_size=4).map(lambda parts: sympy.Add(*parts, evaluate=False)),
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: sympy.Mul(*parts, evaluate=False)),
        st.tuples(inner, st.integers(2, 3)).map(lambda t: sympy.Pow(t[0], t[1], evaluate=False)),
        st.tuples(inner, st.integers(2, 3)).map(lambda t: sympy.Pow(t[0], Rational(1, t[1]), evaluate=False)),
    ),
    max_leaves=6,
)


@given(SUMS)
@settings(max_examples=80)
def test_the_size_of_a_number_bounds_it_and_with_it_all_of_its_conjugates(number: sympy.Expr) -> None:
    """Of positive terms, so that no conjugate is larger; with denominators 2^k, of which L is the product."""
    size = _size(number, {})
    assert not ball(number, bits=200) > arb(2) ** (size.upper - size.lower)


def test_every_point_of_every_grid_is_within_the_sizes_that_the_separation_bound_is_told(monkeypatch) -> None:
    """Where a grid meets a division by zero the next one is tried, with larger integers."""
    told: list[int] = []
    met: list[int] = []
    separation, vanishes = signs._separation, signs._vanishes_on

    def note_sizes(form: sympy.Expr, unknowns: dict) -> int:
        told.append(min(size.upper for size in unknowns.values()))
        return separation(form, unknowns)

    def note_points(form: sympy.Expr, unknowns: list, grid: Iterator, separation: int) -> bool:
        points = list(grid)
        met.append(max(max(point) for point in points))
        return vanishes(form, unknowns, iter(points), separation) and len(met) % 4 == 0

    monkeypatch.setattr(signs, "_separation", note_sizes)
    monkeypatch.setattr(signs, "_vanishes_on", note_points)
    one = (sympy.E + 1) ** 9 - sympy.expand((sympy.E + 1) ** 9)
    two = (sympy.E + sympy.pi) ** 4 - sympy.expand((sympy.E + sympy.pi) ** 4)
    for identity in (one, two):
        assert exact_sign(identity).sign is Sign.ZERO
        assert len(met) == 4
        assert max(met) <= 2 ** min(told)
        told.clear()
        met.clear()


def near(value: sympy.Expr, digits: int = 420) -> Rational:
    """Its decimals: closer to it than any of the precisions tried can tell."""
    return Rational(str(sympy.N(value, digits)))


@given(st.sets(st.integers(-6, 24), min_size=1, max_size=12))
@example({2})
@example(set(range(2, 10)))
@settings(max_examples=40)
def test_a_polynomial_in_an_unknown_that_vanishes_at_many_integers_is_not_taken_for_zero(places: set[int]) -> None:
    """(e - p) (e - k) (e - l) ...: zero at all these integers, tiny at e, and not zero."""
    e = sympy.E
    product = sympy.Mul(e - near(e), *(e - k for k in places), evaluate=False)
    assert exact_sign(product).sign is Sign.UNDECIDED


@given(st.sets(st.integers(2, 12), min_size=1, max_size=6))
@example({2})
@settings(max_examples=30)
def test_a_function_of_an_angle_that_vanishes_at_many_half_angle_tangents_is_not_taken_for_zero(places: set[int]):
    """t = tan(1/2) is 2u/(1 - u^2) with u = tan(1/4), so u = 2 makes t = -4/3."""
    t = tan(Rational(1, 2))
    product = sympy.Mul(t - near(t), *(t - Rational(2 * u, 1 - u * u) for u in places), evaluate=False)
    assert exact_sign(product).sign is Sign.UNDECIDED


@pytest.mark.parametrize("n", [1, 2, 5])
@pytest.mark.parametrize("first", [(2, 3), (2, 4), (2, 5), (2, 6), (2, 7), (2, 8), (2, 9), (3, 4)])
def test_a_function_of_two_unknowns_that_vanishes_on_a_whole_grid_is_not_taken_for_zero(n: int, first: tuple[int, int]):
    """a (u - i)(u - j)... + b (v - k)(v - l)...: zero on n x n integer points, tiny at u = e, v = pi by choice of b."""
    starts = zip((sympy.E, sympy.pi), first, strict=True)
    factors = [sympy.Mul(*(x - k for k in range(start, start + n))) for x, start in starts]
    function = sympy.Add(factors[0], near(-factors[0] / factors[1], 460) * factors[1], evaluate=False)
    assert exact_sign(function).sign is Sign.UNDECIDED


@pytest.mark.parametrize("undefined", [log(sin(1) ** 2 + cos(1) ** 2 - 1), 1 / (sin(1) ** 2 + cos(1) ** 2 - 1)])
def test_zero_times_what_is_not_defined_is_not_zero(undefined: sympy.Expr) -> None:
    """The logarithm and the reciprocal of a hidden zero."""
    product = sympy.Mul(undefined, sin(2) ** 2 + cos(2) ** 2 - 1, evaluate=False)
    assert exact_sign(product).sign is Sign.UNDECIDED


def roots_against_decimals(digits: int) -> sympy.Expr:
    roots = sum(sqrt(prime) for prime in (2, 3, 5, 7, 11, 13, 17, 19, 23))
    return roots - Rational(str(sympy.N(roots, digits)))


@pytest.mark.parametrize(
    "expr",
    [
        4 * atan(Rational(1, 5))
        - atan(Rational(1, 239))
        - pi / 4,  # Machin: a true zero, not among the identities here
        log(4) - 2 * log(2),
        (1 + sqrt(1 + sin(1) ** 2)) ** 2 - 2 * sqrt(1 + sin(1) ** 2) - 2 - sin(1) ** 2,
        cos(pi / 7) - cos(2 * pi / 7) + cos(3 * pi / 7) - Rational(1, 2),
        sin(97 * atan(Rational(1, 3))) - (3 * cos(96 * atan(Rational(1, 3))) + sin(96 * atan(Rational(1, 3)))),
        roots_against_decimals(300),
        roots_against_decimals(3000),
        sum(root(k, 7) for k in range(2, 12)) - Rational(str(sympy.N(sum(root(k, 7) for k in range(2, 12)), 600))),
        sum(sin(sqrt(k)) ** 2 + cos(sqrt(k)) ** 2 for k in (2, 3, 5, 7, 11, 13)) - 6,
        sympy.Mul(*(sin(k * sqrt(2)) + 1 for k in range(1, 30))) * (sin(1) ** 2 + cos(1) ** 2 - 1),
        1 / (sqrt(2) + sqrt(3) - sqrt(5 + 2 * sqrt(6))),
        log(sin(1) ** 2 + cos(1) ** 2 - 1),
        sympy.gamma(Rational(1, 3)),
        sympy.I,
        sympy.zoo,
        X,
        sympy.Float("0.1"),
    ],
    ids=lambda expr: str(expr)[:40],
)
def test_what_is_not_decided_says_why_and_does_not_take_long(expr: sympy.Expr) -> None:
    start = time.process_time()
    signed = exact_sign(expr)
    assert time.process_time() - start < SECONDS
    assert signed.reason
    if signed.sign is not Sign.UNDECIDED:
        assert _agrees(signed.sign, expr, 8000)


def _agrees(sign: Sign, expr: sympy.Expr, digits: int) -> bool:
    """Against mpmath with so many digits that a nonzero number of this kind shows."""
    with mpmath.workdps(digits):
        value = sympy.lambdify([], expr, "mpmath")()
        tiny = mpmath.mpf(10) ** (-digits // 2)
        return {Sign.ZERO: abs(value) < tiny, Sign.POSITIVE: value > tiny, Sign.NEGATIVE: value < -tiny}[sign]


SMALL = st.fractions(-3, 3, max_denominator=6).map(lambda f: Rational(f.numerator, f.denominator))
ALGEBRAIC = st.recursive(
    SMALL | st.sampled_from([sqrt(2), sqrt(3), sqrt(5), root(2, 3)]),
    lambda inner: (
        st.tuples(inner, inner).map(lambda t: t[0] + t[1])
        | st.tuples(inner, inner).map(lambda t: t[0] * t[1])
        | inner.map(lambda e: sqrt(1 + e**2))
    ),
    max_leaves=5,
)


@given(ALGEBRAIC, ALGEBRAIC)
@settings(max_examples=100)
def test_squares_multiplied_out_are_the_same_number(a: sympy.Expr, b: sympy.Expr) -> None:
    difference = sympy.Add((a + b) ** 2, -(a**2), -2 * a * b, -(b**2), evaluate=False)
    assert exact_sign(difference).sign is Sign.ZERO


@given(ALGEBRAIC, ALGEBRAIC, st.integers(2, 40))
@settings(max_examples=100)
def test_the_sign_of_an_algebraic_number_is_that_of_its_decimals(a: sympy.Expr, b: sympy.Expr, digits: int) -> None:
    """Numbers minus their own first decimals: near zero, and zero only where the decimals end."""
    value = a - b
    with mpmath.workdps(60):
        decimals = mpmath.nstr(sympy.lambdify([], value, "mpmath")() + mpmath.mpf(0), digits)
    expr = value - Rational(decimals)
    sign = exact_sign(expr).sign
    assert sign is not Sign.UNDECIDED
    assert _agrees(sign, expr, 3000)


@given(st.fractions(-5, 5, max_denominator=99), st.fractions(-5, 5, max_denominator=99), st.integers(1, 9))
@example(Fraction(-1, 12), Fraction(1, 7), 2)
@settings(max_examples=60)
def test_addition_theorems_hold_for_rational_tangents_and_for_rational_angles(s: Fraction, t: Fraction, n: int) -> None:
    assume(s != t)
    tangents = [Rational(f.numerator, f.denominator) for f in (s, t)]
    for a, b in (tangents, [n * atan(x) for x in tangents]):
        theorem = sympy.Add(cos(a - b), -cos(a) * cos(b), -sin(a) * sin(b), evaluate=False)
        assert exact_sign(theorem).sign is Sign.ZERO


def test_the_reason_says_how_it_was_decided() -> None:
    assert "ball arithmetic at 256 bits" in exact_sign(exp(pi * sqrt(163)) - 640320**3 - 744).reason
    assert "field of degree at most 16" in exact_sign(ZEROS["nested square roots"]).reason
    assert "whatever the values of tan(1/2)" in exact_sign(ZEROS["Pythagoras"]).reason
    powers = sympy.Add((exp(sqrt(2)) + 1) ** 2, -exp(2 * sqrt(2)), -2 * exp(sqrt(2)), -1, evaluate=False)
    assert "whatever the values of exp(sqrt(2))" in exact_sign(powers).reason
    assert "gamma" in exact_sign(sympy.gamma(Rational(1, 3))).reason


def test_the_value_is_the_number_to_double_precision() -> None:
    assert exact_sign(-pi).value == -3.141592653589793
    assert exact_sign(exp(pi * sqrt(163)) - 640320**3 - 744).value == pytest.approx(-7.499274028018143e-13, rel=1e-14)
