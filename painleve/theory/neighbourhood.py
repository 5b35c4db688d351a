"""The sign of gamma on touching or penetrating neighbours of a state with gamma = 0, decided exactly.

Theorem 1 asks whether gamma <= 0 on some ball without Int K (isolated) or gamma > 0 arbitrarily near (approached);
docs/theory.md, section 5, gives the argument. What is differentiated is p = |grad g|^2 det(M) gamma, a polynomial where
gamma is a fraction: a positive factor changes no sign, at a zero it scales the gradient, and it scales the second-order
form wherever that form is asked. p is smooth there: a > 0 and p = 0 make b nonzero and the minimising end unique.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import combinations

import sympy as sp

from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import State
from painleve.theory.sections.listed import theory_of

__all__ = ["Neighbourhood", "Neighbours", "neighbours", "smooth_indicator"]

HIGHEST_ORDER = 8  # of derivatives that are tried where gamma depends on one coordinate alone


class Neighbourhood(Enum):
    """How a critical state lies among its touching or penetrating neighbours."""

    APPROACHED = "approached"
    ISOLATED = "isolated"
    UNDECIDED = "undecided"


@dataclass(frozen=True, kw_only=True)
class Neighbours:
    """The kind, and the argument in one sentence."""

    kind: Neighbourhood
    reason: str

    def __repr__(self) -> str:
        return f"Neighbours({self.kind.value})"


def neighbours(state: State, edge: int) -> Neighbours:
    """The kind of a state with gamma(q) = 0, attained on that edge of the cone (Derivation.edge_direction)."""
    scene = state.scene
    p, g = smooth_indicator(state.scene, edge), scene.contact.constraint
    if p.has(sp.Abs, sp.Min, sp.Max, sp.sign, sp.Piecewise):
        return Neighbours(kind=Neighbourhood.UNDECIDED, reason="gamma is not smooth: no Taylor expansion decides")
    used = [x for x in scene.q if x in p.free_symbols or x in g.free_symbols]
    grad_p, grad_g = ([state.exact(sp.diff(f, x)) for x in used] for f in (p, g))
    parallel = _parallel(grad_p, grad_g)
    if parallel is not Sign.ZERO:
        if parallel is Sign.UNDECIDED:
            return Neighbours(kind=Neighbourhood.UNDECIDED, reason="grad gamma may be parallel to grad g: undecided")
        return _approached("grad gamma is not parallel to grad g: gamma grows along the constraint")
    slope = exact_sign(sum((x * y for x, y in zip(grad_p, grad_g, strict=True)), sp.Integer(0)))
    if slope.sign is Sign.POSITIVE:
        return _approached("grad gamma = -kappa grad g with kappa < 0: gamma grows into penetration")
    if slope.sign is Sign.UNDECIDED:
        return Neighbours(kind=Neighbourhood.UNDECIDED, reason=f"the slope of gamma is undecided: {slope.reason}")
    if slope.sign is Sign.NEGATIVE:
        return _along_the_constraint(state, p, used, grad_p, grad_g)
    return _without_slope(state, p)


def smooth_indicator(scene: Scene, edge: int) -> sp.Expr:
    """A smooth function with the sign of gamma near a state where it is attained on that edge of the cone."""
    return theory_of(scene.contact).indicator(scene, edge)


def _approached(reason: str) -> Neighbours:
    return Neighbours(kind=Neighbourhood.APPROACHED, reason=reason)


def _isolated(reason: str) -> Neighbours:
    return Neighbours(kind=Neighbourhood.ISOLATED, reason=reason)


def _parallel(x: Sequence[sp.Expr], y: Sequence[sp.Expr]) -> Sign:
    """ZERO if all 2x2 minors vanish, else the sign of one that does not, UNDECIDED if none is known not to."""
    signs = [exact_sign(x[i] * y[j] - x[j] * y[i]).sign for i, j in combinations(range(len(x)), 2)]
    for sign in signs:
        if sign in (Sign.POSITIVE, Sign.NEGATIVE):
            return sign
    return Sign.UNDECIDED if Sign.UNDECIDED in signs else Sign.ZERO


def _along_the_constraint(
    state: State, p: sp.Expr, used: Sequence[sp.Symbol], grad_p: Sequence[sp.Expr], grad_g: Sequence[sp.Expr]
) -> Neighbours:
    """kappa > 0: the form of p + kappa g on the tangent directions decides."""
    m = next(i for i, x in enumerate(grad_g) if exact_sign(x).sign in (Sign.POSITIVE, Sign.NEGATIVE))
    kappa = -grad_p[m] / grad_g[m]
    form = state.exact(sp.hessian(p, used)) + kappa * state.exact(sp.hessian(state.scene.contact.constraint, used))
    others = [i for i in range(len(used)) if i != m]
    # Tangent vectors e_i - (g_i/g_m) e_m span the kernel of grad g.
    basis = sp.zeros(len(used), len(others))
    for column, i in enumerate(others):
        basis[i, column], basis[m, column] = 1, -grad_g[i] / grad_g[m]
    return _judge(
        basis.T * form * basis,
        "grad gamma = -kappa grad g with kappa > 0, and the form of gamma + kappa g on the tangent directions",
    )


def _without_slope(state: State, p: sp.Expr) -> Neighbours:
    """kappa = 0: a form takes on a half-space every sign that it takes anywhere."""
    used = [x for x in state.scene.q if x in p.free_symbols]
    if not used:
        return _isolated("gamma does not depend on q: it is zero everywhere")
    found = _judge(state.exact(sp.hessian(p, used)), "grad gamma = 0, and the second-order form of gamma")
    if found.kind is Neighbourhood.UNDECIDED and len(used) == 1:
        return _one_coordinate(state, p, used[0])
    return found


def _judge(form: sp.MatrixBase, what: str) -> Neighbours:
    n = form.shape[0]
    if all(_minor(form, range(size)).sign is Sign.POSITIVE for size in range(1, n + 1)):
        return _isolated(f"{what} is negative definite")
    for size in range(1, n + 1):
        for chosen in combinations(range(n), size):
            if _minor(form, chosen).sign is Sign.NEGATIVE:
                return _approached(f"{what} is positive in some direction")
    return Neighbours(kind=Neighbourhood.UNDECIDED, reason=f"{what} is semidefinite: higher orders would decide")


def _minor(form: sp.MatrixBase, chosen: Sequence[int]) -> Signed:
    """Sign of the principal minor of -form on the chosen rows and columns."""
    index = list(chosen)
    return exact_sign((-form).extract(index, index).det(method="berkowitz"))


def _one_coordinate(state: State, p: sp.Expr, x: sp.Symbol) -> Neighbours:
    """gamma depends on x alone: its first derivative that does not vanish decides, on the sides that g allows."""
    others = [exact_sign(state.exact(sp.diff(state.scene.contact.constraint, y))).sign for y in state.scene.q if y != x]
    both_sides = any(sign in (Sign.POSITIVE, Sign.NEGATIVE) for sign in others)
    for order in range(3, HIGHEST_ORDER + 1):
        sign = exact_sign(state.exact(sp.diff(p, x, order))).sign
        if sign is Sign.ZERO:
            continue
        what = f"gamma depends on {x} alone, and its first derivative that does not vanish is of order {order}"
        if sign is Sign.UNDECIDED:
            break
        if order % 2 == 0:
            return _approached(f"{what}, positive") if sign is Sign.POSITIVE else _isolated(f"{what}, negative")
        if both_sides:
            return _approached(f"{what}, odd: gamma > 0 on one side, and g >= 0 can be had there")
        break
    return Neighbours(kind=Neighbourhood.UNDECIDED, reason=f"the derivatives of gamma in {x} do not decide")
