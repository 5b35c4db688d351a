"""Excess of one set from another, Hausdorff distance, and the points at which they are attained.

The excess of X from Y is e(X, Y) = sup over x in X of dist(x, Y), and d_H = max(e(X, Y), e(Y, X)) (Paoli 2016,
section 3). Distances are Euclidean. Each result carries the side on which it is known: a cloud holds true members of
a larger set, so it bounds a supremum over that set from below and a distance to it from above (docs/theory.md,
section 4).

Rounding: distances between points are good to a few units in the last place (ulps); distances from a segment to a few
ulps of the distance to the segment's nearer end. The supremum over a segment of length L of the distance to n points
is at least L/(2n), so it is good to a few n ulps at worst. Squares of distances below 1e-150 may vanish.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from painleve.errors import InputError
from painleve.sets.bounds import Bounds, largest
from painleve.sets.point_sets import LARGEST_COORDINATE, Cloud, FloatArray, LineSegment, PointSet

__all__ = ["Excess", "Hausdorff", "excess", "excess_of_segment_from_profile", "hausdorff"]

IndexArray = NDArray[np.int64]

_CHUNK = 1 << 14  # rows whose temporaries stay in the cache; memory does not grow with the cloud
_WORTH_A_ROUND = 1 / 16  # of the points: a round over arrays costs about that share of a scan
_FEW_PAIRS = 10_000_000  # below, scipy's quadratic scan is quicker than building a tree


@dataclass(frozen=True, kw_only=True, eq=False)
class Excess:
    """e(X, Y) with its sides, the point of X where it is attained, and the point of Y nearest to that; shape (d,)."""

    bounds: Bounds
    attained_at: FloatArray
    nearest: FloatArray

    def __repr__(self) -> str:
        return f"Excess({self.bounds})"


@dataclass(frozen=True, kw_only=True, eq=False)
class Hausdorff:
    """The two excesses, forward e(X, Y) and backward e(Y, X), kept apart."""

    forward: Excess
    backward: Excess

    def __repr__(self) -> str:
        return f"Hausdorff(forward {self.forward.bounds}, backward {self.backward.bounds})"

    @property
    def bounds(self) -> Bounds:
        """What the two say about d_H, their maximum."""
        return largest(self.forward.bounds, self.backward.bounds)


class _Farthest(NamedTuple):
    distance: float
    attained_at: FloatArray
    nearest: FloatArray


def excess(X: PointSet, Y: PointSet) -> Excess:
    """e(X, Y) = sup over x in X of dist(x, Y).

    Exact between Points and Segments, in any mixture. A Cloud as X gives a lower bound, a Cloud as Y an upper bound.
    From Cloud to Cloud the bounds are unknown: the excess of one sample from another bounds nothing about the sampled
    sets; the points reported are those at which it is attained between the samples.

    Raises InputError where the dimensions differ.
    """
    if X.dimension != Y.dimension:
        raise InputError(f"excess: X lives in dimension {X.dimension} and Y in {Y.dimension}; give sets of one space")
    found = _farthest(X, Y)
    return Excess(
        bounds=_sided(X, Y, found.distance), attained_at=_frozen(found.attained_at), nearest=_frozen(found.nearest)
    )


def hausdorff(X: PointSet, Y: PointSet) -> Hausdorff:
    """Both excesses between X and Y, whose larger one is d_H. Raises InputError where the dimensions differ."""
    return Hausdorff(forward=excess(X, Y), backward=excess(Y, X))


def excess_of_segment_from_profile(t: FloatArray, rho: FloatArray, length: float) -> tuple[float, float, int]:
    """The exact excess of the segment [0, length] from points given by their place along it and distance from its line.

    `t`, shape (n,): signed distances along the segment from its start. `rho`, shape (n,): distances >= 0 from the line
    through it. Returns the supremum over s in [0, length] of min_i sqrt((s - t_i)^2 + rho_i^2), the s at which it is
    attained, and the index i of a point nearest to that s.

    All parabolas (s - t_i)^2 + rho_i^2 have one curvature, so their minimum is s^2 plus a lower envelope of lines. It
    is convex between two breakpoints of that envelope: the supremum is at a breakpoint or at an end of the segment.

    Raises InputError for wrong shapes, no points, numbers that are not finite, rho < 0 and length < 0.
    """
    t, rho = np.asarray(t, dtype=np.float64), np.asarray(rho, dtype=np.float64)
    _check_profile(t, rho, length)
    cells = _lower_envelope(t, rho)
    between = _breakpoints(t[cells], rho[cells])
    left, right = np.append(-np.inf, between), np.append(between, np.inf)
    met = (left <= length) & (right >= 0.0)
    cells, ends = cells[met], np.clip(np.stack([left[met], right[met]]), 0.0, length)
    distances = np.hypot(ends - t[cells], rho[cells])
    side, cell = np.unravel_index(np.argmax(distances), distances.shape)
    return float(distances[side, cell]), float(ends[side, cell]), int(cells[cell])


def _sided(X: PointSet, Y: PointSet, distance: float) -> Bounds:
    match X, Y:
        case Cloud(), Cloud():
            return Bounds.unknown()
        case Cloud(), _:
            return Bounds.at_least(distance)
        case _, Cloud():
            return Bounds.at_most(distance)
        case _:
            return Bounds.exactly(distance)


def _farthest(X: PointSet, Y: PointSet) -> _Farthest:
    if isinstance(Y, LineSegment):  # the distance to a convex set is convex: over a segment its maximum is at an end
        x = np.stack([X.start, X.end]) if isinstance(X, LineSegment) else X.members
        return _points_from_segment(x, Y)
    if isinstance(X, LineSegment):
        return _segment_from_points(X, Y.members)
    return _points_from_points(X.members, Y.members)


def _points_from_points(x: FloatArray, y: FloatArray) -> _Farthest:
    """Scan while there are few pairs; else a tree, because the scan is quadratic for clouds that lie close together."""
    from scipy.spatial import cKDTree, distance  # late: segments and the command line's help do without

    if len(x) * len(y) <= _FEW_PAIRS:
        sup, i, j = distance.directed_hausdorff(x, y)
        return _Farthest(float(sup), x[i], y[j])
    distances, nearest = cKDTree(y, balanced_tree=False, compact_nodes=False).query(x)
    i = int(np.argmax(distances))
    return _Farthest(float(distances[i]), x[i], y[nearest[i]])


def _points_from_segment(x: FloatArray, segment: LineSegment) -> _Farthest:
    length = segment.length
    best, winner, place = -1.0, 0, 0.0
    for first, from_start, from_end, rho in _along_and_across(x, segment):
        beyond = np.maximum(np.maximum(-from_start, from_end), 0.0)
        distances = np.hypot(beyond, rho)
        i = int(np.argmax(distances))
        if distances[i] > best:
            best, winner, place = float(distances[i]), first + i, float(from_start[i])
    return _Farthest(best, x[winner], _at(segment, min(max(place, 0.0), length)))


def _segment_from_points(segment: LineSegment, y: FloatArray) -> _Farthest:
    length = segment.length
    t, across = np.empty(len(y)), np.empty(len(y))
    for first, from_start, _, rho in _along_and_across(y, segment):
        t[first : first + len(rho)] = from_start
        across[first : first + len(rho)] = rho
    sup, place, nearest = excess_of_segment_from_profile(t, across, length)
    return _Farthest(sup, _at(segment, place), y[nearest])


def _along_and_across(
    members: FloatArray, segment: LineSegment
) -> Iterator[tuple[int, FloatArray, FloatArray, FloatArray]]:
    """For chunks of rows: the first row, places along the segment from its start and from its end, distances across.

    Differences are taken from the nearer end, so that a point close to either end loses nothing to cancellation.
    """
    unit = segment.direction
    for first in range(0, len(members), _CHUNK):
        chunk = members[first : first + _CHUNK]
        after_start, after_end = chunk - segment.start, chunk - segment.end
        from_start, from_end = after_start @ unit, after_end @ unit
        near_start = np.abs(from_start) <= np.abs(from_end)
        along = np.where(near_start, from_start, from_end)
        across = np.where(near_start[:, None], after_start, after_end) - along[:, None] * unit
        yield first, from_start, from_end, np.sqrt(np.einsum("ij,ij->i", across, across))


def _at(segment: LineSegment, place: float) -> FloatArray:
    """The point at a distance from the start, from the nearer end, so that both ends are met exactly."""
    length = segment.length
    if 2.0 * place <= length:
        return segment.start + place * segment.direction
    return segment.end - (length - place) * segment.direction


def _lower_envelope(t: FloatArray, rho: FloatArray) -> IndexArray:
    """The points that are nearest somewhere on the line, from left to right.

    A point is hidden where its cell would end before it begins. Whatever its two neighbours hide can go at once, in
    rounds over whole arrays; rounds can go on for as long as there are points, so what resists is scanned with a stack.
    """
    order = np.lexsort((rho, t))
    order = order[np.append(True, np.diff(t[order]) > 0.0)]  # of the points at one place, the one nearest to the line
    while order.size > 2:
        between = _breakpoints(t[order], rho[order])
        hidden = between[:-1] >= between[1:]
        found = np.count_nonzero(hidden)
        if found == 0:
            break
        if found < _WORTH_A_ROUND * order.size:
            return order[_scan(t[order], rho[order])]
        order = order[np.concatenate([[True], ~hidden, [True]])]
    return order


def _breakpoints(t: FloatArray, rho: FloatArray) -> FloatArray:
    """Where each point hands over to the next, for t ascending.

    Formed from differences: the intercepts t^2 + rho^2 of the lines would lose what is small beside the length.
    """
    with np.errstate(over="ignore"):  # a handover at infinity is one that never happens
        return 0.5 * (t[:-1] + t[1:]) + 0.5 * np.diff(rho) * (rho[:-1] + rho[1:]) / np.diff(t)


def _scan(t: FloatArray, rho: FloatArray) -> list[int]:
    """The places of the unhidden points, by one pass with a stack; linear in time, but a point at a time."""
    ts, rhos = t.tolist(), rho.tolist()
    kept, left = [0], [-np.inf]
    for j in range(1, len(ts)):
        tj, rj = ts[j], rhos[j]
        while True:
            ti, ri = ts[kept[-1]], rhos[kept[-1]]
            begin = 0.5 * (ti + tj) + 0.5 * (rj - ri) * (rj + ri) / (tj - ti)
            if begin > left[-1] or len(kept) == 1:
                break
            kept.pop()
            left.pop()
        kept.append(j)
        left.append(begin)
    return kept


def _check_profile(t: FloatArray, rho: FloatArray, length: float) -> None:
    if t.ndim != 1 or t.shape != rho.shape or t.size == 0:
        raise InputError(f"profile: t, rho have shapes {t.shape}, {rho.shape}; give two vectors of one length n >= 1")
    numbers = np.concatenate([t, rho, [length]])
    if not np.all(np.abs(numbers) <= LARGEST_COORDINATE):
        raise InputError("profile: t, rho or length is NaN, infinite or too large to square; leave out empty bins")
    if length < 0.0 or np.any(rho < 0.0):
        raise InputError("profile: rho and length are distances; give numbers >= 0")


def _frozen(point: FloatArray) -> FloatArray:
    copy = np.array(point)  # a view would keep the whole cloud alive
    copy.setflags(write=False)
    return copy
