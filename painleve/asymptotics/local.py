"""The law around one exact state, in offsets: what every method of asymptotics evaluates.

From the exact base state the rows of the scene are expanded in Taylor polynomials whose coefficients are known to
dozens of digits, so that g, v_n, gamma and S - A come out right to rounding however small eps is. Where eps is so large
that no affordable polynomial is accurate, the rows are evaluated plainly; nothing cancels badly there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal

import flint
import numpy as np
import sympy as sp

from painleve.asymptotics.ball_arithmetic import BITS
from painleve.asymptotics.sections.listed import asymptotics_of
from painleve.asymptotics.sections.section import SectionAsymptotics
from painleve.core.lane import BaseImpulse, BaseState
from painleve.core.rows import RowParts
from painleve.core.taylor import Polynomials, monomial_block, polynomial_block, sparse_polynomials
from painleve.errors import InputError
from painleve.exact.balls import ball
from painleve.exact.jets import Jet, jets, monomials
from painleve.kernels.compiled import Kernels, make_kernels
from painleve.kernels.rows import Rows
from painleve.progress import told
from painleve.theory.limit_set import LimitSet

__all__ = ["Arithmetic", "Expansion", "LocalProblem", "make_local_problem"]

Arithmetic = Literal["automatic", "taylor", "plain"]

MOST_MONOMIALS = 70
HIGHEST_ORDER = 16
ACCURACY = 1e-14  # aimed at by the order of a row, relative to its size on the ball
TRUSTED = 1e-10  # proved of every row, else it is evaluated plainly: wide enclosures overestimate


@dataclass(frozen=True, kw_only=True, eq=False)
class Expansion:
    """Polynomials for the varying rows and the highest of their degrees.

    remainder: a rigorous upper bound on what the polynomials leave out anywhere on the ball, for each varying row,
    relative to that row's greatest term there (a row of zeros: absolute).
    """

    order: int
    polynomials: Polynomials
    remainder: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class LocalProblem:
    """The state and its limit set as the kernels want them; arrays are float64, rounded from exact values.

    base: the rows at q; u: u-; direction: unit vector from u- to u_tilde (0 without a jump), length: its distance;
    impulse, multiplier, critical_edge: see painleve.core.lane.BaseState;
    carried: norm of dg with respect to the carried coordinates, and its direction in q.
    """

    limit: LimitSet
    section: SectionAsymptotics
    kernels: Kernels
    q: np.ndarray
    p: np.ndarray
    u: np.ndarray
    base: np.ndarray
    direction: np.ndarray
    length: float
    impulse: BaseImpulse
    multiplier: float
    critical_edge: int
    carried: float
    carried_direction: np.ndarray
    powers: tuple[tuple[int, ...], ...]
    table: np.ndarray

    @property
    def dimension(self) -> int:
        return int(self.u.size)

    @property
    def shape(self) -> tuple[int, ...]:
        return self.kernels.derivation.shape

    @cached_property
    def base_state(self) -> BaseState:
        """The same as compiled code takes it."""
        return BaseState(**{name: getattr(self, name) for name in BaseState._fields})

    @property
    def parts(self) -> RowParts:
        """Which rows are which part."""
        return self.kernels.rows.parts

    @property
    def normal(self) -> np.ndarray:
        """w_n = -grad g at q, (d,)."""
        return self.base[self.parts.w_n]

    @cached_property
    def exact_multiplier(self) -> flint.arb:
        """The normal impulse of the jump from u- to u_tilde, as a ball."""
        return ball(self.limit.multiplier, bits=BITS)

    @cached_property
    def analytic(self) -> bool:
        """Whether the rows have a Taylor expansion at q; where they have none, the table holds NaN."""
        return bool(np.isfinite(self.table).all())

    @cached_property
    def degrees(self) -> np.ndarray:
        return np.array([sum(powers) for powers in self.powers], dtype=int)

    @cached_property
    def gradients(self) -> np.ndarray:
        """(rows, s): derivatives of all rows with respect to the shape coordinates, at the base state."""
        full = np.zeros((self.base.size, len(self.shape)))
        for m, powers in enumerate(self.powers):
            if sum(powers) == 1:
                full[list(self.kernels.rows.varying), powers.index(1)] = self.table[:, m]
        return full

    def expansion(self, eps: float, arithmetic: Arithmetic = "automatic") -> Expansion | None:
        """The lowest order of each row that is accurate on balls of radius eps; None: evaluate the rows plainly.

        The order is chosen from the coefficients; what is then left out is bounded rigorously, and where that bound
        is not small the rows are evaluated plainly, unless "taylor" is asked for.
        """
        if arithmetic == "plain":
            return None
        if not self.analytic:
            if arithmetic == "taylor":
                raise InputError("arithmetic: the scene is not analytic at this state, so taylor has nothing to expand")
            return None
        highest = int(self.degrees.max(initial=0))
        orders = range(min(2, highest), highest + 1)
        accurate = np.array([self._truncation(order, eps) for order in orders]) <= ACCURACY
        if not accurate.any(axis=0).all() and arithmetic != "taylor":
            return None
        # A row for which no order suffices takes the highest.
        choice = np.where(accurate.any(axis=0), accurate.argmax(axis=0), len(orders) - 1)
        found = self._expansion(choice + orders[0], eps)
        if arithmetic != "taylor" and not np.all(found.remainder <= TRUSTED):
            return None
        return found

    def differences(self, eps: float, expansion: Expansion | None, x: np.ndarray) -> np.ndarray:
        """All rows minus their base values (R, n) at the shape offsets eps x, x (s, n)."""
        dq, n = np.ascontiguousarray(eps * x), x.shape[1]
        values = np.empty((len(self.table), n))
        if expansion is not None:
            monomials = np.empty((expansion.polynomials.parents.size, n))
            monomial_block(expansion.polynomials, dq, monomials)
            polynomial_block(expansion.polynomials, monomials, values)
        else:
            self.kernels.varying_block(dq, self.q, self.p, self.base, values)
        full = np.zeros((self.base.size, n))
        full[list(self.kernels.rows.varying)] = values
        return full

    def _remainder(self, orders: np.ndarray, eps: float) -> np.ndarray:
        """Lagrange's remainder after the highest degree used, from derivatives enclosed over the ball, and the terms
        of lower degree that a row does without; relative to the row's greatest term."""
        highest = int(orders.max(initial=0))
        enclosed = _enclosed_coefficients(self, eps, highest + 1)
        if enclosed is None:
            return np.full(len(self.table), np.inf)
        size = np.abs(self.table) * float(eps) ** self.degrees
        skipped = np.where((self.degrees > orders[:, None]) & (self.degrees <= highest), size, 0.0).sum(axis=1)
        greatest = size.max(axis=1, initial=0.0)
        return (enclosed * float(eps) ** (highest + 1) + skipped) / np.where(greatest > 0.0, greatest, 1.0)

    def _truncation(self, order: int, eps: float) -> np.ndarray:
        """Estimate of each row's largest relative error on the ball if degrees above `order` are left out."""
        highest = int(self.degrees.max(initial=0))
        size = np.abs(self.table) * float(eps) ** self.degrees
        kept, left = size[:, self.degrees <= order].sum(axis=1), size[:, self.degrees > order].sum(axis=1)
        # The highest degree stands for all that were never computed.
        left = left + size[:, self.degrees == highest].sum(axis=1) * (eps if order == highest else 0.0)
        return left / np.where(kept > 0.0, kept, 1.0)

    def _expansion(self, orders: np.ndarray, eps: float) -> Expansion:
        order = int(orders.max(initial=0))
        chosen = [powers for powers in self.powers if sum(powers) <= order]
        place = {powers: m for m, powers in enumerate(chosen)}
        parents, factors = [], []
        for powers in chosen:
            factor = next(j for j, power in enumerate(powers) if power)
            parent = tuple(power - (j == factor) for j, power in enumerate(powers))
            parents.append(place.get(parent, -1))
            factors.append(factor)
        kept = np.where(self.degrees <= orders[:, None], self.table, 0.0)[:, : len(chosen)]
        polynomials = sparse_polynomials(np.array(parents, np.int64), np.array(factors, np.int64), kept)
        return Expansion(order=order, polynomials=polynomials, remainder=self._remainder(orders, eps))


