"""Rows of a trajectory that an adaptive integrator produces: on the grid, and twice at every event."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from painleve.core.codes import Branch
from painleve.core.motion_codes import Change, Ending
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory

__all__ = ["Recorder"]


class Recorder:
    """Collects (t, y), y = (q, u, impulses since the start), with the branch and the change up to there."""

    def __init__(self, start: Start) -> None:
        self.start = start
        first = np.concatenate([start.q, start.u, [0.0, 0.0]])
        self.t, self.y = [np.array([start.t])], [first[None, :]]
        self.branch, self.change = [np.array([0], np.int8)], [np.array([0], np.int8)]

    @property
    def last(self) -> np.ndarray:
        return self.y[-1][-1]

    def add(self, t: np.ndarray, y: np.ndarray, branch: np.ndarray, change: Change = Change.ORDINARY) -> None:
        """Instants (n,), states (n, 2 d + 2), branches (n,)."""
        self.t.append(t)
        self.y.append(y)
        self.branch.append(branch.astype(np.int8))
        self.change.append(np.full(len(t), int(change), np.int8))

    def trajectory(
        self, scheme: str, settings: Mapping[str, object], ending: Ending, detail: str, statistics: Mapping[str, int]
    ) -> Trajectory:
        d = len(self.start.q)
        y = np.concatenate(self.y)
        branch = np.concatenate(self.branch)
        counts = {b.label: int((branch[1:] == b).sum()) for b in Branch}
        return Trajectory(
            scheme=scheme, start=self.start, settings=settings, t=np.concatenate(self.t), q=y[:, :d],
            u=y[:, d : 2 * d], r=np.diff(y[:, 2 * d :], axis=0, prepend=y[:1, 2 * d :]), branch=branch,
            change=np.concatenate(self.change), lag=0.0, ending=ending, detail=detail,
            statistics={**counts, **statistics},
        )  # fmt: skip
