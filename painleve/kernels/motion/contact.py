"""Template: the contact in one step, with any friction section."""

import math

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.rows import row_layout
from painleve.core.steps import free_change, quadratic_form
from painleve.kernels.motion.sample import D, drift_at, inertia_at
from painleve.kernels.motion.sections.segment import NO_IMPULSE, contact_velocity, impulse, kind_of_change, respond

FREE = int(ContactMode.FREE)


@jit
def gap(rows):
    """-g(q): how far the contact point is from the obstacle."""
    return -rows[row_layout(D, 0).g]


@jit
def compliance(rows):
    """a = w_n . M^-1 w_n."""
    return rows[row_layout(D, 0).a]


@jit
def solve_contact(touching, bias, rows, v):
    """(u, W^T v, r, branch): u = v + M^-1 W r, r solves the contact problem with that bias (painleve.core.steps)."""
    contact = contact_velocity(rows, v)
    if not touching:
        return v, contact, NO_IMPULSE, FREE
    r, branch = impulse(rows, contact, bias)
    if branch == FREE:
        return v, contact, NO_IMPULSE, FREE
    return respond(rows, r, v), contact, r, branch


@jit
def free_motion(h, u, p, step):
    """(F, M): the free change of a step from the velocity u (painleve.core.steps.free_change), and the inertia."""
    M = inertia_at(step.q, p)
    return free_change(h, compliance(step.rows), M, step.acceleration, drift_at(step.q, u, p)[0], D), M


@jit
def change_at(h, since, u, p, step):
    """What the impulse of a step from the velocity u did to the velocity (painleve.core.motion_codes.Change).

    since: steps since the last contact, this one included.
    """
    free, M = free_motion(h, u, p, step)
    speed = math.sqrt(quadratic_form(M, step.free, step.free, D))
    return kind_of_change(step, free, since, speed)
