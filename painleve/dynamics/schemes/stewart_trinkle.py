"""The scheme of Stewart and Trinkle: complementarity with the linearised gap at the end of the step.

    u_{i+1} = u_i + h M^-1(q_i) f(t_i, q_i, u_i) + M^-1 W r,  0 <= r_n, -g(q_i) + h w_n . u_{i+1} >= 0, one of them 0
    q_{i+1} = q_i + h u_{i+1}

With one planar contact the complementarity problem is solved exactly; where it has several solutions the least impulse
is taken, and the step is counted.
"""

from painleve.core.motion_codes import FixedStep
from painleve.dynamics.scheme import Stepped

SCHEME = Stepped(
    name="stewart_trinkle",
    sentence="linear complementarity problem with the linearised gap",
    source="D. E. Stewart and J. C. Trinkle, Int. J. Numer. Methods Engrg. 39 (1996) 2673-2691",
    order=1,
    tests_contact=False,
    code=FixedStep.STEWART_TRINKLE,
    lag=lambda theta: 1.0,
)
