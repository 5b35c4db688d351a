"""Template: a step of Anitescu and Potra, complementarity of normal velocity and impulse where there is contact.

u_{i+1} = u_i + h M^-1(q_i) f(t_i, q_i, u_i) + M^-1 W r;  where g(q_i) >= 0: 0 <= r_n, w_n . u_{i+1} >= 0, one 0
q_{i+1} = q_i + h u_{i+1}
"""

from painleve._jit import jit
from painleve.core.stepping import Step
from painleve.kernels.motion.contact import gap, solve_contact
from painleve.kernels.motion.sample import motion_at
from painleve.kernels.motion.tuples import add


@jit
def anitescu_potra_step(method, t, h, q, u, p):
    rows, acceleration = motion_at(t, q, u, p)
    v = add(u, h, acceleration)
    u1, contact, r, branch = solve_contact(gap(rows) <= method.tolerance, 0.0, rows, v)
    return Step(add(q, h, u1), u1, contact, r, branch, rows, acceleration, v)
