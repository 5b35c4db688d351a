"""The least scene in which every branch of Theorem 1 occurs: two coordinates, a flat floor, a coupling beta(x, y).

M^-1 = [[A, beta], [beta, N]] and g = -y, so gamma = N - mu |beta|; beta is a polynomial of second degree, positive
definiteness asks for A N > beta^2. With N = mu = beta_0 = 1 and no other term of first order, (0, 0) is critical.
(docs/theory.md, section 6.2.)
"""

import sympy as sp

from painleve.mechanics.friction import Segment
from painleve.mechanics.library.slender_rod import MU
from painleve.mechanics.scene import Coordinate, NamedState, Parameter, StateKey, make_scene

COORDINATES = (
    Coordinate(name="x", unit="m", sentence="position along the floor"),
    Coordinate(name="y", unit="m", sentence="height above the floor"),
)


def coefficient(name: str, unit: str, sentence: str, default: str) -> Parameter:
    return Parameter(name=name, unit=unit, sentence=sentence, default=default, range="real", latex=rf"\{name}")


PARAMETERS = (
    Parameter(name="A", unit="1/kg", sentence="tangential compliance", default="4"),
    Parameter(name="N", unit="1/kg", sentence="normal compliance", default="1"),
    coefficient("beta_0", "1/kg", "coupling beta at the origin", "1"),
    coefficient("beta_x", "1/(kg m)", "slope of beta along the floor", "0"),
    coefficient("beta_y", "1/(kg m)", "slope of beta upwards", "0"),
    coefficient("beta_xx", "1/(kg m^2)", "coefficient of x^2 in beta", "1"),
    coefficient("beta_yy", "1/(kg m^2)", "coefficient of y^2 in beta", "-1"),
    MU,
)

x, y = (c.symbol for c in COORDINATES)
A, N, beta_0, beta_x, beta_y, beta_xx, beta_yy, mu = (p.symbol for p in PARAMETERS)
beta = beta_0 + beta_x * x + beta_y * y + beta_xx * x**2 + beta_yy * y**2

SCENE = make_scene(
    name="minimal",
    sentence="two coordinates whose coupling is a polynomial: every branch of Theorem 1 by a choice of coefficients",
    source="derived for this project: the least example of each branch of L. Paoli, IFIP AICT 494 (2016), Theorem 1",
    coordinates=COORDINATES,
    parameters=PARAMETERS,
    inertia=sp.Matrix([[N, -beta], [-beta, A]]) / (A * N - beta**2),
    constraint=-y,
    tangential_displacements=(x,),
    friction=Segment(minus=mu, plus=mu),
    keys=(
        StateKey(name="x", unit="m", sentence="position along the floor", default="0", interval=("-1/2", "1/2")),
        StateKey(name="slip", unit="m/s", sentence="tangential speed", default="1"),
    ),
    placement={"x": x, "y": sp.Integer(0)},
    velocity={"x": sp.Symbol("slip", real=True)},
    states=(
        NamedState(
            name="sliding",
            sentence="gamma > 0: ordinary sliding, nothing is indeterminate",
            keys={},
            parameters={"mu": "1/2"},
        ),
        NamedState(name="paradox", sentence="gamma < 0: slide or jump to sticking", keys={}, parameters={"mu": "3/2"}),
        NamedState(
            name="crossing",
            sentence="gamma = 0 and grows along the floor: approached",
            keys={},
            parameters={"mu": "1", "beta_x": "1"},
        ),
        NamedState(
            name="approached",
            sentence="gamma = y^2 - x^2: zero gradient, positive only into penetration",
            keys={},
            parameters={"mu": "1"},
        ),
        NamedState(
            name="isolated",
            sentence="gamma = -x^2 - y^2: negative all around",
            keys={},
            parameters={"mu": "1", "beta_yy": "1"},
        ),
        NamedState(
            name="isolated_by_slope",
            sentence="gamma = y - x^2 + y^2: falls into penetration",
            keys={},
            parameters={"mu": "1", "beta_y": "-1"},
        ),
    ),
)
