"""The scheme of Stewart and Trinkle (step: painleve.kernels.motion.schemes.stewart_trinkle).

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
