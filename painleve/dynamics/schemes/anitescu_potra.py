"""The scheme of Anitescu and Potra: complementarity of normal velocity and impulse where there is contact.

u_{i+1} = u_i + h M^-1(q_i) f(t_i, q_i, u_i) + M^-1 W r;  where g(q_i) >= 0: 0 <= r_n, w_n . u_{i+1} >= 0, one 0
q_{i+1} = q_i + h u_{i+1}
"""

from painleve.core.motion_codes import FixedStep
from painleve.dynamics.scheme import Stepped

SCHEME = Stepped(
    name="anitescu_potra",
    sentence="linear complementarity problem in velocities at the old configuration",
    source="M. Anitescu and F. A. Potra, Nonlinear Dynamics 14 (1997) 231-247",
    order=1,
    code=FixedStep.ANITESCU_POTRA,
    lag=lambda theta: 1.0,
)
