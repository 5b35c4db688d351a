"""What the asymptotics ask of a friction section."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import flint

from painleve.asymptotics.ball_arithmetic import Balls, combination
from painleve.core.codes import ContactMode
from painleve.core.lane import BaseImpulse
from painleve.core.rows import RowParts
from painleve.theory.limit_set import LimitSet

__all__ = ["JumpBalls", "OffsetBalls", "SectionAsymptotics", "moved"]

OffsetBalls: TypeAlias = tuple[Balls, ContactMode]


@dataclass(frozen=True, kw_only=True)
class JumpBalls:
    """The jump u_tilde - u-, its normal impulse, and the edge of the cone on which gamma is attained."""

    vector: Balls
    impulse: flint.arb
    edge: int


class SectionAsymptotics(Protocol):
    """A_eps at a contact with this section."""

    @property
    def modes(self) -> tuple[ContactMode, ...]:
        """What S may do in contact."""

    @property
    def branch_excesses(self) -> Callable[..., None] | None:
        """The farthest members of a branch over one configuration (painleve.core.sections.segment); None where members
        are sought in all variables at once, for S is not piecewise linear in v, or its pieces are many."""

    @property
    def affine(self) -> bool:
        """Whether over one configuration the slips along A are affine in their impulse, and stay as near to the line
        through A as their first and last."""

    @property
    def curved(self) -> bool:
        """Whether the cone of friction has a curved edge: A_eps then comes near to A like the root of eps."""

    @property
    def slowest_power(self) -> float:
        """The least power of eps that is allowed for where gamma = 0, as A_eps comes near to A."""

    def base_impulse(self, limit: LimitSet) -> BaseImpulse:
        """What the compiled split needs of the base state, each number correctly rounded.

        Raises InputError for a section without the area that the split supposes.
        """

    def offset(self, rows: Balls, at: RowParts, dv: Balls, velocity: Balls, critical: int) -> OffsetBalls:
        """S - u- = dv + M^-1 W r and its branch, r by the definition of law (7), independently of the compiled law.

        velocity: (v_n, v_t) in the tangents of the rows, v_n < 0; critical: the edge on which gamma is known to be 0
        exactly. Raises ArithmeticError where balls decide nothing.
        """

    def off_the_line(self, rows: Balls, at: RowParts, jump: JumpBalls, reach: float) -> flint.arb:
        """A bound on how far S - v leaves the line through A, for all -v_n up to `reach` times what gives the jump's
        impulse on the edge of the jump (where the slips along A are not affine)."""


def moved(rows: Balls, at: RowParts, dv: Balls, impulse: Sequence[flint.arb]) -> Balls:
    """dv + M^-1 W r."""
    responses = (rows[part] for part in (at.Y_n, *at.Y_t))
    return combination((dv, 1), *zip(responses, impulse, strict=True))
