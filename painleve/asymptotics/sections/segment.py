"""A_eps with planar friction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import flint

from painleve.asymptotics.ball_arithmetic import Balls, certain
from painleve.asymptotics.sections.section import JumpBalls, OffsetBalls, moved
from painleve.core.codes import ContactMode
from painleve.core.rows import RowParts
from painleve.core.sections.segment import SegmentBase, branch_excesses, undivided_stop
from painleve.mechanics.sections.segment import Segment
from painleve.theory.limit_set import LimitSet
from painleve.theory.sections.listed import theory_of

__all__ = ["SegmentAsymptotics"]


@dataclass(frozen=True)
class SegmentAsymptotics:
    """See painleve.asymptotics.sections.section."""

    section: Segment
    modes: tuple[ContactMode, ...] = (ContactMode.STICK, ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS)
    branch_excesses: Callable[..., None] = branch_excesses
    affine: bool = True
    curved: bool = False
    slowest_power: float = 1.0

    def base_impulse(self, limit: LimitSet) -> SegmentBase:
        state = limit.state
        return SegmentBase(*(state.number(x) for x in theory_of(state.scene.contact).sticking_impulse(state)))

    def offset(self, rows: Balls, at: RowParts, dv: Balls, velocity: Balls, critical: int) -> OffsetBalls:
        v_n, v_t = velocity
        a, (b,), (C,) = rows[at.a], rows[at.b], rows[at.C]
        edge_plus, (edge_minus, mu_plus, mu_minus) = rows[at.edge_plus], rows[at.section]
        determinant = a * C - b * b
        r_n, r_t = (r / determinant for r in undivided_stop(a, b, C, v_n, v_t))
        for sense, edge, s, slip in (
            (1, edge_plus, mu_plus, ContactMode.SLIP_PLUS),
            (-1, edge_minus, -mu_minus, ContactMode.SLIP_MINUS),
        ):
            if sense == critical or not certain(edge > 0, edge <= 0, "the sign of gamma"):
                continue
            excess = sense * (r_t * edge + s * v_n)
            if certain(excess > 0, excess <= 0, "stick or slip"):
                return moved(rows, at, dv, (-v_n / edge, -s * v_n / edge)), slip
        return moved(rows, at, dv, (r_n, r_t)), ContactMode.STICK

    def off_the_line(self, rows: Balls, at: RowParts, jump: JumpBalls, reach: float) -> flint.arb:
        raise ValueError("in the plane the slips along A are affine in their impulse")
