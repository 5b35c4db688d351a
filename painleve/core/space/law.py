"""Moreau's contact law S in space from a scene's rows, one point at a time (layout: painleve.kernels.rows)."""

import numpy as np

from painleve._jit import jit
from painleve.core.law import FREE
from painleve.core.space.conic_law import disc_impulse
from painleve.core.space.polygon_law import polygon_impulse


@jit
def conic_law_from_rows(rows, dimension, v, result):
    """S(q, v) into `result` with a disc or an ellipse for the friction section; returns the branch."""
    d, tail = dimension, 3 + 6 * dimension
    if _is_free(rows, d, v, result):
        return FREE
    v_n, v_1, v_2 = _velocity(rows, d, v, 1), _velocity(rows, d, v, 3 + 2 * d), _velocity(rows, d, v, 3 + 3 * d)
    r_n, r_1, r_2, branch = disc_impulse(
        rows[1 + 2 * d],
        rows[2 + 2 * d],
        rows[tail],
        rows[tail + 1],
        rows[tail + 2],
        rows[tail + 3],
        rows[tail + 4],
        v_n,
        v_1,
        v_2,
    )
    _add_impulse(rows, d, r_n, r_1, r_2, result)
    return branch


@jit
def polygon_law_from_rows(rows, dimension, vertices, v, result):
    """S(q, v) into `result` with a polygon of that many vertices for the friction section; returns the branch."""
    d, tail = dimension, 3 + 6 * dimension
    if _is_free(rows, d, v, result):
        return FREE
    v_n, v_1, v_2 = _velocity(rows, d, v, 1), _velocity(rows, d, v, 3 + 2 * d), _velocity(rows, d, v, 3 + 3 * d)
    corners, compliances = np.empty((vertices, 2)), np.empty(vertices)
    for i in range(vertices):
        compliances[i] = rows[tail + 5 + i]
        corners[i, 0], corners[i, 1] = rows[tail + 5 + vertices + 2 * i], rows[tail + 6 + vertices + 2 * i]
    r_n, r_1, r_2, branch = polygon_impulse(
        rows[1 + 2 * d],
        rows[tail],
        rows[tail + 1],
        rows[tail + 2],
        rows[tail + 3],
        rows[tail + 4],
        corners,
        compliances,
        v_n,
        v_1,
        v_2,
    )
    _add_impulse(rows, d, r_n, r_1, r_2, result)
    return branch


@jit
def _is_free(rows, d, v, result):
    """Whether there is no contact, or v does not point into it; `result` becomes v."""
    for j in range(d):
        result[j] = v[j]
    return rows[0] < 0.0 or _velocity(rows, d, v, 1) >= 0.0


@jit
def _velocity(rows, d, v, first):
    total = 0.0
    for j in range(d):
        total += rows[first + j] * v[j]
    return total


@jit
def _add_impulse(rows, d, r_n, r_1, r_2, result):
    for j in range(d):
        result[j] += rows[1 + d + j] * r_n + rows[3 + 4 * d + j] * r_1 + rows[3 + 5 * d + j] * r_2
