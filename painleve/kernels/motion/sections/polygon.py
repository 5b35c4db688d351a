"""Template: a polygon of VERTICES vertices in a step, as painleve.kernels.motion.sections.conic in its own tangents."""

from painleve._jit import jit
from painleve.core.rows import row_layout
from painleve.core.sections import polygon as section
from painleve.kernels.motion.sample import D

VERTICES = 4
NO_IMPULSE = (0.0, 0.0, 0.0)


@jit
def contact_velocity(rows, v):
    return section.contact_velocity(rows, D, v)


@jit
def impulse(rows, contact, bias):
    return section.impulse(rows, D, VERTICES, contact, bias)


@jit
def respond(rows, r, v):
    at = row_layout(D, 2)
    return tuple(
        v[j] + rows[at.Y_n + j] * r[0] + rows[at.Y_t + j] * r[1] + rows[at.Y_t + D + j] * r[2] for j in range(D)
    )


@jit
def store_impulse(x, i, rows, r):
    x[i, 0], x[i, 1], x[i, 2] = r


@jit
def kind_of_change(step, free, since, speed):
    return section.kind_of_change(step.rows, D, VERTICES, step.contact, step.impulse, step.branch, free, since, speed)
