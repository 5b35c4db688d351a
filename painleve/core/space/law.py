"""Moreau's contact law S in space from a scene's rows, one point at a time (painleve.core.rows)."""

from painleve._jit import jit
from painleve.core.law import FREE
from painleve.core.rows import row_layout
from painleve.core.space.steps import conic_problem, contact_velocity, polygon_problem


@jit
def conic_law_from_rows(rows, dimension, v, result):
    """S(q, v) into `result` with a disc or an ellipse for the friction section; returns the branch."""
    v_n, v_1, v_2 = contact_velocity(rows, dimension, v)
    if _is_free(rows, v_n, v, result):
        return FREE
    r_n, r_1, r_2, branch = conic_problem(rows, dimension, v_n, v_1, v_2)
    _add_impulse(rows, dimension, r_n, r_1, r_2, result)
    return branch


@jit
def polygon_law_from_rows(rows, dimension, vertices, v, result):
    """S(q, v) into `result` with a polygon of that many vertices for the friction section; returns the branch."""
    v_n, v_1, v_2 = contact_velocity(rows, dimension, v)
    if _is_free(rows, v_n, v, result):
        return FREE
    r_n, r_1, r_2, branch = polygon_problem(rows, dimension, vertices, v_n, v_1, v_2)
    _add_impulse(rows, dimension, r_n, r_1, r_2, result)
    return branch


@jit
def _is_free(rows, v_n, v, result):
    """Whether there is no contact, or v does not point into it; `result` becomes v."""
    for j in range(v.size):
        result[j] = v[j]
    return rows[row_layout(v.size, 2).g] < 0.0 or v_n >= 0.0


@jit
def _add_impulse(rows, d, r_n, r_1, r_2, result):
    at = row_layout(d, 2)
    for j in range(d):
        result[j] += rows[at.Y_n + j] * r_n + rows[at.Y_t + j] * r_1 + rows[at.Y_t + d + j] * r_2
