"""Smoothness of formulas on a ball, from their structure: every part is analytic but at known singularities.

A formula whose parts stay away from theirs (painleve.theory.hypotheses.singularities) is analytic. A part that meets
its own refutes smoothness only where the formula is shown to inherit the kink, the jump or the pole.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp
from flint import arb

from painleve.theory.hypotheses.claims import Claim, ClaimKind, ClaimStatus, Decision, decide
from painleve.theory.hypotheses.findings import Finding
from painleve.theory.hypotheses.region import Place, Region
from painleve.theory.hypotheses.singularities import Discontinuity, Kink, Level, Singularity, plain, singularities

__all__ = ["Level", "check_smoothness"]


def check_smoothness(region: Region, what: str, expressions: Sequence[sp.Expr], level: Level) -> Finding:
    """Whether all the expressions, which the sentence calls `what`, have that smoothness on the ball."""
    simple = [plain(e) for e in expressions]
    found = singularities(region, simple, level)
    for singularity in found:
        if singularity.kind is None:
            return Finding(status=ClaimStatus.UNDECIDED, sentence=f"nothing is known of {singularity.node} in {what}")
    claims = {s.claim: decide(region, s.claim) for s in found}
    for status in (ClaimStatus.REFUTED, ClaimStatus.UNDECIDED, ClaimStatus.SUPPORTED):
        these = [s for s in found if claims[s.claim].status is status]
        if these:
            return _open_finding(region, what, simple, level, these, claims)
    named = ", ".join(_shown(claim.expressions[0]) for claim in claims)
    why = f": on the ball no singularity is met by {named}" if named else ": no part of it has a singularity"
    return Finding(status=ClaimStatus.PROVED, sentence=f"{what} is {level.value}{why}")


def _open_finding(
    region: Region,
    what: str,
    simple: list[sp.Expr],
    level: Level,
    these: Sequence[Singularity],
    claims: dict[Claim, Decision],
) -> Finding:
    """Of the singularities whose claims have the worst status."""
    first, decision = these[0], claims[these[0].claim]
    if decision.status is ClaimStatus.SUPPORTED:
        claim = f"{_shown(first.argument)} {first.claim.kind.value}"
        sentence = f"{what} is {level.value} where {claim}, which holds at the {decision.points} points tried"
        return Finding(status=ClaimStatus.SUPPORTED, sentence=sentence)
    for singularity in these if decision.status is ClaimStatus.REFUTED else ():
        place = claims[singularity.claim].place
        broken = _breaks(region, simple, singularity, place) if place is not None else None
        if broken is not None:
            return Finding(status=ClaimStatus.REFUTED, sentence=f"{what} {broken[0]} at {broken[1]}", place=broken[1])
    return Finding(
        status=ClaimStatus.UNDECIDED,
        sentence=f"whether {what} is {level.value} where {_shown(first.node)} is not is undecided",
        place=decision.place,
    )


def _breaks(region: Region, expressions: Sequence[sp.Expr], s: Singularity, place: Place) -> tuple[str, Place] | None:
    """How a formula inherits the singularity at that place, or what it is at another one; None where it may not."""
    z = sp.Dummy("z", real=True)
    for expression in expressions:
        if not expression.has(s.node):
            continue
        outer = expression.xreplace({s.node: z})
        if outer.has(sp.Piecewise):
            continue  # the part that is broken may not be the one that counts there
        if s.kind is not ClaimKind.NONZERO:
            negative = None if s.node.func is sp.atan2 else _negative_place(region, s.argument, place)
            if negative is not None:
                return f"is not real: {_shown(s.argument)} < 0", negative
        elif isinstance(s.how, Kink):
            if _has_kink(region, outer, z, s.argument, s.how, place):
                return f"is not continuously differentiable: {_shown(s.node)} has a kink", place
        elif isinstance(s.how, Discontinuity):
            broken = _across(region, outer, z, s.argument, s.how, place)
            if broken is not None:
                return f"{broken[0]}: {_shown(s.node)} {broken[1]}", place
        elif _has_pole(region, outer, z, place):
            return f"is not bounded: {_shown(s.argument)} vanishes", place
    return None


def _negative_place(region: Region, argument: sp.Expr, place: Place) -> Place | None:
    """This place, at which the argument is not positive, or another one, if it is negative there."""
    if _value(region, argument, place) < 0:
        return place
    found = decide(region, Claim(kind=ClaimKind.NONNEGATIVE, expressions=(argument,)))
    return found.place if found.status is ClaimStatus.REFUTED else None


def _has_kink(region: Region, outer: sp.Expr, z: sp.Symbol, argument: sp.Expr, kink: Kink, place: Place) -> bool:
    """F(q, node) has the one-sided gradients F_q +- F_z slopes; F_z may be infinite, as that of a root is."""
    if not (_is_regular(region, argument, place) and any(_is_nonzero(region, e, place) for e in kink.slopes)):
        return False
    slope = sp.diff(outer, z)
    roots = [part.exp for part in slope.atoms(sp.Pow) if part.base == z and not part.exp.is_Integer and part.exp < 0]
    if roots and kink.value == 0:
        slope = sp.expand(slope * z ** (-min(roots)))  # what the infinite slope leads with
    smooth = _is_smooth_at(region, outer.xreplace({z: kink.value}), place)
    return smooth and _is_nonzero(region, slope.xreplace({z: kink.value}), place)


def _across(
    region: Region, outer: sp.Expr, z: sp.Symbol, argument: sp.Expr, jump: Discontinuity, place: Place
) -> tuple[str, str] | None:
    """What the formula loses where its two sides meet, and what the part does there; None where it may lose nothing."""
    sides = [outer.xreplace({z: side}) for side in jump.sides]
    if not (
        all(_is_smooth_at(region, side, place) for side in sides)
        and _is_nonzero(region, jump.given, place)
        and _is_regular(region, argument, place)
    ):
        return None
    difference = sides[0] - sides[1]
    if _is_nonzero(region, difference, place):
        return "is not continuous", "jumps"
    if _is_regular(region, difference, place):  # the gradients of the two sides differ at a point of both closures
        return "is not continuously differentiable", "has a kink"
    return None


def _has_pole(region: Region, outer: sp.Expr, z: sp.Symbol, place: Place) -> bool:
    """F(q, 1/h) = c_0 + c_1/h with c_1 != 0 is not bounded near a zero of h."""
    slope, rest = sp.diff(outer, z), outer.xreplace({z: sp.Integer(0)})
    affine = sp.diff(slope, z) == 0
    return affine and all(_is_smooth_at(region, e, place) for e in (slope, rest)) and _is_nonzero(region, slope, place)


def _is_smooth_at(region: Region, expression: sp.Expr, place: Place) -> bool:
    found = singularities(region, [expression], Level.ANALYTIC)
    return all(s.kind is not None and s.claim.holds([_value(region, s.argument, place)]) for s in found)


def _is_nonzero(region: Region, expression: sp.Expr, place: Place) -> bool:
    return Claim(kind=ClaimKind.NONZERO, expressions=(expression,)).holds([_value(region, expression, place)])


def _is_regular(region: Region, expression: sp.Expr, place: Place) -> bool:
    return any(_is_nonzero(region, sp.diff(expression, x), place) for x in region.state.scene.q)


def _value(region: Region, expression: sp.Expr, place: Place) -> arb:
    """NaN where there is no ball arithmetic for it: of an infinite derivative, say."""
    try:
        return region.enclose(expression, place)
    except (TypeError, ValueError):
        return arb.nan()


def _shown(expression: sp.Expr, limit: int = 60) -> str:
    text = str(expression)
    return text if len(text) <= limit else f"{text[: limit - 3]}..."
