"""The law in space with a convex polygon for the section, from the rows.

Relative to the limit set the impulse is split as in painleve.core.sections.conic. On an edge of the section
r = x_i (1, s_i) + x_j (1, s_j), and two linear equations determine x: the normal velocity vanishes,
p_i x_i + p_j x_j = nu, and the tip's velocity c is orthogonal to T = p_j s_i - p_i s_j, the direction in which r_t may
move. Where the jump's impulse is on that edge it solves them at the base state, so that x minus its coefficients solves
them with small right-hand sides. On the vertex on which gamma vanishes tau = x_i / (that of the jump), and the rest is
the turn of s_i.
"""

from typing import NamedTuple

import numpy as np

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.rows import row_layout
from painleve.core.space.from_rows import change_of, contact_velocity, moved
from painleve.core.space.offset import reduced_compliance, stick_change
from painleve.core.space.polygon_law import nearest_edge, polygon_impulse, sticks
from painleve.core.space.tangent_plane import TangentEnergy, delassus_at

__all__ = [
    "PolygonBase",
    "PolygonCorners",
    "PolygonRows",
    "contact_velocity",
    "impulse",
    "kind_of_change",
    "law_from_rows",
    "polygon_rows",
    "split",
]

FREE, STICK = int(ContactMode.FREE), int(ContactMode.STICK)


class PolygonRows(NamedTuple):
    """Where the rows begin that a polygon of n vertices s_i adds: p_i = a + b.s_i (n), then s_1, ..., s_n (2 each)."""

    p: int
    s: int


class PolygonCorners(NamedTuple):
    """p_i and the two components of s_i for each vertex, as tuples, which cost no allocation."""

    p: tuple[float, ...]
    s_1: tuple[float, ...]
    s_2: tuple[float, ...]


class PolygonBase(NamedTuple):
    """The base state, each number correctly rounded.

    stick: the sticking impulse; jump: that of the jump (0: there is none); after: the tip's velocity after it.
    first, second: the vertices (from 0) on whose edge it lies, with its coefficients x_first, x_second; first = second
    on a vertex, -1 within the cone or without a jump. jump_sticks: whether the jump ends in sticking.
    """

    stick_n: float
    stick_1: float
    stick_2: float
    jump_n: float
    jump_1: float
    jump_2: float
    after_1: float
    after_2: float
    first: int
    second: int
    x_first: float
    x_second: float
    jump_sticks: bool


@jit
def polygon_rows(layout, vertices):
    """Where the rows of a polygon of that many vertices are."""
    return PolygonRows(layout.section, layout.section + vertices)


@jit
def impulse(rows, d, count, velocity, bias):
    """((r_n, r_1, r_2), branch) where there is contact."""
    at, (v_n, v_1, v_2) = row_layout(d, 2), velocity
    own = polygon_rows(at, count)
    vertices, compliances = np.empty((count, 2)), np.empty(count)
    for i in range(count):
        compliances[i] = rows[own.p + i]
        vertices[i, 0], vertices[i, 1] = rows[own.s + 2 * i], rows[own.s + 2 * i + 1]
    r_n, r_1, r_2, branch = polygon_impulse(delassus_at(rows, at), vertices, compliances, (v_n + bias, v_1, v_2))
    return (r_n, r_1, r_2), branch


@jit
def law_from_rows(rows, d, count, v, result):
    """S(q, v) into `result` from the rows at q; returns the branch."""
    velocity = contact_velocity(rows, d, v)
    for j in range(d):
        result[j] = v[j]
    if rows[row_layout(d, 2).g] < 0.0 or velocity[0] >= 0.0:
        return FREE
    r, branch = impulse(rows, d, count, velocity, 0.0)
    moved(rows, d, r, result)
    return branch


