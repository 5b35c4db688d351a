"""S(q0 + dq, u- + dv) relative to the limit set in space with a polygon, without cancellation.

The impulse is split as in painleve.core.space.offset. On an edge of the section r = x_i (1, s_i) + x_j (1, s_j), and
two linear equations determine x: the normal velocity vanishes, p_i x_i + p_j x_j = nu, and the tip's velocity c is
orthogonal to T = p_j s_i - p_i s_j, the direction in which r_t may move. Where the jump's impulse is on that edge it
solves them at the base state, so that x minus its coefficients solves them with small right-hand sides. On the vertex
on which gamma vanishes tau = x_i / (that of the jump), and the rest is the turn of s_i.
"""

from typing import NamedTuple

import numpy as np

from painleve._jit import jit
from painleve.core.law import FREE, STICK
from painleve.core.space.offset import stick_change
from painleve.core.space.polygon_law import nearest_edge, sticks


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
def polygon_split(
    hit,
    a,
    b_1,
    b_2,
    C_11,
    C_12,
    C_22,
    da,
    db_1,
    db_2,
    dC_11,
    dC_12,
    dC_22,
    p,
    s_1,
    s_2,
    dp,
    ds_1,
    ds_2,
    v_n,
    dv_1,
    dv_2,
    base,
    critical,
):
    """(branch, tau, e_n, e_1, e_2) at an offset state.

    p, s_1, s_2: of the vertices, with their differences from the base state, as tuples; `critical`: the vertex (from 1)
    on which gamma = 0 at the base state if there is a jump, else 0; else as for painleve.core.space.offset.conic_split.
    """
    if not hit:
        return FREE, 0.0, 0.0, 0.0, 0.0
    Q_11, Q_12, Q_22 = C_11 - b_1 * b_1 / a, C_12 - b_1 * b_2 / a, C_22 - b_2 * b_2 / a
    e_n, e_1, e_2 = stick_change(
        a, b_1, b_2, Q_11, Q_12, Q_22, da, db_1, db_2, dC_11, dC_12, dC_22, v_n, dv_1, dv_2, base
    )
    X, Y = base.stick_1 + e_1, base.stick_2 + e_2
    corners = np.empty((len(p), 2))
    for k in range(len(p)):
        corners[k, 0], corners[k, 1] = s_1[k], s_2[k]
    i, j, x_i, x_j, branch = 0, 0, 0.0, 0.0, STICK
    if not sticks(corners, p, -v_n, X, Y, 1.0):
        # the energy's linear part, that of least energy being at (X, Y)
        w_1, w_2 = -(Q_11 * X + Q_12 * Y), -(Q_12 * X + Q_22 * Y)
        i, j, x_i, x_j, branch = nearest_edge(corners, p, Q_11, Q_12, Q_22, w_1, w_2, -v_n, X, Y, 1.0)
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
