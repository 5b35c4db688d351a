"""Arithmetics that walk a program: balls, and balls with their first derivatives."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import flint
import sympy as sp

from painleve.exact.balls import FUNCTIONS, ball, square

__all__ = ["BallArithmetic", "Slope", "SlopeArithmetic"]


class BallArithmetic:
    """Arb's balls at the working precision that is set where the program runs."""

    def number(self, value: sp.Expr) -> flint.arb:
        return ball(value, bits=flint.ctx.prec)

    def apply(self, operation: str, operands: Sequence[flint.arb]) -> flint.arb:
        if operation == "mul" and operands[0] is operands[1]:
            return square(operands[0])
        return _BALLS[operation](*operands)


@dataclass(frozen=True)
class Slope:
    """A value and its derivatives with respect to numbered variables; those that vanish are left out."""

    value: flint.arb
    slopes: Mapping[int, flint.arb]


class SlopeArithmetic:
    """The chain rule, step by step (forward differentiation)."""

    def number(self, value: sp.Expr) -> Slope:
        return Slope(ball(value, bits=flint.ctx.prec), {})

    def apply(self, operation: str, operands: Sequence[Slope]) -> Slope:
        values = [x.value for x in operands]
        result = BallArithmetic().apply(operation, values)
        partials = _PARTIALS[operation](result, *values)
        slopes: dict[int, flint.arb] = {}
        for factor, operand in zip(partials, operands, strict=True):
            for j, slope in operand.slopes.items():
                slopes[j] = slopes[j] + factor * slope if j in slopes else factor * slope
        return Slope(result, slopes)


_ONE = flint.arb(1)

_BALLS: dict[str, Callable[..., flint.arb]] = {
    "add": lambda x, y: x + y,
    "mul": lambda x, y: x * y,
    "div": lambda x, y: x / y,
    "neg": lambda x: -x,
    "sqrt": flint.arb.sqrt,
    "min": flint.arb.min,
    "max": flint.arb.max,
    **{function.__name__.lower(): operation for function, operation in FUNCTIONS.items() if function is not sp.atan2},
}

_PARTIALS: dict[str, Callable[..., tuple[flint.arb, ...]]] = {
    "add": lambda z, x, y: (_ONE, _ONE),
    "mul": lambda z, x, y: (y, x),
    "div": lambda z, x, y: (1 / y, -z / y),
    "neg": lambda z, x: (-_ONE,),
    "sqrt": lambda z, x: (1 / (2 * z),),
    "sin": lambda z, x: (x.cos(),),
    "cos": lambda z, x: (-x.sin(),),
    "tan": lambda z, x: (1 + z * z,),
    "cot": lambda z, x: (-1 - z * z,),
    "exp": lambda z, x: (z,),
    "log": lambda z, x: (1 / x,),
    "sinh": lambda z, x: (x.cosh(),),
    "cosh": lambda z, x: (x.sinh(),),
    "tanh": lambda z, x: (1 - z * z,),
    "asin": lambda z, x: (1 / (1 - x * x).sqrt(),),
    "acos": lambda z, x: (-1 / (1 - x * x).sqrt(),),
    "atan": lambda z, x: (1 / (1 + x * x),),
}
