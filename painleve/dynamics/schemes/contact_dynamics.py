"""The Contact Dynamics scheme of the paper's section 2, to the letter (docs/theory.md, section 7).

q_{i+1} = q_i + h u_i,  v = u_i + h M^-1(q_{i+1}) f(t_{i+1}, q_{i+1}, u_i),  u_{i+1} = S(q_{i+1}, v)
"""

from painleve.core.motion_codes import FixedStep
from painleve.dynamics.scheme import Stepped

SCHEME = Stepped(
    name="contact_dynamics",
    sentence="explicit Euler step, then Moreau's law at the new configuration",
    source="L. Paoli, IFIP AICT 494 (2016), section 2; J. J. Moreau, CISM 302 (1988)",
    order=1,
    friction_dimension=2,
    code=FixedStep.CONTACT_DYNAMICS,
)
