"""A two-link arm whose tip slides on a table below its shoulder; constant friction.

Along the table the critical friction has interior maxima and minima. At such a point with mu equal to it, gamma = 0
and grad gamma is parallel to grad g. Half-angle tangents that are rational make sines and cosines rational, and the
condition that mu_c is stationary along the table is then a quadratic equation for m2/m1: the two named states.
(docs/theory.md, section 6.2.)
"""

import sympy as sp

from painleve.mechanics.friction import Segment
from painleve.mechanics.library.slender_rod import GRAVITY, MU
from painleve.mechanics.scene import Coordinate, NamedState, Outline, Parameter, Scene, StateKey, make_scene

COORDINATES = (
    Coordinate(
        name="phi1", unit="rad", sentence="angle of the first link from the downward vertical", latex=r"\varphi_1"
    ),
    Coordinate(
        name="phi2", unit="rad", sentence="angle of the second link from the downward vertical", latex=r"\varphi_2"
    ),
)
MASSES = (
    Parameter(name="m1", unit="kg", sentence="mass of the first link", default="1", latex="m_1"),
    Parameter(name="m2", unit="kg", sentence="mass of the second link", default="1", latex="m_2"),
)
LENGTHS = (
    Parameter(name="l1", unit="m", sentence="length of the first link", default="1", latex=r"\ell_1"),
    Parameter(name="l2", unit="m", sentence="length of the second link", default="1", latex=r"\ell_2"),
)
DEPTH = Parameter(
    name="depth",
    unit="m",
    sentence="depth of the table below the shoulder (default: where the tip is)",
    default="39/20",
    latex="H",
)

phi1, phi2 = (c.symbol for c in COORDINATES)
u1, u2 = (c.velocity for c in COORDINATES)
m1, m2, l1, l2, depth, mu, gravity = (p.symbol for p in (*MASSES, *LENGTHS, DEPTH, MU, GRAVITY))
slip = sp.Symbol("slip", real=True)

# cos(phi1 - phi2), written so that rational half-angle tangents keep it rational
cos_elbow = sp.cos(phi1) * sp.cos(phi2) + sp.sin(phi1) * sp.sin(phi2)
sin_elbow = sp.sin(phi2) * sp.cos(phi1) - sp.cos(phi2) * sp.sin(phi1)
elbow = (l1 * sp.sin(phi1), -l1 * sp.cos(phi1))
tip = (elbow[0] + l2 * sp.sin(phi2), elbow[1] - l2 * sp.cos(phi2))


def make_arm(
    *,
    name: str,
    sentence: str,
    source: str,
    link_parameters: tuple[Parameter, ...],
    centres: tuple[sp.Expr, sp.Expr],
    inertias: tuple[sp.Expr, sp.Expr],
    states: tuple[NamedState, ...],
) -> Scene:
    """An arm of two links, each with its centre of mass on the line between its joints: how far from the upper one,
    and the moment of inertia about it, as expressions in the parameters."""
    d1, d2 = centres
    first_link = (m1 * d1**2 + inertias[0]) * u1**2 / 2
    second_link = (m2 * ((l1 * u1) ** 2 + 2 * l1 * d2 * u1 * u2 * cos_elbow + (d2 * u2) ** 2) + inertias[1] * u2**2) / 2
    return make_scene(
        name=name,
        sentence=sentence,
        source=source,
        coordinates=COORDINATES,
        parameters=(*MASSES, *LENGTHS, *link_parameters, DEPTH, MU, GRAVITY),
        kinetic_energy=first_link + second_link,
        potential=-gravity * (m1 * d1 * sp.cos(phi1) + m2 * (l1 * sp.cos(phi1) + d2 * sp.cos(phi2))),
        constraint=l1 * sp.cos(phi1) + l2 * sp.cos(phi2) - depth,
        tangential_displacements=(l1 * sp.sin(phi1) + l2 * sp.sin(phi2),),
        friction=Segment(minus=mu, plus=mu),
        keys=(
            StateKey(name="phi1", unit="rad", sentence="angle of the first link"),
            StateKey(
                name="phi2",
                unit="rad",
                sentence="angle of the second link; default: not below zero, and such that the tip is at the depth",
                default="acos((depth - l1*cos(phi1))/l2)",
            ),
            StateKey(name="slip", unit="m/s", sentence="tangential speed of the tip", default="1"),
        ),
        placement={"phi1": phi1, "phi2": phi2},
        velocity={
            "phi1": slip * sp.sin(phi2) / (l1 * sin_elbow),
            "phi2": -slip * sp.sin(phi1) / (l2 * sin_elbow),
        },
        contact_parameters={"depth": l1 * sp.cos(phi1) + l2 * sp.cos(phi2)},
        outline=Outline(points=((sp.Integer(0), sp.Integer(0)), elbow, tip), floor=-depth),
        states=states,
    )


# tan(phi1/2) = -1/12, tan(phi2/2) = 1/7: a local maximum of mu_c along the table
MAXIMUM = {"phi1": "-atan(24/143)", "phi2": "atan(7/24)", "slip": "1577*sqrt(55609)/278045"}
MAXIMUM_MASS = "(69803*sqrt(9302610694314086881) - 50256522402277)/164665742038206"
MAXIMUM_FRICTION = "(11366602609 - sqrt(9302610694314086881))/13475730000"
# tan(phi1/2) = -1/3, tan(phi2/2) = 1/8: a local minimum
MINIMUM = {"phi1": "-atan(3/4)", "phi2": "atan(16/63)", "slip": "253*sqrt(1777)/8885"}
MINIMUM_MASS = "(1525508383 - 23*sqrt(401384073317041))/1002713763"
MINIMUM_FRICTION = "(382459321 - sqrt(401384073317041))/339943500"

SCENE = make_arm(
    name="two_link_arm",
    sentence="two uniform links hanging from a shoulder, the tip sliding on a table with constant friction",
    source="the paper's second case of Theorem 1 in a plain mechanism; derived for this project",
    link_parameters=(),
    centres=(l1 / 2, l2 / 2),
    inertias=(m1 * l1**2 / 12, m2 * l2**2 / 12),
    states=(
        NamedState(
            name="sliding",
            sentence="gamma > 0: ordinary sliding, nothing is indeterminate",
            keys=MAXIMUM,
            parameters={"mu": "1/2"},
        ),
        NamedState(name="paradox", sentence="gamma < 0: slide or jump to rest", keys=MAXIMUM, parameters={"mu": "1"}),
        NamedState(
            name="approached",
            sentence="gamma = 0 at a local minimum of mu_c along the table",
            keys=MINIMUM,
            parameters={"m2": MINIMUM_MASS, "mu": MINIMUM_FRICTION},
        ),
        NamedState(
            name="isolated",
            sentence="gamma = 0 at a local maximum of mu_c along the table",
            keys=MAXIMUM,
            parameters={"m2": MAXIMUM_MASS, "mu": MAXIMUM_FRICTION},
        ),
    ),
)
