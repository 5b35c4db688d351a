"""The scheme of Anitescu and Potra (step: painleve.kernels.motion.schemes.anitescu_potra)."""

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
