"""The slender rod in space: its lower tip slides on a horizontal floor with isotropic friction.

Source: docs/theory.md, section 6.2.
"""

import sympy as sp

from painleve.mechanics.friction import Disc, Section
from painleve.mechanics.library.slender_rod import BODY, GRAVITY, MU
from painleve.mechanics.scene import Coordinate, NamedState, Parameter, Scene, StateKey, make_scene

COORDINATES = (
    Coordinate(name="x", unit="m", sentence="horizontal position of the centre"),
    Coordinate(name="y", unit="m", sentence="horizontal position of the centre, across x"),
    Coordinate(name="z", unit="m", sentence="height of the centre above the floor"),
    Coordinate(name="theta", unit="rad", sentence="inclination; the tip is below the centre", latex=r"\theta"),
    Coordinate(
        name="phi", unit="rad", sentence="azimuth: the tip is behind the centre in this direction", latex=r"\varphi"
    ),
)
KEYS = (
    StateKey(name="theta", unit="rad", sentence="inclination", interval=("0", "pi/2")),
    StateKey(name="phi", unit="rad", sentence="azimuth of the rod", default="0"),
    StateKey(name="slip", unit="m/s", sentence="speed of the tip", default="1"),
    StateKey(
        name="heading",
        unit="rad",
        sentence="direction of the tip's velocity against the azimuth (pi: the tip moves away from the centre)",
        default="pi",
    ),
)


def make_spatial_rod(
    *,
    name: str,
    sentence: str,
    friction: Section,
    friction_parameters: tuple[Parameter, ...],
    states: tuple[NamedState, ...],
) -> Scene:
    """A rod in space on a floor with the given friction section; the states translate without turning."""
    x, y, z, theta, phi = (c.symbol for c in COORDINATES)
    m, l, I, gravity = (p.symbol for p in (*BODY, GRAVITY))  # noqa: E741 (the field's letters)
    u_x, u_y, u_z, u_theta, u_phi = (c.velocity for c in COORDINATES)
    slip, heading = KEYS[2].symbol, KEYS[3].symbol
    turning = u_theta**2 + (u_phi * sp.cos(theta)) ** 2
    return make_scene(
        name=name,
        sentence=sentence,
        source="the slender rod of P. Painlevé, C. R. Acad. Sci. Paris 121 (1895) 112-115, in space",
        coordinates=COORDINATES,
        parameters=(*BODY, *friction_parameters, GRAVITY),
        kinetic_energy=m * (u_x**2 + u_y**2 + u_z**2) / 2 + I * turning / 2,
        potential=m * gravity * z,
        constraint=l * sp.sin(theta) - z,
        tangential_displacements=(x - l * sp.cos(theta) * sp.cos(phi), y - l * sp.cos(theta) * sp.sin(phi)),
        friction=friction,
        keys=KEYS,
        placement={"z": l * sp.sin(theta), "theta": theta, "phi": phi},
        # cos(phi + heading) in parts, so that a heading with algebraic sine and cosine stays exact
        velocity={
            "x": slip * (sp.cos(phi) * sp.cos(heading) - sp.sin(phi) * sp.sin(heading)),
            "y": slip * (sp.sin(phi) * sp.cos(heading) + sp.cos(phi) * sp.sin(heading)),
        },
        states=states,
    )


SCENE = make_spatial_rod(
    name="spatial_rod",
    sentence="slender rod in space whose lower tip slides on a floor with constant isotropic friction",
    friction=Disc(mu=MU.symbol),
    friction_parameters=(MU,),
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
            name="oblique",
            sentence="gamma < 0 and the slip is oblique: slide, or jump to another slip",
            keys={"theta": "atan(2)", "heading": "2*pi/3"},
            parameters={"mu": "3/2"},
        ),
        NamedState(
            name="critical",
            sentence="gamma = 0, the slip parallel to b: the jump ends in sticking",
            keys={"theta": "atan(3 - sqrt(5))"},
            parameters={"mu": "2"},
        ),
        NamedState(
            name="critical_oblique",
            sentence="gamma = 0 and the slip is oblique: the jump ends in slip",
            keys={"theta": "atan(3 - sqrt(5))", "heading": "3*pi/4"},
            parameters={"mu": "2"},
        ),
        NamedState(
            name="double_zero",
            sentence="gamma = 0 at the least critical friction, where it touches zero",
            keys={"theta": "atan(2)", "heading": "3*pi/4"},
            parameters={"mu": "4/3"},
        ),
    ),
)
