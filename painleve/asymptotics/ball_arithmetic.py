"""Exact offsets in ball arithmetic: how many bits, their sums and norms, and decisions that are certain or refused."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeAlias

import flint

__all__ = ["BITS", "Balls", "certain", "combination", "dot", "is_inside", "norm"]

BITS = 320
Balls: TypeAlias = list[flint.arb]


def dot(x: Iterable[flint.arb], y: Iterable[flint.arb]) -> flint.arb:
    total = flint.arb(0)
    for left, right in zip(x, y, strict=True):
        total += left * right
    return total


def norm(x: Sequence[flint.arb]) -> flint.arb:
    """The root is taken end by end: of a ball that touches zero it would be undefined."""
    squared = dot(x, x)
    lower, upper = squared.lower(), squared.upper()
    return (lower.sqrt() if lower > 0 else flint.arb(0)).union(upper.sqrt())


def combination(*terms: tuple[Sequence[flint.arb], flint.arb | int]) -> Balls:
    """The sum of vectors, each times its factor."""
    return [sum((row[j] * factor for row, factor in terms), flint.arb(0)) for j in range(len(terms[0][0]))]


def is_inside(x: Sequence[flint.arb], eps: float) -> bool:
    """Whether an exact offset is in the closed ball for certain."""
    with flint.ctx.workprec(BITS):
        return bool(dot(x, x) <= flint.arb(float(eps)) ** 2)


def certain(yes: bool, no: bool, what: str) -> bool:
    """The answer that balls decide. Raises ArithmeticError where they decide neither."""
    if not yes and not no:
        raise ArithmeticError(f"{what} cannot be decided with {BITS} bits at these offsets")
    return yes
