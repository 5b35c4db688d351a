"""(H3), (H4) and (H'4): the friction section D_1(q) = H(q) B(q)/|grad g(q)| of a scene.

D_1 spans the columns of H V, where those of V span Span B. A linear image of a segment, a disc or an ellipse is one of
these or a point, and each is strictly convex relative to its span as (H'4) defines it; a polygon with interior is not.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import sympy as sp

from painleve.mechanics.derive import derive
from painleve.theory.hypotheses.claims import Claim, ClaimKind, ClaimStatus, decide
from painleve.theory.hypotheses.constraint import gradient_claim
from painleve.theory.hypotheses.findings import Finding, Hypothesis, conclude, report
from painleve.theory.hypotheses.region import Place, Region
from painleve.theory.hypotheses.smoothness import Level, check_smoothness
from painleve.theory.sections.listed import theory_of
from painleve.theory.sections.section import SectionTheory

__all__ = ["check_one_dimensional", "check_section", "check_strictly_convex"]


def check_section(region: Region) -> Hypothesis:
    """(H3) on the ball."""
    asks = "D_1 is closed, bounded, convex, holds 0, varies continuously, and its span does not hold grad g"
    settled = _settled(region, "H3")
    if settled is not None:
        return conclude("H3", asks, [settled, _defined(region)])
    return conclude("H3", asks, [_sound(region), *_continuous(region), _normal_apart(region)])


def check_one_dimensional(region: Region) -> Hypothesis:
    """(H4) on the ball."""
    asks = "D_1 spans a line everywhere on the ball"
    settled = _settled(region, "H4")
    if settled is not None:
        return conclude("H4", asks, [settled])
    if not _is_flat(region):
        return conclude("H4", asks, [_plane(region, "Span D_1 has dimension 2")])
    return conclude("H4", asks, list(_line(region)))


def check_strictly_convex(region: Region) -> Hypothesis:
    """(H'4) on the ball: between two points of D_1 there are only points of its interior relative to Span D_1."""
    asks = "D_1 is strictly convex, relative to its span, everywhere on the ball"
    settled = _settled(region, "H'4")
    if settled is not None:
        return conclude("H'4", asks, [settled])
    theory = _theory(region)
    if theory.flat_sides and not _is_flat(region):
        return conclude("H'4", asks, [_plane(region, theory.flat_sides)])
    sentence = (
        f"D_1 is the linear image of {theory.image}: strictly convex relative to its span, "
        "where it shrinks to {0} too"
    )
    return conclude("H'4", asks, [Finding(status=ClaimStatus.PROVED, sentence=sentence)])


def _theory(region: Region) -> SectionTheory:
    return theory_of(region.state.scene.contact)


def _settled(region: Region, hypothesis: str) -> Finding | None:
    """What the kind of the section settles alone."""
    known = _theory(region).settled(hypothesis)
    if known is None:
        return None
    status, sentence = known
    place = region.place(region.state.q) if status is ClaimStatus.REFUTED else None
    return Finding(status=status, sentence=sentence, place=place)


def _sound(region: Region) -> Finding:
    """B is what it is said to be, and holds 0."""
    conditions = tuple(dict.fromkeys(c.expression for c in region.state.scene.contact.section.conditions))
    holds, fails = _theory(region).soundness()
    return report(decide(region, Claim(kind=ClaimKind.NONNEGATIVE, expressions=conditions)), holds=holds, fails=fails)


def _continuous(region: Region) -> Iterator[Finding]:
    contact = region.state.scene.contact
    expressions = [*contact.tangents, *contact.section.expressions]
    yield check_smoothness(region, "the friction section", expressions, Level.CONTINUOUS)
    yield _defined(region)


def _defined(region: Region) -> Finding:
    """n and D_1 are divided by |grad g|."""
    decision = decide(region, gradient_claim(region))
    found = report(decision, holds="grad g does not vanish on the ball", fails="n is not defined")
    if found.status is ClaimStatus.REFUTED:  # the hypotheses ask nothing of D_1 there, and nothing gives it
        return Finding(status=ClaimStatus.UNDECIDED, sentence=f"{found.sentence}, so D_1 is not", place=found.place)
    return found


def _normal_apart(region: Region) -> Finding:
    """grad g is not in Span D_1 wherever [grad g, H] has full rank."""
    w, H = derive(region.state.scene).normal, region.state.scene.contact.tangents
    minors = _minors(sp.Matrix.hstack(sp.Matrix(w), sp.Matrix(H)), 1 + H.shape[1])
    decision = decide(region, Claim(kind=ClaimKind.NONZERO, expressions=minors))
    found = report(decision, holds="grad g is not in Span D_1", fails="grad g is in Span D_1")
    if found.status is not ClaimStatus.REFUTED or found.place is None or _fills(region, found.place):
        return found
    sentence = f"grad g and the columns of H are dependent at {found.place}, but D_1 may not span those columns there"
    return Finding(status=ClaimStatus.UNDECIDED, sentence=sentence, place=found.place)


def _fills(region: Region, place: Place) -> bool:
    """Proved: D_1 spans the columns of H, which are independent, and grad g is not zero."""
    ranks = (*_full_rank(region), gradient_claim(region).expressions)
    return all(
        Claim(kind=ClaimKind.NONZERO, expressions=minors).holds([region.enclose(e, place) for e in minors])
        for minors in ranks
    )


def _full_rank(region: Region) -> tuple[tuple[sp.Expr, ...], ...]:
    """The minors of H and V of which one is not zero each where D_1 has dimension k."""
    H = region.state.scene.contact.tangents
    return _minors(H, H.shape[1]), _minors(_theory(region).spanning(), H.shape[1])


def _minors(matrix: sp.MatrixBase, size: int) -> tuple[sp.Expr, ...]:
    """The minors of that size; those that are zero by their form left out."""
    found = (
        matrix.extract(list(rows), list(columns)).det(method="berkowitz")
        for rows in combinations(range(matrix.shape[0]), size)
        for columns in combinations(range(matrix.shape[1]), size)
    )
    return tuple(dict.fromkeys(m for m in found if m != 0)) or (sp.Integer(0),)


def _is_flat(region: Region) -> bool:
    """B lies on a line through 0 for these parameters, whatever the configuration."""
    spanning = _theory(region).spanning()
    if spanning.rows == 1:
        return True
    parameters = {p.symbol: region.state.parameters[p.name] for p in region.state.scene.parameters}
    return all(minor.xreplace(parameters) == 0 for minor in _minors(spanning, 2))


def _line(region: Region) -> Iterator[Finding]:
    """D_1 is not {0}."""
    H, V = sp.Matrix(region.state.scene.contact.tangents), _theory(region).spanning()
    if V.shape[0] > 1:
        yield _not_zero(region, H * V, "D_1 is not {0}", "D_1 = {0}")
        return
    yield _not_zero(region, V, "friction does not vanish", "D_1 = {0}, for friction vanishes,")
    yield _not_zero(region, H, "H does not vanish", "D_1 = {0}, for H vanishes,")


def _not_zero(region: Region, matrix: sp.MatrixBase, holds: str, fails: str) -> Finding:
    entries = tuple(dict.fromkeys(e for e in matrix if e != 0)) or (sp.Integer(0),)
    return report(decide(region, Claim(kind=ClaimKind.NONZERO, expressions=entries)), holds=holds, fails=fails)


def _plane(region: Region, sentence: str) -> Finding:
    """Refuted at q itself, if D_1 spans a plane there."""
    here = region.place(region.state.q)
    ranks = _full_rank(region)
    if all(Claim(kind=ClaimKind.NONZERO, expressions=minors).holds_exactly(region, region.state.q) for minors in ranks):
        return Finding(status=ClaimStatus.REFUTED, sentence=f"{sentence} at {here}", place=here)
    return Finding(
        status=ClaimStatus.UNDECIDED,
        place=here,
        sentence=f"D_1 does not span a plane at {here}; it may do so beside it",
    )
