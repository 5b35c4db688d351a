"""The farthest member of one branch of S over one configuration, in the plane: all velocities of a ball at once.

For fixed q the law is piecewise linear in v, so on each of its branches dist(S, A) is to be maximised over a ball cut
by half-spaces (painleve.core.farthest). Velocity offsets are measured in units of the ball's radius, and S relative
to the limit set as in painleve.core.sections.segment: S = u- + tau (u_tilde - u-) + eps z. The branches themselves are
in painleve.core.sections: `branch_excesses`.
"""

import math
from typing import NamedTuple

import numpy as np

from painleve._jit import jit
from painleve.core.farthest import dot, farthest
from painleve.core.reduce import PAIR, POINT

__all__ = ["REACH", "excess", "half_space", "no_half_spaces"]

REACH = 3  # instead of a distance: how far S comes back from u_tilde towards u-
EDGES = 3  # half-spaces at most: v_n <= 0 and the two edges of the cone
PIECES = EDGES + 1  # one more tells the nearer end of A


class HalfSpaces(NamedTuple):
    """Room for some: normal . y <= offset."""

    normals: np.ndarray  # (PIECES, d)
    offsets: np.ndarray  # (PIECES,)


@jit
def no_half_spaces(d):
    """Room for those of a branch."""
    return HalfSpaces(np.empty((PIECES, d)), np.empty(PIECES))


@jit
def half_space(normal, offset, cuts, count):
    """Add normal . y <= offset, scaled; a vanishing normal leaves all (the same count) or nothing (-1)."""
    size, length = normal.size, math.sqrt(dot(normal, normal))
    if length < 1e-14:
        return count if offset >= 0.0 else -1
    for j in range(size):
        cuts.normals[count, j] = normal[j] / length
    cuts.offsets[count] = offset / length
    return count + 1


@jit
def excess(kind, A, c, ends, direction, cuts, count, size, radius, best):
    """Largest distance from the limit set over the admissible y, all in units of eps, of A y + c taken from the point
    of its line that is ends[0] after u- and ends[1] beyond u_tilde; the place goes into `best`."""
    after, beyond = ends
    rows = c.size
    slope, level = np.zeros(size), dot(direction, c)
    for i in range(rows):
        for j in range(size):
            slope[j] += direction[i] * A[i, j]
    reach = math.sqrt(dot(slope, slope)) * radius
    if kind == REACH:
        return _back(slope, level + beyond, reach, cuts, count, radius, best)
    start, end = np.empty(rows), np.empty(rows)
    for i in range(rows):
        start[i] = c[i] + after * direction[i]
        end[i] = c[i] + beyond * direction[i]
    if kind == POINT:
        return _root(farthest(A, start, cuts.normals, cuts.offsets, count, size, radius, best))
    # Nearest to u- where level + slope . y <= first, to u_tilde where it is >= second, else to a point between them.
    half = 0.5 * (after - beyond) if kind == PAIR else 0.0
    first, second = half - after, -half - beyond
    value, y, opposite = -1.0, np.zeros(size), np.empty(size)
    if level - reach <= first:
        more = half_space(slope, first - level, cuts, count)
        if more >= 0:
            value = _better(farthest(A, start, cuts.normals, cuts.offsets, more, size, radius, y), value, y, best)
    if level + reach >= second:
        for j in range(size):
            opposite[j] = -slope[j]
        more = half_space(opposite, level - second, cuts, count)
        if more >= 0:
            value = _better(farthest(A, end, cuts.normals, cuts.offsets, more, size, radius, y), value, y, best)
    if kind != PAIR:
        across = np.empty((rows, size))
        for i in range(rows):
            end[i] = c[i] - level * direction[i]
            for j in range(size):
                across[i, j] = A[i, j] - direction[i] * slope[j]
        value = _better(farthest(across, end, cuts.normals, cuts.offsets, count, size, radius, y), value, y, best)
    return _root(value)


@jit
def _back(slope, level, reach, cuts, count, radius, best):
    """max -(level + slope . y): squared after a shift that makes it positive."""
    shift, form = 2.0 * reach + abs(level) + 1.0, np.empty((1, slope.size))
    for j in range(slope.size):
        form[0, j] = -slope[j]
    value = farthest(form, np.array([shift - level]), cuts.normals, cuts.offsets, count, slope.size, radius, best)
    return math.sqrt(value) - shift if value >= 0.0 else -math.inf


@jit
def _better(value, known, y, best):
    if value > known:
        best[:] = y
        return value
    return known


@jit
def _root(squared):
    return math.sqrt(squared) if squared >= 0.0 else -1.0
