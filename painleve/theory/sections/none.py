"""The theory without friction: gamma = a/|grad g|^2 is positive, and nothing is indeterminate."""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.mechanics.sections.none import NoFriction
from painleve.mechanics.state import State
from painleve.theory.hypotheses.claims import ClaimStatus
from painleve.theory.least_energy import LeastEnergy
from painleve.theory.sections.section import Exact, Points

__all__ = ["NoFrictionTheory"]

SETTLED = {
    "H3": (ClaimStatus.PROVED, "without friction D_1 = {0}"),
    "H4": (ClaimStatus.REFUTED, "without friction D_1 = {0}, whose span has dimension 0"),
    "H'4": (
        ClaimStatus.PROVED,
        "D_1 = {0} has no two points between which to fail; without friction gamma > 0 everywhere",
    ),
}


@dataclass(frozen=True)
class NoFrictionTheory:
    """See painleve.theory.sections.section."""

    section: NoFriction
    positive: str = "without friction gamma is positive"
    image: str = "a point"
    flat_sides: str = ""

    def least_edge(self, state: State) -> tuple[int, Signed]:
        """M is positive definite and grad g is not zero, or the state would be none."""
        return 0, replace(exact_sign(state.exact(derive(state.scene).gamma)), sign=Sign.POSITIVE)

    def jump(self, state: State, edge: int, gamma: Sign) -> LeastEnergy:
        return LeastEnergy()

    def sticking_impulse(self, state: State) -> tuple[sp.Expr, ...]:
        """u- is tangential."""
        return (sp.Integer(0),)

    def indicator(self, scene: Scene, edge: int) -> sp.Expr:
        raise ValueError(self.positive)

    def exact_section(self, where: str, exact: Exact) -> tuple[Points, None]:
        return (), None

    def spanning(self) -> sp.MatrixBase:
        return sp.zeros(0, 0)

    def soundness(self) -> tuple[str, str]:
        raise ValueError("(H3) is settled without friction")

    def settled(self, hypothesis: str) -> tuple[ClaimStatus, str]:
        return SETTLED[hypothesis]
