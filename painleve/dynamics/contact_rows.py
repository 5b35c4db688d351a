"""What the rows of a motion, tabulated along a trajectory, say of its contact: W, M^-1 W, gamma and the cone."""

from __future__ import annotations

import numpy as np

from painleve.dynamics.sections.listed import dynamics_of
from painleve.kernels.motion.compiled import Motion

__all__ = ["directions", "gamma_along", "nearest_impulse", "responses", "tangential_names"]


def tangential_names(motion: Motion) -> tuple[str, ...]:
    """How datasets tell the tangential components apart: v_t and r_t, or in space v_t1, v_t2, r_t1 and r_t2."""
    return dynamics_of(motion.scene.contact).tangential


def directions(motion: Motion, rows: np.ndarray) -> list[np.ndarray]:
    """The columns of W, (n, d) each, from rows (n, number of rows): the normal and the scene's own tangents."""
    return [rows[:, part] for part in (motion.rows.parts.w_n, *motion.rows.directions)]


def responses(motion: Motion, rows: np.ndarray) -> list[np.ndarray]:
    """The columns of M^-1 W, (n, d) each."""
    return [rows[:, part] for part in (motion.rows.parts.Y_n, *motion.rows.responses)]


def gamma_along(motion: Motion, rows: np.ndarray) -> np.ndarray:
    """gamma (n,), the least normal compliance over |grad g|^2 (docs/theory.md, section 1)."""
    least = dynamics_of(motion.scene.contact).least_compliance(motion.rows, rows)
    return np.asarray(least / (rows[:, motion.rows.parts.w_n] ** 2).sum(axis=1))


def nearest_impulse(motion: Motion, rows: np.ndarray, impulse: np.ndarray) -> np.ndarray:
    """An impulse (n, 1 + k) of the friction cone near the given one: itself where that is in the cone.

    The normal part is max(r_n, 0). The tangential part is the nearest one in the plane and for polygons, and for discs
    and ellipses the nearest of three.
    """
    normal = np.maximum(impulse[:, 0], 0.0)
    friction = dynamics_of(motion.scene.contact).nearest_friction(motion.rows, rows, normal, impulse[:, 1:])
    return np.column_stack([normal, friction])
