"""How far apart two velocities are, as graphs in (t, u): a jump shifted by one step costs a step and not its height.

The graph of a velocity is the polyline through (t_i, u_i). Where one instant stands twice, a vertical segment fills in
the jump between the two velocities; a jump within a step is filled in by a segment that leans over by that step. The
distance is that of Hausdorff, as the project's notes, section 7, take it from M. D. P. Monteiro Marques, Differential
Inclusions in Nonsmooth Mechanical Problems, 1993, and V. Acary; the Euclidean norm adds seconds and velocities as they
come, in the units of the scene.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from painleve._jit import jit
from painleve.errors import InputError
from painleve.sets import Bounds, Excess, Hausdorff
from painleve.sets.shapes import LARGEST_COORDINATE, FloatArray

__all__ = ["graph_distance", "velocity_graph"]

WIDTH = 1e-3  # relative width at which a supremum over a polyline is enclosed well enough
ROUNDING = 1e-15  # relative to the largest coordinate: distances below it are rounding
LEAST_PART = 2.0**-50  # of a piece: where its halving ends, settled or not


def velocity_graph(t: ArrayLike, u: ArrayLike) -> FloatArray:
    """Vertices (n, 1 + d) of the graph, from instants t (n,) that do not decrease and velocities u (n, d), n >= 2.

    Raises InputError for other shapes, instants that decrease, and numbers that are not finite.
    """
    instants, velocities = np.asarray(t, float), np.asarray(u, float)
    if instants.ndim != 1 or len(instants) < 2 or velocities.ndim != 2 or len(velocities) != len(instants):
        raise InputError(
            f"graph: t, u have shapes {instants.shape}, {velocities.shape}; give (n,) and (n, d) with n >= 2"
        )
    vertices = np.column_stack([instants, velocities])
    if not np.all(np.abs(vertices) <= LARGEST_COORDINATE):
        raise InputError("graph: an instant or a velocity is NaN, infinite or too large to square")
    if np.any(np.diff(instants) < 0.0):
        raise InputError("graph: instants decrease; sort them")
    return vertices


def graph_distance(X: FloatArray, Y: FloatArray) -> Hausdorff:
    """Both excesses between two graphs of `velocity_graph`, each enclosed to a relative width of 1e-3 or to rounding.

    The distance to one segment is convex, hence over a piece of the other graph at most its larger value at the two
    ends; pieces for which this does not settle the supremum are halved.
    Raises InputError where the velocities have different dimensions.
    """
    if X.shape[1] != Y.shape[1]:
        raise InputError(f"graphs: velocities of dimension {X.shape[1] - 1} and {Y.shape[1] - 1}; give the same one")
    return Hausdorff(forward=_excess(X, Y), backward=_excess(Y, X))


def _excess(X: FloatArray, Y: FloatArray) -> Excess:
    tiny = ROUNDING * max(1.0, float(np.abs(X).max()), float(np.abs(Y).max()))
    point, foot = np.empty(X.shape[1]), np.empty(X.shape[1])
    lower, upper = _supremum(X, Y, WIDTH, tiny, point, foot)
    return Excess(bounds=Bounds.between(lower, upper), attained_at=point, nearest=foot)


@jit
def _to_segment(point, Y, k):
    """(distance, place in [0, 1]) of a point to segment k of the polyline Y."""
    along, length = 0.0, 0.0
    for j in range(len(point)):
        edge = Y[k + 1, j] - Y[k, j]
        along += (point[j] - Y[k, j]) * edge
        length += edge * edge
    place = min(max(along / length, 0.0), 1.0) if length > 0.0 else 0.0
    total = 0.0
    for j in range(len(point)):
        difference = point[j] - Y[k, j] - place * (Y[k + 1, j] - Y[k, j])
        total += difference * difference
    return math.sqrt(total), place


@jit
def _to_graph(point, Y):
    """(distance, segment) of a point to the polyline Y: outwards from its own instant, while instants are close."""
    last, t = len(Y) - 2, point[0]
    low, high = 0, len(Y)
    while low < high:
        middle = (low + high) // 2
        if Y[middle, 0] < t:
            low = middle + 1
        else:
            high = middle
    left = min(max(low - 1, 0), last)
    right, best, winner = left + 1, math.inf, left
    while (left >= 0 and t - Y[left + 1, 0] < best) or (right <= last and Y[right, 0] - t < best):
        if left >= 0 and t - Y[left + 1, 0] < best:
            distance, _ = _to_segment(point, Y, left)
            if distance < best:
                best, winner = distance, left
            left -= 1
        if right <= last and Y[right, 0] - t < best:
            distance, _ = _to_segment(point, Y, right)
            if distance < best:
                best, winner = distance, right
            right += 1
    return best, winner


@jit
def _supremum(X, Y, width, tiny, attained, foot):
    """(lower, upper) of the supremum over the polyline X of the distance to Y; `attained` and its `foot` are filled."""
    lower, upper = -1.0, 0.0
    for i in range(len(X)):  # all vertices first: a good lower bound settles most pieces at once
        distance, _ = _to_graph(X[i], Y)
        if distance > lower:
            lower = distance
            _between(X[i], X[i], 0.0, attained)
    for i in range(len(X) - 1):
        lower, bound = _over_piece(X[i], X[i + 1], Y, lower, width, tiny, attained)
        upper = max(upper, bound)
    _, winner = _to_graph(attained, Y)
    _between(Y[winner], Y[winner + 1], _to_segment(attained, Y, winner)[1], foot)
    return lower, max(lower, upper)


@jit
def _over_piece(start, end, Y, lower, width, tiny, attained):
    """The lower bound, raised by what is found between start and end, and an upper bound for that piece.

    Walks through the halvings of [0, 1] from left to right: a part that is not settled is halved, and after a settled
    one comes the largest part that begins where it ends.
    """
    a, b = start.copy(), start.copy()
    place, part, upper = 0.0, 1.0, 0.0
    at_a, by_a = _to_graph(a, Y)
    while place < 1.0:
        _between(start, end, place + part, b)
        at_b, by_b = _to_graph(b, Y)
        if at_b > lower:
            lower = at_b
            _between(b, b, 0.0, attained)
        bound = _bound(a, b, at_a, at_b, by_a, by_b, Y)
        if bound > lower * (1.0 + width) + tiny and part > LEAST_PART:
            part *= 0.5
            continue
        upper = max(upper, bound)
        place += part
        while place < 1.0 and place % (2.0 * part) == 0.0:
            part *= 2.0
        _between(b, b, 0.0, a)
        at_a, by_a = at_b, by_b
    return lower, upper


@jit
def _between(start, end, place, out):
    """The point at a place in [0, 1] between start and end."""
    for j in range(len(out)):
        out[j] = start[j] + place * (end[j] - start[j])


@jit
def _bound(a, b, at_a, at_b, by_a, by_b, Y):
    """An upper bound on the distance to Y over the segment from a to b.

    A distance changes no faster than its point moves; and the distance to one segment of Y is convex.
    """
    length = 0.0
    for j in range(len(a)):
        length += (b[j] - a[j]) ** 2
    bound = 0.5 * (at_a + at_b + math.sqrt(length))
    bound = min(bound, max(at_a, _to_segment(b, Y, by_a)[0]))
    return min(bound, max(at_b, _to_segment(a, Y, by_b)[0]))
