"""What the rows of a motion, tabulated along a trajectory, say of its contact: W, M^-1 W, gamma and the cone."""

from __future__ import annotations

import numpy as np

from painleve.kernels.motion.compiled import Motion
from painleve.mechanics.friction import Polygon

__all__ = ["directions", "gamma_along", "nearest_impulse", "responses", "tangential_names"]


def tangential_names(motion: Motion) -> tuple[str, ...]:
    """How datasets tell the tangential components apart: v_t and r_t, or in space v_t1, v_t2, r_t1 and r_t2."""
    return ("t1", "t2") if motion.scene.friction_dimension > 1 else ("t",)


def directions(motion: Motion, rows: np.ndarray) -> list[np.ndarray]:
    """The columns of W, (n, d) each, from rows (n, number of rows): the normal and the scene's own tangents."""
    d, k = motion.scene.dimension, motion.scene.friction_dimension
    first = motion.rows.index("E_11") - 4 * d if k > 1 else 3 + 2 * d
    return [rows[:, 1 : 1 + d], *(rows[:, first + j * d : first + (j + 1) * d] for j in range(k))]


def responses(motion: Motion, rows: np.ndarray) -> list[np.ndarray]:
    """The columns of M^-1 W, (n, d) each."""
    d, k = motion.scene.dimension, motion.scene.friction_dimension
    first = motion.rows.index("E_11") - 2 * d if k > 1 else 3 + 3 * d
    return [rows[:, 1 + d : 1 + 2 * d], *(rows[:, first + j * d : first + (j + 1) * d] for j in range(k))]


def gamma_along(motion: Motion, rows: np.ndarray) -> np.ndarray:
    """gamma (n,), the least normal compliance over |grad g|^2 (docs/theory.md, section 1)."""
    d, friction = motion.scene.dimension, motion.scene.friction
    if isinstance(friction, Polygon):
        first = motion.rows.index("p_1")
        least = rows[:, first : first + len(friction.vertices)].min(axis=1)
    elif motion.planar:
        least = np.minimum(rows[:, 2 + 2 * d], rows[:, 5 + 4 * d])
    else:
        least = rows[:, 2 + 2 * d]
    return np.asarray(least / (rows[:, 1 : 1 + d] ** 2).sum(axis=1))


def nearest_impulse(motion: Motion, rows: np.ndarray, impulse: np.ndarray) -> np.ndarray:
    """An impulse (n, 1 + k) of the friction cone near the given one: itself where that is in the cone.

    The normal part is max(r_n, 0). The tangential part is the nearest one in the plane and for polygons, and for discs
    and ellipses the nearest of three.
    """
    found, friction = np.maximum(impulse, 0.0), motion.scene.friction
    normal, given, tail = found[:, 0], impulse[:, 1:], 4 * motion.scene.dimension
    if motion.planar:
        found[:, 1] = np.clip(impulse[:, 1], -rows[:, 7 + tail] * normal, rows[:, 6 + tail] * normal)
    elif isinstance(friction, Polygon):
        first, n = motion.rows.index("s_1_1"), len(friction.vertices)
        vertices = rows[:, first : first + 2 * n].reshape(-1, n, 2) * normal[:, None, None]
        found[:, 1:] = _nearest_in_polygons(vertices, given)
    elif friction is not None:
        first = motion.rows.index("E_11")
        found[:, 1:] = _near_in_ellipses(rows[:, first : first + 4].reshape(-1, 2, 2), normal, given)
    return found


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
