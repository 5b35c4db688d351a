"""The closed ball of configurations around a state, boxes that cover it, and rigorous values on boxes and at points.

Offsets from q are exact fractions, so a point of the ball is an exact configuration: one that refutes a hypothesis can
be given to anybody.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import flint
import sympy as sp
from flint import arb, fmpq

from painleve.exact.balls import ball, make_ball_function
from painleve.mechanics.state import State

__all__ = ["Box", "Evaluator", "Offset", "Place", "Region", "as_ball"]

BITS = 128

Offset = tuple[Fraction, ...]


def as_ball(value: Fraction) -> arb:
    """The fraction, rounded outwards."""
    return arb(fmpq(value.numerator, value.denominator))


@dataclass(frozen=True, kw_only=True)
class Box:
    """Offsets of some coordinates from q, each between `low` and `high`."""

    low: Offset
    high: Offset

    @property
    def sides(self) -> Offset:
        return tuple(high - low for low, high in zip(self.low, self.high, strict=True))

    @property
    def longest(self) -> Fraction:
        return max(self.sides)

    def halves(self) -> tuple[Box, Box]:
        """The box cut across its longest side."""
        axis = self.sides.index(self.longest)
        middle = (self.low[axis] + self.high[axis]) / 2
        cut = [(*end[:axis], middle, *end[axis + 1 :]) for end in (self.low, self.high)]
        return Box(low=self.low, high=cut[1]), Box(low=cut[0], high=self.high)

    @property
    def centre(self) -> Offset:
        return tuple((low + high) / 2 for low, high in zip(self.low, self.high, strict=True))

    @property
    def nearest(self) -> Offset:
        """The offset in the box that is nearest to zero."""
        return tuple(max(low, min(high, Fraction(0))) for low, high in zip(self.low, self.high, strict=True))


@dataclass(frozen=True, kw_only=True)
class Place:
    """A point of the ball: exactly q if `within` is 0, else some point no farther from q than that."""

    names: tuple[str, ...]
    q: tuple[sp.Expr, ...]
    within: float

    @cached_property
    def numbers(self) -> tuple[float, ...]:
        return tuple(float(ball(x, bits=BITS).mid()) + 0.0 for x in self.q)

    def __str__(self) -> str:
        numbers = ", ".join(f"{name} = {x:.10g}" for name, x in zip(self.names, self.numbers, strict=True))
        return numbers if self.within == 0.0 else f"{numbers} (to within {self.within:.1g})"

    def as_dict(self) -> dict[str, object]:
        """For machines: floats, exact expressions as text, and how far from them the point may be."""
        return {
            "q": dict(zip(self.names, self.numbers, strict=True)),
            "exact": dict(zip(self.names, map(str, self.q), strict=True)),
            "within": self.within,
        }


@dataclass(frozen=True, kw_only=True, eq=False)
class Region:
    """The closed ball B(q, radius) around the configuration of a state, Euclidean in the scene's units."""

    state: State
    radius: Fraction

    @cached_property
    def centre(self) -> tuple[arb, ...]:
        return tuple(ball(x, bits=2 * BITS) for x in self.state.q)

    @cached_property
    def parameters(self) -> tuple[arb, ...]:
        return tuple(ball(self.state.parameters[p.name], bits=2 * BITS) for p in self.state.scene.parameters)

    def used(self, expressions: Sequence[sp.Expr]) -> tuple[int, ...]:
        """Indices of the coordinates that occur in the expressions."""
        symbols = set().union(*(e.free_symbols for e in expressions))
        return tuple(i for i, x in enumerate(self.state.scene.q) if x in symbols)

    def cube(self, coordinates: Sequence[int]) -> Box:
        """The smallest box around the ball."""
        return Box(low=(-self.radius,) * len(coordinates), high=(self.radius,) * len(coordinates))

    def holds(self, offset: Offset) -> bool:
        return sum((x * x for x in offset), Fraction(0)) <= self.radius**2

    def exact(self, coordinates: Sequence[int], offset: Offset) -> tuple[sp.Expr, ...]:
        """The configuration at that offset in those coordinates, the others as at q."""
        q = list(self.state.q)
        for i, x in zip(coordinates, offset, strict=True):
            q[i] = q[i] + sp.Rational(x.numerator, x.denominator)
        return tuple(q)

    def place(self, q: tuple[sp.Expr, ...], within: float = 0.0) -> Place:
        return Place(names=tuple(c.name for c in self.state.scene.coordinates), q=q, within=within)

    def enclose(self, expression: sp.Expr, place: Place) -> arb:
        """A ball that contains the value at the place, wherever in it the point is."""
        scene = self.state.scene
        q = [ball(x, bits=BITS) + arb(0, place.within) for x in place.q]
        return ball(expression, dict(zip([*scene.q, *scene.p], [*q, *self.parameters], strict=True)), bits=BITS)

    def value(self, expression: sp.Expr, q: tuple[sp.Expr, ...]) -> sp.Expr:
        """The exact value of an expression at a configuration, with the state's parameters."""
        return expression.xreplace(self.state.substitution | dict(zip(self.state.scene.q, q, strict=True)))


class Evaluator:
    """Enclosures of some expressions in the coordinates that they use; raises as `make_ball_function` does."""

    def __init__(self, region: Region, expressions: Sequence[sp.Expr]) -> None:
        scene = region.state.scene
        self.region = region
        self.coordinates = region.used(expressions)
        symbols = [*(scene.q[i] for i in self.coordinates), *scene.p]
        self._function = make_ball_function(expressions, symbols, bits=BITS)

    def on(self, box: Box) -> list[arb]:
        """Balls that contain every value on the box."""
        with flint.ctx.workprec(BITS):
            radii = [as_ball((high - low) / 2).abs_upper() for low, high in zip(box.low, box.high, strict=True)]
            centre = self._balls(box.centre)
            return self._function([*map(arb, centre, radii), *self.region.parameters])

    def at(self, offset: Offset) -> list[arb]:
        """Balls that contain the values at one point."""
        with flint.ctx.workprec(BITS):
            return self._function([*self._balls(offset), *self.region.parameters])

    def _balls(self, offset: Offset) -> list[arb]:
        return [self.region.centre[i] + as_ball(x) for i, x in zip(self.coordinates, offset, strict=True)]
