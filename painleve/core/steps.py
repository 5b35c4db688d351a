"""What the compiled schemes share: the contact problem of one step, and how large a velocity jump is.

A tuple `rows` (painleve.core.rows) is the scene at the configuration where a scheme takes its law. Tuples
live in registers: passing arrays between the functions of a step costs ten times the step.
All fixed-step schemes solve the same problem, with a bias c that is zero for the paper's law:

    0 <= r_n, c + u_n >= 0, one of them 0;  r_t in r_n [-mu_minus, mu_plus] opposes u_t;  u = v + M^-1 W r.

Where v_n + c < 0 it has one solution, for every sign of gamma: along the line u_n = -c the slip u_t grows with r_t, so
that r_t is the sticking impulse clamped to the cone. Where v_n + c >= 0, r = 0 solves it, and at gamma < 0 an edge or
sticking may solve it too; r = 0, the least impulse, is taken and `solutions` counts them.
"""

import math

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.law import planar_impulse, stick_impulse
from painleve.core.motion_codes import Change
from painleve.core.rows import row_layout, segment_rows

FREE, STICK = int(ContactMode.FREE), int(ContactMode.STICK)
FRICTIONLESS = int(ContactMode.FRICTIONLESS)
ORDINARY, IMPACT, FRICTIONAL_IMPACT = int(Change.ORDINARY), int(Change.IMPACT), int(Change.FRICTIONAL_IMPACT)
JUMP_WITHOUT_COLLISION = int(Change.JUMP_WITHOUT_COLLISION)

# How jumps and collisions stand out from ordinary contact at a given step size: see `is_jump` and `is_tangential`.
STUCK_FACTOR, SLIP_FACTOR, LOST_SPEED = 3.0, 10.0, 0.1
APPROACH_FACTOR = 10.0


@jit
def contact_velocity(rows, dimension, planar, v):
    """(v_n, v_t) = W^T v; v_t is 0 without friction."""
    at = row_layout(dimension, 1)
    v_n, v_t = 0.0, 0.0
    for j in range(dimension):
        v_n += rows[at.w_n + j] * v[j]
    if planar:
        for j in range(dimension):
            v_t += rows[at.H + j] * v[j]
    return v_n, v_t


@jit
def contact_problem(rows, dimension, planar, v_n, v_t, bias):
    """(r_n, r_t, branch) of the problem above, for a configuration in contact."""
    if v_n + bias >= 0.0:
        return 0.0, 0.0, FREE
    at = row_layout(dimension, 1)
    a = rows[at.a]
    if not planar:
        return -(v_n + bias) / a, 0.0, FRICTIONLESS
    own = segment_rows(at)
    return planar_impulse(
        a,
        rows[at.b],
        rows[at.C],
        rows[at.edge_plus],
        rows[own.edge_minus],
        rows[own.mu_plus],
        rows[own.mu_minus],
        v_n + bias,
        v_t,
    )


@jit
def solutions(rows, dimension, planar, v_n, v_t, bias):
    """How many impulses solve the problem above: free, sticking, and slip on either edge of the cone."""
    gap_rate = v_n + bias
    if not planar or gap_rate < 0.0:
        return 1
    at = row_layout(dimension, 1)
    own = segment_rows(at)
    a, b, C = rows[at.a], rows[at.b], rows[at.C]
    mu_plus, mu_minus = rows[own.mu_plus], rows[own.mu_minus]
    count = 1
    stick_n, stick_t = stick_impulse(a, b, C, gap_rate, v_t)
    if stick_n > 0.0 and -mu_minus * stick_n <= stick_t <= mu_plus * stick_n:
        count += 1
    for side in range(2):
        s = mu_plus if side == 0 else -mu_minus
        edge = rows[at.edge_plus] if side == 0 else rows[own.edge_minus]
        if edge < 0.0 < gap_rate:
            r_n = -gap_rate / edge
            if (v_t + (b + C * s) * r_n) * s < 0.0:
                count += 1
    return count


@jit
def quadratic_form(M, x, y, dimension):
    """x . M y; M row by row."""
    total = 0.0
    for i in range(dimension):
        for j in range(dimension):
            total += x[i] * M[i * dimension + j] * y[j]
    return total


@jit
def free_change(h, a, M, acceleration, drift_n, dimension):
    """F: the change of velocity, in the kinetic norm, that free motion makes within a step.

    It adds what the force does, h |M^-1 f|, and what the curvature of g does to the normal velocity, h |u . g'' u|,
    the latter divided by sqrt(a): an impulse that changes v_n by w costs the kinetic norm at least |w|/sqrt(a).
    """
    return h * (math.sqrt(quadratic_form(M, acceleration, acceleration, dimension)) + abs(drift_n) / math.sqrt(a))


@jit
def jump_size(rows, dimension, planar, r_n, r_t):
    """The kinetic norm of M^-1 W r: how far the contact moved the velocity."""
    at = row_layout(dimension, 1)
    a = rows[at.a]
    if not planar:
        return math.sqrt(a) * r_n
    return math.sqrt(max(0.0, a * r_n * r_n + 2.0 * rows[at.b] * r_n * r_t + rows[at.C] * r_t * r_t))


@jit
def is_jump(size, free, speed, edge, sticks):
    """Whether the change of velocity at a tangential contact is a jump, at this step size.

    `free` is the free change since the last contact, O(h); `edge` is a + mu_plus b or a - mu_minus b, the side of the
    cone on which friction opposes the slip.
    edge <= 0: S is discontinuous there. Without the discontinuity the tip could only be sticking already, and then S
    is a projection that undoes the free motion: at most `free`, and three times that allows for the curvature.
    edge > 0: a slip answers the approach in proportion, by a factor that grows as edge -> 0+ and stays finite as
    h -> 0: a large contact force, no jump. But if the tip sticks at once, and a tenth of the speed is lost in much
    more than the free change, it is one.
    """
    if edge <= 0.0:
        return size > STUCK_FACTOR * free
    return sticks and size > SLIP_FACTOR * free and size > LOST_SPEED * speed


@jit
def is_tangential(v_n, a, free):
    """Whether the approach |v_n| is one that a few steps of free motion from a tangential contact produce: O(h).

    `free` is the free change of one step. The strict contact test lets the tip hop: contact returns with v_n of the
    size of the curvature term, h |u . g'' u|, however long the hop. A collision arrives faster, at any step size small
    enough.
    """
    return abs(v_n) <= APPROACH_FACTOR * math.sqrt(a) * free


@jit
def kind_of_change(rows, dimension, planar, v_n, v_t, r_n, r_t, branch, free, since, speed):
    """The code of painleve.core.motion_codes.Change for a contact with an impulse.

    free: the free change of this step; since: steps since the last contact, this one included.
    """
    at = row_layout(dimension, 1)
    if not is_tangential(v_n, rows[at.a], free):
        return FRICTIONAL_IMPACT if planar else IMPACT
    if not planar:
        return ORDINARY
    edge = rows[at.edge_plus] if v_t < 0.0 else rows[segment_rows(at).edge_minus]
    size = jump_size(rows, dimension, planar, r_n, r_t)
    return JUMP_WITHOUT_COLLISION if is_jump(size, free * since, speed, edge, branch == STICK) else ORDINARY
