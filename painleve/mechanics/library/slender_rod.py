"""The slender rod of the Painlevé paradox: its lower tip slides on a horizontal floor (docs/theory.md, section 6.1)."""

import sympy as sp

from painleve.mechanics.friction import Segment
from painleve.mechanics.scene import Coordinate, NamedState, Outline, Parameter, Scene, StateKey, make_scene

SOURCE = "P. Painlevé, C. R. Acad. Sci. Paris 121 (1895) 112-115; L. Paoli, IFIP AICT 494 (2016), section 1"

COORDINATES = (
    Coordinate(name="x", unit="m", sentence="horizontal position of the centre"),
    Coordinate(name="y", unit="m", sentence="height of the centre above the floor"),
    Coordinate(
        name="theta",
        unit="rad",
        sentence="inclination; the tip is below and to the left of the centre",
        latex=r"\theta",
    ),
)
MASS = Parameter(name="m", unit="kg", sentence="mass", default="1")
LENGTH = Parameter(name="l", unit="m", sentence="half length", default="1")
INERTIA = Parameter(name="I", unit="kg m^2", sentence="moment of inertia about the centre", default="m*l**2/3")
BODY = (MASS, LENGTH, INERTIA)
GRAVITY = Parameter(
    name="gravity", unit="m/s^2", sentence="acceleration of gravity", default="981/100", range="real", latex="g_0"
)
KEYS = (
    StateKey(name="theta", unit="rad", sentence="inclination", interval=("0", "pi/2")),
    StateKey(name="slip", unit="m/s", sentence="tangential speed of the tip", default="-1"),
    StateKey(name="omega", unit="rad/s", sentence="angular velocity", default="0"),
)


def make_rod(
    *,
    name: str,
    sentence: str,
    friction_parameters: tuple[Parameter, ...],
    friction_coefficient: sp.Expr,
    states: tuple[NamedState, ...],
    inertia_parameter: Parameter = INERTIA,
    inertia: sp.Expr = INERTIA.symbol,
) -> Scene:
    """A rod on a floor; the friction coefficient is an expression in theta and its parameters, the moment of inertia
    one in m, l and its parameter."""
    x, y, theta = (c.symbol for c in COORDINATES)
    m, l, gravity = (p.symbol for p in (MASS, LENGTH, GRAVITY))  # noqa: E741 (the field's letters)
    slip, omega = KEYS[1].symbol, KEYS[2].symbol
    u_x, u_y, u_theta = (c.velocity for c in COORDINATES)
    half = (l * sp.cos(theta), l * sp.sin(theta))
    return make_scene(
        name=name,
        sentence=sentence,
        source=SOURCE,
        coordinates=COORDINATES,
        parameters=(MASS, LENGTH, inertia_parameter, *friction_parameters, GRAVITY),
        kinetic_energy=m * (u_x**2 + u_y**2) / 2 + inertia * u_theta**2 / 2,
        potential=m * gravity * y,
        constraint=l * sp.sin(theta) - y,
        tangential_displacements=(x - l * sp.cos(theta),),
        friction=Segment(minus=friction_coefficient, plus=friction_coefficient),
        keys=KEYS,
        placement={"x": sp.Integer(0), "y": l * sp.sin(theta), "theta": theta},
        # With a spin the centre moves so that the tip's normal velocity is zero.
        velocity={"x": slip - l * omega * sp.sin(theta), "y": l * omega * sp.cos(theta), "theta": omega},
        states=states,
        outline=Outline(points=((x - half[0], y - half[1]), (x + half[0], y + half[1])), floor=sp.Integer(0)),
    )


MU = Parameter(
    name="mu", unit="1", sentence="Coulomb's coefficient of friction", default="1/2", range="nonnegative", latex=r"\mu"
)

SCENE = make_rod(
    name="slender_rod",
    sentence="slender rod whose lower tip slides on a floor with constant friction",
    friction_parameters=(MU,),
    friction_coefficient=MU.symbol,
    states=(
        NamedState(
            name="sliding",
            sentence="gamma > 0: ordinary sliding, nothing is indeterminate",
            keys={"theta": "atan(2)"},
            parameters={"mu": "1/2"},
        ),
        NamedState(
            name="paradox",
            sentence="gamma < 0: slide or jump to sticking",
            keys={"theta": "atan(2)"},
            parameters={"mu": "2"},
        ),
        NamedState(
            name="critical",
            sentence="gamma = 0 on the lower edge of the band of paradoxes",
            keys={"theta": "atan(3 - sqrt(5))"},
            parameters={"mu": "2"},
        ),
        NamedState(
            name="double_zero",
            sentence="gamma = 0 at the least critical friction, where it touches zero",
            keys={"theta": "atan(2)"},
            parameters={"mu": "4/3"},
        ),
        # "Stoss ohne Kollision": C. Glocker, Dynamik von Starrkoerpersystemen mit Reibung und Stoessen, 1995, 5.3.4
        NamedState(
            name="stoss",
            sentence="ordinary sliding that runs into the singular point at 45 degrees",
            keys={"theta": "31*pi/180", "slip": "-30"},
            parameters={"mu": "5/3", "gravity": "10"},
        ),
    ),
)
