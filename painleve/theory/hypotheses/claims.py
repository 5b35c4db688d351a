"""Claims about signs over a whole ball, decided by enclosures on boxes that are cut until they tell, or refuted by a
point.

A claim is proved when it holds on every box that meets the ball. It is refuted by an exact point, or by a change of
sign of a continuous function between two points, which leaves a zero between them. Work is bounded: beyond it the
points that were tried are counted, and nothing more is said.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum
from fractions import Fraction

import sympy as sp
from flint import arb

from painleve.exact.signs import Sign, exact_sign
from painleve.theory.hypotheses.region import Box, Evaluator, Offset, Place, Region
from painleve.theory.hypotheses.simplest import simplest_points

__all__ = ["Claim", "ClaimKind", "ClaimStatus", "Decision", "decide"]

MAX_BOXES = 1500
MAX_OPEN_BOXES = 6  # that are searched for an exact zero
MAX_FACTORED = 300  # operations of an expression that is factored
BISECTIONS = 60
FINEST = Fraction(1, 2**30)  # of the radius: smaller boxes than this are left open, for an exact zero to be found in

# Their enclosures are finite where they jump, so a change of sign across them need not pass through zero.
_JUMPS = (sp.sign, sp.atan2, sp.Heaviside, sp.floor, sp.ceiling, sp.Piecewise)


_FINITE = (sp.sin, sp.cos, sp.exp, sp.sinh, sp.cosh, sp.tanh, sp.atan, sp.Abs, sp.Min, sp.Max)


class ClaimStatus(Enum):
    """How far a claim, or a hypothesis, is settled on the ball."""

    PROVED = "proved"
    REFUTED = "refuted"
    SUPPORTED = "supported numerically"
    UNDECIDED = "undecided"


class ClaimKind(Enum):
    """What is claimed of expressions at every point of the ball."""

    POSITIVE = "> 0"
    NONNEGATIVE = ">= 0"
    NONZERO = "!= 0"


@dataclass(frozen=True, kw_only=True)
class Claim:
    """At every point of the ball every expression is positive, or nonnegative, or at least one of them is not zero.

    With `where`, only at the points at which that expression vanishes.
    """

    kind: ClaimKind
    expressions: tuple[sp.Expr, ...]
    where: sp.Expr | None = None

    def holds(self, values: Sequence[arb]) -> bool:
        """Proved by enclosures of the values."""
        if self.kind is ClaimKind.NONZERO:
            return any(_is_nonzero(value) for value in values)
        return all(value > 0 if self.kind is ClaimKind.POSITIVE else value >= 0 for value in values)

    def fails(self, values: Sequence[arb]) -> bool:
        """Refuted by enclosures of the values at one point."""
        if self.kind is ClaimKind.NONZERO:
            return all(value.is_zero() for value in values)
        return any(value <= 0 if self.kind is ClaimKind.POSITIVE else value < 0 for value in values)

    def holds_exactly(self, region: Region, q: tuple[sp.Expr, ...]) -> bool:
        """Proved at one configuration, by exact signs."""
        signs = (exact_sign(region.value(e, q)).sign for e in self.expressions)
        if self.kind is ClaimKind.NONZERO:
            return any(sign in (Sign.POSITIVE, Sign.NEGATIVE) for sign in signs)
        good = (Sign.POSITIVE,) if self.kind is ClaimKind.POSITIVE else (Sign.POSITIVE, Sign.ZERO)
        return all(sign in good for sign in signs)

    def fails_exactly(self, region: Region, q: tuple[sp.Expr, ...]) -> bool:
        """Refuted at one configuration, by exact signs; the point lies where the claim is made."""
        if self.where is not None and exact_sign(region.value(self.where, q)).sign is not Sign.ZERO:
            return False
        signs = (exact_sign(region.value(e, q)).sign for e in self.expressions)
        if self.kind is ClaimKind.NONZERO:
            return all(sign is Sign.ZERO for sign in signs)
        bad = (Sign.NEGATIVE, Sign.ZERO) if self.kind is ClaimKind.POSITIVE else (Sign.NEGATIVE,)
        return any(sign in bad for sign in signs)

    def margin(self, values: Sequence[arb]) -> float:
        """A lower bound on the least value, or on the largest modulus."""
        if self.kind is ClaimKind.NONZERO:
            return max((float(v.abs_lower()) for v in values if v.is_finite()), default=0.0)
        return min(float(v.lower()) for v in values)


@dataclass(frozen=True, kw_only=True)
class Decision:
    """What became of a claim: `place` refutes it, or is where it stayed open; `bound` is its margin where proved."""

    status: ClaimStatus
    place: Place | None
    boxes: int
    points: int
    bound: float


def decide(region: Region, claim: Claim, *, max_boxes: int = MAX_BOXES) -> Decision:
    """Decide the claim on the ball within `max_boxes` boxes."""
    try:
        search = _ClaimSearch(region, claim)
    except (TypeError, ValueError):  # a function that has no ball arithmetic
        return Decision(status=ClaimStatus.UNDECIDED, place=None, boxes=0, points=0, bound=0.0)
    search.run(max_boxes, until_signs_differ=True)
    search.refuted = search.refuted or _zero_between(search)
    search.run(max_boxes)
    if search.refuted is None and search.remaining:
        search.refuted = _exact_counterexample(search) or _vanishing_factor(region, claim)
    return search.decision()


def _is_nonzero(value: arb) -> bool:
    return bool(value > 0 or value < 0)


@dataclass
class _ClaimSearch:
    region: Region
    claim: Claim
    open: deque[Box] = field(default_factory=deque)
    left: list[Box] = field(default_factory=list)
    boxes: int = 0
    points: int = 0
    bound: float = float("inf")
    refuted: Place | None = None
    unclear: Place | None = None
    ends: dict[Sign, Offset] = field(default_factory=dict)

    def __post_init__(self) -> None:
        on = () if self.claim.where is None else (self.claim.where,)
        self.evaluator = Evaluator(self.region, [*self.claim.expressions, *on])
        self.open.append(self.region.cube(self.evaluator.coordinates))

    def run(self, max_boxes: int, *, until_signs_differ: bool = False) -> None:
        """Breadth first, so that the points tried cover the part of the ball that is still open."""
        while self.open and self.boxes < max_boxes and self.refuted is None:
            if until_signs_differ and len(self.ends) == 2:
                return
            box = self.open.popleft()
            self.boxes += 1
            if self._settles(self.evaluator.on(box)):
                continue
            if self.claim.where is None:
                self._try_point(box)
            if not self.evaluator.coordinates:
                self._settle_constant(box)
            elif box.longest < 2 * FINEST * self.region.radius:
                self.left.append(box)
            else:
                self.open.extend(half for half in box.halves() if self.region.holds(half.nearest))

    def _settle_constant(self, box: Box) -> None:
        if self.claim.holds_exactly(self.region, self.region.state.q):
            self.bound = 0.0
        else:
            self.left.append(box)

    def _settles(self, values: Sequence[arb]) -> bool:
        count = len(self.claim.expressions)
        if self.claim.holds(values[:count]):
            self.bound = min(self.bound, self.claim.margin(values[:count]))
            return True
        return any(_is_nonzero(value) for value in values[count:])

    def _try_point(self, box: Box) -> None:
        offset = box.centre if self.region.holds(box.centre) else box.nearest
        values = self.evaluator.at(offset)
        self.points += 1
        if self.claim.fails(values):
            self.refuted = self.place(offset)
        elif not self.claim.holds(values) and self.unclear is None:
            place = self.place(offset)
            self.unclear = None if self.claim.holds_exactly(self.region, place.q) else place
        if self.claim.kind is ClaimKind.NONZERO and len(values) == 1 and _is_nonzero(values[0]):
            self.ends.setdefault(Sign.POSITIVE if values[0] > 0 else Sign.NEGATIVE, offset)

    def place(self, offset: Offset) -> Place:
        return self.region.place(self.region.exact(self.evaluator.coordinates, offset))

    @property
    def remaining(self) -> list[Box]:
        """The boxes on which nothing is proved, smallest first."""
        return [*self.left, *reversed(self.open)]

    def decision(self) -> Decision:
        status, place = ClaimStatus.PROVED, None
        if self.refuted is not None:
            status, place = ClaimStatus.REFUTED, self.refuted
        elif self.remaining:
            supported = self.points > 0 and self.unclear is None
            status, place = (ClaimStatus.SUPPORTED if supported else ClaimStatus.UNDECIDED), self.unclear
        return Decision(status=status, place=place, boxes=self.boxes, points=self.points, bound=self.bound)


def _zero_between(search: _ClaimSearch) -> Place | None:
    """A zero on the segment between two points at which a continuous function has opposite signs."""
    if len(search.ends) < 2 or search.claim.expressions[0].has(*_JUMPS):
        return None
    ends = dict(search.ends)
    for _ in range(BISECTIONS):
        sign, between = _split(search, *ends.values())
        if sign is Sign.ZERO:
            return search.place(between)
        if sign is Sign.UNDECIDED:
            break
        ends[sign] = between
    hull = _hull(*ends.values())
    if not search.evaluator.on(hull)[0].is_finite():
        return None  # it may jump through a pole
    for q in simplest_points(search.region, search.evaluator.coordinates, hull):
        if search.claim.fails_exactly(search.region, q):
            return search.region.place(q)
    q = search.region.exact(search.evaluator.coordinates, hull.centre)
    return search.region.place(q, _half_diagonal(hull))


def _split(search: _ClaimSearch, one: Offset, other: Offset) -> tuple[Sign, Offset]:
    """A point between two, and the sign there; beside the middle where that is a zero, or too near to one."""
    for share in (Fraction(1, 2), Fraction(1, 3)):
        between = tuple(x + share * (y - x) for x, y in zip(one, other, strict=True))
        value = search.evaluator.at(between)[0]
        if _is_nonzero(value):
            return (Sign.POSITIVE if value > 0 else Sign.NEGATIVE), between
        q = search.region.exact(search.evaluator.coordinates, between)
        if search.claim.fails_exactly(search.region, q):
            return Sign.ZERO, between
    return Sign.UNDECIDED, one


def _hull(one: Offset, other: Offset) -> Box:
    return Box(low=tuple(map(min, one, other)), high=tuple(map(max, one, other)))


def _half_diagonal(box: Box) -> float:
    """An upper bound on the distance of the box's points from its centre."""
    return float(sum(box.sides, Fraction(0))) * 0.5000001


