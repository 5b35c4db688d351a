"""Rigorous values of sympy expressions in real ball arithmetic (Arb's midpoint-radius numbers, through python-flint).

A result contains every value that the expression takes while its symbols stay in their balls; where it may be undefined
or not real (a root or a logarithm of a ball that reaches below zero, a division by a ball around zero) it is NaN, which
contains everything. Balls round outwards at a working precision that is global to the process: it is set for each call
and put back, so two threads must not evaluate at once. (docs/theory.md, section 8.5.)
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from functools import partial, reduce
from types import MappingProxyType
from typing import Any

import sympy
from flint import arb, ctx, fmpq, fmpz_poly

__all__ = ["ball", "make_ball_function"]

_Operation = Callable[..., arb]

# Below this relative accuracy, in bits, a product with itself is visibly wider than the square.
_NARROW = 20


def ball(expr: sympy.Expr, values: Mapping[sympy.Symbol, arb] = MappingProxyType({}), *, bits: int = 128) -> arb:
    """A ball that contains the value of `expr` for all values of its symbols in the balls `values`.

    The tree is taken as it stands: sympy simplifies and evaluates nothing. `bits` is the working precision. Raises
    ValueError for a symbol without a value, TypeError for what has no ball arithmetic here (sympy's rounded numbers and
    infinities, functions beyond the elementary ones, symbolic exponents).
    """
    symbols = list(values)
    function = make_ball_function([expr], symbols, bits=bits, as_written=True)
    return function([values[symbol] for symbol in symbols])[0]


def make_ball_function(
    exprs: Sequence[sympy.Expr], args: Sequence[sympy.Symbol], *, bits: int = 128, as_written: bool = False
) -> Callable[[Sequence[arb]], list[arb]]:
    """Compile expressions once, with common parts shared and constants evaluated, for many evaluations.

    The function takes one ball per symbol of `args` and returns one per expression. Compiling raises as `ball` does.
    `as_written` shares equal sub-trees alone: sympy's search for common parts of sums and products rebuilds the trees,
    and evaluates on the way what was left unevaluated.
    """
    definitions, reduced = ([], exprs) if as_written else sympy.cse(list(exprs), order="none")
    with ctx.workprec(bits):
        program = _Program(args)
        for symbol, part in definitions:
            program.define(symbol, part)
        outputs = [program.compile(expr) for expr in reduced]
    return partial(_run, program.steps, program.registers, outputs, len(args), bits)


def _run(
    steps: Sequence[tuple[int, _Operation, int, int]],
    constants: Sequence[arb | None],
    outputs: Sequence[int],
    arity: int,
    bits: int,
    values: Sequence[arb],
) -> list[arb]:
    """The whole interpreter; plain indices and one branch a step, because it runs thousands of times."""
    if len(values) != arity:
        raise ValueError(f"expected {arity} balls, not {len(values)}")
    registers = list(constants)
    registers[:arity] = values
    before = ctx.prec
    ctx.prec = bits
    try:
        for target, operation, first, second in steps:
            if second < 0:
                registers[target] = operation(registers[first])
            else:
                registers[target] = operation(registers[first], registers[second])
    finally:
        ctx.prec = before
    return [registers[i] for i in outputs]  # type: ignore[misc]


class _Program:
    """Steps over numbered registers: first the arguments, then constants (known) and results (None until run)."""

    def __init__(self, args: Sequence[sympy.Symbol]) -> None:
        self.registers: list[arb | None] = [None] * len(args)
        self.steps: list[tuple[int, _Operation, int, int]] = []
        self._places: dict[sympy.Basic, int] = {symbol: i for i, symbol in enumerate(args)}

    def define(self, symbol: sympy.Symbol, expr: sympy.Expr) -> None:
        self._places[symbol] = self.compile(expr)

    def compile(self, expr: sympy.Expr) -> int:
        """The register that will hold the value of `expr`."""
        if expr not in self._places:
            self._places[expr] = self._compile_new(expr)
        return self._places[expr]

    def _compile_new(self, expr: sympy.Expr) -> int:
        if expr.is_Add:
            return self._fold(operator.add, expr.args)
        if expr.is_Mul:
            return self._product(expr)
        if expr.is_Pow:
            return self._power(*expr.args)
        if expr.func in _FUNCTIONS:
            return self._emit(_FUNCTIONS[expr.func], *map(self.compile, expr.args))
        if expr.func in _FOLDED:
            return self._fold(_FOLDED[expr.func], expr.args)
        return self._constant(_constant(expr))

    def _constant(self, value: arb) -> int:
        self.registers.append(value)
        return len(self.registers) - 1

    def _emit(self, operation: _Operation, first: int, second: int = -1) -> int:
        """Add a step, or take it now when all that it needs is known."""
        operands = [self.registers[i] for i in (first, second) if i >= 0]
        if all(operand is not None for operand in operands):
            return self._constant(operation(*operands))
        self.registers.append(None)
        self.steps.append((len(self.registers) - 1, operation, first, second))
        return len(self.registers) - 1

    def _fold(self, operation: _Operation, parts: Sequence[sympy.Expr]) -> int:
        return reduce(partial(self._emit, operation), map(self.compile, parts))

    def _product(self, expr: sympy.Mul) -> int:
        """One division, instead of one reciprocal a factor."""
        numerator, denominator = _fraction(expr)
        if denominator:
            return self._emit(operator.truediv, self._times(numerator), self._times(denominator))
        return self._times(numerator)

    def _times(self, factors: Sequence[sympy.Expr]) -> int:
        negative = bool(factors) and factors[0] == -1
        rest = factors[1:] if negative else factors
        if not rest:
            return self.compile(sympy.Integer(-1 if negative else 1))
        product = self._fold(operator.mul, rest)
        return self._emit(operator.neg, product) if negative else product

    def _power(self, base: sympy.Expr, exponent: sympy.Expr) -> int:
        if not exponent.is_Rational:
            raise TypeError(f"no ball arithmetic for the exponent {exponent}")
        place = self.compile(base)
        if exponent.q != 1:
            place = self._emit(arb.sqrt if exponent.q == 2 else partial(_root, int(exponent.q)), place)
        place = self._whole_power(place, abs(int(exponent.p)))
        return place if exponent > 0 else self._emit(_reciprocal, place)

    def _whole_power(self, place: int, n: int) -> int:
        if n == 1:
            return place
        half = self._emit(_square, self._whole_power(place, n // 2))
        return half if n % 2 == 0 else self._emit(operator.mul, half, place)


def _fraction(expr: sympy.Mul) -> tuple[list[sympy.Expr], list[sympy.Expr]]:
    numerator, denominator = [], []
    for factor in expr.args:
        if factor.is_Pow and factor.exp.is_Rational and factor.exp < 0:
            denominator.append(factor.base ** (-factor.exp))
        else:
            numerator.append(factor)
    return numerator, denominator


def _square(x: arb) -> arb:
    """Never below zero, and without the excess of x*x, which forgets that both factors are the same number."""
    if x.rel_accuracy_bits() > _NARROW:
        return x * x
    low, high = x.abs_lower(), x.abs_upper()
    return (low * low).union(high * high).nonnegative_part()


def _abs(x: arb) -> arb:
    return abs(x).nonnegative_part()


def _reciprocal(x: arb) -> arb:
    return 1 / x


def _root(n: int, x: arb) -> arb:
    return x.root(n)


def _constant(expr: sympy.Expr) -> arb:
    if expr.is_Rational:
        return arb(fmpq(int(expr.p), int(expr.q)))
    if expr is sympy.pi:
        return arb.pi()
    if expr is sympy.E:
        return arb.const_e()
    if isinstance(expr, sympy.CRootOf):
        return _polynomial_root(expr)
    if expr.is_Symbol:
        raise ValueError(f"no value for the symbol {expr}")
    raise TypeError(f"no ball arithmetic for {type(expr).__name__} in {expr}")


def _polynomial_root(root: sympy.CRootOf) -> arb:
    """sympy numbers the real roots first, upwards; Arb isolates all roots and marks the real ones as exactly real."""
    polynomial = fmpz_poly([int(c) for c in reversed(root.poly.all_coeffs())])
    found: list[Any] = polynomial.complex_roots()  # pairs of a root and its multiplicity
    ordered = sorted((value.real for value, _ in found if value.imag == 0), key=arb.mid)
    return ordered[root.index] if root.index < len(ordered) else arb.nan()


_FUNCTIONS: Mapping[type[sympy.Basic], _Operation] = MappingProxyType(
    {
        sympy.sin: arb.sin,
        sympy.cos: arb.cos,
        sympy.tan: arb.tan,
        sympy.cot: arb.cot,
        sympy.sec: arb.sec,
        sympy.csc: arb.csc,
        sympy.asin: arb.asin,
        sympy.acos: arb.acos,
        sympy.atan: arb.atan,
        sympy.atan2: arb.atan2,
        sympy.exp: arb.exp,
        sympy.log: arb.log,
        sympy.sinh: arb.sinh,
        sympy.cosh: arb.cosh,
        sympy.tanh: arb.tanh,
        sympy.Abs: _abs,
        sympy.sign: arb.sgn,
    }
)

_FOLDED: Mapping[type[sympy.Basic], _Operation] = MappingProxyType({sympy.Min: arb.min, sympy.Max: arb.max})
