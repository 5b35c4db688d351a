"""Moreau's midpoint scheme with Jean's theta, impacts without rebound.

    q_m = q_i + (1 - theta) h u_i,  contact where g(q_m) >= 0
    u_{i+1} = S(q_m, u_i + h M^-1(q_m) f(t_m, q_m, (1 - theta) u_i + theta u_{i+1})),  q_{i+1} = q_m + theta h u_{i+1}

Implicit in the velocity only, solved by fixed-point iteration; one evaluation more where f does not depend on u.
"""

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
