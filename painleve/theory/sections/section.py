"""What the theory asks of a friction section."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import sympy as sp

from painleve.exact.signs import Sign, Signed
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import State
from painleve.theory.hypotheses.claims import ClaimStatus
from painleve.theory.least_energy import LeastEnergy

__all__ = ["POSITIVE", "Exact", "Points", "SectionTheory"]

POSITIVE = "gamma > 0: only r = 0 keeps the velocity tangential"
Exact = Callable[[sp.MatrixBase], sp.ImmutableMatrix]
Points = tuple[sp.ImmutableMatrix, ...]


class SectionTheory(Protocol):
    """The theory of a contact with this section; edges of its cone are numbered as in painleve.mechanics."""

    @property
    def positive(self) -> str:
        """Why A = {u-} where gamma > 0."""

    def least_edge(self, state: State) -> tuple[int, Signed]:
        """The edge of the cone on which gamma is attained, and the sign of gamma, which is that of its compliance."""

    def jump(self, state: State, edge: int, gamma: Sign) -> LeastEnergy:
        """The jump of law (7) at a state with gamma(q) <= 0 attained on that edge."""

    def sticking_impulse(self, state: State) -> tuple[sp.Expr, ...]:
        """-G^-1 W^T u-, (r_n, r_t): what stops the tip, whether or not it is in the cone."""

    def indicator(self, scene: Scene, edge: int) -> sp.Expr:
        """A smooth function with the sign of gamma near a state where it is attained on that edge of the cone."""

    def exact_section(self, where: str, exact: Exact) -> tuple[Points, sp.ImmutableMatrix | None]:
        """Coulomb's section in exact numbers: its vertices, or E of s = E sigma, |sigma| <= 1; neither for {0}.

        Raises InputError, which begins with `where`, for a section that Coulomb's problem is not posed with.
        """

    @property
    def image(self) -> str:
        """What a linear image of it is that is no point, as the hypotheses call it."""

    @property
    def flat_sides(self) -> str:
        """Why an image of dimension 2 is not strictly convex; "" where it is."""

    def spanning(self) -> sp.MatrixBase:
        """A matrix (k x m) whose columns span what the section spans."""

    def soundness(self) -> tuple[str, str]:
        """What is said where the section's conditions hold, and where they fail."""

    def settled(self, hypothesis: str) -> tuple[ClaimStatus, str] | None:
        """What is known of (H3), (H4) or (H'4) whatever the scene, and why; None: it depends on that."""
