"""Template: the time loops, of one trajectory and of the members of an ensemble, and tables along a trajectory."""

import math

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, Ending, MemberOutcome
from painleve.core.steps import is_tangential
from painleve.kernels.motion.contact import change_at, compliance, free_motion, gap
from painleve.kernels.motion.sample import ROWS, D, depths_at, force_at, inertia_at, rows_at
from painleve.kernels.motion.schemes.in_plane import count_solutions, step
from painleve.kernels.motion.sections.segment import store_impulse
from painleve.kernels.motion.tuples import load, size_of, store

FREE, STICK = int(ContactMode.FREE), int(ContactMode.STICK)
ORDINARY, JUMP_WITHOUT_COLLISION = int(Change.ORDINARY), int(Change.JUMP_WITHOUT_COLLISION)
REACHED_END, NOT_FINITE = int(Ending.REACHED_END), int(Ending.NOT_FINITE)
DEGENERATE, NOT_CONVERGED = int(Ending.DEGENERATE), int(Ending.NOT_CONVERGED)
THROUGH_FLOOR, FALLS_THROUGH = int(Ending.THROUGH_FLOOR), int(MemberOutcome.THROUGH_FLOOR)
JUMP, STICKS = int(MemberOutcome.JUMP), int(MemberOutcome.STICK)
LIFT_OFF, IMPACT = int(MemberOutcome.LIFT_OFF), int(MemberOutcome.IMPACT)
SLIDE, FLIGHT = int(MemberOutcome.SLIDE), int(MemberOutcome.FLIGHT)
FAILED = int(MemberOutcome.FAILED)
CLOSE = 1e-12  # relative: an instant that close to the end is the end


@jit
def failure_of(taken):
    """The ending that a step calls for; REACHED_END if none."""
    if taken.branch < 0:
        return NOT_CONVERGED
    if not size_of(taken.q) < math.inf:
        return NOT_FINITE
    if size_of(taken.u) < math.inf:
        return REACHED_END
    return NOT_FINITE if compliance(taken.rows) > 0.0 else DEGENERATE


@jit
def deepest(q, p):
    """How far below the floor the deepest point of the outline is that the contact does not hold up."""
    found = -math.inf
    for depth in depths_at(q, p):
        found = max(found, depth)
    return found


@jit
def is_through(q, p, allowed):
    """Whether a point of the outline is below the floor, and below the contact point, by more than is allowed."""
    depth = deepest(q, p)
    return depth > allowed and depth + gap(rows_at(q, p)) > allowed


@jit
def run(method, since, allowed, t, h, given, p, track):
    """Take len(h) steps of a painleve.core.stepping.SteppingMethod from the first row of a Track, and fill it.

    given: the steps that say what O(h) is (painleve.dynamics.grid); since: steps since the last contact, at the start
    and at the end; allowed: how deep the outline may be below the floor. Returns (steps taken, ending, since).
    """
    q, u = load(track.q, 0), load(track.u, 0)
    for i in range(h.size):
        taken = step(method, t[i], h[i], q, u, p)
        ending = failure_of(taken)
        if ending != REACHED_END:
            return i, ending, since
        since += 1
        if taken.branch != FREE:
            track.change[i + 1] = change_at(given[i], since, u, p, taken)
            since = 0
        track.several[i + 1] = count_solutions(method, h[i], taken)
        store_impulse(track.r, i + 1, taken.rows, taken.impulse)
        track.branch[i + 1] = taken.branch
        q, u = taken.q, taken.u
        store(track.q, i + 1, q)
        store(track.u, i + 1, u)
        if is_through(q, p, allowed):
            return i + 1, THROUGH_FLOOR, since
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
def run_member(method, rounding, t0, h, until, q, u, p):
    """Step from (q, u) to the first thing that happens; returns (outcome, time, steps).

    The steps are those of painleve.dynamics.grid: the last one ends at the end.
    """
    touched = gap(rows_at(q, p)) <= method.tolerance + rounding.g
    allowed = rounding.depth + max(0.0, deepest(q, p))
    steps, since, end = math.ceil(until / h * (1.0 - CLOSE)), 0, t0 + until
    beyond = steps * h - until
    if beyond <= CLOSE * until:
        beyond, end = 0.0, t0 + steps * h
    for i in range(steps):
        start, now, length = t0 + i * h, t0 + (i + 1) * h, h
        if i == steps - 1:
            now, length = end, h - beyond
        taken, since = step(method, start, length, q, u, p), since + 1
        if failure_of(taken) != REACHED_END:
            return FAILED, now, i + 1
        if is_through(taken.q, p, allowed):
            return FALLS_THROUGH, now, i + 1
        if taken.branch != FREE:
            change = change_at(h, since, u, p, taken)
            if change != ORDINARY:
                return (JUMP if change == JUMP_WITHOUT_COLLISION else IMPACT), now, i + 1
            if taken.branch == STICK:
                return STICKS, now, i + 1
            touched, since = True, 0
        elif touched and taken.contact[0] > 0.0:
            free = free_motion(h, u, p, taken)[0]
            if not is_tangential(taken.contact[0], compliance(taken.rows), free):
                return LIFT_OFF, now, i + 1
        q, u = taken.q, taken.u
    return (SLIDE if touched else FLIGHT), end, steps


@jit
def run_members(method, rounding, t0, until, h, q, u, p, fates):
    """run_member for each row of q, u: (members, d) and h: (members,); fills the Fates."""
    for i in range(h.size):
        found = run_member(method, rounding, t0, h[i], until, load(q, i), load(u, i), p)
        fates.outcome[i], fates.time[i], fates.steps[i] = found
