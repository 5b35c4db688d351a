"""Template: planar friction in a step. Contact velocities are (v_n, v_t), impulses (r_n, r_t)."""

from painleve._jit import jit
from painleve.core.rows import row_layout
from painleve.core.sections import segment as section
from painleve.kernels.motion.sample import D

NO_IMPULSE = (0.0, 0.0)


@jit
def contact_velocity(rows, v):
    return section.contact_velocity(rows, D, v)


@jit
def impulse(rows, contact, bias):
    return section.impulse(rows, D, contact, bias)


@jit
def respond(rows, r, v):
    at = row_layout(D, 1)
    return tuple(v[j] + rows[at.Y_n + j] * r[0] + rows[at.Y_t + j] * r[1] for j in range(D))


@jit
def store_impulse(x, i, rows, r):
    x[i, 0], x[i, 1] = r


@jit
def kind_of_change(step, free, since, speed):
    return section.kind_of_change(step.rows, D, step.contact, step.impulse, step.branch, free, since, speed)


@jit
def solutions(rows, contact, gap_rate):
    return section.solutions(rows, D, gap_rate, contact[1])
