"""What discs, ellipses and polygons read alike from the rows of a contact in space (painleve.core.rows).

Tangential velocities and impulses are those of the rows: in tangents in which a disc or an ellipse is the unit disc.
"""

import math

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change
from painleve.core.rows import row_layout
from painleve.core.steps import is_jump_in_space, is_tangential

STICK = int(ContactMode.STICK)
ORDINARY, FRICTIONAL_IMPACT = int(Change.ORDINARY), int(Change.FRICTIONAL_IMPACT)
JUMP_WITHOUT_COLLISION = int(Change.JUMP_WITHOUT_COLLISION)


@jit
def contact_velocity(rows, d, v):
    """(v_n, v_1, v_2) = W^T v."""
    at = row_layout(d, 2)
    v_n, v_1, v_2 = 0.0, 0.0, 0.0
    for j in range(d):
        v_n += rows[at.w_n + j] * v[j]
        v_1 += rows[at.H + j] * v[j]
        v_2 += rows[at.H + d + j] * v[j]
    return v_n, v_1, v_2


@jit
def moved(rows, d, r, result):
    """Add M^-1 W r to `result`."""
    at, (r_n, r_1, r_2) = row_layout(d, 2), r
    for j in range(d):
        result[j] += rows[at.Y_n + j] * r_n + rows[at.Y_t + j] * r_1 + rows[at.Y_t + d + j] * r_2


@jit
def change_of(rows, d, v_n, edge, r, branch, free, since, speed):
    """The code of painleve.core.motion_codes.Change for a contact with an impulse; `edge`: the least compliance of the
    impulses that lower the energy of the slip, where it is not positive, else a.

    free: the free change of this step; since: steps since the last contact, this one included.
    """
    at = row_layout(d, 2)
    if not is_tangential(v_n, rows[at.a], free):
        return FRICTIONAL_IMPACT
    size = _jump_size(rows, at, r)
    return JUMP_WITHOUT_COLLISION if is_jump_in_space(size, free * since, speed, edge, branch == STICK) else ORDINARY


@jit
def _jump_size(rows, at, r):
    """The kinetic norm of M^-1 W r: how far the contact moved the velocity."""
    a, C_11, C_12, C_22 = rows[at.a], rows[at.C], rows[at.C + 1], rows[at.C + 2]
    coupled = 2.0 * (rows[at.b] * r[1] + rows[at.b + 1] * r[2])
    tangential = C_11 * r[1] * r[1] + 2.0 * C_12 * r[1] * r[2] + C_22 * r[2] * r[2]
    return math.sqrt(max(0.0, a * r[0] * r[0] + coupled * r[0] + tangential))
