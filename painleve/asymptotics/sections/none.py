"""A_eps without friction: impacts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import flint

from painleve.asymptotics.ball_arithmetic import Balls
from painleve.asymptotics.sections.section import JumpBalls, OffsetBalls
from painleve.core.codes import ContactMode
from painleve.core.rows import RowParts
from painleve.core.sections.none import NoFrictionBase, branch_excesses
from painleve.mechanics.sections.none import NoFriction
from painleve.theory.limit_set import LimitSet

__all__ = ["NoFrictionAsymptotics"]


@dataclass(frozen=True)
class NoFrictionAsymptotics:
    """See painleve.asymptotics.sections.section."""

    section: NoFriction
    modes: tuple[ContactMode, ...] = (ContactMode.FRICTIONLESS,)
    branch_excesses: Callable[..., None] = branch_excesses
    affine: bool = True
    curved: bool = False
    slowest_power: float = 1.0

    def base_impulse(self, limit: LimitSet) -> NoFrictionBase:
        return NoFrictionBase(stick_n=0.0)

    def offset(self, rows: Balls, at: RowParts, dv: Balls, velocity: Balls, critical: int) -> OffsetBalls:
        moved = [x - y * velocity[0] / rows[at.a] for x, y in zip(dv, rows[at.Y_n], strict=True)]
        return moved, ContactMode.FRICTIONLESS

    def off_the_line(self, rows: Balls, at: RowParts, jump: JumpBalls, reach: float) -> flint.arb:
        raise ValueError("without friction there is no jump")
