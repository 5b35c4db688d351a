"""Template: a disc or an ellipse in a step. Contact velocities are (v_n, v_1, v_2), impulses (r_n, r_1, r_2).

Both are in the tangents in which the section is the unit disc (painleve.core.rows); impulses are stored in the
scene's own tangents, r_t = E r' with the section E times the disc.
"""

from painleve._jit import jit
from painleve.core.rows import row_layout
from painleve.core.sections import conic as section
from painleve.kernels.motion.sample import D

SECTION = 0  # the first row of E, row by row
NO_IMPULSE = (0.0, 0.0, 0.0)


@jit
def contact_velocity(rows, v):
    return section.contact_velocity(rows, D, v)


@jit
def impulse(rows, contact, bias):
    return section.impulse(rows, D, contact, bias)


@jit
def respond(rows, r, v):
    at = row_layout(D, 2)
    return tuple(
        v[j] + rows[at.Y_n + j] * r[0] + rows[at.Y_t + j] * r[1] + rows[at.Y_t + D + j] * r[2] for j in range(D)
    )


@jit
def store_impulse(x, i, rows, r):
    x[i, 0] = r[0]
    x[i, 1] = rows[SECTION] * r[1] + rows[SECTION + 1] * r[2]
    x[i, 2] = rows[SECTION + 2] * r[1] + rows[SECTION + 3] * r[2]


@jit
def kind_of_change(step, free, since, speed):
    return section.kind_of_change(step.rows, D, step.contact, step.impulse, step.branch, free, since, speed)
