"""A tape taken apart into elementary steps: one operation of one or two operands each, equal ones shared.

Each arithmetic (floats, balls, slopes, series, remainders) gives a meaning to a handful of operations and walks the
steps once; nothing is expanded, and no arithmetic knows where the steps came from.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

import sympy as sp

from painleve.exact.tape import Tape

__all__ = ["Arithmetic", "ElementaryStep", "Program", "make_program", "run"]

UNARY = (
    sp.sin,
    sp.cos,
    sp.tan,
    sp.cot,
    sp.sec,
    sp.csc,
    sp.asin,
    sp.acos,
    sp.atan,
    sp.exp,
    sp.log,
    sp.sinh,
    sp.cosh,
    sp.tanh,
    sp.Abs,
    sp.sign,
)
FOLDED = {sp.Min: "min", sp.Max: "max"}


@dataclass(frozen=True)
class ElementaryStep:
    """`operation` of the results of the steps `operands`; an "input" is a symbol and a "number" an exact value."""

    operation: str
    operands: tuple[int, ...] = ()
    value: sp.Expr | None = None


@dataclass(frozen=True, eq=False)
class Program:
    """Steps in order, and which of them are the results that were asked for."""

    steps: tuple[ElementaryStep, ...]
    outputs: tuple[int, ...]

    def depends(self, variables: Sequence[sp.Symbol]) -> list[frozenset[int]]:
        """Of which of these inputs each step is a function, by their positions."""
        found: list[frozenset[int]] = []
        for step in self.steps:
            own = [j for j, x in enumerate(variables) if step.operation == "input" and step.value == x]
            found.append(frozenset(own).union(*(found[i] for i in step.operands)))
        return found


T = TypeVar("T")


class Arithmetic(Protocol[T]):
    """What an arithmetic knows: numbers, and each operation on its own kind of value."""

    def number(self, value: sp.Expr) -> T: ...

    def apply(self, operation: str, operands: Sequence[T]) -> T: ...


def run(program: Program, arithmetic: Arithmetic[T], inputs: Mapping[sp.Symbol, T]) -> list[T]:
    """The results of all steps. Raises ValueError for a symbol without a value."""
    found: list[T] = []
    for step in program.steps:
        if step.operation == "number":
            found.append(arithmetic.number(step.value))
        elif step.operation == "input":
            if step.value not in inputs:
                raise ValueError(f"no value for the symbol {step.value}")
            found.append(inputs[step.value])
        else:
            found.append(arithmetic.apply(step.operation, [found[i] for i in step.operands]))
    return found


def make_program(expressions: Sequence[sp.Expr], tape: Tape | None = None) -> Program:
    """Take the expressions and the steps of the tape that they need apart. Raises TypeError for what has no step."""
    writer = _Writer()
    for symbol, expression in tape.needed(expressions).steps if tape else ():
        writer.known[symbol] = writer.place(expression)
    outputs = tuple(writer.place(expression) for expression in expressions)
    return Program(tuple(writer.steps), outputs)


class _Writer:
    def __init__(self) -> None:
        self.steps: list[ElementaryStep] = []
        self.known: dict[sp.Basic, int] = {}
        self._shared: dict[ElementaryStep, int] = {}

    def place(self, expression: sp.Expr) -> int:
        if expression not in self.known:
            self.known[expression] = self._place_new(expression)
        return self.known[expression]

    def emit(self, operation: str, *operands: int, value: sp.Expr | None = None) -> int:
        step = ElementaryStep(operation, operands, value)
        if step not in self._shared:
            self.steps.append(step)
            self._shared[step] = len(self.steps) - 1
        return self._shared[step]

    def _place_new(self, expression: sp.Expr) -> int:
        if expression.is_Symbol:
            return self.emit("input", value=expression)
        if not expression.free_symbols:
            return self.emit("number", value=expression)
        if expression.is_Add:
            return self._fold("add", expression.args)
        if expression.is_Mul:
            return self._product(expression)
        if expression.is_Pow:
            return self._power(*expression.args)
        if expression.func in UNARY:
            return self.emit(expression.func.__name__.lower(), self.place(expression.args[0]))
        if expression.func in FOLDED:
            return self._fold(FOLDED[expression.func], expression.args)
        raise TypeError(f"no elementary step for {type(expression).__name__} in {expression}")

    def _fold(self, operation: str, parts: Sequence[sp.Expr]) -> int:
        place: Callable[[sp.Expr], int] = self.place
        result = place(parts[0])
        for part in parts[1:]:
            result = self.emit(operation, result, place(part))
        return result

    def _product(self, expression: sp.Mul) -> int:
        above: list[sp.Expr] = []
        below: list[sp.Expr] = []
        for factor in expression.args:
            inverse = factor.is_Pow and factor.exp.is_Rational and factor.exp < 0
            (below if inverse else above).append(1 / factor if inverse else factor)
        negative = bool(above) and above[0] == -1
        above = above[1:] if negative else above
        result = self._fold("mul", above) if above else self.place(sp.Integer(1))
        if below:
            result = self.emit("div", result, self._fold("mul", below))
        return self.emit("neg", result) if negative else result

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> int:
        if not exponent.is_Rational:
            raise TypeError(f"no elementary step for the exponent {exponent}")
        place = self.place(base)
        if exponent.q == 2:
            place = self.emit("sqrt", place)
        elif exponent.q != 1:
            place = self.emit("exp", self.emit("mul", self.place(sp.Rational(1, exponent.q)), self.emit("log", place)))
        result = self._whole(place, abs(int(exponent.p)))
        return result if exponent > 0 else self.emit("div", self.place(sp.Integer(1)), result)

    def _whole(self, place: int, n: int) -> int:
        if n == 1:
            return place
        half = self._whole(place, n // 2)
        square = self.emit("mul", half, half)
        return square if n % 2 == 0 else self.emit("mul", square, place)
