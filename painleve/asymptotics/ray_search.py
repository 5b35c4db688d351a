"""The search for the farthest member where the law depends on three coordinates or more: along rays from q.

A configuration is a direction on a face of the cube around q and a place between the ends of one piece of its ray on
which all conditions of the branch hold: what is farthest often lies at such an end. A low-discrepancy sample of all
faces gives the starts, and a stencil that shrinks, turned at random where it would have too many points, refines them.
It is a search: a maximum whose basin holds none of the starts is missed, and nothing shows that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import product

import numpy as np

from painleve.asymptotics.charts import Conditions, PlaneChart
from painleve.asymptotics.search import SLIPS, FarthestMember, PlaneSearch, lattice
from painleve.core.codes import ContactMode
from painleve.core.lattice import kronecker_block, kronecker_generators, kronecker_shifts

__all__ = ["RaySearch"]

RADII = np.linspace(0.0, 1.0, 33)
RADII[0] = 1e-6  # at q itself all conditions may vanish
BISECTIONS = 30  # of the ends of a piece
STARTS = 2048  # points on each face and piece of its rays
LARGEST_LATTICE = 4  # dimensions; a stencil of 3^n points is too large beyond
TURNED = 6  # directions of a turned stencil, for each dimension
APART = 0.1  # of the box: two starts nearer than that are one


class RaySearch(PlaneSearch):
    """The ball around one state, in units of its radius."""

    def within(self, conditions: Conditions) -> Sequence[PlaneChart]:
        return list(_ray_charts(len(self.problem.shape), conditions))

    def best(self, branches: Sequence[ContactMode], kind: int) -> FarthestMember | None:
        """The best place of all charts: only the best starts among them are refined."""
        found = [self._best_of(branch, kind) for branch in branches]
        return max((f for f in found if f is not None), key=lambda f: f.value, default=None)

    def _best_of(self, branch: ContactMode, kind: int) -> FarthestMember | None:
        starts: list[tuple[float, PlaneChart, np.ndarray]] = []
        for chart in self.charts(branch):
            boxes = _sample(chart.size, slips=branch in SLIPS)
            value = self.values(branch, chart, boxes, kind)[0]
            order = _apart(boxes, value)[: self.starts]
            starts += [(float(value[i]), chart, boxes[:, i]) for i in order]
        starts.sort(key=lambda start: -start[0])
        found = [self.climb(branch, chart, box[:, None], 0.1, kind) for _, chart, box in starts[: self.starts]]
        return max(found, key=lambda f: f.value, default=None)

    def stencil(self, size: int, turn: int) -> np.ndarray:
        """(size, points): all neighbours in a lattice, or axes turned at random and their opposites."""
        if size <= LARGEST_LATTICE:
            return lattice(np.array([0.0, -1.0, 1.0]), size)
        points = np.random.default_rng(turn).normal(size=(size, TURNED * size))
        points /= np.max(np.abs(points), axis=0)
        return np.hstack([np.zeros((size, 1)), points, np.eye(size), -np.eye(size)])


def _sample(shape: int, *, slips: bool = False) -> np.ndarray:
    """Points of a face, a place on the piece and, of a slip, its impulse: a third of these two each at either end."""
    size = shape + slips
    points = np.empty((size, STARTS))
    kronecker_block(0, kronecker_generators(size), kronecker_shifts(0, size), points)
    points = 0.5 * (points + 1.0)
    for row, every in zip(range(shape - 1, size), (1, 3), strict=False):
        third = np.arange(STARTS) // every % 3
        points[row] = np.where(third == 0, points[row], third - 1.0)
    return points


def _apart(boxes: np.ndarray, value: np.ndarray) -> list[int]:
    """Indices of the best points, none of them near to a better one."""
    chosen: list[int] = []
    for i in np.argsort(-value, kind="stable")[:256]:
        near = any(np.max(np.abs(boxes[:, i] - boxes[:, j])) < APART for j in chosen)
        if np.isfinite(value[i]) and not near:
            chosen.append(int(i))
    return chosen


def _ray_charts(shape: int, conditions: Conditions) -> Iterator[PlaneChart]:
    """For each face of the cube and each piece of its rays on which all conditions hold."""
    for axis, sign in product(range(shape), (1.0, -1.0)):
        face = partial(_direction, axis, sign)
        pieces = int(_starts(_holding(conditions, face(_sample(shape)[:-1]))).sum(axis=1).max(initial=0))
        for piece in range(pieces):
            yield PlaneChart(size=shape, place=_along_rays(conditions, face, piece, shape))


def _direction(axis: int, sign: float, box: np.ndarray) -> np.ndarray:
    """Unit vectors (s, n) through a face, from points (s - 1, n) of a box."""
    vectors = np.insert(2.0 * box - 1.0, axis, sign, axis=0)
    unit: np.ndarray = vectors / np.linalg.norm(vectors, axis=0)
    return unit


def _along_rays(
    conditions: Conditions, face: Callable[[np.ndarray], np.ndarray], piece: int, shape: int
) -> Callable[[np.ndarray], np.ndarray]:
    def place(box: np.ndarray) -> np.ndarray:
        e = face(box[: shape - 1])
        low, high = _ends(conditions, e, piece)
        return e * (low + (high - low) * box[shape - 1])

    return place


def _holding(conditions: Conditions, e: np.ndarray) -> np.ndarray:
    """(n, radii): whether all conditions hold along the rays."""
    points = (e[:, :, None] * RADII).reshape(len(e), -1)
    return np.all(conditions(points) >= 0.0, axis=0).reshape(e.shape[1], RADII.size)


def _starts(holds: np.ndarray) -> np.ndarray:
    return holds & ~np.pad(holds, ((0, 0), (1, 0)))[:, :-1]


def _ends(conditions: Conditions, e: np.ndarray, piece: int) -> tuple[np.ndarray, np.ndarray]:
    """Both ends of that piece on each ray; NaN where it has fewer."""
    holds = _holding(conditions, e)
    first = _nth(_starts(holds), piece)
    last = _nth(_starts(holds[:, ::-1])[:, ::-1], piece)
    return _end(conditions, e, first, -1), _end(conditions, e, last, 1)


def _nth(marks: np.ndarray, n: int) -> np.ndarray:
    """The index of each row's mark number n, -1 where there are fewer."""
    chosen = marks & (np.cumsum(marks, axis=1) == n + 1)
    return np.where(chosen.any(axis=1), chosen.argmax(axis=1), -1)


def _end(conditions: Conditions, e: np.ndarray, index: np.ndarray, step: int) -> np.ndarray:
    """Where the conditions cease to hold between that radius and the next one in that sense, from the side where
    they do."""
    inside = np.where(index >= 0, RADII[index], np.nan)
    beyond = index + step
    cut = (index >= 0) & (beyond >= 0) & (beyond < RADII.size)
    outside = np.where(cut, RADII[np.clip(beyond, 0, RADII.size - 1)], inside)
    at = np.flatnonzero(cut)
    for _ in range(BISECTIONS if at.size else 0):
        middle = 0.5 * (inside[at] + outside[at])
        holds = np.all(conditions(e[:, at] * middle) >= 0.0, axis=0)
        inside[at], outside[at] = np.where(holds, middle, inside[at]), np.where(holds, outside[at], middle)
    return inside
