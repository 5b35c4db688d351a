"""Exact numbers among which the zeros of a function of one variable are, where that function is algebraic.

With T = tan(s) the sine and the cosine of an angle s are algebraic; so are roots and constants such as sqrt(5). Each
gets an unknown of its own with the equation that it solves, and resultants eliminate them all but T. What is left is a
polynomial with whole coefficients whose real roots include the zeros: candidates, to be checked by whoever asked.
Degrees and numbers of terms are bounded; beyond the bounds there are no candidates. (docs/theory.md, section 8.4.)
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import flint
import sympy as sp

from painleve.exact.balls import ball

__all__ = ["candidate_zeros"]

RADICALS = 5  # unknowns beside T
LONGEST = 4000  # terms of a polynomial on the way
DEGREE = 300  # of a polynomial in T
EXACT_DEGREE = 8  # of an irreducible factor whose roots are written down
OPERATIONS = 4000  # of the function

Fraction = tuple[flint.fmpz_mpoly, flint.fmpz_mpoly]


class _NotAlgebraic(Exception):
    """The function is not algebraic in T, or too large."""


def candidate_zeros(function: sp.Expr, variable: sp.Symbol, low: flint.arb, high: flint.arb) -> list[sp.Expr]:
    """Exact numbers in [low, high] that may be zeros of the function; not complete where it is not algebraic."""
    found = list(_linear_zeros(function, variable))
    try:
        angle, polynomial = _polynomial(function, variable)
    except _NotAlgebraic:
        angle = False
    else:
        found += [x for root in _real_roots(polynomial) for x in (_turns(root, low, high) if angle else [root])]
    if angle:
        found += [sp.pi / 2 * k for k in _whole_between(low, high, flint.arb.pi() / 2)]
    inside = low.union(high)
    return [x for x in dict.fromkeys(found) if inside.overlaps(ball(x))]


def _linear_zeros(function: sp.Expr, variable: sp.Symbol) -> Iterator[sp.Expr]:
    """Of the terms that are linear in the variable: what a scene's parameters single out."""
    for part in sp.preorder_traversal(function):
        slope = part.diff(variable) if part.is_Add and part.has(variable) else sp.Integer(0)
        if slope.is_Rational and slope != 0:
            yield -part.xreplace({variable: sp.Integer(0)}) / slope


def _turns(tangent: sp.Expr, low: flint.arb, high: flint.arb) -> list[sp.Expr]:
    first = sp.atan(tangent)
    offset = ball(first)
    return [first + sp.pi * k for k in _whole_between(low - offset, high - offset, flint.arb.pi())]


def _whole_between(low: flint.arb, high: flint.arb, unit: flint.arb) -> range:
    return range(math.floor(float((low / unit).mid())) - 1, math.ceil(float((high / unit).mid())) + 2)


# --- the polynomial --------------------------------------------------------------------------------------------------


def _polynomial(function: sp.Expr, variable: sp.Symbol) -> tuple[bool, flint.fmpz_poly]:
    """(whether T is the tangent of the variable, the polynomial in T)."""
    if function.count_ops() > OPERATIONS:
        raise _NotAlgebraic
    written = sp.expand_trig(function) if function.has(sp.sin, sp.cos, sp.tan, sp.cot) else function
    angle = written.has(sp.sin(variable), sp.cos(variable), sp.tan(variable), sp.cot(variable))
    reader = _AlgebraicReader(variable, angle)
    numerator = reader.fraction(written)[0]
    for place, relation in reversed(reader.relations):
        if numerator.degrees()[place] > 0:
            numerator = _eliminated(numerator, relation, place)
    if numerator.is_zero() or any(numerator.degrees()[1:]):
        raise _NotAlgebraic
    coefficients = [0] * (numerator.degrees()[0] + 1)
    for powers, value in numerator.terms():
        coefficients[int(powers[0])] = int(value)
    return angle, flint.fmpz_poly(coefficients)


def _eliminated(numerator: flint.fmpz_mpoly, relation: flint.fmpz_mpoly, place: int) -> flint.fmpz_mpoly:
    degrees, others = numerator.degrees(), relation.degrees()
    if max(d * others[place] + e * degrees[place] for d, e in zip(degrees, others, strict=True)) > 2 * DEGREE:
        raise _NotAlgebraic
    return _checked(numerator.resultant(relation, place))


def _checked(polynomial: flint.fmpz_mpoly) -> flint.fmpz_mpoly:
    if len(polynomial) > LONGEST or max(polynomial.degrees()) > DEGREE:
        raise _NotAlgebraic
    return polynomial


