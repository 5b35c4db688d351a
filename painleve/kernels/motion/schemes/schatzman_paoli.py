"""Template: a position-level step of Schatzman and Paoli, impacts without rebound, with Coulomb's friction.

    q_{i+1} = 2 q_i - q_{i-1} + h^2 M^-1 f(t_i, q_i, u_i) + h M^-1(q_{i+1}) W(q_{i+1}) r,  u_{i+1} = (q_{i+1} - q_i)/h
    0 <= r_n, g(q_{i+1}) <= 0, one of them 0

Published without friction; friction opposes the slip W^T u_{i+1}. The constraint is met by Newton's iteration on g.
"""

from painleve._jit import jit
from painleve.core.stepping import ITERATIONS, NOT_SOLVED, Step
from painleve.kernels.motion.contact import gap, solve_contact
from painleve.kernels.motion.sample import motion_at, rows_at
from painleve.kernels.motion.sections.segment import contact_velocity
from painleve.kernels.motion.tuples import add, close, size_of

ROUNDING = 1e-14  # of g; the velocity that would correct it in one step is known to this over h


@jit
def schatzman_paoli_step(method, t, h, q, u, p):
    acceleration = motion_at(t, q, u, p)[1]
    v = add(u, h, acceleration)
    previous, code = v, NOT_SOLVED
    for _ in range(ITERATIONS):
        q1 = add(q, h, previous)
        rows = rows_at(q1, p)
        bias = gap(rows) / h - contact_velocity(rows, previous)[0]
        u1, contact, r, branch = solve_contact(True, bias, rows, v)
        noise = ROUNDING / h
        # What rounding of g does to u1 on this branch: on a slip 1/p times as much, p -> 0 at the edge of a paradox.
        blurred, _, _, same = solve_contact(True, bias - noise, rows, v)
        if close(u1, previous, v, noise + (size_of(add(blurred, -1.0, u1)) if same == branch else 0.0)):
            code = branch
            break
        previous = u1
    return Step(q1, u1, contact, r, code, rows, acceleration, v)
