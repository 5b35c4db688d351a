"""The law in space with a disc or an ellipse for the section, from the rows: as the unit disc.

Relative to the limit set, as in painleve.core.sections.segment, every impulse is split as r = tau r_jump + e, so that
S = u- + tau (u_tilde - u-) + z with z of the size of S - A.

The optimum is found in the frame of b, where `conic_law` gives its component across b with a small relative error,
if the sticking impulse and the slip have theirs: b x (stick) and b x (slip) are known exactly at the base state and
change by small numbers. That is what is needed

- where gamma = 0 at the base state: r_jump opposes b there, tau = r_n / (that of the jump), and e is r_n times the turn
  of r_t/r_n away from -b_0/|b_0|;
- where gamma < 0 and the jump ends in slip: r_jump is on an edge s_1 of the wedge a + b.s = 0. With r_t = r_n s,
  s = s_1 turned by alpha, and c the tip's velocity afterwards, two equations hold,
      a + b.s = nu/r_n       and       (b.s_perp) (s.c) = (nu/r_n) (s_perp.c)   (c is normal to the conic),
  and as a_0 + b_0.s_1 = 0 = s_1.c_0 they say what alpha and r_n - (that of the jump) are in terms of small numbers.
"""

import math
from typing import NamedTuple

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.rows import row_layout
from painleve.core.space.conic_law import aligned, disc_impulse
from painleve.core.space.from_rows import change_of, contact_velocity, moved
from painleve.core.space.offset import reduced_compliance, stick_change
from painleve.core.space.tangent_plane import TangentEnergy, delassus_at

__all__ = ["ConicBase", "contact_velocity", "impulse", "kind_of_change", "law_from_rows", "split"]

FREE, STICK = int(ContactMode.FREE), int(ContactMode.STICK)

NEAR = 0.3  # rad, and relative: how near to the edge of the wedge the second split is used
NEWTON_STEPS = 3  # from a start that is right to rounding


class ConicBase(NamedTuple):
    """The base state in the coordinates of the unit disc, each number correctly rounded.

    stick: the sticking impulse; jump: that of the jump (0: there is none); slip: the tip's velocity; slip_across and
    stick_across: b x slip and b x stick; after_across: s_perp . (the tip's velocity after the jump), s = jump_t/jump_n;
    jump_sticks: whether the jump ends in sticking.
    """

    stick_n: float
    stick_1: float
    stick_2: float
    jump_n: float
    jump_1: float
    jump_2: float
    slip_1: float
    slip_2: float
    slip_across: float
    stick_across: float
    after_across: float
    jump_sticks: bool


@jit
def impulse(rows, d, velocity, bias):
    """((r_n, r_1, r_2), branch) where there is contact."""
    at, (v_n, v_1, v_2) = row_layout(d, 2), velocity
    r_n, r_1, r_2, branch = disc_impulse(delassus_at(rows, at), rows[at.edge_plus], (v_n + bias, v_1, v_2))
    return (r_n, r_1, r_2), branch


@jit
def law_from_rows(rows, d, v, result):
    """S(q, v) into `result` from the rows at q; returns the branch."""
    velocity = contact_velocity(rows, d, v)
    for j in range(d):
        result[j] = v[j]
    if rows[row_layout(d, 2).g] < 0.0 or velocity[0] >= 0.0:
        return FREE
    r, branch = impulse(rows, d, velocity, 0.0)
    moved(rows, d, r, result)
    return branch


