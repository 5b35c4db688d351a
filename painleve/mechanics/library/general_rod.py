"""A rod of any mass distribution that is symmetric about its centre: alpha = m l^2/I says all that friction asks.

The least critical friction is mu_P(alpha) = 2 sqrt(1 + alpha)/alpha, at tan(theta) = sqrt(1 + alpha).
(docs/theory.md, section 6.1.)
"""

import sympy as sp

from painleve.mechanics.library.slender_rod import LENGTH, MASS, MU, make_rod
from painleve.mechanics.scene import NamedState, Parameter

ALPHA = Parameter(
    name="alpha",
    unit="1",
    sentence="m l^2/I: 1 for two point masses at the ends, 3 for a uniform rod",
    default="3",
    latex=r"\alpha",
)

SCENE = make_rod(
    name="general_rod",
    sentence="rod with the moment of inertia m l^2/alpha whose lower tip slides on a floor with constant friction",
    friction_parameters=(MU,),
    friction_coefficient=MU.symbol,
    inertia_parameter=ALPHA,
    inertia=MASS.symbol * LENGTH.symbol**2 / ALPHA.symbol,
    states=(
        NamedState(
            name="sliding",
            sentence="gamma > 0: ordinary sliding, nothing is indeterminate",
            keys={"theta": "atan(3)"},
            parameters={"alpha": "8", "mu": "1/2"},
        ),
        NamedState(
            name="paradox",
            sentence="gamma < 0: slide or jump to sticking",
            keys={"theta": "atan(3)"},
            parameters={"alpha": "8", "mu": "1"},
        ),
        NamedState(
            name="double_zero",
            sentence="gamma = 0 at the least critical friction of alpha = 8, which is 3/4",
            keys={"theta": "atan(3)"},
            parameters={"alpha": "8", "mu": "3/4"},
        ),
        NamedState(
            name="dumbbell",
            sentence="gamma = 0 at the least critical friction of two point masses",
            keys={"theta": "atan(sqrt(2))"},
            parameters={"alpha": "1", "mu": str(2 * sp.sqrt(2))},
        ),
    ),
)
