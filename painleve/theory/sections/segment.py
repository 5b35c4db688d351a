"""The theory of planar friction."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.mechanics.sections.segment import Segment
from painleve.mechanics.state import State
from painleve.theory.least_energy import LeastEnergy, contact_slip, edge_indicator, lowest_edge
from painleve.theory.sections.section import POSITIVE, Exact, Points

__all__ = ["SegmentTheory"]


@dataclass(frozen=True)
class SegmentTheory:
    """See painleve.theory.sections.section."""

    section: Segment
    positive: str = POSITIVE
    image: str = "a segment"
    flat_sides: str = ""

    def least_edge(self, state: State) -> tuple[int, Signed]:
        return lowest_edge(state, self.section.edges)

    def jump(self, state: State, edge: int, gamma: Sign) -> LeastEnergy:
        """The ray has s = -a/b: the jump ends where the tip sticks, if the slip is in the destabilising sense."""
        drive = exact_sign(contact_slip(state)[0] * state.exact(derive(state.scene).couplings[0]))
        if drive.sign is Sign.UNDECIDED:
            return LeastEnergy(undecided=f"the sense of the slip is undecided: {drive.reason}")
        if drive.sign is not Sign.POSITIVE:
            return LeastEnergy()
        return LeastEnergy(impulse=self.sticking_impulse(state), after="sticks")

    def sticking_impulse(self, state: State) -> tuple[sp.Expr, ...]:
        d, slip = derive(state.scene), contact_slip(state)[0]
        a, b, C = (state.exact(x) for x in (d.a, d.couplings[0], d.compliance[0]))
        determinant = a * C - b**2
        return slip * b / determinant, -slip * a / determinant

    def indicator(self, scene: Scene, edge: int) -> sp.Expr:
        return edge_indicator(scene, edge)

    def exact_section(self, where: str, exact: Exact) -> tuple[Points, None]:
        ends = exact(sp.Matrix([-self.section.minus, self.section.plus]))
        return () if ends.is_zero_matrix else tuple(sp.ImmutableMatrix([end]) for end in ends), None

    def spanning(self) -> sp.MatrixBase:
        return sp.Matrix([list(dict.fromkeys(self.section.expressions))])

    def soundness(self) -> tuple[str, str]:
        mu = "the coefficient of friction" if self.section.symmetric else "every coefficient of friction"
        return f"{mu} is nonnegative", "a coefficient of friction is negative"

    def settled(self, hypothesis: str) -> None:
        return None
