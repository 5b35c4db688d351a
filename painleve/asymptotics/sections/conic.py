"""A_eps in space with a disc or an ellipse, as the unit disc."""

from __future__ import annotations

from dataclasses import dataclass

import flint
import sympy as sp

from painleve.asymptotics.ball_arithmetic import Balls, combination, dot, norm
from painleve.asymptotics.sections.section import JumpBalls, OffsetBalls, moved
from painleve.asymptotics.space.base import cross, rounder
from painleve.asymptotics.space.member import ContactBalls, conic_impulse
from painleve.core.codes import ContactMode
from painleve.core.rows import RowParts
from painleve.core.sections.conic import ConicBase
from painleve.errors import InputError
from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.sections.conic import Disc, Ellipse
from painleve.mechanics.state import State
from painleve.theory.least_energy import contact_slip, inverse_of_two
from painleve.theory.limit_set import LimitSet
from painleve.theory.sections.listed import theory_of

__all__ = ["ConicAsymptotics"]

LEAST_FRICTION = 1e-140  # the impulse that stops the tip is of the size of 1/mu, and its square must be a double


@dataclass(frozen=True)
class ConicAsymptotics:
    """See painleve.asymptotics.sections.section."""

    section: Disc | Ellipse
    modes: tuple[ContactMode, ...] = (ContactMode.STICK, ContactMode.SLIP)
    branch_excesses: None = None
    affine: bool = False
    curved: bool = True
    slowest_power: float = 0.5

    def base_impulse(self, limit: LimitSet) -> ConicBase:
        """Raises InputError where the section has no area at q: there the tip's sticking impulse is not one of the
        disc's."""
        state, d = limit.state, derive(limit.state.scene)
        E, inverse = self._map(state)
        number = rounder(state)
        # Numbers first: of matrices of formulas a determinant may take minutes.
        slip, couplings, compliance = contact_slip(state), state.exact(d.couplings), state.exact(d.compliance)
        b, turned = E.T * couplings, E.T * slip
        stick_n, *stick_t = theory_of(state.scene.contact).sticking_impulse(state)
        stick, jump = inverse * sp.Matrix(stick_t), inverse * sp.Matrix(limit.tangential)
        after = turned + E.T * (couplings * limit.multiplier + compliance * sp.Matrix(limit.tangential))
        size = limit.multiplier if limit.kind != "point" else sp.Integer(1)
        return ConicBase(
            stick_n=number(stick_n),
            stick_1=number(stick[0]),
            stick_2=number(stick[1]),
            jump_n=number(limit.multiplier),
            jump_1=number(jump[0]),
            jump_2=number(jump[1]),
            slip_1=number(turned[0]),
            slip_2=number(turned[1]),
            slip_across=number(cross(b, turned)),
            stick_across=number(cross(b, stick)),
            after_across=number(cross(jump, after) / size),
            jump_sticks=limit.after == "sticks",
        )

    def _map(self, state: State) -> tuple[sp.MatrixBase, sp.MatrixBase]:
        """E of the section E times the unit disc, and its inverse."""
        E = state.exact(self.section.map)
        if exact_sign(E[0, 0] * E[1, 1] - E[0, 1] * E[1, 0]).sign is not Sign.POSITIVE:
            raise InputError(
                f"state {state.label}: a coefficient of friction vanishes; the friction section must have an "
                "area: give positive coefficients"
            )
        shorter = abs(state.number(E.det())) / max(abs(state.number(e)) for e in E)  # semi-axis, but for a factor
        if shorter < LEAST_FRICTION:
            raise InputError(
                f"state {state.label}: a coefficient of friction of {shorter:.0e} is too small for its square to be a "
                f'double; give {LEAST_FRICTION:.0e} at least, or no friction (kind = "none")'
            )
        return E, inverse_of_two(E)

    def offset(self, rows: Balls, at: RowParts, dv: Balls, velocity: Balls, critical: int) -> OffsetBalls:
        contact = ContactBalls(a=rows[at.a], b=rows[at.b], C=rows[at.C], v=velocity)
        *r, branch = conic_impulse(contact, flint.arb(0) if critical else rows[at.edge_plus])
        return moved(rows, at, dv, r), branch

    def off_the_line(self, rows: Balls, at: RowParts, jump: JumpBalls, reach: float) -> flint.arb:
        """See painleve.asymptotics.space.witness."""
        p, most = rows[at.edge_plus], flint.arb(reach) * jump.impulse
        Y_n, (Y_1, Y_2), (b_1, b_2) = rows[at.Y_n], [rows[part] for part in at.Y_t], rows[at.b]
        size = (b_1 * b_1 + b_2 * b_2).sqrt()
        e_1, e_2 = b_1 / size, b_2 / size
        ray = combination((Y_n, 1), (Y_1, -e_1), (Y_2, -e_2))
        along, across = norm(combination((Y_1, e_1), (Y_2, e_2))), norm(combination((Y_1, -e_2), (Y_2, e_1)))
        rest = most * (p * along + ((2 * size + p) * p / 4).sqrt() * across) / size
        share = dot(ray, jump.vector) / dot(jump.vector, jump.vector)
        return most * norm(combination((ray, 1), (jump.vector, -share))) + rest
