"""A contact in space with a polygon along a trajectory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from painleve.kernels.motion.rows import MotionRows
from painleve.mechanics.sections.polygon import Polygon

__all__ = ["PolygonDynamics"]


@dataclass(frozen=True)
class PolygonDynamics:
    """See painleve.dynamics.sections.section."""

    section: Polygon
    tangential: tuple[str, ...] = ("t1", "t2")
    counts_solutions: bool = False

    def least_compliance(self, at: MotionRows, rows: np.ndarray) -> np.ndarray:
        return np.asarray(rows[:, at.parts.section][:, : len(self.section.vertices)].min(axis=1))

    def nearest_friction(
        self, at: MotionRows, rows: np.ndarray, normal: np.ndarray, friction: np.ndarray
    ) -> np.ndarray:
        """The nearest one."""
        n = len(self.section.vertices)
        vertices = rows[:, at.parts.section][:, n:].reshape(-1, n, 2) * normal[:, None, None]
        return _nearest_in_polygons(vertices, friction)


def _nearest_in_polygons(vertices: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The nearest point (n, 2) of each convex polygon (n, m, 2), counterclockwise, to each point (n, 2)."""
    along = np.roll(vertices, -1, axis=1) - vertices
    offset = points[:, None, :] - vertices
    squared = (along**2).sum(axis=2)
    part = np.divide((offset * along).sum(axis=2), squared, out=np.zeros_like(squared), where=squared > 0.0)
    candidates = vertices + np.clip(part, 0.0, 1.0)[..., None] * along
    best = ((candidates - points[:, None, :]) ** 2).sum(axis=2).argmin(axis=1)
    turns = along[..., 0] * offset[..., 1] - along[..., 1] * offset[..., 0]
    inside = (turns >= 0.0).all(axis=1) & (turns > 0.0).any(axis=1)
    return np.where(inside[:, None], points, candidates[np.arange(len(points)), best])
