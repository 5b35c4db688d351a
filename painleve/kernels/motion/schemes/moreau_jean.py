"""Template: a step of Moreau's midpoint scheme with Jean's theta, impacts without rebound.

    q_m = q_i + (1 - theta) h u_i,  contact where g(q_m) >= 0
    u_{i+1} = S(q_m, u_i + h M^-1(q_m) f(t_m, q_m, (1 - theta) u_i + theta u_{i+1})),  q_{i+1} = q_m + theta h u_{i+1}

Implicit in the velocity only, solved by fixed-point iteration; one evaluation more where f does not depend on u.
"""

from painleve._jit import jit
from painleve.core.stepping import ITERATIONS, NOT_SOLVED, Step
from painleve.kernels.motion.contact import gap, solve_contact
from painleve.kernels.motion.sample import motion_at
from painleve.kernels.motion.tuples import add, close, mix


@jit
def moreau_jean_step(method, t, h, q, u, p):
    before = (1.0 - method.theta) * h
    middle = add(q, before, u)
    previous, code = u, NOT_SOLVED
    for _ in range(ITERATIONS):
        rows, acceleration = motion_at(t + before, middle, mix(method.theta, u, previous), p)
        v = add(u, h, acceleration)
        u1, contact, r, branch = solve_contact(gap(rows) <= method.tolerance, 0.0, rows, v)
        if close(u1, previous, v, 0.0):
            code = branch
            break
        previous = u1
    return Step(add(middle, method.theta * h, u1), u1, contact, r, code, rows, acceleration, v)
