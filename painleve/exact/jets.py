"""Taylor coefficients of a scene's functions in several variables, as balls (python-flint).

From an exact point the coefficients are known to dozens of digits, so that those which vanish there come out as
zero for every practical purpose, and differences such as g(q + dq) - g(q) are formed without cancellation. From a
wide ball the same arithmetic encloses the derivatives over a whole box: the remainder of a Taylor form.
(docs/theory.md, section 8.2.)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

import flint
import sympy as sp

from painleve.errors import InputError
from painleve.exact.balls import ball

__all__ = ["Jet", "jets", "monomials"]

Powers = tuple[int, ...]

_SERIES: dict[type, Callable[[flint.arb_series], flint.arb_series]] = {
    sp.sin: lambda s: s.sin(),
    sp.cos: lambda s: s.cos(),
    sp.tan: lambda s: s.tan(),
    sp.exp: lambda s: s.exp(),
    sp.log: lambda s: s.log(),
    sp.atan: lambda s: s.atan(),
    sp.asin: lambda s: s.asin(),
    sp.acos: lambda s: s.acos(),
    sp.cot: lambda s: s.cos() / s.sin(),
    sp.sec: lambda s: 1 / s.cos(),
    sp.csc: lambda s: 1 / s.sin(),
}


def monomials(variables: int, order: int) -> list[Powers]:
    """The exponents of all monomials of degree <= order, by rising degree."""
    found = []
    for degree in range(order + 1):
        for chosen in combinations_with_replacement(range(variables), degree):
            found.append(tuple(chosen.count(j) for j in range(variables)))
    return found


@dataclass(frozen=True)
class Jet:
    """A polynomial of bounded degree with ball coefficients; products are truncated at `order`."""

    terms: Mapping[Powers, flint.arb]
    variables: int
    order: int

    def constant(self) -> flint.arb:
        return self.terms.get((0,) * self.variables, flint.arb(0))

    def with_terms(self, terms: Mapping[Powers, flint.arb]) -> Jet:
        return Jet(terms, self.variables, self.order)

    def __add__(self, other: Jet) -> Jet:
        terms = dict(self.terms)
        for powers, value in other.terms.items():
            terms[powers] = terms[powers] + value if powers in terms else value
        return self.with_terms(terms)

    def __mul__(self, other: Jet) -> Jet:
        terms: dict[Powers, flint.arb] = {}
        for left, x in self.terms.items():
            room = self.order - sum(left)
            for right, y in other.terms.items():
                if sum(right) <= room:
                    powers = tuple(i + j for i, j in zip(left, right, strict=True))
                    terms[powers] = terms[powers] + x * y if powers in terms else x * y
        return self.with_terms(terms)

    def is_finite(self) -> bool:
        """Whether all coefficients are known: the function is analytic at the point, or on the ball."""
        return all(value.is_finite() for value in self.terms.values())

    def scale(self, factor: flint.arb) -> Jet:
        return self.with_terms({powers: factor * value for powers, value in self.terms.items()})

    def compose(self, series: Callable[[flint.arb_series], flint.arb_series]) -> Jet:
        """f(jet) for a function of one variable, given by its action on a power series; NaN where that has none."""
        try:
            outer = series(flint.arb_series([self.constant(), 1], self.order + 1))
        except ValueError:  # a division by what may be zero
            outer = flint.arb_series([flint.arb.nan()] * (self.order + 1), self.order + 1)
        zero = (0,) * self.variables
        inner = self.with_terms({powers: value for powers, value in self.terms.items() if powers != zero})
        result = self.with_terms({})
        for degree in range(self.order, -1, -1):  # Horner
            result = result * inner + self.with_terms({zero: outer[degree]})
        return result


def jets(
    expressions: Sequence[sp.Expr],
    variables: Sequence[sp.Symbol],
    values: Mapping[sp.Symbol, flint.arb],
    order: int,
    *,
    bits: int = 256,
) -> list[Jet]:
    """The Taylor polynomials of the expressions in `variables` about the point `values`, up to `order`.

    `values` must have every symbol. Coefficients are NaN, which contains everything, where a root, a quotient, a
    logarithm or an inverse function is not shown to be analytic. Raises InputError for |.| of what may be zero, and for
    functions and exponents that have no expansion here.
    """
    with _precision(bits, order + 1):
        count = len(variables)
        unit = {x: tuple(int(i == j) for j in range(count)) for i, x in enumerate(variables)}
        zero = (0,) * count
        known: dict[sp.Expr, Jet] = {}
        for symbol, value in values.items():
            linear = {unit[symbol]: flint.arb(1)} if symbol in unit and order > 0 else {}
            known[symbol] = Jet({zero: value} | linear, count, order)
        shared, reduced = sp.cse([_exponential(e) for e in expressions], symbols=sp.numbered_symbols("cse_", real=True))
        for symbol, expression in shared:
            known[symbol] = _jet(expression, known, count, order)
        return [_jet(expression, known, count, order) for expression in reduced]


def _exponential(expression: sp.Expr) -> sp.Expr:
    """Hyperbolic functions by exponentials; `rewrite` would take the circular ones along, into complex numbers."""
    return (
        expression.replace(sp.sinh, lambda x: (sp.exp(x) - sp.exp(-x)) / 2)
        .replace(sp.cosh, lambda x: (sp.exp(x) + sp.exp(-x)) / 2)
        .replace(sp.tanh, lambda x: 1 - 2 / (sp.exp(2 * x) + 1))
    )


def _jet(expression: sp.Expr, known: dict[sp.Expr, Jet], count: int, order: int) -> Jet:
    if expression in known:
        return known[expression]
    if not expression.free_symbols:
        return Jet({(0,) * count: ball(expression, bits=flint.ctx.prec)}, count, order)
    arguments = [_jet(argument, known, count, order) for argument in _operands(expression)]
    result = arguments[0]
    if isinstance(expression, sp.Add):
        for argument in arguments[1:]:
            result = result + argument
    elif isinstance(expression, sp.Mul):
        for argument in arguments[1:]:
            result = result * argument
    elif isinstance(expression, sp.Pow):
        result = _power(result, expression.exp)
    elif isinstance(expression, sp.Abs):
        result = _absolute(result)
    elif type(expression) in _SERIES:
        result = result.compose(_SERIES[type(expression)])
    else:
        name = type(expression).__name__
        raise InputError(f"no Taylor expansion for {name}, so none of this scene; write it in another way")
    known[expression] = result
    return result


def _operands(expression: sp.Expr) -> tuple[sp.Expr, ...]:
    return expression.args[:1] if isinstance(expression, sp.Pow) else expression.args


def _power(base: Jet, exponent: sp.Expr) -> Jet:
    if exponent.is_Integer and exponent > 0:
        result = base
        for _ in range(int(exponent) - 1):
            result = result * base
        return result
    if exponent.is_Integer:
        return _power(base.compose(lambda s: 1 / s), -exponent)
    if exponent.is_Rational:
        root = int(exponent.q)
        if root == 2:
            return _power(base.compose(lambda s: s.sqrt()), sp.Integer(exponent.p))
        return base.compose(lambda s: (s.log() * (flint.arb(int(exponent.p)) / root)).exp())
    raise InputError(f"no Taylor expansion for the exponent {exponent}, so none of this scene; write it with exp")


def _absolute(jet: Jet) -> Jet:
    if jet.constant() > 0:
        return jet
    if jet.constant() < 0:
        return jet.scale(flint.arb(-1))
    raise InputError("no Taylor expansion of |.| at zero, so none of this scene at this state; choose another state")


class _precision:
    """Sets flint's working precision and series length, and restores them: both are global."""

    def __init__(self, bits: int, length: int) -> None:
        self.wanted = (bits, length)

    def __enter__(self) -> None:
        self.before = (flint.ctx.prec, flint.ctx.cap)
        flint.ctx.prec, flint.ctx.cap = self.wanted

    def __exit__(self, *_: object) -> None:
        flint.ctx.prec, flint.ctx.cap = self.before
