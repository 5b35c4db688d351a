"""A tape: named intermediate results, each a small expression of what stands before it, never expanded.

The inertia matrix of a mechanism of nine coordinates fills pages in closed form and takes five hundred operations where
every intermediate result keeps its name. What evaluates a scene (floats, balls, series, exact numbers) walks its tape;
the closed form is made on request, for a reader.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

__all__ = ["Tape", "TapeBuilder"]


@dataclass(frozen=True, eq=False)
class Tape:
    """Steps (symbol, expression) in the order in which they can be taken."""

    steps: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()

    def __repr__(self) -> str:
        return f"Tape({len(self.steps)} steps, {self.operations()} operations)"

    @property
    def names(self) -> frozenset[sp.Symbol]:
        return frozenset(symbol for symbol, _ in self.steps)

    def needed(self, outputs: Iterable[sp.Basic]) -> Tape:
        """The steps that the outputs depend on."""
        wanted: set[sp.Basic] = set().union(*(e.free_symbols for e in outputs), set())
        kept = []
        for symbol, expression in reversed(self.steps):
            if symbol in wanted:
                kept.append((symbol, expression))
                wanted |= expression.free_symbols
        return Tape(tuple(reversed(kept)))

    def inputs(self, outputs: Iterable[sp.Basic]) -> frozenset[sp.Basic]:
        """The symbols that the outputs depend on and the tape does not define."""
        outputs = tuple(outputs)
        steps = self.needed(outputs).steps
        used: set[sp.Basic] = set().union(*(e.free_symbols for e in (*outputs, *(e for _, e in steps))), set())
        return frozenset(used - self.names)

    def operations(self) -> int:
        """Arithmetic operations of all steps, as sympy counts them."""
        return int(sum(expression.count_ops() for _, expression in self.steps))

    def expand(self, expressions: Sequence[sp.Expr]) -> list[sp.Expr]:
        """The closed forms. Their size can grow exponentially with the steps: ask `operations` first."""
        values: dict[sp.Basic, sp.Basic] = {}
        for symbol, expression in self.needed(expressions).steps:
            values[symbol] = expression.xreplace(values)
        return [expression.xreplace(values) for expression in expressions]

    def at(self, point: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
        """The point, with the value of every step added, each evaluated from the values before it."""
        values = dict(point)
        for symbol, expression in self.steps:
            values[symbol] = expression.xreplace(values)
        return values


class TapeBuilder:
    """Writes a tape: what is built twice gets one name, and numbers and names get none of their own."""

    def __init__(self, prefix: str, steps: Iterable[tuple[sp.Symbol, sp.Expr]] = ()) -> None:
        self._prefix = prefix
        self._steps = list(steps)
        self._names: dict[sp.Expr, sp.Symbol] = {expression: symbol for symbol, expression in self._steps}

    @property
    def tape(self) -> Tape:
        return Tape(tuple(self._steps))

    def name(self, expression: sp.Expr) -> sp.Expr:
        """The expression itself if it is an atom or minus one, else plus or minus the symbol that is bound to it."""
        if expression.is_Atom:
            return expression
        sign = -1 if expression.could_extract_minus_sign() else 1
        positive = expression * sign
        if positive.is_Atom:
            return expression
        if positive not in self._names:
            symbol = sp.Symbol(f"{self._prefix}{len(self._steps)}", real=True)
            self._steps.append((symbol, positive))
            self._names[positive] = symbol
        return sign * self._names[positive]

    def names(self, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
        return [self.name(expression) for expression in expressions]

    def gradient(self, outputs: Sequence[sp.Expr], variables: Sequence[sp.Symbol]) -> list[list[sp.Expr]]:
        """Derivatives (outputs x variables) through all steps, bound to names of their own as they are formed."""
        slopes: dict[sp.Basic, dict[sp.Symbol, sp.Expr]] = {x: {x: sp.Integer(1)} for x in variables}
        for symbol, expression in Tape(tuple(self._steps)).needed(outputs).steps:
            slopes[symbol] = self._chain(expression, slopes)
        rows = [self._chain(output, slopes) for output in outputs]
        return [[row.get(x, sp.Integer(0)) for x in variables] for row in rows]

    def _chain(
        self, expression: sp.Expr, slopes: Mapping[sp.Basic, Mapping[sp.Symbol, sp.Expr]]
    ) -> dict[sp.Symbol, sp.Expr]:
        arguments = sorted((s for s in expression.free_symbols if slopes.get(s)), key=str)
        partials = {s: self.name(sp.diff(expression, s)) for s in arguments}
        reached = dict.fromkeys(x for s in arguments for x in slopes[s])  # in a fixed order, which a set has not
        terms = {x: [partials[s] * slopes[s][x] for s in arguments if x in slopes[s]] for x in reached}
        found = {x: self.name(sp.Add(*parts)) for x, parts in terms.items()}
        return {x: value for x, value in found.items() if value != 0}
