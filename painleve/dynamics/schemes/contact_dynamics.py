"""The Contact Dynamics scheme of the paper's section 2 (step: painleve.kernels.motion.schemes.contact_dynamics)."""

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
