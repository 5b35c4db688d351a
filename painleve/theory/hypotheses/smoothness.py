"""Smoothness of formulas on a ball, from their structure: every part is analytic but at known singularities.

Quotients, roots, logarithms, inverse functions, |.|, sign, Min and Max each have a set on which they are not analytic;
a formula whose parts stay away from theirs is analytic. A part that meets its own refutes smoothness only where the
formula is shown to inherit the kink, the jump or the pole.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import reduce

import sympy as sp

from painleve.theory.hypotheses.claims import Claim, ClaimKind, ClaimStatus, Decision, decide
from painleve.theory.hypotheses.findings import Finding
from painleve.theory.hypotheses.region import Place, Region

__all__ = ["Level", "check_smoothness"]

_ENTIRE = (sp.sin, sp.cos, sp.exp, sp.sinh, sp.cosh, sp.tanh, sp.atan)


class Level(Enum):
    """How smooth a formula is to be; analytic formulas are of every class C^n, with locally Lipschitz derivatives."""

    CONTINUOUS = "continuous"
    ANALYTIC = "analytic"


@dataclass(frozen=True, kw_only=True)
class _Singularity:
    """The part `node` is smooth where `argument` meets `kind`; no kind means that nothing is known of it."""

    node: sp.Expr
    argument: sp.Expr
    kind: ClaimKind | None

    @property
    def claim(self) -> Claim:
        assert self.kind is not None
        return Claim(kind=self.kind, expressions=(self.argument,))


def check_smoothness(region: Region, what: str, expressions: Sequence[sp.Expr], level: Level) -> Finding:
    """Whether all the expressions, which the sentence calls `what`, have that smoothness on the ball."""
    plain = [_plain(e) for e in expressions]
    singularities = _singularities(region, plain, level)
    for singularity in singularities:
        if singularity.kind is None:
            return Finding(status=ClaimStatus.UNDECIDED, sentence=f"nothing is known of {singularity.node} in {what}")
    decisions = [(s, decide(region, s.claim)) for s in singularities]
    for status in (ClaimStatus.REFUTED, ClaimStatus.UNDECIDED, ClaimStatus.SUPPORTED):
        for singularity, decision in decisions:
            if decision.status is status:
                return _open_finding(region, what, plain, level, singularity, decision)
    named = ", ".join(_shown(s.argument) for s, _ in decisions)
    why = f": on the ball no singularity is met by {named}" if named else ": no part of it has a singularity"
    return Finding(status=ClaimStatus.PROVED, sentence=f"{what} is {level.value}{why}")


def _open_finding(
    region: Region, what: str, plain: list[sp.Expr], level: Level, s: _Singularity, decision: Decision
) -> Finding:
    claim = f"{_shown(s.argument)} {s.claim.kind.value}"
    if decision.status is ClaimStatus.SUPPORTED:
        sentence = f"{what} is {level.value} where {claim}, which holds at the {decision.points} points tried"
        return Finding(status=ClaimStatus.SUPPORTED, sentence=sentence)
    if decision.status is ClaimStatus.REFUTED and decision.place is not None:
        broken = _breaks(region, plain, s, decision.place)
        if broken is not None:
            return Finding(status=ClaimStatus.REFUTED, sentence=f"{what} {broken}", place=decision.place)
    return Finding(
        status=ClaimStatus.UNDECIDED,
        sentence=f"whether {what} is {level.value} where {_shown(s.node)} is not is undecided",
        place=decision.place,
    )


def _plain(expression: sp.Expr) -> sp.Expr:
    """Tangents and the like as quotients, Min and Max by |.|: fewer kinds of singularity."""
    rules: dict[type, Callable[..., sp.Expr]] = {
        sp.tan: lambda x: sp.sin(x) / sp.cos(x),
        sp.cot: lambda x: sp.cos(x) / sp.sin(x),
        sp.sec: lambda x: 1 / sp.cos(x),
        sp.csc: lambda x: 1 / sp.sin(x),
        sp.Min: lambda *x: reduce(lambda a, b: (a + b - sp.Abs(a - b)) / 2, x),
        sp.Max: lambda *x: reduce(lambda a, b: (a + b + sp.Abs(a - b)) / 2, x),
    }
    for function, rule in rules.items():
        expression = expression.replace(function, rule)
    return expression


def _singularities(region: Region, expressions: Sequence[sp.Expr], level: Level) -> list[_Singularity]:
    """Inner parts first, each set of points once."""
    found: dict[tuple[ClaimKind | None, sp.Expr], _Singularity] = {}
    for expression in expressions:
        for node in sp.postorder_traversal(expression):
            for singularity in _of_node(region, node, level):
                found.setdefault((singularity.kind, singularity.argument), singularity)
    return list(found.values())


def _of_node(region: Region, node: sp.Expr, level: Level) -> Iterator[_Singularity]:
    if node.is_Add or node.is_Mul or node.is_Atom or node.func in _ENTIRE:
        return
    argument, kind = node.args[0], None
    smooth = level is Level.ANALYTIC
    if node.is_Pow and node.exp.is_Integer:
        if node.exp > 0:
            return
        kind = ClaimKind.NONZERO
    elif node.is_Pow and node.exp.is_Rational:
        kind = ClaimKind.POSITIVE if smooth or node.exp < 0 else ClaimKind.NONNEGATIVE
    elif node.func is sp.log:
        kind = ClaimKind.POSITIVE
    elif node.func in (sp.asin, sp.acos):
        argument, kind = 1 - argument**2, ClaimKind.POSITIVE if smooth else ClaimKind.NONNEGATIVE
    elif node.func is sp.atan2:  # the cut is where y = 0 and x <= 0
        y, x = node.args
        argument, kind = sp.sqrt(x**2 + y**2) + x, ClaimKind.POSITIVE
    elif node.func in (sp.Abs, sp.sign):
        if not region.used([argument]) or (node.func is sp.Abs and not smooth):
            return
        kind = ClaimKind.NONZERO
    yield _Singularity(node=node, argument=argument, kind=kind)


def _breaks(region: Region, expressions: Sequence[sp.Expr], s: _Singularity, place: Place) -> str | None:
    """How a formula inherits the singularity at that place, as the end of a sentence; None where it may not."""
    if s.kind is not ClaimKind.NONZERO:
        unreal = s.node.func is not sp.atan2 and bool(region.enclose(s.argument, place) < 0)
        return f"is not real: {_shown(s.argument)} < 0 at {place}" if unreal else None
    z = sp.Dummy("z", real=True)
    for expression in expressions:
        if not expression.has(s.node):
            continue
        outer = expression.xreplace({s.node: z})
        if s.node.func is sp.Abs and _has_kink(region, outer, z, s.argument, place):
            return f"is not continuously differentiable: {_shown(s.node)} has a kink at {place}"
        if s.node.func is sp.sign and _jumps(region, outer, z, s.argument, place):
            return f"is not continuous: {_shown(s.node)} jumps at {place}"
        if s.node.is_Pow and _has_pole(region, outer, z, place):
            return f"is not bounded: {_shown(s.argument)} vanishes at {place}"
    return None


def _has_kink(region: Region, outer: sp.Expr, z: sp.Symbol, argument: sp.Expr, place: Place) -> bool:
    """One-sided derivatives along grad h differ where F(q, |h|) has dF/dz != 0 and grad h != 0."""
    slope = sp.diff(outer, z).xreplace({z: sp.Integer(0)})
    smooth = _is_smooth_at(region, outer.xreplace({z: sp.Integer(0)}), place)
    return smooth and _is_nonzero(region, slope, place) and _is_regular(region, argument, place)


def _jumps(region: Region, outer: sp.Expr, z: sp.Symbol, argument: sp.Expr, place: Place) -> bool:
    sides = [outer.xreplace({z: sp.Integer(side)}) for side in (1, -1)]
    smooth = all(_is_smooth_at(region, side, place) for side in sides)
    return smooth and _is_nonzero(region, sides[0] - sides[1], place) and _is_regular(region, argument, place)


def _has_pole(region: Region, outer: sp.Expr, z: sp.Symbol, place: Place) -> bool:
    """F(q, 1/h) = c_0 + c_1/h with c_1 != 0 is not bounded near a zero of h."""
    slope, rest = sp.diff(outer, z), outer.xreplace({z: sp.Integer(0)})
    affine = sp.diff(slope, z) == 0
    return affine and all(_is_smooth_at(region, e, place) for e in (slope, rest)) and _is_nonzero(region, slope, place)


def _is_smooth_at(region: Region, expression: sp.Expr, place: Place) -> bool:
    claims = [s.claim for s in _singularities(region, [expression], Level.ANALYTIC) if s.kind is not None]
    return all(c.holds([region.enclose(c.expressions[0], place)]) for c in claims)


def _is_nonzero(region: Region, expression: sp.Expr, place: Place) -> bool:
    return Claim(kind=ClaimKind.NONZERO, expressions=(expression,)).holds([region.enclose(expression, place)])


def _is_regular(region: Region, expression: sp.Expr, place: Place) -> bool:
    return any(_is_nonzero(region, sp.diff(expression, x), place) for x in region.state.scene.q)


def _shown(expression: sp.Expr, limit: int = 60) -> str:
    text = str(expression)
    return text if len(text) <= limit else f"{text[: limit - 3]}..."
