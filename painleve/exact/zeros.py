"""All zeros of a function of one variable on an interval, with a proof that none was missed (ball arithmetic).

Subdivision: an interval has no zero where the function, or its Taylor form of second order, excludes zero; at most one
where the derivative does, and then the signs at its ends tell. What stays undecided down to the least width is a
cluster: an exact candidate in it at which the derivatives below some order vanish exactly, while the derivative of that
order excludes zero on the whole cluster, is its only zero; otherwise the cluster is reported as it is.
(docs/theory.md, section 8.4.)
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

import sympy as sp
from flint import arb, ctx

from painleve.errors import InputError
from painleve.exact.algebraic import candidate_zeros
from painleve.exact.balls import ball, make_ball_function
from painleve.exact.signs import Sign, exact_sign

__all__ = ["Zero", "ZeroStatus", "Zeros", "find_zeros"]

BITS = 128
HIGHEST = 4  # multiplicity that is looked for
LEAST = 2.0**-24  # width of an interval that is still divided, in units of the whole
BOXES = 20_000
CUT = (491, 1000)  # where an interval is divided: off the middle, so that a zero at a simple fraction is inside a part
SHARP = 2.0**-80  # width of an enclosure, in units of the whole


class ZeroStatus(Enum):
    """EXACT: a number. ENCLOSED: exactly one simple zero in the ball. UNDECIDED: it may hold any number of zeros."""

    EXACT = "exact"
    ENCLOSED = "enclosed"
    UNDECIDED = "undecided"


@dataclass(frozen=True, kw_only=True, eq=False)
class Zero:
    """A zero or, if undecided, an interval, of multiplicity 0; `rise` is the sign of the derivative of that order."""

    status: ZeroStatus
    place: sp.Expr | None
    enclosure: arb
    multiplicity: int
    rise: int
    reason: str


@dataclass(frozen=True, kw_only=True, eq=False)
class Zeros:
    """All zeros by rising place; and the intervals on which the function is not defined or not real."""

    zeros: tuple[Zero, ...]
    outside: tuple[arb, ...]
    boxes: int


@dataclass(frozen=True)
class _Part:
    """An interval between two numbers of [0, 1]."""

    low: arb
    high: arb

    def union(self) -> arb:
        return self.low.union(self.high)


def find_zeros(function: sp.Expr, variable: sp.Symbol, low: sp.Expr, high: sp.Expr) -> Zeros:
    """The zeros of the function on [low, high]. Raises InputError for a function that cannot be differentiated."""
    return _ZeroSearch(function, variable, low, high).run()


class _ZeroSearch:
    def __init__(self, function: sp.Expr, variable: sp.Symbol, low: sp.Expr, high: sp.Expr) -> None:
        self.function, self.variable, self.ends = function, variable, (low, high)
        self.derivatives = [function]
        with ctx.workprec(BITS):
            self.low, self.high = ball(low, bits=BITS), ball(high, bits=BITS)
            self.size = self.high - self.low
        self.first = self._compiled([function, self._derivative(1)])
        self.second = self._compiled([self._derivative(2)])
        self.conditions = self._compiled(list(_conditions(function)))
        self.boxes = 0
        self._candidates: list[sp.Expr] | None = None

    def _derivative(self, order: int) -> sp.Expr:
        while len(self.derivatives) <= order:
            self.derivatives.append(self.derivatives[-1].diff(self.variable))
        return self.derivatives[order]

    def _compiled(self, expressions: Sequence[sp.Expr]) -> Callable[[Sequence[arb]], list[arb]]:
        try:
            return make_ball_function(expressions, [self.variable], bits=BITS)
        except (TypeError, ValueError) as reason:
            raise InputError(f"no zeros can be proved of a function that is not smooth: {reason}") from None

    def run(self) -> Zeros:
        with ctx.workprec(BITS):
            found, open_parts, outside = self._divide()
            clusters = self._clusters(_merged(open_parts))
            ordered = sorted([*found, *clusters], key=lambda zero: zero.enclosure.mid())
            gaps = [self._at(part.union()) for part in _merged(outside)]
        return Zeros(zeros=tuple(_without_doubles(ordered)), outside=tuple(gaps), boxes=self.boxes)

    def _at(self, u: arb) -> arb:
        return self.low + self.size * u

    def _divide(self) -> tuple[list[Zero], list[_Part], list[_Part]]:
        found: list[Zero] = []
        clusters: list[_Part] = []
        outside: list[_Part] = []
        stack = [_Part(arb(0), arb(1))]
        while stack:
            part = stack.pop()
            self.boxes += 1
            s = self._at(part.union())
            if any(condition < 0 for condition in self.conditions([s])):
                outside.append(part)
                continue
            value, slope = self._enclosed(s)
            if _nonzero(value):
                continue
            if _nonzero(slope):
                zero = self._monotone(part, s, slope)
                if zero is not None:
                    found.append(zero)
                if zero is not None or self._same_sign(part, slope):
                    continue
            width = float((part.high - part.low).mid())
            if width < LEAST or self.boxes > BOXES:
                (clusters if value.is_finite() else outside).append(part)
                continue
            cut = (part.low + (part.high - part.low) * CUT[0] / CUT[1]).mid()
            stack += [_Part(cut, part.high), _Part(part.low, cut)]
        return found, clusters, outside

    def _enclosed(self, s: arb) -> tuple[arb, arb]:
        """The function and its derivative on an interval: as they are written, and by Taylor's formula."""
        value, slope = self.first([s])
        if _nonzero(value) or not value.is_finite():
            return value, slope
        middle, curvature = s.mid(), self.second([s])[0]
        if not curvature.is_finite():
            return value, slope
        at, rise = self.first([middle])
        h = s - middle
        expanded = at + rise * h + curvature * (h * h).nonnegative_part() / 2
        return value.intersection(expanded), slope.intersection(rise + curvature * h)

    def _end_sign(self, u: arb) -> Sign:
        value = self.first([self._at(u)])[0]
        if _nonzero(value):
            return Sign.POSITIVE if value > 0 else Sign.NEGATIVE
        if u == 0 or u == 1:  # the interval's own ends are exact
            return exact_sign(self.function.xreplace({self.variable: self.ends[int(u == 1)]})).sign
        return Sign.UNDECIDED

    def _same_sign(self, part: _Part, slope: arb) -> bool:
        signs = {self._end_sign(part.low), self._end_sign(part.high)}
        return len(signs) == 1 and Sign.UNDECIDED not in signs

    def _monotone(self, part: _Part, s: arb, slope: arb) -> Zero | None:
        """The one zero of a part on which the derivative has one sign; None: there is none, or an end is undecided."""
        signs = [self._end_sign(part.low), self._end_sign(part.high)]
        rise = 1 if slope > 0 else -1
        for sign, end in zip(signs, self.ends, strict=True):
            if sign is Sign.ZERO:
                return Zero(
                    status=ZeroStatus.EXACT,
                    place=end,
                    enclosure=ball(end, bits=BITS),
                    multiplicity=1,
                    rise=rise,
                    reason="at the end of the interval",
                )
        if set(signs) != {Sign.POSITIVE, Sign.NEGATIVE}:
            return None
        enclosure = self._sharpened(s)
        place = self._exact_in(enclosure, 1)
        status = ZeroStatus.ENCLOSED if place is None else ZeroStatus.EXACT
        enclosure = enclosure if place is None else ball(place, bits=BITS)
        return Zero(
            status=status,
            place=place,
            enclosure=enclosure,
            multiplicity=1,
            rise=rise,
            reason="the derivative has one sign, and the function another sign at each end",
        )

    def _sharpened(self, s: arb) -> arb:
        """Newton's method on intervals."""
        for _ in range(60):
            middle = s.mid()
            value, slope = self.first([middle])[0], self._enclosed(s)[1]
            narrower = (middle - value / slope).intersection(s)
            if not narrower.rad() < 0.75 * s.rad() or narrower.rad() < SHARP * self.size:
                return narrower
            s = narrower
        return s

    # --- exact zeros and clusters ------------------------------------------------------------------------------------

    def _exact_in(self, enclosure: arb, multiplicity: int) -> sp.Expr | None:
        """A candidate there at which the derivatives below `multiplicity` vanish exactly."""
        if self._candidates is None:
            self._candidates = candidate_zeros(self.function, self.variable, self.low, self.high)
        for place in self._candidates:
            if enclosure.overlaps(ball(place, bits=BITS)) and all(
                exact_sign(self._derivative(order).xreplace({self.variable: place})).sign is Sign.ZERO
                for order in range(multiplicity)
            ):
                return place
        return None

    def _clusters(self, parts: list[_Part]) -> list[Zero]:
        """A zero for each part. One that stays undecided may be the flank of a multiple zero next to it: where a higher
        derivative keeps its sign on both and on what lies between, they hold that one zero together."""
        zeros = [self._cluster(part) for part in parts]
        i = 0
        while i + 1 < len(parts):
            pair = zeros[i : i + 2]
            joined = _Part(parts[i].low, parts[i + 1].high)
            both = self._cluster(joined) if any(z.status is ZeroStatus.UNDECIDED for z in pair) else None
            if both is not None and both.status is ZeroStatus.EXACT:
                parts[i : i + 2], zeros[i : i + 2] = [joined], [both]
                i = max(i - 1, 0)
            else:
                i += 1
        return zeros

    def _cluster(self, part: _Part) -> Zero:
        s = self._at(part.union())
        for multiplicity in range(1, HIGHEST + 1):
            derivative = self._compiled([self._derivative(multiplicity)])([s])[0]
            place = self._exact_in(s, multiplicity) if _nonzero(derivative) else None
            if place is not None:
                return Zero(
                    status=ZeroStatus.EXACT,
                    place=place,
                    enclosure=ball(place, bits=BITS),
                    multiplicity=multiplicity,
                    rise=1 if derivative > 0 else -1,
                    reason=f"a zero of multiplicity {multiplicity}, and the only one near",
                )
        return Zero(
            status=ZeroStatus.UNDECIDED,
            place=None,
            enclosure=s,
            multiplicity=0,
            rise=0,
            reason="it comes too near to zero there for balls to tell none, one or several zeros",
        )


def _nonzero(x: arb) -> bool:
    return bool(x > 0 or x < 0)


def _merged(parts: Sequence[_Part]) -> list[_Part]:
    """Parts that touch become one."""
    merged: list[_Part] = []
    for part in sorted(parts, key=lambda p: p.low):
        if merged and merged[-1].high >= part.low:
            merged[-1] = _Part(merged[-1].low, part.high)
        else:
            merged.append(part)
    return merged


def _without_doubles(zeros: Sequence[Zero]) -> list[Zero]:
    """One that was found exactly may also have been met by the part beside it."""
    kept: list[Zero] = []
    for zero in zeros:
        if not (kept and zero.place is not None and kept[-1].place == zero.place):
            kept.append(zero)
    return kept


def _conditions(function: sp.Expr) -> set[sp.Expr]:
    """What must not be negative for the function to be real."""
    found = {p.base for p in function.atoms(sp.Pow) if p.exp.is_Rational and p.exp.q % 2 == 0}
    found |= {1 - x.args[0] ** 2 for x in function.atoms(sp.acos, sp.asin)}
    return found | {x.args[0] for x in function.atoms(sp.log)}