class _AlgebraicReader:
    """The walk from an expression to a fraction of polynomials in T and in unknowns for cosine and roots."""

    def __init__(self, variable: sp.Symbol, angle: bool) -> None:
        names = ("T", *(f"r{i}" for i in range(RADICALS)))
        self.ring = flint.fmpz_mpoly_ctx.get(names, "lex")
        self.one = self.ring.constant(1)
        self.variable, self.angle = variable, angle
        self.relations: list[tuple[int, flint.fmpz_mpoly]] = []
        self.known: dict[sp.Expr, Fraction] = {}

    def fraction(self, expression: sp.Expr) -> Fraction:
        if expression not in self.known:
            self.known[expression] = self._reduced(*self._read(expression))
        return self.known[expression]

    def _reduced(self, above: flint.fmpz_mpoly, below: flint.fmpz_mpoly) -> Fraction:
        if below.is_zero():
            raise _NotAlgebraic
        common = _checked(above).gcd(_checked(below))
        return (above // common, below // common) if not common.is_one() else (above, below)

    def _read(self, e: sp.Expr) -> Fraction:
        if e.is_Rational:
            return self.ring.constant(int(e.p)), self.ring.constant(int(e.q))
        if e.is_Add or e.is_Mul:
            total = self.fraction(e.args[0])
            for part in e.args[1:]:
                (a, b), (c, d) = total, self.fraction(part)
                total = self._reduced(a * d + c * b, b * d) if e.is_Add else self._reduced(a * c, b * d)
            return total
        if e.is_Pow and e.exp.is_Rational:
            return self._power(e)
        if isinstance(e, sp.CRootOf):
            return self._root_of(e)
        return self._elementary(e)

    def _elementary(self, e: sp.Expr) -> Fraction:
        T = self.ring.gen(0)
        if e == self.variable and not self.angle:
            return T, self.one
        if not self.angle or e.args != (self.variable,):
            raise _NotAlgebraic
        if isinstance(e, sp.tan | sp.cot):
            return (T, self.one) if isinstance(e, sp.tan) else (self.one, T)
        if not isinstance(e, sp.sin | sp.cos):
            raise _NotAlgebraic
        cosine = self._unknown(sp.cos(self.variable), lambda c: c**2 * (T**2 + 1) - 1)
        return (cosine if isinstance(e, sp.cos) else T * cosine), self.one

    def _power(self, e: sp.Expr) -> Fraction:
        above, below = self.fraction(e.base)
        n, k = int(e.exp.p), int(e.exp.q)
        if k > 1:
            root = sp.Pow(e.base, sp.Rational(1, k), evaluate=False)
            above, below = self._unknown(root, lambda r: r**k * below - above), self.one
        if abs(n) * max(*above.degrees(), *below.degrees(), 1) > DEGREE:
            raise _NotAlgebraic
        return (above**n, below**n) if n >= 0 else (below**-n, above**-n)

    def _root_of(self, e: sp.CRootOf) -> Fraction:
        coefficients = [int(c) for c in e.poly.all_coeffs()]

        def relation(r: flint.fmpz_mpoly) -> flint.fmpz_mpoly:
            total = self.ring.constant(0)
            for c in coefficients:
                total = total * r + c
            return total

        return self._unknown(e, relation), self.one

    def _unknown(self, meaning: sp.Expr, relation: object) -> flint.fmpz_mpoly:
        if meaning not in self.known:
            if len(self.relations) == RADICALS:
                raise _NotAlgebraic
            place = len(self.relations) + 1
            symbol = self.ring.gen(place)
            self.relations.append((place, _checked(relation(symbol))))  # type: ignore[operator]
            self.known[meaning] = (symbol, self.one)
        return self.known[meaning][0]


# --- its real roots --------------------------------------------------------------------------------------------------


def _real_roots(polynomial: flint.fmpz_poly) -> Iterator[sp.Expr]:
    """Exact, of the irreducible factors of low degree."""
    for factor, _ in polynomial.factor()[1]:
        if factor.degree() <= EXACT_DEGREE:
            yield from _roots_of_factor([int(c) for c in reversed(list(factor))])


def _roots_of_factor(coefficients: list[int]) -> Iterator[sp.Expr]:
    """Radicals up to degree two, and for even polynomials of degree four; else numbered roots."""
    x = sp.Symbol("x")
    degree = len(coefficients) - 1
    if degree <= 2:
        yield from _quadratic(coefficients)
    elif degree == 4 and coefficients[1] == coefficients[3] == 0:
        for square in _quadratic(coefficients[::2]):
            if ball(square) > 0:
                yield from (sp.sqrt(square), -sp.sqrt(square))
    else:
        polynomial = sp.Poly(coefficients, x)
        yield from (sp.CRootOf(polynomial, k) for k in range(polynomial.count_roots()))


def _quadratic(coefficients: list[int]) -> list[sp.Expr]:
    """Real roots of a polynomial of degree one or two."""
    if len(coefficients) == 2:
        return [sp.Rational(-coefficients[1], coefficients[0])]
    a, b, c = coefficients
    discriminant = b * b - 4 * a * c
    if discriminant < 0:
        return []
    return [(-b + sign * sp.sqrt(discriminant)) / (2 * sp.Integer(a)) for sign in (1, -1)]
