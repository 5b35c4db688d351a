"""Template: a contact without friction in a step. Contact velocities are (v_n,), impulses (r_n,)."""

from painleve._jit import jit
from painleve.core import steps
from painleve.core.rows import row_layout
from painleve.kernels.motion.sample import D

NO_IMPULSE = (0.0,)


@jit
def contact_velocity(rows, v):
    return (steps.contact_velocity(rows, D, False, v)[0],)


@jit
def impulse(rows, contact, bias):
    r_n, _, branch = steps.contact_problem(rows, D, False, contact[0], 0.0, bias)
    return (r_n,), branch


@jit
def respond(rows, r, v):
    at = row_layout(D, 0)
    return tuple(v[j] + rows[at.Y_n + j] * r[0] for j in range(D))


@jit
def store_impulse(x, i, rows, r):
    x[i, 0] = r[0]


@jit
def kind_of_change(step, free, since, speed):
    return steps.kind_of_change(
        step.rows, D, False, step.contact[0], 0.0, step.impulse[0], 0.0, step.branch, free, since, speed
    )


@jit
def solutions(rows, contact, gap_rate):
    return 1
