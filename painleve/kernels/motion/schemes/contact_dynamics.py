"""Template: the Contact Dynamics step of the paper's section 2, to the letter (docs/theory.md, section 7).

q_{i+1} = q_i + h u_i,  v = u_i + h M^-1(q_{i+1}) f(t_{i+1}, q_{i+1}, u_i),  u_{i+1} = S(q_{i+1}, v)
"""

from painleve._jit import jit
from painleve.core.stepping import Step
from painleve.kernels.motion.contact import gap, solve_contact
from painleve.kernels.motion.sample import motion_at
from painleve.kernels.motion.tuples import add


@jit
def contact_dynamics_step(method, t, h, q, u, p):
    q1 = add(q, h, u)
    rows, acceleration = motion_at(t + h, q1, u, p)
    v = add(u, h, acceleration)
    u1, contact, r, branch = solve_contact(gap(rows) <= method.tolerance, 0.0, rows, v)
    return Step(q1, u1, contact, r, branch, rows, acceleration, v)
