"""A bead on a curved wall y = kappa x^2/2, without friction: the inertia matrix depends on the configuration.

The coordinates are x and the height w above the wall, so that g = -w and y = w + kappa x^2/2. On the wall the bead
obeys (1 + kappa^2 x^2) x'' + kappa^2 x x'^2 + gravity kappa x = 0, and presses on it while
m (gravity + kappa x'^2) > 0; over a hill, kappa < 0, a fast bead leaves it. (docs/theory.md, section 6.2.)
"""

import sympy as sp

from painleve.mechanics.library.slender_rod import GRAVITY
from painleve.mechanics.scene import Coordinate, NamedState, Parameter, StateKey, make_scene

COORDINATES = (
    Coordinate(name="x", unit="m", sentence="horizontal position"),
    Coordinate(name="w", unit="m", sentence="height above the wall"),
)
PARAMETERS = (
    Parameter(name="m", unit="kg", sentence="mass", default="1"),
    Parameter(
        name="kappa",
        unit="1/m",
        sentence="curvature of the wall at its lowest point; a hill where negative",
        default="1",
        range="real",
        latex=r"\kappa",
    ),
    GRAVITY,
)

x, w = (c.symbol for c in COORDINATES)
u_x, u_w = (c.velocity for c in COORDINATES)
m, kappa, gravity = (p.symbol for p in PARAMETERS)
speed = sp.Symbol("speed", real=True)

SCENE = make_scene(
    name="bead",
    sentence="bead on a parabolic wall that it may leave, without friction",
    source="derived for this project: Lagrange's equations of a point on a parabola",
    coordinates=COORDINATES,
    parameters=PARAMETERS,
    kinetic_energy=m * (u_x**2 + (u_w + kappa * x * u_x) ** 2) / 2,
    potential=m * gravity * (w + kappa * x**2 / 2),
    constraint=-w,
    keys=(
        StateKey(name="x", unit="m", sentence="horizontal position"),
        StateKey(name="speed", unit="m/s", sentence="speed along the wall", default="1"),
    ),
    placement={"x": x, "w": sp.Integer(0)},
    velocity={"x": speed / sp.sqrt(1 + kappa**2 * x**2)},
    states=(
        NamedState(
            name="sliding", sentence="without friction nothing is indeterminate", keys={"x": "3/4"}, parameters={}
        ),
        NamedState(
            name="hilltop",
            sentence="over a hill, fast enough to leave it",
            keys={"x": "0", "speed": "4"},
            parameters={"kappa": "-1"},
        ),
    ),
)