@jit
def split(hit, G, change, corners, moved_corners, dv, base, critical):
    """(branch, tau, e_n, e_1, e_2) at an offset state.

    `corners`: PolygonCorners, and their differences from the base state; `critical`: the vertex (from 1) on which gamma
    = 0 at the base state if there is a jump, else 0; the rest as for painleve.core.sections.conic.
    """
    if not hit:
        return FREE, 0.0, 0.0, 0.0, 0.0
    v_n, dv_1, dv_2 = dv
    p, s_1, s_2 = corners
    dp, ds_1, ds_2 = moved_corners
    Q_11, Q_12, Q_22 = reduced_compliance(G)
    e_n, e_1, e_2 = stick_change(G, (Q_11, Q_12, Q_22), change, dv, base)
    X, Y = base.stick_1 + e_1, base.stick_2 + e_2
    vertices = np.empty((len(p), 2))
    for k in range(len(p)):
        vertices[k, 0], vertices[k, 1] = s_1[k], s_2[k]
    i, j, x_i, x_j, branch = 0, 0, 0.0, 0.0, STICK
    if not sticks(vertices, p, -v_n, (X, Y, 1.0)):
        # the energy's linear part, that of least energy being at (X, Y)
        energy = TangentEnergy(Q_11, Q_12, Q_22, -(Q_11 * X + Q_12 * Y), -(Q_12 * X + Q_22 * Y))
        i, j, x_i, x_j, branch = nearest_edge(vertices, p, energy, -v_n, (X, Y, 1.0))
    if branch == STICK:
        if base.jump_sticks:
            return STICK, 1.0, e_n, e_1, e_2
        return STICK, 0.0, base.stick_n + e_n, X, Y
    if critical == i + 1 and x_j == 0.0:
        return branch, x_i / base.jump_n, 0.0, x_i * ds_1[i], x_i * ds_2[i]
    if critical == j + 1 and x_i == 0.0:
        return branch, x_j / base.jump_n, 0.0, x_j * ds_1[j], x_j * ds_2[j]
    start_i, start_j = _start(base, i), _start(base, j)
    if base.first < 0 or start_i + start_j == 0.0 or x_i * x_j == 0.0 or not _holds(base, i, j):
        return branch, 0.0, x_i + x_j, x_i * s_1[i] + x_j * s_1[j], x_i * s_2[i] + x_j * s_2[j]
    _, b_1, b_2, C_11, C_12, C_22 = G
    _, db_1, db_2, dC_11, dC_12, dC_22 = change
    # the right-hand sides
    T_1, T_2 = p[j] * s_1[i] - p[i] * s_1[j], p[j] * s_2[i] - p[i] * s_2[j]
    dT_1 = dp[j] * s_1[i] + (p[j] - dp[j]) * ds_1[i] - dp[i] * s_1[j] - (p[i] - dp[i]) * ds_1[j]
    dT_2 = dp[j] * s_2[i] + (p[j] - dp[j]) * ds_2[i] - dp[i] * s_2[j] - (p[i] - dp[i]) * ds_2[j]
    m_1, m_2 = start_i * ds_1[i] + start_j * ds_1[j], start_i * ds_2[i] + start_j * ds_2[j]
    c_1 = dv_1 + db_1 * base.jump_n + dC_11 * base.jump_1 + dC_12 * base.jump_2 + C_11 * m_1 + C_12 * m_2
    c_2 = dv_2 + db_2 * base.jump_n + dC_12 * base.jump_1 + dC_22 * base.jump_2 + C_12 * m_1 + C_22 * m_2
    right_n = -v_n - dp[i] * start_i - dp[j] * start_j
    right_t = -(dT_1 * base.after_1 + dT_2 * base.after_2) - (T_1 * c_1 + T_2 * c_2)
    k_1, k_2 = T_1 * C_11 + T_2 * C_12, T_1 * C_12 + T_2 * C_22
    along = T_1 * b_1 + T_2 * b_2
    k_i, k_j = along + k_1 * s_1[i] + k_2 * s_2[i], along + k_1 * s_1[j] + k_2 * s_2[j]
    determinant = p[i] * k_j - p[j] * k_i
    y_i = (right_n * k_j - p[j] * right_t) / determinant
    y_j = (p[i] * right_t - right_n * k_i) / determinant
    return branch, 1.0, y_i + y_j, y_i * s_1[i] + y_j * s_1[j] + m_1, y_i * s_2[i] + y_j * s_2[j] + m_2


@jit
def _start(base, i):
    """The jump's coefficient on vertex i."""
    return base.x_first if base.first == i else base.x_second if base.second == i else 0.0


@jit
def _holds(base, i, j):
    """Whether the jump's impulse is on the edge between the vertices i and j."""
    return (base.first == i or base.first == j) and (base.second == i or base.second == j)


@jit
def kind_of_change(rows, d, count, velocity, r, branch, free, since, speed):
    """free: the free change of the step; since: steps since the last contact, this one included."""
    edge = opposing_edge(rows, d, count, velocity[1], velocity[2])
    return change_of(rows, d, velocity[0], edge, r, branch, free, since, speed)


@jit
def opposing_edge(rows, d, count, v_1, v_2):
    """As for a conic: v_t.s is least at a vertex of the part with a + b.s <= 0."""
    at = row_layout(d, 2)
    own, a = polygon_rows(at, count), rows[at.a]
    least, lowered = a, False
    for i in range(count):
        j = (i + 1) % count
        p, p_next = rows[own.p + i], rows[own.p + j]
        s, s_next = own.s + 2 * i, own.s + 2 * j
        slope, slope_next = v_1 * rows[s] + v_2 * rows[s + 1], v_1 * rows[s_next] + v_2 * rows[s_next + 1]
        least = min(least, p)
        if p <= 0.0 and slope < 0.0:
            lowered = True
        if min(p, p_next) < 0.0 < max(p, p_next) and (p * slope_next - p_next * slope) * (p - p_next) < 0.0:
            lowered = True
    return least if lowered else a
