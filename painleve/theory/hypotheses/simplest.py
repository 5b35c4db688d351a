"""The simplest exact numbers in a short interval: where a function that only touches zero is likely to do so."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import islice, product

import flint
import sympy as sp
from flint import arb

from painleve.exact.signs import Sign, exact_sign
from painleve.theory.hypotheses.region import BITS, Box, Region, as_ball

__all__ = ["complexity", "simplest_fraction", "simplest_points"]

MAX_POINTS = 27  # three numbers for each of three coordinates


def simplest_fraction(low: Fraction, high: Fraction) -> Fraction:
    """The fraction of least denominator in [low, high], by continued fractions (the Stern-Brocot tree)."""
    if low <= 0 <= high:
        return Fraction(0)
    if high < 0:
        return -simplest_fraction(-high, -low)
    whole = low.numerator // low.denominator
    if whole == low or whole + 1 <= high:
        return Fraction(whole if whole == low else whole + 1)
    return whole + 1 / simplest_fraction(1 / (high - whole), 1 / (low - whole))


def simplest_points(region: Region, coordinates: tuple[int, ...], box: Box) -> Iterator[tuple[sp.Expr, ...]]:
    """Configurations of the ball in that box, by the simplest fractions and fractions of pi; q itself before them."""
    choices = [_numbers(region, i, box.low[k], box.high[k]) for k, i in enumerate(coordinates)]
    for chosen in islice(product(*choices), MAX_POINTS):
        q = list(region.state.q)
        for i, x in zip(coordinates, chosen, strict=True):
            q[i] = x
        if _is_inside(region, q):
            yield tuple(q)


def complexity(region: Region, coordinates: tuple[int, ...], box: Box) -> int:
    """How simple the simplest configuration of the box is: the sum of its denominators."""
    choices = (_numbers(region, i, box.low[k], box.high[k]) for k, i in enumerate(coordinates))
    return sum(min(_denominator(x) for x in numbers) for numbers in choices)


def _denominator(x: sp.Expr) -> int:
    """Of a fraction or a fraction of pi; the state's own number counts as whole."""
    factor = x.as_coeff_Mul()[0]
    return int(factor.q) if factor.is_Rational else 1


def _numbers(region: Region, i: int, low: Fraction, high: Fraction) -> list[sp.Expr]:
    with flint.ctx.workprec(BITS):
        ends = [region.centre[i] + as_ball(x) for x in (low, high)]
        turns = [end / arb.pi() for end in ends]
    found = [region.state.q[i]] if low <= 0 <= high else []
    for (left, right), unit in ((ends, sp.Integer(1)), (turns, sp.pi)):
        bounds = _fraction(left.lower()), _fraction(right.upper())
        if bounds[0] <= bounds[1]:
            number = simplest_fraction(*bounds)
            found.append(sp.Rational(number.numerator, number.denominator) * unit)
    return list(dict.fromkeys(found))


def _fraction(value: arb) -> Fraction:
    """The midpoint of a ball that rounding alone has made wide."""
    middle = value.mid().fmpq()
    return Fraction(int(middle.p), int(middle.q))


def _is_inside(region: Region, q: list[sp.Expr]) -> bool:
    """Proved to lie in the closed ball."""
    offsets = (x - y for x, y in zip(q, region.state.q, strict=True) if x != y)
    radius = sp.Rational(region.radius.numerator, region.radius.denominator)
    outside = exact_sign(sum((x**2 for x in offsets), -(radius**2)))
    return outside.sign in (Sign.NEGATIVE, Sign.ZERO)
