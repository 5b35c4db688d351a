"""A contact with planar friction along a trajectory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from painleve.kernels.motion.rows import MotionRows
from painleve.mechanics.sections.segment import Segment

__all__ = ["SegmentDynamics"]


@dataclass(frozen=True)
class SegmentDynamics:
    """See painleve.dynamics.sections.section."""

    section: Segment
    tangential: tuple[str, ...] = ("t",)
    counts_solutions: bool = True

    def least_compliance(self, at: MotionRows, rows: np.ndarray) -> np.ndarray:
        edge_minus = rows[:, at.parts.section][:, 0]
        return np.minimum(rows[:, at.parts.edge_plus], edge_minus)

    def nearest_friction(
        self, at: MotionRows, rows: np.ndarray, normal: np.ndarray, friction: np.ndarray
    ) -> np.ndarray:
        """The nearest one."""
        _, mu_plus, mu_minus = rows[:, at.parts.section].T
        return np.clip(friction, (-mu_minus * normal)[:, None], (mu_plus * normal)[:, None])
