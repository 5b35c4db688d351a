"""The position-level scheme of Schatzman and Paoli, impacts without rebound, with Coulomb's friction.

    q_{i+1} = 2 q_i - q_{i-1} + h^2 M^-1 f(t_i, q_i, u_i) + h M^-1(q_{i+1}) W(q_{i+1}) r,  u_{i+1} = (q_{i+1} - q_i)/h
    0 <= r_n, g(q_{i+1}) <= 0, one of them 0

Published without friction; friction opposes the slip W^T u_{i+1}. The constraint is met by Newton's iteration on g.
"""

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
