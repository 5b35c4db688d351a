"""The slender rod in space on a floor whose friction depends on the direction: grooves along the first axis, say."""

from painleve.mechanics.friction import Ellipse
from painleve.mechanics.library.spatial_rod import make_spatial_rod
from painleve.mechanics.scene import NamedState, Parameter

MU_1 = Parameter(
    name="mu_1",
    unit="1",
    sentence="coefficient of friction along the first axis",
    default="1/2",
    range="nonnegative",
    latex=r"\mu_1",
)
MU_2 = Parameter(
    name="mu_2",
    unit="1",
    sentence="coefficient of friction across it",
    default="2",
    range="nonnegative",
    latex=r"\mu_2",
)
ANGLE = Parameter(
    name="angle", unit="rad", sentence="direction of the first axis on the floor", default="0", range="real"
)

SCENE = make_spatial_rod(
    name="spatial_rod_ellipse",
    sentence="slender rod in space whose lower tip slides on a floor with friction that depends on the direction",
    friction=Ellipse(mu_1=MU_1.symbol, mu_2=MU_2.symbol, angle=ANGLE.symbol),
    friction_parameters=(MU_1, MU_2, ANGLE),
    states=(
        NamedState(
            name="sliding",
            sentence="the rod lies along the smooth axis: gamma > 0, ordinary sliding",
            keys={"theta": "atan(2)"},
            parameters={},
        ),
        NamedState(
            name="paradox",
            sentence="the rod lies along the rough axis: gamma < 0, slide or jump to sticking",
            keys={"theta": "atan(2)", "phi": "pi/2"},
            parameters={},
        ),
        NamedState(
            name="oblique",
            sentence="the same under an oblique slip: slide, or jump to another slip",
            keys={"theta": "atan(2)", "phi": "pi/2", "heading": "2*pi/3"},
            parameters={},
        ),
        NamedState(
            name="critical",
            sentence="gamma = 0, the slip parallel to b: the jump ends in sticking",
            keys={"theta": "atan(3 - sqrt(5))", "phi": "pi/2"},
            parameters={},
        ),
        NamedState(
            name="critical_oblique",
            sentence="gamma = 0 and the slip is oblique: the jump ends in slip",
            keys={"theta": "atan(3 - sqrt(5))", "phi": "pi/2", "heading": "3*pi/4"},
            parameters={},
        ),
        NamedState(
            name="tilted",
            sentence="gamma = 0 with the axes at 45 degrees to the rod: the jump ends in slip",
            keys={"theta": "atan(3 - sqrt(5))"},
            parameters={"mu_1": "2*sqrt(2/5)", "mu_2": "4*sqrt(2/5)", "angle": "pi/4"},
        ),
    ),
)
