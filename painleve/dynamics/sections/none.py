"""A contact without friction along a trajectory; files have a column of zeros for its friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from painleve.kernels.motion.rows import MotionRows
from painleve.mechanics.sections.none import NoFriction

__all__ = ["NoFrictionDynamics"]


@dataclass(frozen=True)
class NoFrictionDynamics:
    """See painleve.dynamics.sections.section."""

    section: NoFriction
    tangential: tuple[str, ...] = ("t",)
    counts_solutions: bool = True

    def least_compliance(self, at: MotionRows, rows: np.ndarray) -> np.ndarray:
        return rows[:, at.parts.a]

    def nearest_friction(
        self, at: MotionRows, rows: np.ndarray, normal: np.ndarray, friction: np.ndarray
    ) -> np.ndarray:
        return friction