@jit
def split(hit, G, p, change, dv, base, critical):
    """(branch, tau, e_n, e_1, e_2) at an offset state.

    `hit`: in contact with v_n < 0; change: of G from the base state; dv = (v_n, that of the tip's tangential velocity);
    `critical`: 1 if gamma = 0 at the base state and there is a jump, else 0.
    """
    if not hit:
        return FREE, 0.0, 0.0, 0.0, 0.0
    v_n, dv_1, dv_2 = dv
    Q_11, Q_12, Q_22 = reduced_compliance(G)
    e_n, e_1, e_2 = stick_change(G, (Q_11, Q_12, Q_22), change, dv, base)
    beta = math.hypot(G.b_1, G.b_2)
    f_1, f_2 = (G.b_1 / beta, G.b_2 / beta) if beta > 0.0 else (1.0, 0.0)
    inverse = 1.0 / beta if beta > 0.0 else 0.0
    X = f_1 * (base.stick_1 + e_1) + f_2 * (base.stick_2 + e_2)
    Y = (base.stick_across + (change.b_1 * base.stick_2 - change.b_2 * base.stick_1)) * inverse
    Y += f_1 * e_2 - f_2 * e_1
    along = f_1 * (base.slip_1 + dv_1) + f_2 * (base.slip_2 + dv_2)
    across = (base.slip_across + (change.b_1 * base.slip_2 - change.b_2 * base.slip_1)) * inverse
    across += f_1 * dv_2 - f_2 * dv_1
    if beta == 0.0:
        Y, across = base.stick_2 + e_2, base.slip_2 + dv_2
    energy = TangentEnergy(
        f_1 * (f_1 * Q_11 + f_2 * Q_12) + f_2 * (f_1 * Q_12 + f_2 * Q_22),
        f_1 * (f_1 * Q_12 + f_2 * Q_22) - f_2 * (f_1 * Q_11 + f_2 * Q_12),
        f_1 * (f_1 * Q_22 - f_2 * Q_12) - f_2 * (f_1 * Q_12 - f_2 * Q_11),
        along - beta * (v_n / G.a),
        across,
    )
    r_n, x, y, branch = aligned(G.a, p, beta, energy, -v_n, (X, Y, 1.0))
    if branch == STICK:
        if base.jump_sticks:
            return STICK, 1.0, e_n, e_1, e_2
        return STICK, 0.0, base.stick_n + e_n, base.stick_1 + e_1, base.stick_2 + e_2
    if critical == 1:
        d_1, d_2 = _turn(x / r_n, y / r_n, f_1, f_2, G.b_1, G.b_2, change.b_1, change.b_2)
        return branch, r_n / base.jump_n, 0.0, r_n * d_1, r_n * d_2
    r_1, r_2 = f_1 * x - f_2 * y, f_1 * y + f_2 * x
    if base.jump_n > 0.0 and not base.jump_sticks:
        near, d_n, d_1, d_2 = _from_ray(G, change, dv, (r_n, r_1, r_2), base)
        if near:
            return branch, 1.0, d_n, d_1, d_2
    return branch, 0.0, r_n, r_1, r_2


@jit
def _turn(cosine, sine, f_1, f_2, b_1, b_2, db_1, db_2):
    """s - s_0 with s at the angle (cosine, sine) from b, f = b/|b|, and s_0 opposed to b at the base state."""
    base_1, base_2 = b_1 - db_1, b_2 - db_2
    beta_0, beta = math.hypot(base_1, base_2), math.hypot(b_1, b_2)
    k_1, k_2 = base_1 / beta_0, base_2 / beta_0
    turn_s, turn_c = (k_1 * db_2 - k_2 * db_1) / beta, f_1 * k_1 + f_2 * k_2
    less = -turn_s * turn_s / (1.0 + turn_c) if turn_c > 0.0 else turn_c - 1.0
    more = sine * sine / (1.0 - cosine) if cosine < 0.0 else 1.0 + cosine
    return (
        more * f_1 - sine * f_2 - (less * k_1 - turn_s * k_2),
        more * f_2 + sine * f_1 - (less * k_2 + turn_s * k_1),
    )


