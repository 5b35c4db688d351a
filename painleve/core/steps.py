"""What the compiled schemes share with any friction section: how large a velocity jump is, and what passes for one.

The rows of the scene (painleve.core.rows) are a tuple there, those of the configuration where a scheme takes its law.
Tuples live in registers: passing arrays between the functions of a step costs ten times the step.
All fixed-step schemes solve the same problem, with a bias c that is zero for the paper's law:

    0 <= r_n, c + u_n >= 0, one of them 0;  r_t in r_n B opposes u_t;  u = v + M^-1 W r.

In the plane, where v_n + c < 0 it has one solution, for every sign of gamma: along the line u_n = -c the slip u_t grows
with r_t, so that r_t is the sticking impulse clamped to the cone. Where v_n + c >= 0, r = 0 solves it, and at gamma < 0
an edge or sticking may solve it too; r = 0, the least impulse, is taken, and painleve.core.sections.segment counts
them.
"""

import math

from painleve._jit import jit

# How jumps and collisions stand out from ordinary contact at a given step size: see `is_jump` and `is_tangential`.
STUCK_FACTOR, SLIP_FACTOR, LOST_SPEED = 3.0, 10.0, 0.1
APPROACH_FACTOR = 10.0


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
def is_jump_in_space(size, free, speed, edge, sticks):
    """Whether the change of velocity at a tangential contact is a jump, at this step size.

    As `is_jump` where the tip sticks. In space it may slip after a jump, along the edge of the wedge
    a + b.s <= 0; that edge turns, and a slip that follows it changes by h times its rate, which `free` does not hold.
    So a jump to slip must also take a tenth of the speed.
    """
    if edge <= 0.0:
        return size > STUCK_FACTOR * free and (sticks or size > LOST_SPEED * speed)
    return sticks and size > SLIP_FACTOR * free and size > LOST_SPEED * speed


@jit
def is_tangential(v_n, a, free):
    """Whether the approach |v_n| is one that a few steps of free motion from a tangential contact produce: O(h).

    `free` is the free change of one step. The strict contact test lets the tip hop: contact returns with v_n of the
    size of the curvature term, h |u . g'' u|, however long the hop. A collision arrives faster, at any step size small
    enough.
    """
    return abs(v_n) <= APPROACH_FACTOR * math.sqrt(a) * free
