"""A rigid body in the plane that touches a floor with one of its points, at (xi, eta) in the body's frame.

With X and Y the contact point's offset from the centre of mass, mu_c = (I/m + X^2)/|X Y|: a rod whose alpha is
m (xi^2 + eta^2)/I. A uniform rectangle on its corner has alpha = 3, whatever its sides: it is a slender rod.
(docs/theory.md, section 6.1.)
"""

import sympy as sp

from painleve.mechanics.friction import Segment
from painleve.mechanics.library.slender_rod import GRAVITY, MU
from painleve.mechanics.scene import Coordinate, NamedState, Outline, Parameter, StateKey, make_scene

COORDINATES = (
    Coordinate(name="x", unit="m", sentence="horizontal position of the centre of mass"),
    Coordinate(name="y", unit="m", sentence="height of the centre of mass above the floor"),
    Coordinate(name="theta", unit="rad", sentence="rotation of the body's frame, counterclockwise", latex=r"\theta"),
)
PARAMETERS = (
    Parameter(name="m", unit="kg", sentence="mass", default="1"),
    Parameter(
        name="xi",
        unit="m",
        sentence="contact point in the body's frame, along its first axis",
        default="-3/5",
        range="real",
        latex=r"\xi",
    ),
    Parameter(
        name="eta",
        unit="m",
        sentence="contact point in the body's frame, along its second axis",
        default="-4/5",
        range="real",
        latex=r"\eta",
    ),
    Parameter(
        name="I",
        unit="kg m^2",
        sentence="moment of inertia about the centre of mass; default: a uniform "
        "rectangle with a corner at the contact point",
        default="m*(xi**2 + eta**2)/3",
    ),
    MU,
    GRAVITY,
)

x, y, theta = (c.symbol for c in COORDINATES)
u_x, u_y, u_theta = (c.velocity for c in COORDINATES)
m, xi, eta, I, mu, gravity = (p.symbol for p in PARAMETERS)  # noqa: E741 (the field's letters)
slip, omega = sp.symbols("slip omega", real=True)


def turned(first: sp.Expr, second: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Components along the floor and upwards of a vector in the body's frame."""
    return first * sp.cos(theta) - second * sp.sin(theta), first * sp.sin(theta) + second * sp.cos(theta)


X, Y = turned(xi, eta)
corners = [turned(i * xi, j * eta) for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))]

SCENE = make_scene(
    name="planar_body",
    sentence="rigid body in the plane, a point of which slides on a floor with constant friction",
    source="F. Génot and B. Brogliato, Eur. J. Mech. A/Solids 18 (1999) 653-677; here with any offset",
    coordinates=COORDINATES,
    parameters=PARAMETERS,
    kinetic_energy=m * (u_x**2 + u_y**2) / 2 + I * u_theta**2 / 2,
    potential=m * gravity * y,
    constraint=-(y + Y),
    tangential_displacements=(x + X,),
    friction=Segment(minus=mu, plus=mu),
    keys=(
        StateKey(name="theta", unit="rad", sentence="rotation of the body's frame"),
        StateKey(name="slip", unit="m/s", sentence="tangential speed of the contact point", default="-1"),
        StateKey(name="omega", unit="rad/s", sentence="angular velocity", default="0"),
    ),
    placement={"x": sp.Integer(0), "y": -Y, "theta": theta},
    velocity={"x": slip + omega * Y, "y": -omega * X, "theta": omega},
    outline=Outline(points=tuple((x + i, y + j) for i, j in corners), floor=sp.Integer(0)),
    # The contact point is at atan(4/3) below the body's first axis: these are the rod's states, turned.
    states=(
        NamedState(
            name="sliding",
            sentence="gamma > 0: ordinary sliding, nothing is indeterminate",
            keys={"theta": "atan(2/11)"},
            parameters={"mu": "1/2"},
        ),
        NamedState(
            name="paradox",
            sentence="gamma < 0: slide or jump to sticking",
            keys={"theta": "atan(2/11)"},
            parameters={"mu": "2"},
        ),
        NamedState(
            name="critical",
            sentence="gamma = 0 on the lower edge of the band of paradoxes",
            keys={"theta": "atan(3 - sqrt(5)) - atan(4/3)"},
            parameters={"mu": "2"},
        ),
        NamedState(
            name="double_zero",
            sentence="gamma = 0 at the least critical friction, where it touches zero",
            keys={"theta": "atan(2/11)"},
            parameters={"mu": "4/3"},
        ),
    ),
)
