"""A_eps in space with a polygon."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import flint
import sympy as sp

from painleve.asymptotics.ball_arithmetic import Balls, combination, dot, norm
from painleve.asymptotics.sections.section import JumpBalls, OffsetBalls, moved
from painleve.asymptotics.space.base import cross, rounder
from painleve.asymptotics.space.member import ContactBalls, polygon_impulse
from painleve.core.codes import ContactMode
from painleve.core.rows import RowParts
from painleve.core.sections.polygon import PolygonBase
from painleve.mechanics.derive import derive
from painleve.mechanics.sections.polygon import Polygon
from painleve.theory.least_energy import contact_slip
from painleve.theory.limit_set import LimitSet
from painleve.theory.sections.listed import theory_of

__all__ = ["PolygonAsymptotics"]


@dataclass(frozen=True)
class PolygonAsymptotics:
    """See painleve.asymptotics.sections.section."""

    section: Polygon
    modes: tuple[ContactMode, ...] = (ContactMode.STICK, ContactMode.SLIP)
    branch_excesses: None = None
    affine: bool = False
    curved: bool = False
    slowest_power: float = 0.5

    def base_impulse(self, limit: LimitSet) -> PolygonBase:
        state, d = limit.state, derive(limit.state.scene)
        number = rounder(state)
        slip, jump = contact_slip(state), sp.Matrix(limit.tangential)
        stick_n, *stick = theory_of(state.scene.contact).sticking_impulse(state)
        after = slip + state.exact(d.couplings) * limit.multiplier + state.exact(d.compliance) * jump
        first, second, x_first, x_second = self._edge_of_jump(limit, number)
        return PolygonBase(
            stick_n=number(stick_n),
            stick_1=number(stick[0]),
            stick_2=number(stick[1]),
            jump_n=number(limit.multiplier),
            jump_1=number(jump[0]),
            jump_2=number(jump[1]),
            after_1=number(after[0]),
            after_2=number(after[1]),
            first=first,
            second=second,
            x_first=x_first,
            x_second=x_second,
            jump_sticks=limit.after == "sticks",
        )

    def _edge_of_jump(self, limit: LimitSet, number: Callable[[sp.Expr], float]) -> tuple[int, int, float, float]:
        """The two vertices (from 0) between which the jump's impulse lies, and how it is made of them; -1: of no
        two."""
        vertices = [sp.Matrix(v) for v in self.section.vertices]
        if limit.kind == "segment":
            return limit.edge - 1, limit.edge - 1, number(limit.multiplier), 0.0
        jump = sp.Matrix(limit.tangential)
        for i, s in enumerate(vertices):
            j = (i + 1) % len(vertices)
            z, r_n = vertices[j], limit.multiplier
            if limit.kind == "pair" and number(cross(z - s, jump - r_n * s)) == 0.0:
                along = z - s
                share = (along.T * (jump - r_n * s))[0, 0] / (along.T * along)[0, 0]
                found = number(r_n - share), number(share)
                if min(found) >= 0.0:
                    return i, j, *found
        return -1, -1, 0.0, 0.0

    def _corners(self, rows: Balls, at: RowParts) -> tuple[Balls, list[Balls]]:
        """The compliances p of the vertices, and these."""
        own, n = rows[at.section], len(self.section.vertices)
        return own[:n], [own[n + 2 * i : n + 2 * i + 2] for i in range(n)]

    def offset(self, rows: Balls, at: RowParts, dv: Balls, velocity: Balls, critical: int) -> OffsetBalls:
        contact = ContactBalls(a=rows[at.a], b=rows[at.b], C=rows[at.C], v=velocity)
        p, vertices = self._corners(rows, at)
        known = [flint.arb(0) if i + 1 == critical else x for i, x in enumerate(p)]
        *r, branch = polygon_impulse(contact, vertices, known)
        return moved(rows, at, dv, r), branch

    def off_the_line(self, rows: Balls, at: RowParts, jump: JumpBalls, reach: float) -> flint.arb:
        """See painleve.asymptotics.space.witness."""
        Y_n, (Y_1, Y_2) = rows[at.Y_n], [rows[part] for part in at.Y_t]
        (p, vertices), most = self._corners(rows, at), flint.arb(reach) * jump.impulse
        rays = [combination((Y_n, 1), (Y_1, x), (Y_2, y)) for x, y in vertices]
        own = jump.edge - 1
        others = [most * p[own] * norm(rays[i]) / p[i] for i in range(len(rays)) if i != own]
        share = dot(rays[own], jump.vector) / dot(jump.vector, jump.vector)
        away = norm(combination((rays[own], 1), (jump.vector, -share)))
        return most * away + max(others, key=lambda x: x.upper())
