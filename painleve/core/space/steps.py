"""What the compiled schemes share with friction in space: the law of one step, and how large a velocity jump is.

As painleve.core.steps; `rows` are painleve.core.rows in space. The velocity v_t and the impulse r_t
are those of the rows: in tangents in which a disc or an ellipse is the unit disc.
"""

import math

import numpy as np

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change
from painleve.core.rows import polygon_rows, row_layout
from painleve.core.space.conic_law import disc_impulse
from painleve.core.space.polygon_law import polygon_impulse
from painleve.core.steps import LOST_SPEED, SLIP_FACTOR, STUCK_FACTOR, is_tangential

STICK = int(ContactMode.STICK)
ORDINARY, FRICTIONAL_IMPACT = int(Change.ORDINARY), int(Change.FRICTIONAL_IMPACT)
JUMP_WITHOUT_COLLISION = int(Change.JUMP_WITHOUT_COLLISION)


@jit
def contact_velocity(rows, dimension, v):
    """(v_n, v_1, v_2) = W^T v."""
    at = row_layout(dimension, 2)
    v_n, v_1, v_2 = 0.0, 0.0, 0.0
    for j in range(dimension):
        v_n += rows[at.w_n + j] * v[j]
        v_1 += rows[at.H + j] * v[j]
        v_2 += rows[at.H + dimension + j] * v[j]
    return v_n, v_1, v_2


@jit
def conic_problem(rows, dimension, v_n, v_1, v_2):
    """(r_n, r_1, r_2, branch) of the law with a disc or an ellipse for the section, for a configuration in contact."""
    at = row_layout(dimension, 2)
    return disc_impulse(
        rows[at.a],
        rows[at.edge_plus],
        rows[at.b],
        rows[at.b + 1],
        rows[at.C],
        rows[at.C + 1],
        rows[at.C + 2],
        v_n,
        v_1,
        v_2,
    )


@jit
def polygon_problem(rows, dimension, count, v_n, v_1, v_2):
    """(r_n, r_1, r_2, branch) of the law with a polygon of `count` vertices, for a configuration in contact."""
    at = row_layout(dimension, 2)
    own = polygon_rows(at, count)
    vertices, compliances = np.empty((count, 2)), np.empty(count)
    for i in range(count):
        compliances[i] = rows[own.p + i]
        vertices[i, 0], vertices[i, 1] = rows[own.s + 2 * i], rows[own.s + 2 * i + 1]
    return polygon_impulse(
        rows[at.a],
        rows[at.b],
        rows[at.b + 1],
        rows[at.C],
        rows[at.C + 1],
        rows[at.C + 2],
        vertices,
        compliances,
        v_n,
        v_1,
        v_2,
    )


@jit
def conic_edge(rows, dimension, v_1, v_2):
    """The least compliance a + b.s of the s that lower the energy of the slip v_t, where it is not positive; else a.

    For p = a - |b| <= 0 the impulses (1, s) with a + b.s <= 0 fill the wedge of half-angle arccos(a/|b|) about -b.
    One of them has v_t.s < 0, and u_tilde differs from u-, if one of its two rays has.
    """
    at = row_layout(dimension, 2)
    a, p = rows[at.a], rows[at.edge_plus]
    if p > 0.0:
        return a
    b_1, b_2 = rows[at.b], rows[at.b + 1]
    size = math.hypot(b_1, b_2)
    along, across = (v_1 * b_1 + v_2 * b_2) / size, abs(v_1 * b_2 - v_2 * b_1) / size
    return p if a * along + math.sqrt(-p * (a + size)) * across > 0.0 else a


@jit
def polygon_edge(rows, dimension, count, v_1, v_2):
    """As conic_edge, for a polygon of `count` vertices: v_t.s is least at a vertex of the part with a + b.s <= 0."""
    at = row_layout(dimension, 2)
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


@jit
def jump_size(rows, dimension, r):
    """The kinetic norm of M^-1 W r: how far the contact moved the velocity."""
    at = row_layout(dimension, 2)
    a, C_11, C_12, C_22 = rows[at.a], rows[at.C], rows[at.C + 1], rows[at.C + 2]
    coupled = 2.0 * (rows[at.b] * r[1] + rows[at.b + 1] * r[2])
    tangential = C_11 * r[1] * r[1] + 2.0 * C_12 * r[1] * r[2] + C_22 * r[2] * r[2]
    return math.sqrt(max(0.0, a * r[0] * r[0] + coupled * r[0] + tangential))


@jit
def is_jump(size, free, speed, edge, sticks):
    """Whether the change of velocity at a tangential contact is a jump, at this step size.

    As painleve.core.steps.is_jump where the tip sticks. In space it may slip after a jump, along the edge of the wedge
    a + b.s <= 0; that edge turns, and a slip that follows it changes by h times its rate, which `free` does not hold.
    So a jump to slip must also take a tenth of the speed.
    """
    if edge <= 0.0:
        return size > STUCK_FACTOR * free and (sticks or size > LOST_SPEED * speed)
    return sticks and size > SLIP_FACTOR * free and size > LOST_SPEED * speed


@jit
def kind_of_change(rows, dimension, v_n, edge, r, branch, free, since, speed):
    """The code of painleve.core.motion_codes.Change for a contact with an impulse; `edge`: conic_edge, polygon_edge.

    free: the free change of this step; since: steps since the last contact, this one included.
    """
    if not is_tangential(v_n, rows[row_layout(dimension, 2).a], free):
        return FRICTIONAL_IMPACT
    size = jump_size(rows, dimension, r)
    return JUMP_WITHOUT_COLLISION if is_jump(size, free * since, speed, edge, branch == STICK) else ORDINARY
