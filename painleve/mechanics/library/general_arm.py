"""A two-link arm of any mass distribution along its links; the default values are those of the uniform arm."""

from painleve.mechanics.library.two_link_arm import l1, l2, make_arm
from painleve.mechanics.scene import NamedState, Parameter

LINKS = (
    Parameter(
        name="c1",
        unit="1",
        sentence="centre of mass of the first link, as a fraction of its length",
        default="1/2",
        range="real",
        latex="c_1",
    ),
    Parameter(
        name="c2",
        unit="1",
        sentence="centre of mass of the second link, as a fraction of its length",
        default="1/2",
        range="real",
        latex="c_2",
    ),
    Parameter(
        name="I1",
        unit="kg m^2",
        sentence="moment of inertia of the first link about its centre of mass",
        default="m1*l1**2/12",
        latex="I_1",
    ),
    Parameter(
        name="I2",
        unit="kg m^2",
        sentence="moment of inertia of the second link about its centre of mass",
        default="m2*l2**2/12",
        latex="I_2",
    ),
)
c1, c2, I1, I2 = (p.symbol for p in LINKS)

# tan(phi1/2) = -1/7, tan(phi2/2) = 1/3; that mu_c is stationary along the table is a quadratic equation for I2.
KEYS = {"phi1": "-atan(7/24)", "phi2": "atan(3/4)"}
LINKS_OF_STATES = {
    "m2": "1/2",
    "c2": "2/3",
    "I1": "1/4",
    "I2": "23943/6125 - 88*sqrt(5652826)/55125",
}

SCENE = make_arm(
    name="general_arm",
    sentence="two links of any mass distribution, the tip sliding on a table with constant friction",
    source="the uniform arm of this library, with centres of mass and moments of inertia as parameters",
    link_parameters=LINKS,
    centres=(c1 * l1, c2 * l2),
    inertias=(I1, I2),
    states=(
        NamedState(
            name="sliding",
            sentence="gamma > 0: ordinary sliding, nothing is indeterminate",
            keys=KEYS,
            parameters=LINKS_OF_STATES | {"mu": "1/2"},
        ),
        NamedState(
            name="paradox",
            sentence="gamma < 0: slide or jump to rest",
            keys=KEYS,
            parameters=LINKS_OF_STATES | {"mu": "2"},
        ),
        NamedState(
            name="isolated",
            sentence="gamma = 0 at a local maximum of mu_c along the table",
            keys=KEYS,
            parameters=LINKS_OF_STATES | {"mu": "(950 + sqrt(5652826))/2343"},
        ),
    ),
)
