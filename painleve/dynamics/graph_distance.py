"""How far apart two velocities are, as graphs in (t, u): a jump shifted by one step costs a step and not its height.

The graph of a velocity is the polyline through (t_i, u_i). Where one instant stands twice, a vertical segment fills in
the jump between the two velocities; a jump within a step is filled in by a segment that leans over by that step. The
distance is that of Hausdorff, as docs/theory.md, section 7, takes it from M. D. P. Monteiro Marques, Differential
Inclusions in Nonsmooth Mechanical Problems, 1993, and V. Acary; the Euclidean norm adds seconds and velocities as they
come, in the units of the scene.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from painleve.core.graph_excess import supremum
from painleve.errors import InputError
from painleve.sets import Bounds, Excess, Hausdorff
from painleve.sets.point_sets import LARGEST_COORDINATE, FloatArray

__all__ = ["graph_distance", "velocity_graph"]

WIDTH = 1e-3  # relative width at which a supremum over a polyline is enclosed well enough
ROUNDING = 1e-15  # relative to the largest coordinate: distances below it are rounding


def velocity_graph(t: ArrayLike, u: ArrayLike) -> FloatArray:
    """Vertices (n, 1 + d) of the graph, from instants t (n,) that do not decrease and velocities u (n, d), n >= 2.

    Raises InputError for other shapes, instants that decrease, and numbers that are not finite.
    """
    instants, velocities = np.asarray(t, float), np.asarray(u, float)
    if instants.ndim != 1 or len(instants) < 2 or velocities.ndim != 2 or len(velocities) != len(instants):
        raise InputError(
            f"graph: t, u have shapes {instants.shape}, {velocities.shape}; give (n,) and (n, d) with n >= 2"
        )
    vertices = np.column_stack([instants, velocities])
    if not np.all(np.abs(vertices) <= LARGEST_COORDINATE):
        raise InputError("graph: an instant or a velocity is NaN, infinite or too large to square")
    if np.any(np.diff(instants) < 0.0):
        raise InputError("graph: instants decrease; sort them")
    return vertices


def graph_distance(X: FloatArray, Y: FloatArray) -> Hausdorff:
    """Both excesses between two graphs of `velocity_graph`, each enclosed to a relative width of 1e-3 or to rounding.

    The distance to one segment is convex, hence over a piece of the other graph at most its larger value at the two
    ends; pieces for which this does not settle the supremum are halved.
    Raises InputError where the velocities have different dimensions.
    """
    if X.shape[1] != Y.shape[1]:
        raise InputError(f"graphs: velocities of dimension {X.shape[1] - 1} and {Y.shape[1] - 1}; give the same one")
    return Hausdorff(forward=_excess(X, Y), backward=_excess(Y, X))


def _excess(X: FloatArray, Y: FloatArray) -> Excess:
    tiny = ROUNDING * max(1.0, float(np.abs(X).max()), float(np.abs(Y).max()))
    point, foot = np.empty(X.shape[1]), np.empty(X.shape[1])
    lower, upper = supremum(X, Y, WIDTH, tiny, point, foot)
    return Excess(bounds=Bounds.between(lower, upper), attained_at=point, nearest=foot)
