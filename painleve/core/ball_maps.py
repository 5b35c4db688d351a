"""Blocks of points of closed Euclidean balls: from points of a cube, or from uniform numbers.

A block is a C-ordered array (coordinates, samples). Work goes row by row, so that every inner loop runs over contiguous
samples, without branches, and vectorises. Vectors are formed in the unit ball and scaled last: no square underflows
however small the radius. (docs/theory.md, section 4.2.)
"""

from __future__ import annotations

import math

import numpy as np

from painleve._jit import jit

__all__ = ["cube_to_ball", "uniform_ball", "uniforms_needed"]

_TINY = 1e-300  # keeps 0/0 away from the cube's centre; lost in rounding against any square above 1e-284


@jit
def _inner_radius(radius: float, rows: int) -> float:
    """`radius` less a bound on the rounding errors, so that the stored point is in the closed ball exactly.

    The norms below carry at most `rows` + 12 roundings of relative size 2^-53. A component that rounds to a subnormal
    number errs by less than 5e-324, which is far inside this margin at any radius from 1e-300 on.
    """
    return radius * (1.0 - (rows + 12) * 2.0**-53)


@jit
def cube_to_ball(x: np.ndarray, radius: float, boundary_weight: int) -> None:
    """Map each column of x, a point of [-1, 1]^m, onto the closed ball of that radius, in place.

    x goes to radius p(r) x / ||x||_2 with r = max |x_j| and 1 - p(r) = (1 - r)^(2^boundary_weight): a homeomorphism
    that takes cubes to spheres and keeps rays, Lipschitz, not volume-preserving. Each step of the weight squares the
    relative distance to the sphere, where the extremal values of a map are usually attained; weight 0 keeps it.
    Where m > 1, points with r < 1e-142 are drawn towards 0.

    x: (m, samples); radius: at least 1e-300. The exact norm of each result is at most `radius`.
    """
    inner = _inner_radius(radius, x.shape[0])
    if x.shape[0] == 1:
        _map_interval(x[0], inner, boundary_weight)
    else:
        _map_cube(x, inner, boundary_weight)


@jit
def _push_outwards(r: np.ndarray) -> None:
    """1 - |r| becomes its square, the sign stays."""
    for i in range(r.size):
        r[i] *= 2.0 - abs(r[i])


@jit
def _map_interval(row: np.ndarray, radius: float, boundary_weight: int) -> None:
    for _ in range(boundary_weight):
        _push_outwards(row)
    for i in range(row.size):
        row[i] *= radius


@jit
def _map_cube(x: np.ndarray, radius: float, boundary_weight: int) -> None:
    rows, columns = x.shape
    factor = np.zeros(columns)  # max |x_j| first, then p(max |x_j|), then the factor of the column
    squares = np.full(columns, _TINY)
    for j in range(rows):
        _accumulate(x[j], factor, squares)
    for _ in range(boundary_weight):
        _push_outwards(factor)
    for i in range(columns):
        factor[i] = factor[i] / math.sqrt(squares[i]) * radius
    for j in range(rows):
        row = x[j]
        for i in range(columns):
            row[i] *= factor[i]


@jit
def _accumulate(row: np.ndarray, largest: np.ndarray, squares: np.ndarray) -> None:
    for i in range(row.size):
        size = abs(row[i])
        largest[i] = size if size > largest[i] else largest[i]
        squares[i] += size * size


def uniforms_needed(rows: int, dimension: int) -> int:
    """How many uniform numbers `uniform_ball` takes for `rows` coordinates of one point of a ball of R^dimension."""
    return sum(_uniforms_for_pair(dimension - j) for j in range(0, rows, 2))


@jit
def _uniforms_for_pair(dimension: int) -> int:
    return 1 if dimension == 1 else (dimension + 1) // 2 + 1


