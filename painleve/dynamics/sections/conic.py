"""A contact in space with a disc or an ellipse along a trajectory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from painleve.kernels.motion.rows import MotionRows
from painleve.mechanics.sections.conic import Disc, Ellipse

__all__ = ["ConicDynamics"]


@dataclass(frozen=True)
class ConicDynamics:
    """See painleve.dynamics.sections.section."""

    section: Disc | Ellipse
    tangential: tuple[str, ...] = ("t1", "t2")
    counts_solutions: bool = False

    def least_compliance(self, at: MotionRows, rows: np.ndarray) -> np.ndarray:
        return rows[:, at.parts.edge_plus]

    def nearest_friction(
        self, at: MotionRows, rows: np.ndarray, normal: np.ndarray, friction: np.ndarray
    ) -> np.ndarray:
        """The nearest of three."""
        return _near_in_ellipses(rows[:, at.map].reshape(-1, 2, 2), normal, friction)


def _near_in_ellipses(E: np.ndarray, radius: np.ndarray, points: np.ndarray) -> np.ndarray:
    """A point (n, 2) of each ellipse E sigma, |sigma| <= radius (n,), near each point (n, 2): itself if it is inside.

    Of the point shortened and of those that are clamped along either axis the nearest: on a thin ellipse rounding
    across it shortens much, and clamping little.
    """
    axes, sizes, _ = np.linalg.svd(E)
    along = np.einsum("nji,nj->ni", axes, points)
    sigma = np.divide(along, sizes, out=np.zeros_like(along), where=sizes > 0.0)
    length = np.linalg.norm(sigma, axis=1)
    shorter = np.divide(radius, length, out=np.ones_like(length), where=length > radius)
    candidates = [sigma * shorter[:, None]]
    for kept in (0, 1):
        clamped = np.clip(sigma, -radius[:, None], radius[:, None])
        rest = np.sqrt((radius - clamped[:, kept]) * (radius + clamped[:, kept]))
        clamped[:, 1 - kept] = np.clip(sigma[:, 1 - kept], -rest, rest)
        candidates.append(clamped)
    moved = np.stack(candidates, axis=1) * sizes[:, None, :]
    best = ((moved - along[:, None, :]) ** 2).sum(axis=2).argmin(axis=1)
    return np.asarray(np.einsum("nij,nj->ni", axes, moved[np.arange(len(points)), best]))
