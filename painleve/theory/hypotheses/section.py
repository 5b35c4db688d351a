"""(H3), (H4) and (H'4): the friction section D_1(q) = H(q) B(q)/|grad g(q)| of a scene.

D_1 spans the columns of H V, where those of V span Span B. A linear image of a segment, a disc or an ellipse is one of
these or a point, and each is strictly convex relative to its span as (H'4) defines it; a polygon with interior is not.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import sympy as sp

from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Disc, Polygon, Section, Segment
from painleve.theory.hypotheses.claims import Claim, ClaimKind, ClaimStatus, decide
from painleve.theory.hypotheses.constraint import gradient_claim
from painleve.theory.hypotheses.findings import Finding, Hypothesis, conclude, report
from painleve.theory.hypotheses.region import Place, Region
from painleve.theory.hypotheses.smoothness import Level, check_smoothness

__all__ = ["check_one_dimensional", "check_section", "check_strictly_convex"]


def check_section(region: Region) -> Hypothesis:
    """(H3) on the ball."""
    asks = "D_1 is closed, bounded, convex, holds 0, varies continuously, and its span does not hold grad g"
    friction = region.state.scene.contact.section
    if not friction.dimension:
        sentence = "without friction D_1 = {0}"
        return conclude("H3", asks, [Finding(status=ClaimStatus.PROVED, sentence=sentence), _defined(region)])
    findings = [_sound(region, friction), *_continuous(region, friction), _normal_apart(region, friction)]
    return conclude("H3", asks, findings)


def check_one_dimensional(region: Region) -> Hypothesis:
    """(H4) on the ball."""
    asks = "D_1 spans a line everywhere on the ball"
    friction = region.state.scene.contact.section
    if not friction.dimension:
        here = region.place(region.state.q)
        sentence = "without friction D_1 = {0}, whose span has dimension 0"
        return conclude("H4", asks, [Finding(status=ClaimStatus.REFUTED, sentence=sentence, place=here)])
    if not _is_flat(region, friction):
        return conclude("H4", asks, [_plane(region, friction, "Span D_1 has dimension 2")])
    return conclude("H4", asks, list(_line(region, friction)))


def check_strictly_convex(region: Region) -> Hypothesis:
    """(H'4) on the ball: between two points of D_1 there are only points of its interior relative to Span D_1."""
    asks = "D_1 is strictly convex, relative to its span, everywhere on the ball"
    friction = region.state.scene.contact.section
    if not friction.dimension:
        sentence = "D_1 = {0} has no two points between which to fail; without friction gamma > 0 everywhere"
        return conclude("H'4", asks, [Finding(status=ClaimStatus.PROVED, sentence=sentence)])
    if isinstance(friction, Polygon) and not _is_flat(region, friction):
        return conclude("H'4", asks, [_plane(region, friction, "D_1 is a polygon, with edges in its boundary,")])
    sentence = (
        f"D_1 is the linear image of {_name(friction)}: strictly convex relative to its span, "
        "where it shrinks to {0} too"
    )
    return conclude("H'4", asks, [Finding(status=ClaimStatus.PROVED, sentence=sentence)])


def _sound(region: Region, friction: Section) -> Finding:
    """B is what it is said to be, and holds 0."""
    conditions = tuple(dict.fromkeys(c.expression for c in friction.conditions))
    decision = decide(region, Claim(kind=ClaimKind.NONNEGATIVE, expressions=conditions))
    if isinstance(friction, Polygon):
        around = "the vertices of the friction polygon go around 0 with nothing but left turns"
        return report(decision, holds=around, fails="the friction polygon is not convex, or does not hold 0,")
    mu = "every coefficient of friction" if len(conditions) > 1 else "the coefficient of friction"
    return report(decision, holds=f"{mu} is nonnegative", fails="a coefficient of friction is negative")


def _continuous(region: Region, friction: Section) -> Iterator[Finding]:
    expressions = [*region.state.scene.contact.tangents, *friction.expressions]
    yield check_smoothness(region, "the friction section", expressions, Level.CONTINUOUS)
    yield _defined(region)


def _defined(region: Region) -> Finding:
    """n and D_1 are divided by |grad g|."""
    decision = decide(region, gradient_claim(region))
    found = report(decision, holds="grad g does not vanish on the ball", fails="n is not defined")
    if found.status is ClaimStatus.REFUTED:  # the hypotheses ask nothing of D_1 there, and nothing gives it
        return Finding(status=ClaimStatus.UNDECIDED, sentence=f"{found.sentence}, so D_1 is not", place=found.place)
    return found


def _normal_apart(region: Region, friction: Section) -> Finding:
    """grad g is not in Span D_1 wherever [grad g, H] has full rank."""
    w, H = derive(region.state.scene).normal, region.state.scene.contact.tangents
    minors = _minors(sp.Matrix.hstack(sp.Matrix(w), sp.Matrix(H)), 1 + friction.dimension)
    decision = decide(region, Claim(kind=ClaimKind.NONZERO, expressions=minors))
    found = report(decision, holds="grad g is not in Span D_1", fails="grad g is in Span D_1")
    if found.status is not ClaimStatus.REFUTED or found.place is None or _fills(region, friction, found.place):
        return found
    sentence = f"grad g and the columns of H are dependent at {found.place}, but D_1 may not span those columns there"
    return Finding(status=ClaimStatus.UNDECIDED, sentence=sentence, place=found.place)


def _fills(region: Region, friction: Section, place: Place) -> bool:
    """Proved: D_1 spans the columns of H, which are independent, and grad g is not zero."""
    ranks = (*_full_rank(region, friction), gradient_claim(region).expressions)
    return all(
        Claim(kind=ClaimKind.NONZERO, expressions=minors).holds([region.enclose(e, place) for e in minors])
        for minors in ranks
    )


def _full_rank(region: Region, friction: Section) -> tuple[tuple[sp.Expr, ...], ...]:
    """The minors of H and V of which one is not zero each where D_1 has dimension k."""
    k = friction.dimension
    return _minors(region.state.scene.contact.tangents, k), _minors(_spanning(friction), k)


def _name(friction: Section) -> str:
    """What B is; a polygon that is asked for this is flat."""
    if isinstance(friction, Segment | Polygon):
        return "a segment"
    return "a disc" if isinstance(friction, Disc) else "an ellipse"


def _spanning(friction: Section) -> sp.MatrixBase:
    """A matrix (k x m) whose columns span what B spans."""
    if isinstance(friction, Segment):
        return sp.Matrix([list(dict.fromkeys(friction.expressions))])
    return sp.Matrix(friction.vertices).T if isinstance(friction, Polygon) else sp.Matrix(friction.map)  # type: ignore[attr-defined]


def _minors(matrix: sp.MatrixBase, size: int) -> tuple[sp.Expr, ...]:
    """The minors of that size; those that are zero by their form left out."""
    found = (
        matrix.extract(list(rows), list(columns)).det(method="berkowitz")
        for rows in combinations(range(matrix.shape[0]), size)
        for columns in combinations(range(matrix.shape[1]), size)
    )
    return tuple(dict.fromkeys(m for m in found if m != 0)) or (sp.Integer(0),)


def _is_flat(region: Region, friction: Section) -> bool:
    """B lies on a line through 0 for these parameters, whatever the configuration."""
    if friction.dimension == 1:
        return True
    parameters = {p.symbol: region.state.parameters[p.name] for p in region.state.scene.parameters}
    return all(minor.xreplace(parameters) == 0 for minor in _minors(_spanning(friction), 2))


def _line(region: Region, friction: Section) -> Iterator[Finding]:
    """D_1 is not {0}."""
    H, V = sp.Matrix(region.state.scene.contact.tangents), _spanning(friction)
    if V.shape[0] > 1:
        yield _not_zero(region, H * V, "D_1 is not {0}", "D_1 = {0}")
        return
    yield _not_zero(region, V, "friction does not vanish", "D_1 = {0}, for friction vanishes,")
    yield _not_zero(region, H, "H does not vanish", "D_1 = {0}, for H vanishes,")


def _not_zero(region: Region, matrix: sp.MatrixBase, holds: str, fails: str) -> Finding:
    entries = tuple(dict.fromkeys(e for e in matrix if e != 0)) or (sp.Integer(0),)
    return report(decide(region, Claim(kind=ClaimKind.NONZERO, expressions=entries)), holds=holds, fails=fails)


def _plane(region: Region, friction: Section, sentence: str) -> Finding:
    """Refuted at q itself, if D_1 spans a plane there."""
    here = region.place(region.state.q)
    ranks = _full_rank(region, friction)
    if all(Claim(kind=ClaimKind.NONZERO, expressions=minors).holds_exactly(region, region.state.q) for minors in ranks):
        return Finding(status=ClaimStatus.REFUTED, sentence=f"{sentence} at {here}", place=here)
    return Finding(
        status=ClaimStatus.UNDECIDED,
        place=here,
        sentence=f"D_1 does not span a plane at {here}; it may do so beside it",
    )
