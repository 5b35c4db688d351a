"""Numbers of the base state of a contact in space: correctly rounded, and exactly zero where they are."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import flint
import sympy as sp

from painleve.asymptotics.ball_arithmetic import BITS
from painleve.exact.balls import ball
from painleve.mechanics.state import State

__all__ = ["cross", "rounder"]


def rounder(state: State) -> Callable[[sp.Expr], float]:
    """What rounds an expression at the state; what a ball of many bits cannot tell from zero is zero by an identity."""
    return partial(_number, state)


def _number(state: State, expression: sp.Expr) -> float:
    found = ball(state.exact(expression), bits=BITS)
    return 0.0 if found.contains(flint.arb(0)) else float(found.mid())


def cross(x: sp.MatrixBase, y: sp.MatrixBase) -> sp.Expr:
    return x[0] * y[1] - x[1] * y[0]
