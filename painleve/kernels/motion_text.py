"""The text of a scene's motion that is the same with and without friction, in the plane and in space.

It calls what the other two texts define, painleve.kernels.planar_motion_text and space_motion_text: `solve_contact`,
`step`, `change_at` and `count_solutions`. All is compiled with the scene: a compiled function that is passed as an
argument is compiled anew in every process.
"""

__all__ = ["HEADER", "SCHEMES"]

HEADER = '''"""Motion of the scene {name}, written by painleve from its derivation; edits are lost.

Rows: {rows}
"""

import math

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, Ending, FixedStep, MemberOutcome
from painleve.core.steps import free_change, is_tangential, quadratic_form
{imports}

D, ROWS = {dimension}, {row_count}
{constants}
FREE, STICK = int(ContactMode.FREE), int(ContactMode.STICK)
CONTACT_DYNAMICS, MOREAU_JEAN = int(FixedStep.CONTACT_DYNAMICS), int(FixedStep.MOREAU_JEAN)
ORDINARY, JUMP_WITHOUT_COLLISION = int(Change.ORDINARY), int(Change.JUMP_WITHOUT_COLLISION)
REACHED_END, NOT_FINITE = int(Ending.REACHED_END), int(Ending.NOT_FINITE)
DEGENERATE, NOT_CONVERGED = int(Ending.DEGENERATE), int(Ending.NOT_CONVERGED)
JUMP, STICKS = int(MemberOutcome.JUMP), int(MemberOutcome.STICK)
LIFT_OFF, IMPACT = int(MemberOutcome.LIFT_OFF), int(MemberOutcome.IMPACT)
SLIDE, FLIGHT = int(MemberOutcome.SLIDE), int(MemberOutcome.FLIGHT)
FAILED = int(MemberOutcome.FAILED)
NOT_SOLVED = -1  # in place of a branch
ITERATIONS, ACCURACY = 50, 1e-12  # of implicit steps: change, relative to the velocities, at which they are solved

'''

SCHEMES = '''@jit
def step_contact_dynamics(tolerance, t, h, q, u, p):
    q1 = add(q, h, u)
    rows, acceleration = motion_at(t + h, q1, u, p)
    v = add(u, h, acceleration)
    u1, v_n, r, branch = solve_contact(rows[0] >= -tolerance, 0.0, rows, v)
    return q1, u1, v_n, r, branch, rows, acceleration, v


@jit
def step_moreau_jean(theta, tolerance, t, h, q, u, p):
    middle = add(q, (1.0 - theta) * h, u)
    previous, code = u, NOT_SOLVED
    for _ in range(ITERATIONS):
        rows, acceleration = motion_at(t + (1.0 - theta) * h, middle, mix(theta, u, previous), p)
        v = add(u, h, acceleration)
        u1, v_n, r, branch = solve_contact(rows[0] >= -tolerance, 0.0, rows, v)
        if close(u1, previous, v, 0.0):
            code = branch
            break
        previous = u1
    return add(middle, theta * h, u1), u1, v_n, r, code, rows, acceleration, v


@jit
def failure_of(branch, rows, q1, u1):
    """The ending that a step calls for; REACHED_END if none."""
    if branch < 0:
        return NOT_CONVERGED
    if not size_of(q1) < math.inf:
        return NOT_FINITE
    if size_of(u1) < math.inf:
        return REACHED_END
    return NOT_FINITE if rows[1 + 2 * D] > 0.0 else DEGENERATE


@jit
def free_motion(h, q, u, p, rows, acceleration):
    """(F, M): the free change of a step (painleve.core.steps.free_change) and the inertia."""
    M = inertia_at(q, p)
    return free_change(h, rows[1 + 2 * D], M, acceleration, drift_at(q, u, p)[0], D), M


@jit
def run(scheme, theta, tolerance, since, t, h, p, q, u, r, branch, change, several):
    """Take len(h) steps from q[0], u[0]; row i + 1 of each array is for the step that ends at t[i + 1].

    q, u: (n + 1, d); r: (n + 1, 2), in space (n + 1, 3), in physical tangents; branch, change and several, how many
    impulses solve the step: (n + 1,).
    since: steps since the last contact, at the start and at the end. Returns (steps taken, ending, since).
    """
    q0, u0 = load(q, 0), load(u, 0)
    for i in range(h.size):
        q1, u1, v_n, impulse, code, rows, acceleration, v = step(scheme, theta, tolerance, t[i], h[i], q0, u0, p)
        ending = failure_of(code, rows, q1, u1)
        if ending != REACHED_END:
            return i, ending, since
        since += 1
        if code != FREE:
            change[i + 1] = change_at(h[i], since, q1, u0, p, rows, acceleration, v, v_n, impulse, code)
            since = 0
        several[i + 1] = count_solutions(scheme, tolerance, h[i], rows, v)
        store_impulse(r, i + 1, rows, impulse)
        branch[i + 1] = code
        store(q, i + 1, q1)
        store(u, i + 1, u1)
        q0, u0 = q1, u1
    return h.size, REACHED_END, since


@jit
def tabulate(t, q, u, p, rows, M, f):
    """Rows, M (row by row) and f at many (t, q, u): t (n,), q, u (n, d); rows (n, ROWS), M (n, d d), f (n, d)."""
    for i in range(t.size):
        q0, u0 = load(q, i), load(u, i)
        values, inertia, force = rows_at(q0, p), inertia_at(q0, p), force_at(t[i], q0, u0, p)
        for j in range(ROWS):
            rows[i, j] = values[j]
        for j in range(D * D):
            M[i, j] = inertia[j]
        store(f, i, force)


@jit
def run_member(scheme, theta, tolerance, rounding, t0, h, until, q, u, p):
    """Step from (q, u) to the first thing that happens; returns (outcome, time, steps)."""
    touched = rows_at(q, p)[0] >= -tolerance - rounding
    steps, since = int(math.ceil(until / h * (1.0 - 1e-12))), 0
    for i in range(steps):
        q1, u1, v_n, r, code, rows, acceleration, v = step(scheme, theta, tolerance, t0 + i * h, h, q, u, p)
        now, since = t0 + (i + 1) * h, since + 1
        if failure_of(code, rows, q1, u1) != REACHED_END:
            return FAILED, now, i + 1
        if code != FREE:
            change = change_at(h, since, q1, u, p, rows, acceleration, v, v_n, r, code)
            if change != ORDINARY:
                return (JUMP if change == JUMP_WITHOUT_COLLISION else IMPACT), now, i + 1
            if code == STICK:
                return STICKS, now, i + 1
            touched, since = True, 0
        elif touched and v_n > 0.0:
            free = free_motion(h, q1, u, p, rows, acceleration)[0]
            if not is_tangential(v_n, rows[1 + 2 * D], free):
                return LIFT_OFF, now, i + 1
        q, u = q1, u1
    return (SLIDE if touched else FLIGHT), t0 + steps * h, steps


@jit
def run_members(scheme, theta, tolerance, rounding, t0, h, until, q, u, p, outcome, time, steps):
    """run_member for each row of q, u: (members, d) and h: (members,)."""
    for i in range(h.size):
        outcome[i], time[i], steps[i] = run_member(
            scheme, theta, tolerance, rounding, t0, h[i], until, load(q, i), load(u, i), p)
'''
