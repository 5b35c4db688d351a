"""Moreau's midpoint scheme with Jean's theta, impacts without rebound (painleve.kernels.motion.schemes.moreau_jean)."""

from painleve.core.motion_codes import FixedStep
from painleve.dynamics.scheme import Stepped

SCHEME = Stepped(
    name="moreau_jean",
    sentence="Moreau's law at a predicted midpoint, theta-method for the velocity",
    source="J. J. Moreau, CISM 302 (1988); M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235-257",
    order=2,
    friction_dimension=2,
    options={"theta": 0.5},
    code=FixedStep.MOREAU_JEAN,
    lag=lambda theta: theta,
)
