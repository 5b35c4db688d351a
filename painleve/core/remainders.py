"""What is left of a function after the tangent, without subtracting close numbers (docs/theory.md, section 8).

Each is f(x) minus its value and slope at 0, for small and large x alike: by its series where the difference would
cancel, plainly where it would not.
"""

from __future__ import annotations

import math

from painleve._jit import jit

__all__ = ["arctangent_remainder", "cosine_remainder", "exponential_remainder", "logarithm_remainder", "sine_remainder"]

# Below these |x| the series are taken; twelve terms then leave less than 1e-17 of the first.
TURN, GROWTH, QUOTIENT = 1.0, 0.5, 0.125


@jit
def sine_remainder(x):
    """sin(x) - x."""
    if abs(x) > TURN:
        return math.sin(x) - x
    square = x * x
    term = -x * square / 6.0
    total = term
    for n in range(2, 12):
        term *= -square / ((2 * n) * (2 * n + 1))
        total += term
    return total


@jit
def cosine_remainder(x):
    """cos(x) - 1."""
    half = math.sin(0.5 * x)
    return -2.0 * half * half


@jit
def exponential_remainder(x):
    """exp(x) - 1 - x."""
    if abs(x) > GROWTH:
        return math.expm1(x) - x
    term = 0.5 * x * x
    total = term
    for n in range(3, 16):
        term *= x / n
        total += term
    return total


@jit
def logarithm_remainder(x):
    """log(1 + x) - x, x > -1: from the series in x/(2 + x), whose first term cancels exactly."""
    if abs(x) > GROWTH:
        return math.log1p(x) - x
    w = x / (2.0 + x)
    square, power, total = w * w, w * w * w, 0.0
    for n in range(3, 40, 2):
        total += power / n
        power *= square
    return 2.0 * total - x * w


@jit
def arctangent_remainder(x):
    """atan(x) - x."""
    if abs(x) > QUOTIENT:
        return math.atan(x) - x
    square, power, total = x * x, -x * x * x, 0.0
    for n in range(3, 27, 2):
        total += power / n
        power *= -square
    return total
