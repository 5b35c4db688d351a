"""The points of the outline that the contact does not hold up: how far below the floor they are."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from painleve.dynamics.start import Start

__all__ = ["allowed_depth", "depth_rounding", "depth_through", "start_notes", "where_through"]

ROUNDING = 1e-9  # of a depth, relative to 1 m and the depths at the start: far above rounding, far below a picture


def depth_rounding(start: Start) -> float:
    """How deep a point may be for rounding's sake (m)."""
    depths = np.array(start.motion.depths_at(start.q, start.p))
    return ROUNDING * (1.0 + float(np.abs(depths[np.isfinite(depths)]).max(initial=0.0)))


def allowed_depth(start: Start) -> float:
    """How deep a point may be (m): as deep as the deepest is at the start already, or as rounding makes it."""
    deepest = max(start.motion.depths_at(start.q, start.p))
    return depth_rounding(start) + max(0.0, deepest) if deepest > -math.inf else math.inf


def start_notes(start: Start) -> tuple[str, ...]:
    """What to know of a motion from this start: what put it on the contact, and what of the body is watched."""
    found = [f"the start was put on the contact: {start.projected}"] if start.projected else []
    deepest = max(start.motion.depths_at(start.q, start.p))
    if start.scene.outline is None:
        found.append("without an outline nothing but the contact point is kept above the floor")
    elif deepest > depth_rounding(start):
        found.append(
            f"at the start the outline is {deepest:.3g} m below the floor: only what goes deeper ends the motion"
        )
    return tuple(found)


def depth_through(start: Start, q: Sequence[float] | np.ndarray) -> float:
    """By how much the deepest point is below the floor and below the contact point (m); -inf where there is none."""
    at = tuple(map(float, q))
    return max(start.motion.depths_at(at, start.p)) - max(0.0, start.motion.rows_at(at, start.p)[0])


def where_through(start: Start, t: float, q: Sequence[float] | np.ndarray) -> str:
    """Which point is deepest, how deep, and when, counted from 1 as the outline has them."""
    outline, depths = start.scene.outline, start.motion.depths_at(tuple(map(float, q)), start.p)
    assert outline is not None
    deepest = int(np.argmax(depths))
    point = list(outline.depths(start.scene.contact.constraint))[deepest]
    return f"point {point + 1} of the outline is {depths[deepest]:.3g} m below the floor at t = {t:.9g}"
