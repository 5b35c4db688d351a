"""The one root of a quartic in an interval of positive numbers, to rounding relative to the root itself."""

from math import sqrt

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
