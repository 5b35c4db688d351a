"""The position-level scheme of Schatzman and Paoli (step: painleve.kernels.motion.schemes.schatzman_paoli)."""

from painleve.core.motion_codes import FixedStep
from painleve.dynamics.scheme import Stepped

SCHEME = Stepped(
    name="schatzman_paoli",
    sentence="central differences and the constraint imposed on the position",
    source="L. Paoli and M. Schatzman, SIAM J. Numer. Anal. 40 (2002) 702-733",
    order=1,
    tests_contact=False,
    code=FixedStep.SCHATZMAN_PAOLI,
)
