"""Roots of quartics: the one root in an interval of positive numbers, to rounding relative to the root itself, and all
roots between -1 and 1."""

from math import sqrt

import numpy as np

from painleve._jit import jit

# Newton's method squares the relative error: after a step of this size what is left is below rounding.
LAST_STEP = 1e-9
# Doubling the exponent, halving its range, then the interval, takes less than 10 + 11 + 53 bisections.
MOST_STEPS = 128


@jit
def middle(low, high):
    """A point between that halves the logarithms while these are far apart: no scale is preferred.

    Below high <= 1 the logarithm has no end: the exponent is doubled until one is known.
    """
    if low == 0.0:
        return high * min(high, 0.0625)
    if high > 8.0 * low:
        return sqrt(low) * sqrt(high)
    return 0.5 * (low + high)


@jit
def bracketed_root(c_0, c_1, c_2, c_3, c_4, low, high, guess):
    """The root of c_0 + ... + c_4 x^4 between low >= 0 and high <= 1, where it changes sign once, from - to +.

    Newton's method from `guess`, replaced by a bisection wherever it leaves the interval or does not halve its step.
    """
    x = guess if low < guess < high else high
    allowed = high - low
    for _ in range(MOST_STEPS):
        value = c_0 + x * (c_1 + x * (c_2 + x * (c_3 + x * c_4)))
        slope = c_1 + x * (2.0 * c_2 + x * (3.0 * c_3 + x * (4.0 * c_4)))
        if value < 0.0:
            low = x
        elif value > 0.0:
            high = x
        else:
            return x
        step = value / slope
        following = x - step
        if abs(step) <= LAST_STEP * x:
            return following
        if low < following < high and abs(step) <= 0.5 * allowed:
            allowed = abs(step)
        else:
            following = middle(low, high)
            if following <= low or following >= high:
                return following
            allowed = high - low
        x = following
    return x


@jit
def roots_of_quartic(polynomial, roots):
    """Simple real roots in [-1, 1) of the quartic with these coefficients (constant first), upwards; their number.

    The roots of each derivative cut the interval into pieces on which the polynomial before it is monotone: every
    change of sign is found, and between two of them there is one.
    """
    knots = np.empty(6)
    found = 0
    for degree in range(1, 5):
        derived = polynomial.copy()
        for _ in range(4 - degree):
            for k in range(4):
                derived[k] = (k + 1) * derived[k + 1]
            derived[4] = 0.0
        knots[0] = -1.0
        for i in range(found):
            knots[1 + i] = roots[i]
        knots[1 + found] = 1.0
        pieces = found + 1
        found = 0
        for i in range(pieces):
            below, above = _value(derived, knots[i]), _value(derived, knots[i + 1])
            if (below >= 0.0) != (above >= 0.0):
                roots[found] = _root_between(derived, knots[i], knots[i + 1], 1.0 if above >= 0.0 else -1.0)
                found += 1
    return found


@jit
def _value(c, x):
    return (((c[4] * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0]


@jit
def _root_between(c, low, high, sense):
    """The root between -1 <= low and high <= 1, where the polynomial changes sign once, upwards if sense is 1."""
    if low < 0.0 < high:
        if c[0] == 0.0:
            return 0.0
        low, high = (low, 0.0) if sense * c[0] > 0.0 else (0.0, high)
    if high <= 0.0:  # mirrored: odd coefficients and the sense change their sign
        low, high = -high, -low
        return -bracketed_root(
            -sense * c[0], sense * c[1], -sense * c[2], sense * c[3], -sense * c[4], low, high, 0.5 * (low + high)
        )
    return bracketed_root(
        sense * c[0], sense * c[1], sense * c[2], sense * c[3], sense * c[4], low, high, 0.5 * (low + high)
    )
