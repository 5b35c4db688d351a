"""The rows of a scene's motion: those of its law, and in space also what makes impulses physical.

The law in space takes discs and ellipses as the unit disc (painleve.core.rows). A trajectory gives impulses in the
scene's own tangents H, which cannot be found from H E where a coefficient of friction vanishes. So these follow:
    H_1 (d), H_2 (d), M^-1 H_1 (d), M^-1 H_2 (d), E_11, E_12, E_21, E_22          (E = 1 for a polygon)
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from painleve.kernels.rows import Rows, rows_of
from painleve.mechanics.derive import Derivation
from painleve.mechanics.friction import Polygon

__all__ = ["motion_rows"]


def motion_rows(derivation: Derivation) -> Rows:
    """The rows of a scene's motion in their fixed order; `varying` tells of those of the law alone."""
    rows, scene = rows_of(derivation), derivation.scene
    if scene.friction_dimension < 2:
        return rows
    E = sp.eye(2) if isinstance(scene.friction, Polygon) else scene.friction.map  # type: ignore[union-attr]
    axes = [c.name for c in scene.coordinates]
    names = [f"{what}_{k}_{x}" for what in ("tangent", "response") for k in (1, 2) for x in axes]
    columns = [m[:, k] for m in (scene.tangents, derivation.tangent_response) for k in range(2)]
    return replace(
        rows,
        names=(*rows.names, *names, "E_11", "E_12", "E_21", "E_22"),
        expressions=(*rows.expressions, *(x for column in columns for x in column), *E),
    )
