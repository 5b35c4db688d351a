"""The curve of states on which one state key varies, and the functions of that key that say what is critical."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce

import sympy as sp
from flint import arb

from painleve.errors import InputError
from painleve.exact.balls import ball
from painleve.exact.parse import exact_number, parse_expression
from painleve.exact.signs import Sign, exact_sign
from painleve.exact.zeros import Zero, ZeroStatus, find_zeros
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene, StateKey
from painleve.mechanics.state import Number, State, make_curve, make_state
from painleve.theory.neighbourhood import smooth_indicator

__all__ = ["StateCurve"]


class StateCurve:
    """The curve's substitution, and the functions of its key whose zeros are sought."""

    def __init__(
        self,
        scene: Scene,
        along: str,
        name: str | None,
        keys: dict[str, Number],
        parameters: dict[str, Number],
        low: Number | None,
        high: Number | None,
    ) -> None:
        if not scene.contact.section.edges:
            raise InputError(f"scene {scene.name} has no friction: gamma is positive and mu_c infinite everywhere")
        self.scene, self.along, self.name, self.keys, self.parameters = scene, along, name, keys, parameters
        self.rules = make_curve(scene, along, name, keys=keys, parameters=parameters)
        self.key: StateKey = next(k for k in scene.keys if k.name == along)
        self.variable = self.key.symbol
        self.low, self.high = self._interval(low, high)
        self.derivation, self.outside = derive(scene), list[arb]()
        self.edges = scene.contact.section.edges
        adjugate, H = scene.inertia.adjugate(), scene.contact.tangents
        w = self.derivation.normal
        self.a, self.b = (w.T * adjugate * w)[0, 0], H.T * adjugate * w  # times det(M), as the indicator
        self._check_variation()

    def _interval(self, low: Number | None, high: Number | None) -> tuple[sp.Expr, sp.Expr]:
        own = self.key.interval or (("-pi", "pi") if self.key.unit == "rad" else None)
        if own is None and (low is None or high is None):
            raise InputError(f"{self.along} [{self.key.unit}] has no interval of its own; give both ends of it")
        ends = []
        for given, place, what in ((low, 0, "from"), (high, 1, "to")):
            default = parse_expression(own[place], where=what) if own else sp.Integer(0)
            ends.append(default if given is None else exact_number(given, where=f"{what} of {self.along}"))
        if exact_sign(ends[1] - ends[0]).sign is not Sign.POSITIVE:
            raise InputError(f"the interval from {ends[0]} to {ends[1]} of {self.along} is empty")
        return ends[0], ends[1]

    def on(self, expression: sp.Expr) -> sp.Expr:
        return expression.xreplace(self.rules)

    def _check_variation(self) -> None:
        if all(self.on(x) == 0 for x in self.b):
            raise InputError(
                f"scene {self.scene.name}: mu_c is infinite everywhere along {self.along}: "
                "normal and tangent are not coupled"
            )
        if not any(self.on(self.indicator(edge)).has(self.variable) for edge in self.edges):
            others = ", ".join(k.name for k in self.scene.keys if k.name != self.along)
            raise InputError(
                f"scene {self.scene.name}: gamma does not depend on {self.along}; take another key: {others}"
            )

    def indicator(self, edge: int) -> sp.Expr:
        return smooth_indicator(self.scene, edge)

    def zeros(self, function: sp.Expr) -> tuple[Zero, ...]:
        function = self.on(function)
        if not function.has(self.variable):
            return ()
        found = find_zeros(function, self.variable, self.low, self.high)
        self._leave(found.outside)
        return tuple(zero for zero in found.zeros if not self._is_singular(zero))

    def stationarity(self) -> tuple[sp.Expr | None, str]:
        """A function that vanishes where mu_c is stationary, with the sign of its slope; None and why there is none."""
        if self.derivation.critical_friction is None:
            return None, "mu_c is defined for a symmetric segment or a disc alone"
        a, b = self.on(self.a), [self.on(x) for x in self.b]
        s = self.variable
        if len(b) == 1:
            return a.diff(s) * b[0] - a * b[0].diff(s), ""
        squared = sum((x**2 for x in b), sp.Integer(0))
        return 2 * a.diff(s) * squared - a * squared.diff(s), ""

    def coupling(self) -> sp.Expr:
        """b, or |b|^2 for k = 2."""
        b = [self.on(x) for x in self.b]
        return b[0] if len(b) == 1 else sum((x**2 for x in b), sp.Integer(0))

    def friction_at(self, place: arb) -> arb:
        value = self.value(self.on(self.a), place), self.value(self.coupling(), place)
        size = abs(value[1]) if len(self.b) == 1 else value[1].sqrt()
        return value[0] / size

    def value(self, expression: sp.Expr, place: arb) -> arb:
        return ball(expression, {self.variable: place})

    def _is_singular(self, zero: Zero) -> bool:
        """Whether M or grad g degenerates there: what vanishes is a common factor, and not gamma."""
        sizes = [self.on(x) for x in (self.scene.inertia.det(method="berkowitz"), self.derivation.gradient_squared)]
        if zero.place is not None:
            return any(exact_sign(x.xreplace({self.variable: zero.place})).sign is Sign.ZERO for x in sizes)
        if zero.status is ZeroStatus.UNDECIDED and not all(self.value(x, zero.enclosure) > 0 for x in sizes):
            self._leave([zero.enclosure])
            return True
        return False

    def _leave(self, intervals: Sequence[arb]) -> None:
        """Intervals that touch become one."""
        for interval in intervals:
            apart = [x for x in self.outside if not x.overlaps(interval)]
            self.outside = [*apart, reduce(arb.union, [x for x in self.outside if x.overlaps(interval)], interval)]

    def end_frictions(self) -> tuple[arb, arb]:
        return self.friction_at(ball(self.low)), self.friction_at(ball(self.high))

    @property
    def changing(self) -> tuple[str, ...]:
        """Parameters that change along the curve: it does not touch one and the same obstacle."""
        return tuple(p.name for p in self.scene.parameters if self.on(p.symbol).has(self.variable))

    def state(self, place: sp.Expr, parameters: Mapping[str, Number]) -> State:
        return make_state(
            self.scene, self.name, keys=self.keys | {self.along: place}, parameters=self.parameters | dict(parameters)
        )
