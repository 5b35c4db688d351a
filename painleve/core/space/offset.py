"""The split of impulses in space that both sections share, relative to the limit set."""

from painleve._jit import jit
from painleve.core.space.tangent_plane import SMALLEST, UP


@jit
def reduced_compliance(G):
    """(Q_11, Q_12, Q_22) of Q = C - b b^T/a."""
    a, b_1, b_2, C_11, C_12, C_22 = G
    return C_11 - b_1 * b_1 / a, C_12 - b_1 * b_2 / a, C_22 - b_2 * b_2 / a


@jit
def stick_change(G, Q, change, dv, base):
    """How the sticking impulse differs from the base state's, whose contact velocity it leaves no longer at zero."""
    (Q_11, Q_12, Q_22), (v_n, dv_1, dv_2) = Q, dv
    n = v_n + change.a * base.stick_n + change.b_1 * base.stick_1 + change.b_2 * base.stick_2
    t_1 = dv_1 + change.b_1 * base.stick_n + change.C_11 * base.stick_1 + change.C_12 * base.stick_2 - G.b_1 * (n / G.a)
    t_2 = dv_2 + change.b_2 * base.stick_n + change.C_12 * base.stick_1 + change.C_22 * base.stick_2 - G.b_2 * (n / G.a)
    if max(Q_11, Q_22) < SMALLEST:  # Q is of the size of mu^2: its determinant would vanish
        Q_11, Q_12, Q_22, t_1, t_2 = UP * Q_11, UP * Q_12, UP * Q_22, UP * t_1, UP * t_2
    determinant = Q_11 * Q_22 - Q_12 * Q_12
    e_1, e_2 = (Q_12 * t_2 - Q_22 * t_1) / determinant, (Q_12 * t_1 - Q_11 * t_2) / determinant
    return -(n + G.b_1 * e_1 + G.b_2 * e_2) / G.a, e_1, e_2
