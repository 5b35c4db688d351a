"""Where the parts of a formula are not analytic, found from their structure, and how they break there.

Quotients, roots, logarithms, inverse functions, |.|, sign and Piecewise each have a set on which they are not analytic.
A root of a square is a |.|, and so are, but for smooth factors, asin and acos of what only touches 1 or -1: asin(sin x)
has a kink wherever cos x vanishes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import reduce

import sympy as sp
from sympy.functions.elementary.piecewise import ExprCondPair
from sympy.logic.boolalg import Boolean

from painleve.theory.hypotheses.claims import MAX_FACTORED, Claim, ClaimKind
from painleve.theory.hypotheses.region import Region

__all__ = ["Discontinuity", "Kink", "Level", "Singularity", "plain", "singularities"]

_ONE = sp.Integer(1)
_INEQUALITIES = (sp.StrictLessThan, sp.LessThan, sp.StrictGreaterThan, sp.GreaterThan)
_ANY = sp.Wild("any")
_ENTIRE = (sp.sin, sp.cos, sp.exp, sp.sinh, sp.cosh, sp.tanh)


class Level(Enum):
    """How smooth a formula is to be; analytic formulas are of every class C^n, with locally Lipschitz derivatives."""

    CONTINUOUS = "continuous"
    ANALYTIC = "analytic"


@dataclass(frozen=True, kw_only=True)
class Kink:
    """Where the argument vanishes the node has this value, and its gradients on the two sides are +- slopes."""

    value: sp.Expr
    slopes: tuple[sp.Expr, ...]


@dataclass(frozen=True, kw_only=True)
class Discontinuity:
    """The node is the one formula where the argument is positive and the other where it is negative, near a point at
    which the argument vanishes and `given` does not."""

    sides: tuple[sp.Expr, sp.Expr]
    given: sp.Expr = _ONE


@dataclass(frozen=True, kw_only=True)
class Singularity:
    """The part `node` is smooth where `argument` meets `kind`; no kind means that nothing is known of it."""

    node: sp.Expr
    argument: sp.Expr
    kind: ClaimKind | None
    how: Kink | Discontinuity | None = None

    @property
    def claim(self) -> Claim:
        assert self.kind is not None
        return Claim(kind=self.kind, expressions=(self.argument,))


def plain(expression: sp.Expr) -> sp.Expr:
    """Tangents and the like as quotients, Min, Max and roots of squares by |.|: fewer kinds of singularity."""
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
    return expression.replace(_is_root, _root)


def singularities(region: Region, expressions: Sequence[sp.Expr], level: Level) -> list[Singularity]:
    """Inner parts first."""
    found: dict[Singularity, None] = {}
    for expression in expressions:
        for node in sp.postorder_traversal(expression):
            if not isinstance(node, ExprCondPair | Boolean):
                found |= dict.fromkeys(_of_node(region, node, level))
    return list(found)


def _of_node(region: Region, node: sp.Expr, level: Level) -> Iterator[Singularity]:
    if node.is_Add or node.is_Mul or node.is_Atom or node.func in _ENTIRE:
        return
    argument, smooth = node.args[0], level is Level.ANALYTIC
    if node.is_Pow and node.exp.is_Integer:
        if node.exp < 0:
            yield Singularity(node=node, argument=argument, kind=ClaimKind.NONZERO)
    elif node.is_Pow and node.exp.is_Rational:
        kind = ClaimKind.POSITIVE if smooth or node.exp < 0 else ClaimKind.NONNEGATIVE
        yield Singularity(node=node, argument=argument, kind=kind)
    elif node.func is sp.log:
        yield Singularity(node=node, argument=argument, kind=ClaimKind.POSITIVE)
    elif node.func in (sp.asin, sp.acos):
        yield from _of_inverse_sine(region, node, smooth)
    elif node.func is sp.atan:
        yield from _of_arctangent(region, node)
    elif node.func is sp.atan2:  # the cut is where y = 0 and x <= 0
        y, x = node.args
        yield Singularity(node=node, argument=sp.sqrt(x**2 + y**2) + x, kind=ClaimKind.POSITIVE)
    elif node.func is sp.Abs:
        if region.used([argument]) and smooth:
            kink = Kink(value=sp.Integer(0), slopes=_gradient(region, argument))
            yield Singularity(node=node, argument=argument, kind=ClaimKind.NONZERO, how=kink)
    elif node.func is sp.sign:
        if region.used([argument]):
            step = Discontinuity(sides=(_ONE, -_ONE))
            yield Singularity(node=node, argument=argument, kind=ClaimKind.NONZERO, how=step)
    elif isinstance(node, sp.Piecewise) and _has_two_parts(node):
        first, second = node.args
        parts = Discontinuity(sides=(first.expr, second.expr))
        yield Singularity(node=node, argument=first.cond.lhs - first.cond.rhs, kind=ClaimKind.NONZERO, how=parts)
    else:
        yield Singularity(node=node, argument=argument, kind=None)


def _of_inverse_sine(region: Region, node: sp.Expr, smooth: bool) -> Iterator[Singularity]:
    """1 - v^2 > 0; or, where 1 - v^2 = w^2 c, that w != 0 and c > 0: on the two sides of w = 0 the derivative is
    +- (v'/w)/sqrt(c)."""
    v = node.args[0]
    w, c = _square(1 - v**2)
    if w == 1:
        kind = ClaimKind.POSITIVE if smooth else ClaimKind.NONNEGATIVE
        yield Singularity(node=node, argument=c, kind=kind)
        return
    if not (c.is_number and c.is_positive):
        yield Singularity(node=node, argument=c, kind=ClaimKind.POSITIVE if smooth else ClaimKind.NONNEGATIVE)
    if smooth:
        slopes = tuple(sp.cancel(slope / w) / sp.sqrt(c) for slope in _gradient(region, v))
        value = (v if node.func is sp.asin else 1 - v) * sp.pi / 2
        yield Singularity(node=node, argument=w, kind=ClaimKind.NONZERO, how=Kink(value=value, slopes=slopes))


def _of_arctangent(region: Region, node: sp.Expr) -> Iterator[Singularity]:
    """atan of a quotient is bounded where its divisor vanishes, and jumps there unless the numerator vanishes too."""
    if node.args[0].count_ops() > MAX_FACTORED:
        return  # what is divided by has a singularity of its own
    above, below = sp.fraction(sp.together(node.args[0]))
    if region.used([below]):
        how = Discontinuity(sides=(sp.pi / 2, -sp.pi / 2), given=above)
        yield Singularity(node=node, argument=below, kind=ClaimKind.NONZERO, how=how)


def _has_two_parts(node: sp.Piecewise) -> bool:
    """One formula where an inequality holds, and another elsewhere."""
    return len(node.args) == 2 and isinstance(node.args[0].cond, _INEQUALITIES) and node.args[1].cond == sp.true


def _gradient(region: Region, expression: sp.Expr) -> tuple[sp.Expr, ...]:
    return tuple(sp.diff(expression, x) for x in region.state.scene.q)


def _is_root(expression: sp.Expr) -> bool:
    return bool(expression.is_Pow and expression.exp.is_Rational and expression.exp.q == 2)


def _root(power: sp.Expr) -> sp.Expr:
    w, c = _square(power.base)
    return power if w == 1 else sp.Abs(w) ** (2 * power.exp) * c**power.exp


def _square(expression: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """(w, c) with w^2 c the expression: w the largest square that is found in it, 1 if none is."""
    if expression.count_ops() <= MAX_FACTORED and expression.free_symbols:
        for form in _forms(expression):
            w, c = _ONE, _ONE
            for factor in sp.Mul.make_args(form):
                base, power = factor.as_base_exp()
                whole = power.is_Integer and power >= 2 and bool(base.free_symbols)
                w *= base ** (power // 2) if whole else _ONE
                c *= base ** (power % 2) if whole else factor
            if w != 1:
                return w, c
    return _ONE, expression


def _forms(expression: sp.Expr) -> Iterator[sp.Expr]:
    """As it is written and factored; with the half angle, and with squares of sines by cosines and the reverse."""
    yield expression
    yield sp.factor(expression)
    yield _half_angle(expression)
    for old, new in ((sp.sin, sp.cos), (sp.cos, sp.sin)):
        yield sp.factor(expression.replace(old(_ANY) ** 2, 1 - new(_ANY) ** 2))


def _half_angle(expression: sp.Expr) -> sp.Expr:
    """k (1 + cos u) and k (1 - cos u) as squares; anything else as it is."""
    k, rest = expression.as_independent(*expression.free_symbols, as_Add=True)
    factor, call = rest.as_coeff_Mul()
    if k != 0 and isinstance(call, sp.cos) and factor in (k, -k):
        half = call.args[0] / 2
        return 2 * k * (sp.cos(half) if factor == k else sp.sin(half)) ** 2
    return expression
