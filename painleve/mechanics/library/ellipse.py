"""An elliptical body that slides and rolls on a floor: the contact point moves over the body.

The height of the lowest point below the centre is the support function h(theta) = sqrt(A^2 sin^2 + B^2 cos^2), and that
point is (-h', -h) from the centre. H is the velocity of the material point that is there, u_x + h u_theta: it is no
gradient of the moving point's position. mu_c = (I/m + h'^2)/|h h'|: infinite for a disc (A = B), a rod's for B = 0, and
with the mass near the centre it has a maximum between two minima. (docs/theory.md, section 6.2.)
"""

import sympy as sp

from painleve.mechanics.friction import Segment
from painleve.mechanics.library.slender_rod import GRAVITY, MU
from painleve.mechanics.scene import Coordinate, NamedState, Outline, Parameter, StateKey, make_scene

COORDINATES = (
    Coordinate(name="x", unit="m", sentence="horizontal position of the centre"),
    Coordinate(name="y", unit="m", sentence="height of the centre above the floor"),
    Coordinate(
        name="theta", unit="rad", sentence="angle from the floor to the axis A, counterclockwise", latex=r"\theta"
    ),
)
PARAMETERS = (
    Parameter(name="m", unit="kg", sentence="mass", default="1"),
    Parameter(name="A", unit="m", sentence="first semi-axis", default="1"),
    Parameter(name="B", unit="m", sentence="second semi-axis", default="1/2"),
    Parameter(
        name="I",
        unit="kg m^2",
        sentence="moment of inertia about the centre; default: uniform",
        default="m*(A**2 + B**2)/4",
    ),
    MU,
    GRAVITY,
)

x, y, theta = (c.symbol for c in COORDINATES)
u_x, u_y, u_theta = (c.velocity for c in COORDINATES)
m, A, B, I, mu, gravity = (p.symbol for p in PARAMETERS)  # noqa: E741 (the field's letters)
slip, omega = sp.symbols("slip omega", real=True)

support = sp.sqrt(A**2 * sp.sin(theta) ** 2 + B**2 * sp.cos(theta) ** 2)
slope = (A**2 - B**2) * sp.sin(theta) * sp.cos(theta) / support

rim = [(A * sp.cos(j * sp.pi / 12), B * sp.sin(j * sp.pi / 12)) for j in range(25)]
outline = [(x + p * sp.cos(theta) - q * sp.sin(theta), y + p * sp.sin(theta) + q * sp.cos(theta)) for p, q in rim]

# A^2 = 2 B^2 and I = 3/100 m A^2: mu_c is greatest at theta = pi/6, between two minima.
HEAVY_CORE = {"B": "sqrt(2)/2", "I": "3/100"}

SCENE = make_scene(
    name="ellipse",
    sentence="elliptical body that slides and rolls on a floor with constant friction",
    source="derived for this project: an ellipse's support function; its limits are a disc and a slender rod",
    coordinates=COORDINATES,
    parameters=PARAMETERS,
    kinetic_energy=m * (u_x**2 + u_y**2) / 2 + I * u_theta**2 / 2,
    potential=m * gravity * y,
    constraint=support - y,
    tangents=sp.Matrix([1, 0, support]),
    friction=Segment(minus=mu, plus=mu),
    keys=(
        StateKey(name="theta", unit="rad", sentence="angle of the axis A", interval=("0", "pi/2")),
        StateKey(name="slip", unit="m/s", sentence="tangential speed of the body at the contact", default="-1"),
        StateKey(name="omega", unit="rad/s", sentence="angular velocity", default="0"),
    ),
    placement={"x": sp.Integer(0), "y": support, "theta": theta},
    velocity={"x": slip - omega * support, "y": omega * slope, "theta": omega},
    outline=Outline(points=tuple(outline), floor=sp.Integer(0), contact_is_lowest=True),
    states=(
        NamedState(
            name="sliding",
            sentence="gamma > 0: ordinary sliding, nothing is indeterminate",
            keys={"theta": "pi/4"},
            parameters={"mu": "1/2"},
        ),
        NamedState(
            name="paradox",
            sentence="gamma < 0: slide or jump to rolling",
            keys={"theta": "pi/4"},
            parameters={"mu": "2"},
        ),
        NamedState(
            name="critical",
            sentence="gamma = 0 on an edge of the band of paradoxes",
            keys={"theta": "pi/4"},
            parameters={"mu": "43/30"},
        ),
        NamedState(
            name="isolated",
            sentence="gamma = 0 at a maximum of mu_c: a heavy core, constant friction",
            keys={"theta": "pi/6"},
            parameters=HEAVY_CORE | {"mu": "7*sqrt(3)/25"},
        ),
        NamedState(
            name="approached",
            sentence="gamma = 0 at a minimum of mu_c of the same body",
            keys={"theta": "atan(sqrt(4 - sqrt(61)/2))"},
            parameters=HEAVY_CORE | {"mu": "sqrt(1753 + 61*sqrt(61))/100"},
        ),
    ),
)
