"""A rod whose tip slides on a round obstacle: the rod of a flat floor, turned with the tangent at the contact.

With r the tip's distance from the obstacle's centre, g = (R^2 - r^2)/(2 R): the true depth R - r but for a factor that
is 1 on the surface. H is the tip's velocity along the tangent times r/R, which is no gradient. grad g carries the same
factor, so that mu is Coulomb's coefficient everywhere, and both are free of roots.
gamma depends on theta + psi alone, psi the place of the tip.
"""

import sympy as sp

from painleve.mechanics.friction import Segment
from painleve.mechanics.library.slender_rod import COORDINATES, GRAVITY, INERTIA, LENGTH, MASS, MU
from painleve.mechanics.scene import NamedState, Parameter, StateKey, make_scene

RADIUS = Parameter(name="R", unit="m", sentence="radius of the obstacle, whose top is the origin", default="2")
PARAMETERS = (MASS, LENGTH, INERTIA, RADIUS, MU, GRAVITY)

x, y, theta = (c.symbol for c in COORDINATES)
u_x, u_y, u_theta = (c.velocity for c in COORDINATES)
m, l, I, R, mu, gravity = (p.symbol for p in PARAMETERS)  # noqa: E741 (the field's letters)
psi, slip, omega = sp.symbols("psi slip omega", real=True)

arm = sp.Matrix([-l * sp.cos(theta), -l * sp.sin(theta)])  # from the centre to the tip
radial = sp.Matrix([x, y + R]) + arm  # from the obstacle's centre to the tip
tangent = sp.Matrix([radial[1], -radial[0]]) / R
tip_velocity = sp.Matrix([[1, 0, -arm[1]], [0, 1, arm[0]]])  # its Jacobian
outward, along = sp.Matrix([sp.sin(psi), sp.cos(psi)]), sp.Matrix([sp.cos(psi), -sp.sin(psi)])

SCENE = make_scene(
    name="rod_on_obstacle",
    sentence="slender rod whose lower tip slides on a round obstacle with constant friction",
    source="derived for this project: the rod of L. Paoli, IFIP AICT 494 (2016), section 1, on a circle",
    coordinates=COORDINATES,
    parameters=PARAMETERS,
    kinetic_energy=m * (u_x**2 + u_y**2) / 2 + I * u_theta**2 / 2,
    potential=m * gravity * y,
    constraint=(R**2 - (radial.T * radial)[0, 0]) / (2 * R),
    tangents=tip_velocity.T * tangent,
    friction=Segment(minus=mu, plus=mu),
    keys=(
        StateKey(name="theta", unit="rad", sentence="inclination", interval=("0", "pi/2")),
        StateKey(name="psi", unit="rad", sentence="angle from the upward vertical to the tip, clockwise", default="0"),
        StateKey(name="slip", unit="m/s", sentence="speed of the tip along the tangent", default="-1"),
        StateKey(name="omega", unit="rad/s", sentence="angular velocity", default="0"),
    ),
    placement={"x": R * outward[0] - arm[0], "y": R * (outward[1] - 1) - arm[1], "theta": theta},
    velocity={"x": slip * along[0] + omega * arm[1], "y": slip * along[1] - omega * arm[0], "theta": omega},
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
            sentence="gamma = 0 on an edge of the band of paradoxes",
            keys={"theta": "pi/4"},
            parameters={"mu": "5/3"},
        ),
        NamedState(
            name="double_zero",
            sentence="gamma = 0 at the least critical friction, that of the flat floor",
            keys={"theta": "atan(2)"},
            parameters={"mu": "4/3"},
        ),
        NamedState(
            name="slope",
            sentence="the same on the obstacle's side: theta + psi = atan(2)",
            keys={"theta": "atan(2) - atan(3/4)", "psi": "atan(3/4)"},
            parameters={"mu": "4/3"},
        ),
    ),
)
