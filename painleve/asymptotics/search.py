"""The search for the farthest member over all configurations in contact, for rows however they are formed.

Over one configuration the law is piecewise linear in v, and the farthest member of each branch is found globally
(painleve.core.excess). What is left are the shape offsets and, where the tip slips, its impulse: a grid on every
chart, then a stencil that shrinks about the best places.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from painleve.asymptotics.charts import Conditions, PlaneChart, charts
from painleve.asymptotics.local import LocalProblem
from painleve.core.codes import ContactMode
from painleve.core.excess import REACH

__all__ = ["SLIPS", "FarthestMember", "PlaneSearch", "lattice"]

GRIDS = {0: 1, 1: 33, 2: 9, 3: 9}  # points an axis of a box of that size
LAST_STEP = 2.0**-36
MOST_ROUNDS = 400  # for places from which a top is approached slowly; the second search shows what was left
PROGRESS = 1e-15  # relative; less is rounding, on which a search could wander for ever
SLIPS = {ContactMode.SLIP_PLUS: 1, ContactMode.SLIP_MINUS: -1}  # edges of the cone


@dataclass(frozen=True, kw_only=True, eq=False)
class FarthestMember:
    """The best place of a search: value in units of eps, where, and what a second search from there added."""

    value: float
    branch: ContactMode
    x: np.ndarray
    dv: np.ndarray
    impulse: float
    error: float


class PlaneSearch:
    """The ball around one state, in units of its radius."""

    def __init__(
        self,
        problem: LocalProblem,
        eps: float,
        kind: int,
        differences: Callable[[np.ndarray], np.ndarray],
        *,
        base: np.ndarray | None = None,
        starts: int = 4,
    ) -> None:
        """`differences`: rows minus their base values (R, n) at the shape offsets eps x, x (s, n); kind: of the limit
        set (painleve.core.reduce); starts: how many of the grid's best places are refined."""
        self.problem, self.eps, self.kind, self.differences = problem, eps, kind, differences
        self.base, self.starts = problem.base if base is None else base, starts
        self.state = problem.base_state._replace(base=self.base)
        excesses = problem.section.branch_excesses
        assert excesses is not None  # in space: painleve.asymptotics.space.search
        self.branches, self.branch_excesses = problem.section.modes, excesses
        self.counts = {b.label: 0 for b in (ContactMode.FREE, *self.branches)}

    def contact(self, x: np.ndarray) -> np.ndarray:
        """The largest g/eps that the offsets x leave room for."""
        room = self.problem.carried * np.sqrt(np.maximum(0.0, 1.0 - np.sum(x * x, axis=0)))
        return self.differences(x)[self.problem.parts.g] / self.eps + room

    def edge(self, branch: ContactMode, x: np.ndarray) -> np.ndarray:
        """a + s b on the branch's edge of the cone."""
        row = self.problem.kernels.rows.edges[SLIPS[branch]]
        return self.base[row] + self.differences(x)[row]

    def charts(self, branch: ContactMode) -> Sequence[PlaneChart]:
        """Where the branch has members, over its shape offsets."""

        def conditions(x: np.ndarray) -> np.ndarray:
            if branch not in SLIPS:
                return self.contact(x)[None, :]
            return np.stack([self.contact(x), self.edge(branch, x)])

        return self.within(conditions)

    def within(self, conditions: Conditions) -> Sequence[PlaneChart]:
        """Charts of the offsets at which all conditions are >= 0."""
        return list(charts(len(self.problem.shape), conditions))

    def values(
        self, branch: ContactMode, chart: PlaneChart, box: np.ndarray, kind: int
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Value, shape offset, dv/eps and impulse at points (chart.size [+ 1], n) of the box."""
        p, x = self.problem, chart.place(box)
        known = ~np.isnan(x).any(axis=0)
        n = int(known.sum())
        value, dv, impulse = np.empty(n), np.zeros((p.dimension, n)), np.empty(n)
        share = np.ascontiguousarray(box[-1][known]) if branch in SLIPS else np.zeros(n)
        self.branch_excesses(
            int(branch),
            kind,
            self.state,
            self.differences(x[:, known]),
            share,
            self.eps,
            value,
            dv,
            impulse,
        )
        self.counts[branch.label] += n
        all_values = np.full(box.shape[1], -np.inf)
        all_values[known] = np.where(value == -1.0, -np.inf, value) if kind != REACH else value
        wide = np.zeros((p.dimension + 1, box.shape[1]))
        wide[:-1, known], wide[-1, known] = dv, impulse
        return all_values, x, wide[:-1], wide[-1]

    def best(self, branches: Sequence[ContactMode], kind: int) -> FarthestMember | None:
        """The best place of all charts of the branches."""
        found = [self.search(b, chart, kind) for b in branches for chart in self.charts(b)]
        return max((f for f in found if f is not None), key=lambda f: f.value, default=None)

    def search(self, branch: ContactMode, chart: PlaneChart, kind: int) -> FarthestMember | None:
        """The best place of one chart; None where it holds no member."""
        size = chart.size + (branch in SLIPS)
        axis = np.linspace(0.0, 1.0, GRIDS[size])
        grid = lattice(axis, size)
        value = self.values(branch, chart, grid, kind)[0]
        peaks = _peaks(value.reshape((axis.size,) * size))[: self.starts]
        if not peaks.size:
            return None
        return self.climb(branch, chart, grid[:, peaks], 0.5 / (axis.size - 1) if size else 0.0, kind)

    def climb(
        self, branch: ContactMode, chart: PlaneChart, starts: np.ndarray, step: float, kind: int
    ) -> FarthestMember:
        """The best place that is reached from the starts (chart.size [+ 1], n), and what a second climb added."""
        first = self._refine(branch, chart, starts, step, kind)
        top = first[:, [int(np.argmax(first[-1]))]]
        again = self._refine(branch, chart, top[:-1], 1e-3 if len(starts) else 0.0, kind)
        value, x, dv, impulse = self.values(branch, chart, again[:-1], kind)
        return FarthestMember(
            value=float(value[0]),
            branch=branch,
            x=x[:, 0],
            dv=dv[:, 0],
            impulse=float(impulse[0]),
            error=abs(float(again[-1, 0] - top[-1, 0])),
        )

    def stencil(self, size: int, turn: int) -> np.ndarray:
        """(size, points) around a place, the place itself among them; turn: the number of the round."""
        return lattice(np.array([0.0, -1.0, 1.0]), size)

    def _refine(self, branch: ContactMode, chart: PlaneChart, places: np.ndarray, step: float, kind: int) -> np.ndarray:
        """Move each place to the best point of a stencil, which grows on a slope and shrinks at a top."""
        size, n = places.shape
        best, steps, value = places.copy(), np.full(n, step), self.values(branch, chart, places, kind)[0]
        for turn in range(MOST_ROUNDS):
            at = np.flatnonzero(steps > LAST_STEP)
            if not at.size:
                break
            stencil = self.stencil(size, turn)
            tried = np.clip(best[:, at, None] + steps[at, None] * stencil[:, None, :], 0.0, 1.0)
            values = self.values(branch, chart, tried.reshape(size, -1), kind)[0].reshape(at.size, -1)
            winner = np.argmax(values, axis=1)
            each = np.arange(at.size)
            better = values[each, winner] > value[at] + PROGRESS * np.abs(value[at])
            best[:, at] = np.where(better, tried[:, each, winner], best[:, at])
            value[at] = np.where(better, values[each, winner], value[at])
            steps[at] *= np.where(better, 2.0, 0.5)  # a slope is gone up in strides, a top is closed in on
        return np.vstack([best, value])


def lattice(axis: np.ndarray, size: int) -> np.ndarray:
    """All points with coordinates from the axis, (size, n)."""
    return np.array(list(product(axis, repeat=size)), dtype=float).reshape(axis.size**size, size).T


def _peaks(values: np.ndarray) -> np.ndarray:
    """Flat indices of the grid's local maxima, the highest first."""
    padded = np.pad(values, 1, constant_values=-np.inf)
    highest = np.full(values.shape, True)
    for shift in product((0, 1, 2), repeat=values.ndim):
        window = tuple(slice(s, s + n) for s, n in zip(shift, values.shape, strict=True))
        highest &= values >= padded[window]
    flat = np.flatnonzero((highest & np.isfinite(values)).ravel())
    return flat[np.argsort(-values.ravel()[flat], kind="stable")]