@jit
def _outer_share(u: np.ndarray, dimension: int, share: np.ndarray) -> None:
    """1 - s^2, s the norm of two coordinates of a uniform point of the unit ball: P(1 - s^2 < t) = t^(dimension/2).

    A product of distribution functions is that of the largest, and the square of a uniform number has t^(1/2): so no
    power is taken.
    """
    last = u[u.shape[0] - 1]
    odd = dimension % 2 == 1
    for i in range(share.size):
        share[i] = last[i] * last[i] if odd else last[i]
    for k in range(u.shape[0] - 1):
        row = u[k]
        for i in range(share.size):
            share[i] = row[i] if row[i] > share[i] else share[i]


@jit
def _sine(t: float) -> float:
    """Taylor, |t| <= pi/4: the remainder is below 5e-17. A call of the C library would not vectorise."""
    y = t * t
    p = -1.0 / 1307674368000.0
    p = p * y + 1.0 / 6227020800.0
    p = p * y - 1.0 / 39916800.0
    p = p * y + 1.0 / 362880.0
    p = p * y - 1.0 / 5040.0
    p = p * y + 1.0 / 120.0
    p = p * y - 1.0 / 6.0
    return t + t * (y * p)


@jit
def _cosine(t: float) -> float:
    """Taylor, |t| <= pi/4: the remainder is below 3e-18."""
    y = t * t
    p = 1.0 / 20922789888000.0
    p = p * y - 1.0 / 87178291200.0
    p = p * y + 1.0 / 479001600.0
    p = p * y - 1.0 / 3628800.0
    p = p * y + 1.0 / 40320.0
    p = p * y - 1.0 / 720.0
    p = p * y + 1.0 / 24.0
    p = p * y - 0.5
    return 1.0 + y * p


@jit
def _place_pair(
    turn: np.ndarray, share: np.ndarray, rest: np.ndarray, radius: float, first: np.ndarray, second: np.ndarray
) -> None:
    """Two coordinates in a uniform direction, with squared norm rest (1 - share); rest becomes what is left of it."""
    for i in range(turn.size):
        # The signs of h and a and the size of a are independent: four quadrants, and an angle (pi/2)|a| in each.
        h = 4.0 * turn[i] - 2.0
        a = abs(h) - 1.0
        t = (abs(a) - 0.5) * (0.5 * math.pi)
        c, s = _cosine(t), _sine(t)
        # cos(t + pi/4) = (c - s) sqrt(1/2): the factor 0.5 below.
        size = math.sqrt(0.5 * rest[i] * (1.0 - share[i])) * radius
        first[i] = math.copysign(size * (c - s), h)
        second[i] = math.copysign(size * (c + s), a)
        rest[i] *= share[i]


@jit
def uniform_ball(u: np.ndarray, x: np.ndarray, radius: float, dimension: int) -> None:
    """Fill the columns of x with the first m coordinates of points uniform in the closed ball of R^dimension.

    Two coordinates at a time: given them, the others are uniform in a ball of dimension - 2 and of squared radius less
    the sum of their squares. No logarithm, no rejection: a sample costs the same always.

    u: (uniforms_needed(m, dimension), samples) of uniform numbers in [0, 1); x: (m, samples), m <= dimension;
    radius: at least 1e-300. The exact norm of each result is at most `radius`.
    """
    rows, columns = x.shape
    inner = _inner_radius(radius, rows)
    rest, share, spare = np.ones(columns), np.empty(columns), np.empty(columns)
    used = 0
    for j in range(0, rows, 2):
        needed = _uniforms_for_pair(dimension - j)
        own = u[used : used + needed]
        used += needed
        if dimension - j == 1:
            _place_last(own[0], rest, inner, x[j])
        else:
            _outer_share(own[1:], dimension - j, share)
            _place_pair(own[0], share, rest, inner, x[j], x[j + 1] if j + 1 < rows else spare)


@jit
def _place_last(u: np.ndarray, rest: np.ndarray, radius: float, row: np.ndarray) -> None:
    for i in range(u.size):
        row[i] = (2.0 * u[i] - 1.0) * math.sqrt(rest[i]) * radius
