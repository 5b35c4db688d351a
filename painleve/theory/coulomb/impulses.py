"""All impulses that solve Coulomb's one-step problem with maximal dissipation (docs/theory.md, section 2).

r = lambda (1, s), s in the section B, with u = (v_n, v_t) + G r: u_n >= 0, lambda u_n = 0 and, where lambda > 0,
s.u_t <= s'.u_t for all s' in B. Where s is interior to B this says u_t = 0; elsewhere
- at a vertex V with the neighbours V': u_t.(V' - V) >= 0, and lambda (a + b.V) = -v_n;
- on an edge e with the outward normal m: u_t.e = 0 > u_t.m, two linear equations in the multiples of its two vertices;
- on the border of the unit disc: u_t = -kappa d, a quartic where v_n is not 0 (`slip_roots`).
At v_n = 0 a slip on the disc has a + b.d = 0, which fixes d: two directions where gamma < 0, one where gamma = 0. Then
d x (v_t + lambda (b + C d)) = 0 is linear in lambda: one slip at most, unless both of its coefficients vanish; then
every lambda with kappa > 0 solves the problem, from 0 to the impulse that sticks. kappa does fall to 0, for the slope
d.(b + C d) = rho.G rho of -kappa, rho = (1, d), is positive.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Literal, TypeAlias

import sympy as sp
from flint import arb, ctx

from painleve.exact.balls import ball
from painleve.exact.signs import Sign, exact_sign
from painleve.theory.coulomb.problem import ContactProblem, recognised
from painleve.theory.coulomb.slip_roots import Undecided, find_slips

__all__ = ["BITS", "Exact", "Impulse", "ImpulseKind", "find_impulses"]

ImpulseKind = Literal["open", "stick", "slip", "frictionless"]
Exact: TypeAlias = sp.Expr | arb

BITS = 256


@dataclass(frozen=True, kw_only=True, eq=False)
class Impulse:
    """(r_n, r_t) in physical tangents, exact numbers or balls of 256 bits and more.

    `multiplicity` is that of the root of the slip equation, 1 where it is linear. A family of solutions has no
    multiplicity and an `end`: it is the open segment from `values` to `end`.
    """

    kind: ImpulseKind
    values: tuple[Exact, ...]
    multiplicity: int | None = 1
    end: tuple[Exact, ...] | None = None


def find_impulses(problem: ContactProblem) -> tuple[list[Impulse], list[str]]:
    """Every solution, and what could not be decided (nothing: then there are no others)."""
    nothing = Impulse(kind="open", values=(sp.Integer(0),) * problem.delassus.rows)
    contact = problem.constraint
    if contact.sign is Sign.UNDECIDED:
        return [], [f"whether there is contact, g(q) >= 0: {contact.reason}"]
    if contact.sign is Sign.NEGATIVE:
        return [nothing], []
    try:
        approach = _sign(problem.contact_velocity[0], "the sign of v_n")
    except Undecided as doubt:
        return [], [str(doubt)]
    found = [] if approach is Sign.NEGATIVE else [nothing]
    doubts = []
    for search in _searches(problem, approach):
        try:
            for impulse in search():  # one by one: what was found before a doubt is kept
                found.append(impulse)
        except Undecided as doubt:
            doubts.append(str(doubt))
    return found, doubts


def _searches(problem: ContactProblem, approach: Sign) -> list[Callable[[], Iterable[Impulse]]]:
    if problem.section_map is not None:
        return [partial(_disc, problem, approach)]
    if not problem.vertices:
        return [partial(_frictionless, problem)] if approach is Sign.NEGATIVE else []
    corners = range(len(problem.vertices))
    edges = corners if problem.delassus.rows == 3 else range(0)
    return [
        partial(_stick_in_polygon, problem),
        *(partial(_at_vertex, problem, i) for i in corners),
        *(partial(_on_edge, problem, i) for i in edges),
    ]


def _sign(number: sp.Expr, what: str) -> Sign:
    signed = exact_sign(number)
    if signed.sign is Sign.UNDECIDED:
        raise Undecided(f"{what}: {signed.reason}")
    return signed.sign


def _dot(x: sp.MatrixBase, y: sp.MatrixBase) -> sp.Expr:
    return recognised(sum((p * q for p, q in zip(x, y, strict=True)), sp.Integer(0)))


def _cross(x: sp.MatrixBase, y: sp.MatrixBase) -> sp.Expr:
    return recognised(x[0] * y[1] - x[1] * y[0])


def _blocks(G: sp.MatrixBase) -> tuple[sp.Expr, sp.MatrixBase, sp.MatrixBase]:
    return G[0, 0], G[1:, 0], G[1:, 1:]


def _sticking(G: sp.MatrixBase, v: sp.MatrixBase) -> tuple[sp.Expr, ...]:
    """-G^-1 v."""
    return tuple(recognised(x) for x in -G.adjugate() * v / G.det(method="berkowitz"))


def _frictionless(problem: ContactProblem) -> list[Impulse]:
    normal = recognised(-problem.contact_velocity[0] / problem.delassus[0, 0])
    return [Impulse(kind="frictionless", values=(normal, *(sp.Integer(0),) * (problem.delassus.rows - 1)))]


# --- the unit disc ---------------------------------------------------------------------------------------------------


def _disc(problem: ContactProblem, approach: Sign) -> Iterator[Impulse]:
    G, v = problem.normalised
    E = problem.section_map
    assert E is not None
    stick, border = _sticking(G, v), Sign.NEGATIVE
    if _sign(stick[0], "the sign of the sticking impulse") is Sign.POSITIVE:
        border = _sign(stick[0] ** 2 - stick[1] ** 2 - stick[2] ** 2, "whether the sticking impulse is in the cone")
    if border is not Sign.NEGATIVE:
        yield Impulse(kind="stick", values=(stick[0], *_image(E, stick[1:])))
    if approach is Sign.ZERO:
        yield from _tangential_slips(G, v, E)
        return
    for slip in find_slips(G, v, stick if border is Sign.ZERO else None):
        with ctx.workprec(BITS):
            e = [ball(x, bits=BITS) for x in E]
            d = slip.direction
            friction = (slip.impulse * (e[0] * d[0] + e[1] * d[1]), slip.impulse * (e[2] * d[0] + e[3] * d[1]))
        yield Impulse(kind="slip", values=(slip.impulse, *friction), multiplicity=slip.multiplicity)


def _image(E: sp.MatrixBase, friction: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
    return tuple(recognised(x) for x in E * sp.Matrix(list(friction)))


def _tangential_slips(G: sp.MatrixBase, v: sp.MatrixBase, E: sp.MatrixBase) -> list[Impulse]:
    a, b, C = _blocks(G)
    v_t = v[1:, 0]
    squared = _dot(b, b)
    paradox = _sign(squared - a**2, "the sign of gamma")
    if paradox is Sign.NEGATIVE:
        return []
    root = recognised(sp.sqrt(squared - a**2)) if paradox is Sign.POSITIVE else sp.Integer(0)
    across = sp.Matrix([-b[1], b[0]])
    senses = (1, -1) if paradox is Sign.POSITIVE else (0,)
    found = []
    for sense in senses:
        d = ((-a * b + sense * root * across) / squared).applyfunc(recognised)
        lift = b + C * d
        turning, drift = _cross(d, lift), _cross(d, v_t)
        ray = (sp.Integer(1), *_image(E, d))
        if _sign(turning, "whether friction turns a slip at gamma <= 0") is not Sign.ZERO:
            normal = recognised(-drift / turning)
            if (
                _sign(normal, "the sign of a slip's impulse") is Sign.POSITIVE
                and _sign(-_dot(d, v_t + normal * lift), "whether friction opposes a slip") is Sign.POSITIVE
            ):
                values = tuple(recognised(normal * x) for x in ray)
                found.append(Impulse(kind="slip", values=values, multiplicity=2 if sense == 0 else 1))
        elif _sign(drift, "whether a slip keeps its direction") is Sign.ZERO:
            last = recognised(-_dot(d, v_t) / _dot(d, lift))
            if _sign(last, "the sense of a slip") is Sign.POSITIVE:
                found.append(_family(tuple(0 * x for x in ray), tuple(recognised(last * x) for x in ray)))
    return found


def _family(start: tuple[sp.Expr, ...], end: tuple[sp.Expr, ...]) -> Impulse:
    return Impulse(kind="slip", values=start, end=end, multiplicity=None)


# --- segments and polygons -------------------------------------------------------------------------------------------


def _stick_in_polygon(problem: ContactProblem) -> list[Impulse]:
    r = _sticking(problem.delassus, problem.contact_velocity)
    what = "whether the sticking impulse is in the cone"
    if _sign(r[0], what) is not Sign.POSITIVE:
        return []
    corners = problem.vertices
    if len(r) == 2:
        sides = [r[1] - r[0] * corners[0][0], r[0] * corners[1][0] - r[1]]
    else:
        offsets = [sp.Matrix([r[1] - r[0] * V[0], r[2] - r[0] * V[1]]) for V in corners]
        sides = [_cross(corners[(i + 1) % len(corners)] - V, offsets[i]) for i, V in enumerate(corners)]
    return [] if any(_sign(side, what) is Sign.NEGATIVE for side in sides) else [Impulse(kind="stick", values=r)]


def _at_vertex(problem: ContactProblem, i: int) -> list[Impulse]:
    """Slips with s = V: lambda is fixed by v_n, or free where a + b.V = 0 = v_n."""
    (a, b, C), v = _blocks(problem.delassus), problem.contact_velocity
    corners = problem.vertices
    V = corners[i]
    lift, lever = b + C * V, a + _dot(b, V)
    steps = [corners[j % len(corners)] - V for j in {(i - 1) % len(corners), (i + 1) % len(corners)}]
    opposing = [(_dot(step, v[1:, 0]), _dot(step, lift)) for step in steps]
    ray = (sp.Integer(1), *V)
    if _sign(lever, "the normal compliance at a vertex") is not Sign.ZERO:
        normal = recognised(-v[0] / lever)
        return _point(normal, opposing, ray)
    if _sign(v[0], "the sign of v_n") is not Sign.ZERO:
        return []
    span = _interval([(sp.Integer(0), sp.Integer(1)), *opposing])
    if span is None:
        return []
    if _sign(span[1] - span[0], "the length of a family") is Sign.ZERO:
        return _point(span[0], opposing, ray)
    ends = (tuple(recognised(x * y) for y in ray) for x in span)
    return [_family(*ends)]


def _point(normal: sp.Expr, opposing: list[tuple[sp.Expr, sp.Expr]], ray: tuple[sp.Expr, ...]) -> list[Impulse]:
    """The slip with that lambda, if it is positive, friction opposes it and the tip does not stick."""
    if _sign(normal, "the sign of a slip's impulse") is not Sign.POSITIVE:
        return []
    senses = [_sign(start + slope * normal, "whether friction opposes a slip") for start, slope in opposing]
    if Sign.NEGATIVE in senses or Sign.POSITIVE not in senses:
        return []
    return [Impulse(kind="slip", values=tuple(recognised(normal * x) for x in ray))]


def _interval(constraints: list[tuple[sp.Expr, sp.Expr]]) -> tuple[sp.Expr, sp.Expr] | None:
    """Where start + slope x >= 0 for all of them; it is bounded, because what friction takes bounds the impulse."""
    low = high = None
    for start, slope in constraints:
        sense = _sign(slope, "whether an impulse turns a slip")
        if sense is Sign.ZERO:
            if _sign(start, "whether friction opposes a slip") is Sign.NEGATIVE:
                return None
            continue
        bound = recognised(-start / slope)
        if sense is Sign.POSITIVE and (low is None or _sign(bound - low, "the ends of a family") is Sign.POSITIVE):
            low = bound
        if sense is Sign.NEGATIVE and (high is None or _sign(bound - high, "the ends of a family") is Sign.NEGATIVE):
            high = bound
    assert low is not None
    assert high is not None
    return None if _sign(high - low, "the ends of a family") is Sign.NEGATIVE else (low, high)


def _on_edge(problem: ContactProblem, i: int) -> list[Impulse]:
    """Slips across an edge, strictly between its ends: r = x (1, V) + y (1, V') with x, y > 0."""
    (a, b, C), v = _blocks(problem.delassus), problem.contact_velocity
    ends = problem.vertices[i], problem.vertices[(i + 1) % len(problem.vertices)]
    e = ends[1] - ends[0]
    outward = sp.Matrix([e[1], -e[0]])
    levers = [a + _dot(b, V) for V in ends]
    along = [_dot(e, b + C * V) for V in ends]
    across = [_dot(outward, b + C * V) for V in ends]
    lift, drift, push = -v[0], -_dot(e, v[1:, 0]), -_dot(outward, v[1:, 0])
    determinant = recognised(levers[0] * along[1] - levers[1] * along[0])
    if _sign(determinant, "whether an edge has one slip") is not Sign.ZERO:
        x = recognised((lift * along[1] - levers[1] * drift) / determinant)
        y = recognised((levers[0] * drift - lift * along[0]) / determinant)
        wanted = (x, y, push - across[0] * x - across[1] * y)
        if any(_sign(number, "a slip across an edge") is not Sign.POSITIVE for number in wanted):
            return []
        return [Impulse(kind="slip", values=_between(ends, x, y))]
    if any(
        _sign(lift * m - n * drift, "whether an edge has slips") is not Sign.ZERO
        for m, n in zip(along, levers, strict=True)
    ):
        return []
    # along[1] - along[0] = e.C e > 0: one equation is left, a line of pairs (x, y)
    base = drift / (along[1] - along[0])
    lines = [(-base, along[1]), (base, -along[0])]
    opposing = (
        push - across[0] * lines[0][0] - across[1] * lines[1][0],
        -across[0] * lines[0][1] - across[1] * lines[1][1],
    )
    span = _interval([*lines, opposing])
    if span is None or _sign(span[1] - span[0], "the length of a family") is Sign.ZERO:
        return []
    return [_family(*(_between(ends, *(start + slope * z for start, slope in lines)) for z in span))]


def _between(ends: tuple[sp.MatrixBase, sp.MatrixBase], x: sp.Expr, y: sp.Expr) -> tuple[sp.Expr, ...]:
    """x (1, V) + y (1, V')."""
    return tuple(recognised(n) for n in (x + y, *(ends[0] * x + ends[1] * y)))