def _exact_counterexample(search: _ClaimSearch) -> Place | None:
    """An exact point of the boxes that stayed open at which the claim fails."""
    for q in _candidates(search):
        if search.claim.fails_exactly(search.region, q):
            return search.region.place(q)
    return None


def _candidates(search: _ClaimSearch) -> Iterator[tuple[sp.Expr, ...]]:
    boxes = search.remaining
    step = -(-len(boxes) // MAX_OPEN_BOXES)
    for box in boxes[::step]:
        yield from simplest_points(search.region, search.evaluator.coordinates, box)


def _vanishing_factor(region: Region, claim: Claim) -> Place | None:
    """A zero of one factor: a square only touches zero, what is squared passes through it."""
    if claim.kind is ClaimKind.NONNEGATIVE or len(claim.expressions) > 1 or claim.where is not None:
        return None
    expression = claim.expressions[0]
    if expression.count_ops() > MAX_FACTORED or not _is_finite_everywhere(region, expression):
        return None
    for base in _bases(expression):
        if base == expression or not region.used([base]):
            continue
        found = decide(region, Claim(kind=ClaimKind.NONZERO, expressions=(base,)), max_boxes=MAX_BOXES // 4)
        if found.status is ClaimStatus.REFUTED:
            return found.place
    return None


def _bases(expression: sp.Expr) -> Iterator[sp.Expr]:
    """What the expression is a product of powers of, as it is written and factored."""
    for form in (expression, sp.factor(expression)):
        for factor in sp.Mul.make_args(form):
            base, power = factor.as_base_exp()
            if power.is_Rational and power > 0:
                yield base


def _is_finite_everywhere(region: Region, expression: sp.Expr) -> bool:
    """No coordinate in a division, a root or a function that can be infinite: no factor takes another's zero away."""
    parts = [part for part in expression.atoms(sp.Pow, sp.Function) if region.used([part])]
    return all(part.exp.is_Integer and part.exp > 0 if part.is_Pow else isinstance(part, _FINITE) for part in parts)