@lru_cache(maxsize=256)
def _enclosed_coefficients(problem: LocalProblem, eps: float, degree: int) -> np.ndarray | None:
    """For each varying row, the sum over monomials of that degree of the largest coefficient anywhere on the ball;
    None where a row has no expansion there."""
    state, rows = problem.limit.state, problem.kernels.rows
    variables = [state.scene.q[i] for i in problem.shape]
    point = {s: ball(value, bits=BITS) for s, value in state.substitution.items() if s not in state.scene.u}
    for x in variables:
        point[x] += flint.arb(0, float(eps))
    expressions = [rows.expressions[r] for r in rows.varying]
    try:
        wide = jets(expressions, variables, point, degree, bits=BITS)
    except InputError:
        return None
    bounds = [sum((abs(c).upper() for m, c in jet.terms.items() if sum(m) == degree), flint.arb(0)) for jet in wide]
    return np.array([np.nextafter(float(bound.upper()), np.inf) for bound in bounds])


@lru_cache(maxsize=64)
@told(lambda limit: f"expanding the law about {limit.state.scene.name}, {limit.state.label}")
def make_local_problem(limit: LimitSet) -> LocalProblem:
    """Round an exact state and its limit set to arrays, and expand the rows of its scene about it."""
    state = limit.state
    kernels, section = make_kernels(state.scene), asymptotics_of(state.scene.contact)
    derivation, rows = kernels.derivation, kernels.rows
    point = {symbol: ball(value, bits=BITS) for symbol, value in state.substitution.items()}
    variables = [state.scene.q[i] for i in derivation.shape]
    order = _order(len(variables))
    configuration = {symbol: value for symbol, value in point.items() if symbol not in state.scene.u}
    expanded = jets(rows.expressions, variables, configuration, order, bits=BITS)
    powers = tuple(monomials(len(variables), order)[1:])
    table = [[float(expanded[r].terms.get(m, flint.arb(0)).mid()) for m in powers] for r in rows.varying]
    base = np.array([_base_value(rows, r, jet, configuration) for r, jet in enumerate(expanded)])
    if limit.critical:
        base[rows.edges[limit.edge]] = 0.0
    base[rows.parts.g] = 0.0
    jump = limit.jump
    length = float(np.linalg.norm(jump))
    carried = np.zeros(state.scene.dimension)
    for i in derivation.carried:
        carried[i] = state.number(-derivation.normal[i])
    norm = float(np.linalg.norm(carried))
    return LocalProblem(
        limit=limit,
        section=section,
        kernels=kernels,
        q=_floats(limit, state.q),
        p=_floats(limit, [state.parameters[s.name] for s in state.scene.parameters]),
        u=limit.u_minus,
        base=base,
        direction=jump / length if length > 0.0 else jump,
        length=length,
        impulse=section.base_impulse(limit),
        multiplier=state.number(limit.multiplier),
        critical_edge=limit.edge if limit.critical else 0,
        carried=norm,
        carried_direction=carried / norm if norm > 0.0 else carried,
        powers=powers,
        table=np.array(table).reshape(len(rows.varying), len(powers)),
    )


def _base_value(rows: Rows, r: int, jet: Jet, configuration: Mapping[sp.Symbol, flint.arb]) -> float:
    """A row at the base state, also where it is defined there and has no expansion."""
    value = jet.constant()
    if not value.is_finite():
        value = ball(rows.expressions[r], configuration, bits=BITS)
    if not value.is_finite():
        raise InputError(f"{rows.names[r]} cannot be told from an undefined value at this state; choose another one")
    return float(value.mid())


def _order(variables: int) -> int:
    if variables == 0:
        return 1
    fitting = [n for n in range(2, HIGHEST_ORDER + 1) if len(monomials(variables, n)) <= MOST_MONOMIALS]
    return max(fitting, default=2)


def _floats(limit: LimitSet, values: Sequence[sp.Expr]) -> np.ndarray:
    return np.array([limit.state.number(value) for value in values])