@jit
def _from_ray(G, change, dv, r, base):
    """(whether it is near to the jump's impulse, r_n - jump_n, r_1 - jump_1, r_2 - jump_2) of a slip's impulse r."""
    _, b_1, b_2, C_11, C_12, C_22 = G
    da, db_1, db_2, dC_11, dC_12, dC_22 = change
    (v_n, dv_1, dv_2), (r_n, r_1, r_2) = dv, r
    nu, jump = -v_n, base.jump_n
    s_1, s_2 = base.jump_1 / jump, base.jump_2 / jump
    alpha = math.atan2(s_1 * r_2 - s_2 * r_1, s_1 * r_1 + s_2 * r_2)
    if not (abs(alpha) < NEAR and abs(r_n - jump) < NEAR * jump):
        return False, 0.0, 0.0, 0.0
    h = nu / r_n
    b_s, b_p = b_1 * s_1 + b_2 * s_2, b_2 * s_1 - b_1 * s_2
    wanted, start = h - da - db_1 * s_1 - db_2 * s_2, alpha
    for _ in range(NEWTON_STEPS):
        half, sine = math.sin(0.5 * alpha), math.sin(alpha)
        slope = b_p * math.cos(alpha) - b_s * sine
        alpha -= (b_p * sine - 2.0 * b_s * half * half - wanted) / slope
    half, sine = math.sin(0.5 * alpha), math.sin(alpha)
    less = -2.0 * half * half
    d_1, d_2 = less * s_1 - sine * s_2, less * s_2 + sine * s_1
    t_1, t_2 = s_1 + d_1, s_2 + d_2
    after_1 = base.slip_1 + dv_1 + b_1 * r_n + C_11 * r_1 + C_12 * r_2
    after_2 = base.slip_2 + dv_2 + b_2 * r_n + C_12 * r_1 + C_22 * r_2
    known = h * (t_1 * after_2 - t_2 * after_1) / (t_1 * b_2 - t_2 * b_1) - sine * base.after_across
    m_1 = dv_1 + jump * (db_1 + dC_11 * s_1 + dC_12 * s_2 + C_11 * d_1 + C_12 * d_2)
    m_2 = dv_2 + jump * (db_2 + dC_12 * s_1 + dC_22 * s_2 + C_12 * d_1 + C_22 * d_2)
    stiffness = t_1 * (b_1 + C_11 * t_1 + C_12 * t_2) + t_2 * (b_2 + C_12 * t_1 + C_22 * t_2)
    d_n = (known - t_1 * m_1 - t_2 * m_2) / stiffness
    # Rounding may part the two where the equations are badly conditioned, far from the base state: there nothing
    # cancels, and the impulse is taken as it was found.
    if not (abs(alpha - start) < 1e-8 and abs(jump + d_n - r_n) < 1e-8 * jump):
        return False, 0.0, 0.0, 0.0
    return True, d_n, d_n * t_1 + jump * d_1, d_n * t_2 + jump * d_2


@jit
def kind_of_change(rows, d, velocity, r, branch, free, since, speed):
    """free: the free change of the step; since: steps since the last contact, this one included."""
    edge = opposing_edge(rows, d, velocity[1], velocity[2])
    return change_of(rows, d, velocity[0], edge, r, branch, free, since, speed)


@jit
def opposing_edge(rows, d, v_1, v_2):
    """The least compliance a + b.s of the s that lower the energy of the slip v_t, where it is not positive; else a.

    For p = a - |b| <= 0 the impulses (1, s) with a + b.s <= 0 fill the wedge of half-angle arccos(a/|b|) about -b.
    One of them has v_t.s < 0, and u_tilde differs from u-, if one of its two rays has.
    """
    at = row_layout(d, 2)
    a, p = rows[at.a], rows[at.edge_plus]
    if p > 0.0:
        return a
    b_1, b_2 = rows[at.b], rows[at.b + 1]
    size = math.hypot(b_1, b_2)
    along, across = (v_1 * b_1 + v_2 * b_2) / size, abs(v_1 * b_2 - v_2 * b_1) / size
    return p if a * along + math.sqrt(-p * (a + size)) * across > 0.0 else a
