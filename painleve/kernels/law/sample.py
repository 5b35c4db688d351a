"""What a scene defines for its law, for one small scene: the templates run on it where nothing is compiled.

A point of mass 1 in the plane slides with friction on the parabola y = x^2/2, as in painleve.kernels.motion.sample. Its
law depends on x alone (the shape), and y carries the contact.
"""

import numpy as np

from painleve._jit import jit
from painleve.core.sections import segment

D, SHAPE, ROWS, VARYING = 2, 1, 16, 7


@jit
def rows_at(q, p, rows):
    """The rows at the configuration q."""
    x, mu = q[0], p[0]
    a = x * x + 1.0
    rows[:6] = x * x / 2.0 - q[1], -x, 1.0, -x, 1.0, a
    rows[6:] = -mu * x + a, 1.0, 0.0, 1.0, 0.0, -x, 1.0, mu * x + a, mu, mu


@jit
def varying_block(dq, q, p, base, values):
    """g, w_x, Yn_x, a, edge_plus, b and edge_minus minus their base values."""
    rows = np.empty(ROWS)
    for i in range(values.shape[1]):
        rows_at(q + np.array([dq[0, i], 0.0]), p, rows)
        for k, r in enumerate((0, 1, 3, 5, 6, 11, 13)):
            values[k, i] = rows[r] - base[r]


@jit
def law_block(values, room, dv, state, result):
    """S relative to the limit set through a block."""
    base_n, _ = state.impulse
    _, _, _, _, _, a, edge_plus, _, _, _, _, b, C, edge_minus, mu_plus, mu_minus = state.base
    for i in range(room.size):
        dg, dw, dY, da, d_plus, db, d_minus = values[:, i]
        v_n = dw * state.u[0] + (state.base[1] + dw) * dv[0, i] + dv[1, i]
        contact = segment.SegmentContact(a + da, b + db, C, edge_plus + d_plus, edge_minus + d_minus, mu_plus, mu_minus)
        code, tau, e_n, e_t = segment.split(
            (v_n < 0.0) & (dg + room[i] >= 0.0),
            contact,
            segment.SegmentChange(da, db, 0.0, 0.0, 0.0),
            v_n,
            dv[0, i],
            state.impulse,
            state.multiplier,
            state.critical_edge,
        )
        z_0 = dv[0, i] + tau * (dY * base_n) + (state.base[3] + dY) * e_n + e_t
        z_1 = dv[1, i] + e_n
        dot = z_0 * state.direction[0] + z_1 * state.direction[1]
        z_0 -= dot * state.direction[0]
        z_1 -= dot * state.direction[1]
        result.branch[i] = code
        result.along[i] = dot + tau * state.length
        result.beyond[i] = dot + (tau - 1.0) * state.length
        result.across2[i] = z_0 * z_0 + z_1 * z_1


@jit
def law(rows, v, result):
    """S(q, v) from the rows at q."""
    return segment.law_from_rows(rows, D, v, result)
