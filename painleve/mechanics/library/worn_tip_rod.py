"""The slender rod with a worn tip: the coefficient of friction depends on the inclination.

Source: docs/theory.md, section 6.2.
"""

import sympy as sp

from painleve.mechanics.library.slender_rod import COORDINATES, make_rod
from painleve.mechanics.scene import NamedState, Parameter

MU_0 = Parameter(
    name="mu_0",
    unit="1",
    sentence="coefficient of friction at the inclination theta_0",
    default="4/3",
    range="nonnegative",
    latex=r"\mu_0",
)
K = Parameter(name="k", unit="1/rad^2", sentence="wear: mu = mu_0 + k (theta - theta_0)^2", default="2", range="real")
THETA_0 = Parameter(
    name="theta_0",
    unit="rad",
    sentence="inclination of least friction",
    default="atan(2)",
    range="real",
    latex=r"\theta_0",
)

theta: sp.Symbol = COORDINATES[2].symbol

SCENE = make_rod(
    name="worn_tip_rod",
    sentence="slender rod whose coefficient of friction mu_0 + k (theta - theta_0)^2 depends on its inclination",
    friction_parameters=(MU_0, K, THETA_0),
    friction_coefficient=MU_0.symbol + K.symbol * (theta - THETA_0.symbol) ** 2,
    # The critical friction has the second derivative 25/3 at arctan 2: k = 25/6 parts the two kinds of critical state.
    states=(
        NamedState(
            name="sliding",
            sentence="gamma > 0: ordinary sliding, nothing is indeterminate",
            keys={"theta": "atan(2)"},
            parameters={"mu_0": "1/2", "k": "2"},
        ),
        NamedState(
            name="paradox",
            sentence="gamma < 0: slide or jump to sticking",
            keys={"theta": "atan(2)"},
            parameters={"mu_0": "2", "k": "2"},
        ),
        NamedState(
            name="approached",
            sentence="gamma = 0, positive on both sides: k = 2 < 25/6",
            keys={"theta": "atan(2)"},
            parameters={"k": "2"},
        ),
        NamedState(
            name="isolated",
            sentence="gamma = 0, negative on both sides: k = 6 > 25/6",
            keys={"theta": "atan(2)"},
            parameters={"k": "6"},
        ),
    ),
)
