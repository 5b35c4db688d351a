"""The rows of a scene's motion: those of its law, and in space also what makes impulses physical.

The law in space takes discs and ellipses as the unit disc (painleve.core.rows). A trajectory gives impulses in the
scene's own tangents H, which cannot be found from H E where a coefficient of friction vanishes. So these follow:
    H_1 (d), H_2 (d), M^-1 H_1 (d), M^-1 H_2 (d), E_11, E_12, E_21, E_22          (E = 1 for a polygon)
"""

from __future__ import annotations

from dataclasses import dataclass

from painleve.kernels.rows import Rows, rows_of
from painleve.kernels.sections.listed import kernels_of
from painleve.mechanics.derive import Derivation

__all__ = ["MotionRows", "motion_rows"]


@dataclass(frozen=True, kw_only=True, eq=False)
class MotionRows(Rows):
    """`directions` and `responses` are H and M^-1 H in the scene's own tangents, one tangent after the other; `map` is
    E, row by row, where the tangents of the law are others, else empty."""

    directions: tuple[slice, ...]
    responses: tuple[slice, ...]
    map: slice


def motion_rows(derivation: Derivation) -> MotionRows:
    """The rows of a scene's motion in their fixed order; `varying` tells of those of the law alone."""
    rows, scene = rows_of(derivation), derivation.scene
    own, end = kernels_of(scene.contact).own_tangents(derivation), len(rows.names)
    if own is None:
        at = rows.parts
        return MotionRows(**vars(rows), directions=at.H, responses=at.Y_t, map=slice(end, end))
    H, Y, E = own
    axes, k, d = [c.name for c in scene.coordinates], H.cols, scene.dimension
    names = [f"{what}_{j + 1}_{x}" for what in ("tangent", "response") for j in range(k) for x in axes]
    names += [f"E_{i + 1}{j + 1}" for i in range(k) for j in range(k)]
    columns = [slice(end + j * d, end + (j + 1) * d) for j in range(2 * k)]
    return MotionRows(
        names=(*rows.names, *names),
        expressions=(*rows.expressions, *(x for m in (H, Y) for j in range(k) for x in m[:, j]), *E),
        parts=rows.parts,
        edges=rows.edges,
        varying=rows.varying,
        directions=tuple(columns[:k]),
        responses=tuple(columns[k:]),
        map=slice(end + 2 * k * d, end + 2 * k * d + k * k),
    )
