"""The limit set A(q, u-) at a tangential contact, exactly (paper, section 3; docs/theory.md, section 3)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, overload

import numpy as np
import sympy as sp

from painleve import sets
from painleve.errors import InputError
from painleve.exact.signs import Sign, Signed
from painleve.mechanics.derive import derive
from painleve.mechanics.state import State
from painleve.theory.coulomb.limit import CoulombLimitSet, coulomb_limit_set
from painleve.theory.sections.listed import theory_of

__all__ = ["Edge", "LimitSet", "limit_set"]

LimitSetKind = Literal["point", "pair", "segment", "undecided"]
Edge = int


@dataclass(frozen=True, kw_only=True, eq=False)
class LimitSet:
    """A(q, u-): the point {u-}, the pair {u-, u_tilde} or the segment between them, with exact ends.

    `gamma` is the sign of gamma(q), `multiplier` the normal impulse of the jump from u- to u_tilde (0 if there is none)
    and `tangential` its friction impulse (k,). `edge` says on which edge of the cone gamma is attained
    (painleve.mechanics.derive.Derivation.edge_direction); 0 if gamma > 0 or there is no friction. `after`: what the tip
    does after the jump, "" if there is none.
    """

    state: State
    kind: LimitSetKind
    gamma: Signed
    gamma_value: float
    edge: Edge
    multiplier: sp.Expr
    tangential: tuple[sp.Expr, ...]
    u_tilde: tuple[sp.Expr, ...]
    reason: str
    after: str = ""

    def __repr__(self) -> str:
        return f"LimitSet({self.state.scene.name!r}, {self.state.label!r}, {self.kind})"

    @property
    def critical(self) -> bool:
        """gamma = 0 at q, and there is a jump."""
        return self.gamma.sign is Sign.ZERO and self.kind != "point"

    @cached_property
    def ends(self) -> LimitSet:
        """{u-, u_tilde} alone: what A_eps tends to at an isolated critical state."""
        return replace(self, kind="pair", reason="the ends of A") if self.kind == "segment" else self

    @property
    def u_minus(self) -> np.ndarray:
        """(d,) floats."""
        return np.array([self.state.number(x) for x in self.state.u])

    @property
    def u_plus(self) -> np.ndarray:
        """(d,) floats of u_tilde."""
        return np.array([self.state.number(x) for x in self.u_tilde]) + 0.0  # no negative zeros

    @property
    def jump(self) -> np.ndarray:
        """(d,) floats of u_tilde - u-, formed exactly first."""
        pairs = zip(self.u_tilde, self.state.u, strict=True)
        return np.array([self.state.number(x - y) for x, y in pairs])

    @property
    def point_set(self) -> sets.Points | sets.LineSegment:
        """A as a set of the plane of velocities, to rounding. Raises ValueError where A is undecided."""
        if self.kind == "undecided":
            raise ValueError(f"A is undecided: {self.reason}")
        if self.kind == "segment":
            return sets.LineSegment(self.u_minus, self.u_plus)
        ends = [self.u_minus] if self.kind == "point" else [self.u_minus, self.u_plus]
        return sets.Points(np.array(ends))


@overload
def limit_set(state: State, law: Literal["projection"] = "projection") -> LimitSet: ...
@overload
def limit_set(state: State, law: Literal["coulomb"]) -> CoulombLimitSet: ...
def limit_set(state: State, law: str = "projection") -> LimitSet | CoulombLimitSet:
    """The right velocities at a tangential contact, from exact signs; kind "undecided" where a sign is not decided.

    Of the law "projection", S of the paper's (7): A(q, u-). Of the law "coulomb", Coulomb's law with maximal
    dissipation: the same for k <= 1 and in general another set for k = 2 (painleve.theory.coulomb.limit). Raises
    InputError for another law.
    """
    if law == "coulomb":
        return coulomb_limit_set(state)
    if law != "projection":
        raise InputError(f"limit set: no law {law!r}; choose projection or coulomb")
    return _projected(state)


def _projected(state: State) -> LimitSet:
    theory = theory_of(state.scene.contact)
    edge, gamma = theory.least_edge(state)
    if gamma.sign is Sign.POSITIVE:
        return _limit(state, "point", gamma, 0, None, theory.positive)
    if gamma.sign is Sign.UNDECIDED:
        return _limit(state, "undecided", gamma, edge, None, f"the sign of gamma is undecided: {gamma.reason}")
    least = theory.jump(state, edge, gamma.sign)
    if least.undecided:
        return _limit(state, "undecided", gamma, edge, None, least.undecided)
    if least.impulse is None:
        return _limit(state, "point", gamma, edge, None, "u_tilde = u-: the slip is not in the destabilising sense")
    if gamma.sign is Sign.NEGATIVE:
        reason = f"gamma < 0: stay at u- or jump to u_tilde, where the contact point {least.after}"
        return _limit(state, "pair", gamma, edge, least.impulse, reason, least.after)
    reason = "gamma = 0: every velocity between u- and u_tilde"
    return _limit(state, "segment", gamma, edge, least.impulse, reason, least.after)


def _limit(
    state: State,
    kind: LimitSetKind,
    gamma: Signed,
    edge: Edge,
    impulse: tuple[sp.Expr, ...] | None,
    reason: str,
    after: str = "",
) -> LimitSet:
    d, k = derive(state.scene), state.scene.contact.section.dimension
    u_tilde, exact = state.u, (sp.Integer(0),) * (1 + k)
    if impulse is not None:
        exact = tuple(state.exact(r) for r in impulse)
        jump = d.normal_response * impulse[0] + d.tangent_response * sp.Matrix(impulse[1:])
        u_tilde = tuple(u + state.exact(x) for u, x in zip(state.u, jump, strict=True))
    value = 0.0 if gamma.sign is Sign.ZERO else state.number(d.gamma)
    return LimitSet(
        state=state,
        kind=kind,
        gamma=gamma,
        gamma_value=value,
        edge=edge,
        multiplier=exact[0],
        tangential=exact[1:],
        u_tilde=u_tilde,
        reason=reason,
        after=after,
    )
