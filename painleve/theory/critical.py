"""Critical states along a curve: where gamma vanishes, where mu_c is least and greatest, and of which kind they are.

One state key varies, the rest is fixed. All zeros of gamma at the scene's friction and all extrema of the critical
friction are found, with a proof that none was missed, or with the intervals in which that was not decided. At an exact
zero the kind is decided by exact arithmetic (painleve.theory.neighbourhood); at one that is only enclosed by what
holds on the whole enclosure (docs/theory.md, section 5):
- touching states on both sides of it have gamma > 0, or one side has: approached;
- gamma is negative on both sides and depends on the coordinate that varies alone, or on two coordinates and falls into
  penetration: isolated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum

import sympy as sp
from flint import arb

from painleve.errors import InputError
from painleve.exact.balls import ball
from painleve.exact.signs import Sign, exact_sign
from painleve.exact.zeros import Zero, ZeroStatus
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number
from painleve.progress import told
from painleve.theory.curve import StateCurve
from painleve.theory.limit_set import limit_set
from painleve.theory.neighbourhood import Neighbourhood, Neighbours, neighbours, smooth_indicator

__all__ = ["CriticalState", "CriticalStates", "Extremum", "critical_states"]

LONG = 200  # operations of a value that is not simplified any more


class Extremum(Enum):
    """What the critical friction does along the curve."""

    MINIMUM = "minimum"
    MAXIMUM = "maximum"
    INFLECTION = "stationary, no extremum"


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalState:
    """One zero of gamma, or one extremum of mu_c with mu equal to it.

    `place` is the exact value of the key (None: only `enclosure` is known), `friction` mu_c there, in closed form where
    the place has one; `extremum` is None for a zero of gamma at the scene's own friction.
    """

    status: ZeroStatus
    place: sp.Expr | None
    enclosure: arb
    friction: sp.Expr | None
    friction_enclosure: arb
    extremum: Extremum | None
    kind: Neighbourhood
    reason: str

    def __repr__(self) -> str:
        place, friction = (float(x.mid()) for x in (self.enclosure, self.friction_enclosure))
        return f"CriticalState({self.status.value}, at {place:.6g}, mu_c = {friction:.6g}, {self.kind.value})"


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalStates:
    """What was found along the curve on [low, high].

    `ends` enclose mu_c there; `outside` are intervals where the curve is not defined, or M degenerates; `changing` are
    parameters that change along the curve, which then touches another obstacle everywhere: no kind follows from it for
    a state that is only enclosed; `note` says why there are no extrema, if it is for a reason.
    """

    scene: Scene
    along: str
    low: sp.Expr
    high: sp.Expr
    zeros: tuple[CriticalState, ...]
    extrema: tuple[CriticalState, ...]
    ends: tuple[arb, arb]
    outside: tuple[arb, ...]
    changing: tuple[str, ...]
    note: str

    def __repr__(self) -> str:
        found = f"zeros of gamma: {len(self.zeros)}, extrema of mu_c: {len(self.extrema)}"
        return f"CriticalStates({self.scene.name!r}, along {self.along!r}; {found}, unresolved: {len(self.unresolved)})"

    @property
    def unresolved(self) -> tuple[CriticalState, ...]:
        """Intervals that may hold more than one zero, or none; without any, it is proved that none was missed."""
        return tuple(x for x in (*self.zeros, *self.extrema) if x.status is ZeroStatus.UNDECIDED)

    @property
    def least(self) -> CriticalState | None:
        """The minimum at which mu_c is least; None if there is none, or it is less at an end of the interval."""
        minima = [x for x in self.extrema if x.extremum is Extremum.MINIMUM]
        lowest = min(minima, key=lambda x: x.friction_enclosure.mid(), default=None)
        if lowest is None or any(end < lowest.friction_enclosure for end in self.ends):
            return None
        return lowest


@told(lambda scene, along, *_, **__: f"searching {scene.name} along {along} for zeros of gamma and extrema of mu_c")
def critical_states(
    scene: Scene,
    along: str,
    *,
    low: Number | None = None,
    high: Number | None = None,
    name: str | None = None,
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
) -> CriticalStates:
    """Zeros of gamma and extrema of mu_c as the key `along` goes from low to high, the rest as make_state takes it.

    Without ends the key's own interval is taken, or a full turn for an angle. Raises InputError for an unknown key, an
    empty interval, a scene without friction, and where gamma does not change along the curve.
    """
    curve = StateCurve(scene, along, name, dict(keys or {}), dict(parameters or {}), low, high)
    zeros = [_zero_of_gamma(curve, edge, zero) for edge in curve.edges for zero in curve.zeros(curve.indicator(edge))]
    numerator, note = curve.stationarity()
    extrema = [_extremum(curve, zero) for zero in (curve.zeros(numerator) if numerator is not None else ())]
    return CriticalStates(
        scene=scene,
        along=along,
        low=curve.low,
        high=curve.high,
        zeros=tuple(sorted((z for z in zeros if z is not None), key=lambda z: z.enclosure.mid())),
        extrema=tuple(x for x in extrema if x is not None),
        ends=curve.end_frictions(),
        outside=tuple(curve.outside),
        note=note,
        changing=curve.changing,
    )


# --- zeros of gamma --------------------------------------------------------------------------------------------------


def _zero_of_gamma(curve: StateCurve, edge: int, zero: Zero) -> CriticalState | None:
    others = [curve.on(curve.indicator(e)) for e in curve.edges if e != edge]
    if any(curve.value(other, zero.enclosure) < 0 for other in others):
        return None  # gamma is attained on another edge, and negative
    kind, reason = Neighbourhood.UNDECIDED, zero.reason
    if zero.place is not None:
        kind, reason = _exact_kind(curve, zero.place, {})
    if kind is Neighbourhood.UNDECIDED and zero.status is not ZeroStatus.UNDECIDED and not curve.changing:
        if zero.multiplicity % 2 == 1:
            kind, reason = Neighbourhood.APPROACHED, "gamma changes its sign along touching states"
        elif zero.rise > 0:
            kind, reason = Neighbourhood.APPROACHED, "gamma is positive on both sides along touching states"
    return CriticalState(
        status=zero.status,
        place=zero.place,
        enclosure=zero.enclosure,
        friction=_exact_friction(curve, zero.place),
        friction_enclosure=curve.friction_at(zero.enclosure),
        extremum=None,
        kind=kind,
        reason=reason,
    )


def _exact_kind(curve: StateCurve, place: sp.Expr, parameters: Mapping[str, Number]) -> tuple[Neighbourhood, str]:
    """By exact arithmetic; undecided where the numbers are too much for it, or the state is none."""
    try:
        limit = limit_set(curve.state(place, parameters))
    except InputError as reason:
        return Neighbourhood.UNDECIDED, str(reason)
    if limit.gamma.sign is not Sign.ZERO:
        return Neighbourhood.UNDECIDED, f"the sign of gamma: {limit.gamma.reason}"
    near: Neighbours = neighbours(limit.state, limit.edge)
    return near.kind, near.reason


def _exact_friction(curve: StateCurve, place: sp.Expr | None) -> sp.Expr | None:
    """mu_c at an exact place, simplified where that is cheap; None where it is not defined."""
    formula = curve.derivation.critical_friction
    if place is None or formula is None:
        return None
    value = curve.on(formula).xreplace({curve.variable: place})
    if value.has(sp.zoo, sp.nan, sp.oo):
        return None
    if value.count_ops() > LONG:
        return None
    if value.has(sp.CRootOf):
        return value
    shorter = min((value, sp.radsimp(sp.simplify(value))), key=lambda x: x.count_ops())
    return shorter if ball(shorter).overlaps(ball(value)) else value


# --- extrema of mu_c -------------------------------------------------------------------------------------------------


def _extremum(curve: StateCurve, zero: Zero) -> CriticalState | None:
    coupling = curve.value(curve.coupling(), zero.enclosure)
    if zero.place is not None and exact_sign(curve.coupling().xreplace({curve.variable: zero.place})).sign is Sign.ZERO:
        return None  # mu_c is infinite there
    if zero.status is not ZeroStatus.UNDECIDED and not (coupling > 0 or coupling < 0):
        zero = replace(zero, status=ZeroStatus.UNDECIDED, multiplicity=0, reason="mu_c may be infinite there")
    sense = zero.rise * (1 if coupling > 0 else -1)
    extremum = None
    if zero.status is not ZeroStatus.UNDECIDED:
        extremum = (
            Extremum.INFLECTION if zero.multiplicity % 2 == 0 else (Extremum.MINIMUM if sense > 0 else Extremum.MAXIMUM)
        )
    friction, enclosure = _exact_friction(curve, zero.place), curve.friction_at(zero.enclosure)
    kind, reason = _kind_of_extremum(curve, zero, extremum, friction, enclosure)
    return CriticalState(
        status=zero.status,
        place=zero.place,
        enclosure=zero.enclosure,
        friction=friction,
        friction_enclosure=enclosure,
        extremum=extremum,
        kind=kind,
        reason=reason,
    )


def _coefficient(curve: StateCurve) -> str | None:
    """The parameter that is the coefficient of friction and nothing else, if there is one."""
    value = curve.scene.contact.section.expressions[0]
    elsewhere = set().union(*(x.free_symbols for x in (curve.a, *curve.b, curve.scene.contact.constraint)))
    return next((p.name for p in curve.scene.parameters if p.symbol == value and value not in elsewhere), None)


def _kind_of_extremum(
    curve: StateCurve, zero: Zero, extremum: Extremum | None, friction: sp.Expr | None, enclosure: arb
) -> tuple[Neighbourhood, str]:
    name = _coefficient(curve)
    if name is None:
        return Neighbourhood.UNDECIDED, "friction is not a parameter, and cannot be set to mu_c"
    if zero.status is ZeroStatus.UNDECIDED:
        return Neighbourhood.UNDECIDED, zero.reason
    kind, reason = Neighbourhood.UNDECIDED, "mu_c is stationary there"
    if zero.place is not None and friction is not None:
        kind, reason = _exact_kind(curve, zero.place, {name: friction})
    if kind is not Neighbourhood.UNDECIDED or curve.changing:
        return kind, reason
    if extremum is not Extremum.MAXIMUM:
        return Neighbourhood.APPROACHED, "mu_c is greater beside it along touching states"
    return _kind_of_maximum(curve, zero.enclosure, curve.scene.parameter(name).symbol, enclosure, reason)


def _kind_of_maximum(
    curve: StateCurve, place: arb, mu: sp.Symbol, friction: arb, reason: str
) -> tuple[Neighbourhood, str]:
    """gamma < 0 on both sides along the curve: what happens in the other directions, on the whole enclosure?"""
    scene = curve.scene
    fixed = curve.rules | {mu: mu}
    coupling = curve.value(curve.coupling(), place)
    edge = -1 if len(curve.b) == 1 and coupling > 0 else 1
    p, g = smooth_indicator(scene, edge), scene.contact.constraint
    used = [x for x in scene.q if x in p.free_symbols]
    if len(used) == 1 and _moves(curve, used[0], place):
        return Neighbourhood.ISOLATED, f"gamma depends on {used[0]} alone, and is negative on both sides"
    both = [x for x in scene.q if x in p.free_symbols or x in g.free_symbols]
    product = sum((sp.diff(p, x) * sp.diff(g, x) for x in both), sp.Integer(0)).xreplace(fixed)
    slope = ball(product, {curve.variable: place, mu: friction})
    if slope > 0:
        return Neighbourhood.APPROACHED, "gamma grows into penetration"
    if slope < 0 and len(both) == 2:
        return Neighbourhood.ISOLATED, "gamma is negative on the constraint on both sides, and falls into penetration"
    return Neighbourhood.UNDECIDED, reason


def _moves(curve: StateCurve, coordinate: sp.Symbol, place: arb) -> bool:
    speed = curve.value(curve.on(coordinate).diff(curve.variable), place)
    return bool(speed > 0 or speed < 0)
