"""Rows of a trajectory that an adaptive integrator produces: on the grid, and twice at every event."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, Ending
from painleve.dynamics.arc import ArcPoint
from painleve.dynamics.grid import TimeGrid
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory

__all__ = ["Recorder"]


class Recorder:
    """Collects (t, y), y = (q, u, impulses since the start), with the branch and the change up to there."""

    def __init__(self, start: Start) -> None:
        self.start = start
        first = np.concatenate([start.q, start.u, [0.0, 0.0]])
        # (t, y, branch, change) together, so that an interruption leaves no column shorter than another
        self.parts = [(np.array([start.t]), first[None, :], *(np.zeros(1, np.int8) for _ in range(2)))]

    @property
    def last(self) -> ArcPoint:
        return ArcPoint(float(self.parts[-1][0][-1]), self.parts[-1][1][-1])

    def passed(self, grid: TimeGrid, end: float) -> np.ndarray:
        """The grid's instants after the last row and before `end`."""
        first, stop = np.searchsorted(grid.t, self.last.t, "right"), np.searchsorted(grid.t, end, "left")
        return grid.t[first:stop]

    def add(self, t: np.ndarray, y: np.ndarray, branch: np.ndarray, change: Change = Change.ORDINARY) -> None:
        """Instants (n,), states (n, 2 d + 2), branches (n,)."""
        self.parts.append((t, y, branch.astype(np.int8), np.full(len(t), int(change), np.int8)))

    def trajectory(
        self, scheme: str, settings: Mapping[str, object], ending: Ending, detail: str, statistics: Mapping[str, int]
    ) -> Trajectory:
        d = len(self.start.q)
        t, y, branch, change = (np.concatenate(column) for column in zip(*self.parts, strict=True))
        counts = {b.label: int((branch[1:] == b).sum()) for b in ContactMode}
        return Trajectory(
            scheme=scheme,
            start=self.start,
            settings=settings,
            t=t,
            q=y[:, :d],
            u=y[:, d : 2 * d],
            r=np.diff(y[:, 2 * d :], axis=0, prepend=y[:1, 2 * d :]),
            branch=branch,
            change=change,
            lag=0.0,
            integrated=True,
            ending=ending,
            detail=detail,
            statistics={**counts, **statistics},
        )
