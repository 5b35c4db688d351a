"""The slips of Coulomb's one-step problem on the unit disc, as roots that are isolated and counted exactly.

With nu = -v_n not 0 a slip is a direction d = (1 - t^2, 2 t)/(1 + t^2) for which w(d) = v_t (a + b.d) + nu (b + C d)
is parallel to d: a quartic in t. It never vanishes identically where a slip solves the problem: it does only if v_t =
-nu b/a and C - b b^T/a = c Id, and then w(d) = nu c d with c > 0, so that lambda > 0 would mean friction that drives.
Rational data make the quartic rational; its multiple roots are then split off exactly. Of other data balls enclose
the coefficients, and two roots that balls cannot separate are left undecided.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp
from flint import acb_poly, arb, arb_poly, ctx, fmpq, fmpq_poly

from painleve.exact.balls import ball

__all__ = ["SlipRoot", "Undecided", "find_slips"]

PRECISIONS = (128, 512, 2048)
TURNS = (fmpq(0), fmpq(1, 2), fmpq(2, 7), fmpq(-3, 5), fmpq(5, 11))
"""Half-angle tangents of the first axis of frames: t = infinity is a root in at most four of them."""


class Undecided(Exception):
    """What could not be decided, and why."""


@dataclass(frozen=True, kw_only=True)
class SlipRoot:
    """An impulse lambda (1, d) with u_t = -kappa d: balls that hold lambda, d, and the multiplicity of the root."""

    impulse: arb
    direction: tuple[arb, arb]
    multiplicity: int


@dataclass(frozen=True, kw_only=True, eq=False)
class _Equation:
    """In one frame: the quartic d x w, the lever a + b.d and -d.w, each times a power of 1 + t^2; polynomials in t."""

    quartic: Any
    lever: Any
    push: Any
    turn: fmpq


def find_slips(G: sp.MatrixBase, v: sp.MatrixBase, stick: Sequence[sp.Expr] | None) -> list[SlipRoot]:
    """All slips at v_n != 0, upwards in t. `stick` is the sticking impulse where it lies exactly on the border of the
    cone: it is a root too, with u_t = 0, and no slip. Raises Undecided."""
    numbers = [G[0, 0], G[0, 1], G[0, 2], G[1, 1], G[1, 2], G[2, 2], *v]
    if all(x.is_Rational for x in numbers):
        return _of_rational([fmpq(int(x.p), int(x.q)) for x in numbers])
    for bits, turn in zip(PRECISIONS, TURNS[1:], strict=False):
        with ctx.workprec(bits):
            data = [ball(x, bits=bits) for x in numbers]
            equation = _equation(arb_poly, data, turn)
            roots = _isolated(equation.quartic, bits)
            along = None if stick is None else [ball(x, bits=bits) for x in stick]
            slips = None if roots is None else _slips(equation, [(t, 1) for t in roots], -data[6], along)
            if slips is not None:
                return slips
    raise Undecided(
        f"the slips: the data are not rational, and {PRECISIONS[-1]} bits do not separate two of them, "
        "or one of them from sticking"
    )


def _of_rational(data: list[fmpq]) -> list[SlipRoot]:
    equations = (_equation(fmpq_poly, data, turn) for turn in TURNS)
    equation = next((e for e in equations if e.quartic.degree() == 4), None)
    if equation is None:
        return []  # identically zero: no direction solves the problem
    # No impulse lambda (1, d) cancels v_n where a + b.d = 0, and where d.w = 0 the tip sticks: both are split off.
    parts = equation.quartic.factor_squarefree()[1]
    parts = [(part // part.gcd(equation.lever * equation.push), n) for part, n in parts]
    for bits in PRECISIONS:
        with ctx.workprec(bits):
            roots = [
                (z.real, n) for part, n in parts if part.degree() > 0 for z, _ in part.complex_roots() if z.imag == 0
            ]
            enclosed = replace(equation, lever=arb_poly(equation.lever), push=arb_poly(equation.push))
            slips = _slips(enclosed, sorted(roots, key=lambda root: root[0].mid()), arb(-data[6]), None)
        if slips is not None:
            return slips
    raise Undecided(f"the slips: {PRECISIONS[-1]} bits do not tell one of them from sticking")


def _equation(ring: Any, data: Sequence[Any], turn: fmpq) -> _Equation:
    a, b_1, b_2, C_11, C_12, C_22, v_n, v_1, v_2 = data
    c, s = (1 - turn * turn) / (1 + turn * turn), 2 * turn / (1 + turn * turn)
    b = (b_1 * c + b_2 * s, b_2 * c - b_1 * s)
    V = (v_1 * c + v_2 * s, v_2 * c - v_1 * s)
    column = (C_11 * c + C_12 * s, C_12 * c + C_22 * s)
    A_11, A_12 = column[0] * c + column[1] * s, column[1] * c - column[0] * s
    A = ((A_11, A_12), (A_12, C_11 + C_22 - A_11))
    d = (ring([1, 0, -1]), ring([0, 2]))
    circle = ring([1, 0, 1])
    lever = circle * a + d[0] * b[0] + d[1] * b[1]
    w = [lever * V[i] - (circle * b[i] + d[0] * A[i][0] + d[1] * A[i][1]) * v_n for i in (0, 1)]
    return _Equation(quartic=d[0] * w[1] - d[1] * w[0], lever=lever, push=-(d[0] * w[0] + d[1] * w[1]), turn=turn)


def _isolated(quartic: arb_poly, bits: int) -> list[arb] | None:
    """The real roots, upwards, or None where the precision does not suffice to isolate four roots."""
    if quartic.degree() < 4 or quartic[4].contains(0):
        return None
    try:
        roots = acb_poly(quartic).roots(tol=arb(2) ** (-bits // 4))
    except ValueError:
        return None
    found = []
    for i, z in enumerate(roots):
        if not z.imag.contains(0):
            continue
        # one root a ball: if the mirror image meets no other ball, its root is the root itself, and real
        if any(z.conjugate().overlaps(other) for j, other in enumerate(roots) if j != i):
            return None
        found.append(z.real)
    return sorted(found, key=arb.mid)


def _slips(
    equation: _Equation, roots: list[tuple[arb, int]], nu: arb, stick: Sequence[arb] | None
) -> list[SlipRoot] | None:
    """Those roots with lambda > 0 and kappa > 0; None where a sign is not decided.

    The sticking impulse on the border, if there is one, is exactly one of the roots, and left out.
    """
    found, sticking = [], 0
    for t, multiplicity in roots:
        lever, push = nu * equation.lever(t), nu * equation.push(t)
        direction = _direction(t, equation.turn)
        if lever < 0 or push < 0:
            continue
        if lever > 0 and push > 0:
            impulse = nu * (1 + t * t) / equation.lever(t)
            found.append(SlipRoot(impulse=impulse, direction=direction, multiplicity=multiplicity))
        elif stick is not None and all((stick[1 + i] - direction[i] * stick[0]).contains(0) for i in (0, 1)):
            sticking += 1
        else:
            return None
    return found if sticking <= 1 else None


def _direction(t: arb, turn: fmpq) -> tuple[arb, arb]:
    c, s = (1 - turn * turn) / (1 + turn * turn), 2 * turn / (1 + turn * turn)
    square = 1 + t * t
    d = ((1 - t * t) / square, 2 * t / square)
    return c * d[0] - s * d[1], s * d[0] + c * d[1]
