"""Template: a polygon of VERTICES vertices in a step, as painleve.kernels.motion.sections.conic in its own tangents."""

from painleve._jit import jit
from painleve.core.rows import row_layout
from painleve.core.space import steps
from painleve.kernels.motion.sample import D

VERTICES = 4
NO_IMPULSE = (0.0, 0.0, 0.0)


@jit
def contact_velocity(rows, v):
    return steps.contact_velocity(rows, D, v)


@jit
def impulse(rows, contact, bias):
    r_n, r_1, r_2, branch = steps.polygon_problem(rows, D, VERTICES, contact[0] + bias, contact[1], contact[2])
    return (r_n, r_1, r_2), branch


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
    contact = step.contact
    edge = steps.polygon_edge(step.rows, D, VERTICES, contact[1], contact[2])
    return steps.kind_of_change(step.rows, D, contact[0], edge, step.impulse, step.branch, free, since, speed)
