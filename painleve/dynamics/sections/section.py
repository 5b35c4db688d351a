"""What the dynamics ask of a friction section, of rows that are tabulated along a trajectory."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from painleve.kernels.motion.rows import MotionRows

__all__ = ["SectionDynamics"]


class SectionDynamics(Protocol):
    """A contact with this section along a trajectory; rows: (n, number of rows)."""

    @property
    def tangential(self) -> tuple[str, ...]:
        """How datasets tell the tangential components apart: v_<name> and r_<name>."""

    @property
    def counts_solutions(self) -> bool:
        """Whether what else solves Coulomb's law in a step is counted."""

    def least_compliance(self, at: MotionRows, rows: np.ndarray) -> np.ndarray:
        """gamma |grad g|^2, (n,)."""

    def nearest_friction(
        self, at: MotionRows, rows: np.ndarray, normal: np.ndarray, friction: np.ndarray
    ) -> np.ndarray:
        """A friction impulse (n, k) near the given one that the normal impulse (n,) admits: itself where it does."""
