"""The base state of a contact with friction in space, in the numbers that the compiled split of impulses needs."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import flint
import sympy as sp

from painleve.core.space.offset import SpaceBase
from painleve.core.space.polygon_offset import PolygonBase
from painleve.errors import InputError
from painleve.exact.balls import ball
from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import Derivation, derive
from painleve.mechanics.friction import Polygon
from painleve.mechanics.state import State
from painleve.theory.least_energy import contact_slip, inverse_of_two
from painleve.theory.limit_set import LimitSet
from painleve.theory.sections.listed import theory_of

__all__ = ["space_base"]

LEAST_FRICTION = 1e-140  # the impulse that stops the tip is of the size of 1/mu, and its square must be a double


def space_base(limit: LimitSet, bits: int) -> SpaceBase | PolygonBase:
    """See painleve.core.space.offset.SpaceBase and painleve.core.space.polygon_offset.PolygonBase.

    The numbers are rounded from balls of that many bits.

    Raises InputError where the section has no area at q: there the tip's sticking impulse is not one of the disc's.
    """
    state, d = limit.state, derive(limit.state.scene)
    if isinstance(d.scene.contact.section, Polygon):
        return _polygon_base(limit, bits)
    E, inverse = _map(state, d)
    number = partial(_number, state, bits)
    # Numbers first: of matrices of formulas a determinant may take minutes.
    slip, couplings, compliance = contact_slip(state), state.exact(d.couplings), state.exact(d.compliance)
    b, turned = E.T * couplings, E.T * slip
    stick_n, *stick = theory_of(state.scene.contact).sticking_impulse(state)
    stick, jump = inverse * sp.Matrix(stick), inverse * sp.Matrix(limit.tangential)
    after = turned + E.T * (couplings * limit.multiplier + compliance * sp.Matrix(limit.tangential))
    size = limit.multiplier if limit.kind != "point" else sp.Integer(1)
    return SpaceBase(
        stick_n=number(stick_n),
        stick_1=number(stick[0]),
        stick_2=number(stick[1]),
        jump_n=number(limit.multiplier),
        jump_1=number(jump[0]),
        jump_2=number(jump[1]),
        slip_1=number(turned[0]),
        slip_2=number(turned[1]),
        slip_across=number(_cross(b, turned)),
        stick_across=number(_cross(b, stick)),
        after_across=number(_cross(jump, after) / size),
        jump_sticks=limit.after == "sticks",
    )


def _map(state: State, d: Derivation) -> tuple[sp.MatrixBase, sp.MatrixBase]:
    """E of the section E times the unit disc, and its inverse."""
    E = state.exact(d.scene.contact.section.map)  # type: ignore[attr-defined]
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


def _polygon_base(limit: LimitSet, bits: int) -> PolygonBase:
    state, d = limit.state, derive(limit.state.scene)
    number = partial(_number, state, bits)
    slip, jump = contact_slip(state), sp.Matrix(limit.tangential)
    stick_n, *stick = theory_of(state.scene.contact).sticking_impulse(state)
    after = slip + state.exact(d.couplings) * limit.multiplier + state.exact(d.compliance) * jump
    first, second, x_first, x_second = _edge_of_jump(limit, number)
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


def _edge_of_jump(limit: LimitSet, number: Callable[[sp.Expr], float]) -> tuple[int, int, float, float]:
    """The two vertices (from 0) between which the jump's impulse lies, and how it is made of them; -1: of no two."""
    vertices = [sp.Matrix(v) for v in limit.state.scene.contact.section.vertices]  # type: ignore[attr-defined]
    if limit.kind == "segment":
        return limit.edge - 1, limit.edge - 1, number(limit.multiplier), 0.0
    jump = sp.Matrix(limit.tangential)
    for i, s in enumerate(vertices):
        j = (i + 1) % len(vertices)
        z, r_n = vertices[j], limit.multiplier
        if limit.kind == "pair" and number(_cross(z - s, jump - r_n * s)) == 0.0:
            along = z - s
            share = (along.T * (jump - r_n * s))[0, 0] / (along.T * along)[0, 0]
            found = number(r_n - share), number(share)
            if min(found) >= 0.0:
                return i, j, *found
    return -1, -1, 0.0, 0.0


def _number(state: State, bits: int, expression: sp.Expr) -> float:
    """Rounded; what a ball of many bits cannot tell from zero is zero by an identity."""
    found = ball(state.exact(expression), bits=bits)
    return 0.0 if found.contains(flint.arb(0)) else float(found.mid())


def _cross(x: sp.MatrixBase, y: sp.MatrixBase) -> sp.Expr:
    return x[0] * y[1] - x[1] * y[0]
