"""The law S from its definition, with mpmath: the oracle of the tests, written without looking at the package's law.

A cone in the plane is spanned by its two edges. The feasible impulses are the points x >= 0 of their span whose normal
compliances x_+ edge_+ + x_- edge_- add up to -v_n: a segment, or a ray where one edge cannot lift the tip. On it the
kinetic energy is a parabola, whose least point is found from its two values at ends or from its vertex.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeAlias

import flint
import mpmath
import sympy as sp

from painleve.mechanics.scene import Scene
from painleve.mechanics.state import State

DIGITS = 60
Exact: TypeAlias = sp.Expr | float | Fraction | flint.arb


@dataclass(frozen=True)
class Local:
    """M, w_n, H, the ends of the section and g at one configuration, as mpmath numbers."""

    M: mpmath.matrix
    w_n: mpmath.matrix
    H: mpmath.matrix | None
    minus: mpmath.mpf
    plus: mpmath.mpf
    g: mpmath.mpf

    def edges(self) -> list[mpmath.matrix]:
        """The generators W (1, s) of the cone at the two ends of the section; one without friction."""
        if self.H is None:
            return [self.w_n]
        return [self.w_n + self.plus * self.H, self.w_n - self.minus * self.H]

    def lifts(self) -> list[mpmath.mpf]:
        """<w_n, M^-1 generator>: gamma |grad g|^2 is the least of these."""
        return [dot(self.w_n, mpmath.lu_solve(self.M, edge)) for edge in self.edges()]


def dot(x: mpmath.matrix, y: mpmath.matrix) -> mpmath.mpf:
    return mpmath.fdot(list(x), list(y))


def norm(x: Sequence[mpmath.mpf]) -> mpmath.mpf:
    return mpmath.sqrt(mpmath.fsum(y * y for y in x))


def to_mp(value: Exact) -> mpmath.mpf:
    """An exact sympy number at the working precision; a float and the midpoint of a ball as what they are."""
    if isinstance(value, flint.arb):
        mantissa, exponent = value.mid().man_exp()
        return mpmath.ldexp(mpmath.mpf(int(mantissa)), int(exponent))
    if isinstance(value, sp.Basic):
        return mpmath.mpf(sp.N(value, mpmath.mp.dps + 10)._to_mpmath(mpmath.mp.prec))
    if isinstance(value, Fraction):
        return mpmath.mpf(value.numerator) / value.denominator
    return mpmath.mpf(float(value))


class Reference:
    """A scene as functions of (q, parameters) in mpmath, straight from its symbols."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        normal = [-sp.diff(scene.contact.constraint, x) for x in scene.q]
        section = scene.contact.section
        ends = [section.minus, section.plus] if section.dimension else [sp.Integer(0)] * 2
        parts = [*scene.inertia, *normal, *scene.contact.tangents, *ends, scene.contact.constraint]
        self.function = sp.lambdify([*scene.q, *scene.p], parts, modules="mpmath")

    def at(self, q: Sequence[mpmath.mpf], p: Sequence[mpmath.mpf]) -> Local:
        values, d = list(self.function(*q, *p)), self.scene.dimension
        M = mpmath.matrix(d, d)
        for i in range(d):
            for j in range(d):
                M[i, j] = values[i * d + j]
        w_n, tail = mpmath.matrix(values[d * d : d * d + d]), values[d * d + d :]
        H = mpmath.matrix(tail[:d]) if self.scene.contact.section.dimension else None
        minus, plus, g = tail[-3:]
        return Local(M=M, w_n=w_n, H=H, minus=minus, plus=plus, g=g)

    def at_state(self, state: State, dq: Sequence[Exact]) -> Local:
        """At q + dq, with dq exact; at q itself g is exactly zero, which digits cannot show."""
        offset = [to_mp(x) for x in dq]
        local = self.at([to_mp(x) + y for x, y in zip(state.q, offset, strict=True)], self.parameters(state.parameters))
        return local if any(offset) else replace(local, g=mpmath.mpf(0))

    def parameters(self, values: Mapping[str, sp.Expr]) -> list[mpmath.mpf]:
        return [to_mp(values[p.name]) for p in self.scene.parameters]


def gamma_squared(local: Local) -> mpmath.mpf:
    """gamma |grad g|^2."""
    return min(local.lifts())


def law(local: Local, v: Sequence[mpmath.mpf]) -> mpmath.matrix:
    """S(q, v) = Proj_q(0, (v + M^-1 R) in T) where g >= 0 and <v, n> < 0, else v."""
    v = mpmath.matrix(list(v))
    v_n = dot(local.w_n, v)
    if local.g < 0 or v_n >= 0:
        return v
    return v + mpmath.lu_solve(local.M, least_impulse(local, v, v_n))


def least_impulse(local: Local, v: mpmath.matrix, v_n: mpmath.mpf) -> mpmath.matrix:
    """The impulse in the cone that cancels v_n with the least kinetic energy afterwards."""
    lifts = local.lifts()
    # A critical state has a compliance that is exactly zero, which digits cannot show: take it for one.
    nothing = max(map(abs, lifts)) * mpmath.mpf(10) ** (15 - mpmath.mp.dps)
    lifts = [mpmath.mpf(0) if abs(lift) < nothing else lift for lift in lifts]
    ends = [edge * (-v_n / lift) for edge, lift in zip(local.edges(), lifts, strict=True) if lift > 0]
    if not ends:
        raise ArithmeticError("no impulse of the cone lifts the tip")
    if len(lifts) == 1:
        return ends[0]
    if len(ends) == 2:
        start, along, longest = ends[0], ends[1] - ends[0], mpmath.mpf(1)
    else:  # x_+ edge_+ + x_- edge_- = -v_n with one compliance <= 0: a ray
        (start,), longest = ends, mpmath.inf
        plus, minus = local.edges()
        along = (plus * abs(lifts[1]) + minus * abs(lifts[0])) / max(map(abs, lifts))
    response = mpmath.lu_solve(local.M, along)
    curvature = dot(along, response)
    if curvature == 0:  # no friction: both edges are the normal
        return start
    slope = dot(along, v) + dot(response, start)
    return start + along * min(max(-slope / curvature, mpmath.mpf(0)), longest)
