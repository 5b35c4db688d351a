"""One member of A_eps, evaluated in ball arithmetic: what is printed as a member is one, to the last digit.

The offsets (dq, dv) are exact dyadic numbers, doubles as a rule; the base state is exact; so S(q + dq, u- + dv) is
known to dozens of digits, and so are its distances, however small the offsets are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import flint
import numpy as np

from painleve.asymptotics.local import BITS, LocalProblem
from painleve.asymptotics.space.member import ContactBalls, conic_impulse, polygon_impulse
from painleve.core.codes import ContactMode
from painleve.exact.balls import ball, make_ball_function
from painleve.sets import Bounds

__all__ = ["Member", "base_balls", "distance_to_point", "jump_balls", "make_member", "row_balls"]

Balls = list[flint.arb]


@dataclass(frozen=True, kw_only=True, eq=False)
class Member:
    """S(q + dq, u- + dv): preimage, branch, value, distance to A.

    preimage: (dq, dv) as the exact dyadic numbers that they are; dq, dv: the same as doubles, which a witness at small
    eps may not survive (lambda = -v_n/gamma is a quotient of numbers far below the rounding of dv). offset: S - u-,
    rounded from an enclosure; distance: an enclosure (lower, upper) of dist(S, A), rounded outwards.
    """

    preimage: tuple[tuple[flint.arb, ...], tuple[flint.arb, ...]]
    dq: np.ndarray
    dv: np.ndarray
    branch: ContactMode
    offset: np.ndarray
    distance: tuple[float, float]
    enclosure: tuple[flint.arb, ...]

    def __repr__(self) -> str:
        offset = ", ".join(f"{x:.6g}" for x in self.offset)
        return f"Member({self.branch.label}, S - u- = ({offset}), dist(S, A) {Bounds.between(*self.distance)})"

    def as_dict(self) -> dict[str, object]:
        arrays = {"dq": self.dq.tolist(), "dv": self.dv.tolist(), "offset": self.offset.tolist()}
        return arrays | {"branch": self.branch.label}


def make_member(
    problem: LocalProblem, dq: Sequence[float] | Balls | np.ndarray, dv: Sequence[float] | Balls | np.ndarray
) -> Member:
    """Evaluate the law at an offset state. Raises ArithmeticError where balls cannot decide its branch."""
    with flint.ctx.workprec(BITS):
        exact_q, exact_v = _exact(dq), _exact(dv)
        offset, branch = _law(problem, exact_q, exact_v)
        return Member(
            preimage=(tuple(exact_q), tuple(exact_v)),
            dq=_rounded(exact_q),
            dv=_rounded(exact_v),
            branch=branch,
            offset=_rounded(offset),
            distance=_outward(_distance_to_limit(problem, offset)),
            enclosure=tuple(offset),
        )


def row_balls(problem: LocalProblem, dq: Balls) -> Balls:
    """All rows of the scene at q + dq."""
    q, p, _ = base_balls(problem)
    with flint.ctx.workprec(BITS):
        return _row_function(problem)([*(x + y for x, y in zip(q, dq, strict=True)), *p])


def _exact(offsets: Sequence[float] | Balls | np.ndarray) -> Balls:
    return [x if isinstance(x, flint.arb) else flint.arb(float(x)) for x in offsets]


def _rounded(values: Balls) -> np.ndarray:
    return np.array([float(x.mid()) for x in values])


def distance_to_point(problem: LocalProblem, member: Member, fraction: float) -> tuple[float, float]:
    """Enclosure of the distance from a member to u- + fraction (u_tilde - u-)."""
    with flint.ctx.workprec(BITS):
        jump = jump_balls(problem)
        share = flint.arb(float(fraction))
        return _outward(_norm([x - share * y for x, y in zip(member.enclosure, jump, strict=True)]))


def _outward(value: flint.arb) -> tuple[float, float]:
    """Floats below and above everything in a ball known to be >= 0."""
    lower, upper = float(value.lower()), float(value.upper())
    return max(0.0, float(np.nextafter(lower, -np.inf))) if lower > 0.0 else 0.0, float(np.nextafter(upper, np.inf))


@lru_cache(maxsize=16)
def _row_function(problem: LocalProblem) -> Callable[[Sequence[flint.arb]], Balls]:
    scene, rows = problem.kernels.scene, problem.kernels.rows
    return make_ball_function(rows.expressions, [*scene.q, *scene.p], bits=BITS)


@lru_cache(maxsize=16)
def base_balls(problem: LocalProblem) -> tuple[Balls, Balls, Balls]:
    """(q, parameters, u-) of the base state."""
    state = problem.limit.state
    exact = [state.q, [state.parameters[p.name] for p in state.scene.parameters], state.u]
    q, p, u = ([ball(value, bits=BITS) for value in values] for values in exact)
    return q, p, u


@lru_cache(maxsize=16)
def jump_balls(problem: LocalProblem) -> Balls:
    """u_tilde - u-."""
    pairs = zip(problem.limit.u_tilde, problem.limit.state.u, strict=True)
    return [ball(problem.limit.state.exact(x - y), bits=BITS) for x, y in pairs]


def _law(problem: LocalProblem, dq: Balls, dv: Balls) -> tuple[Balls, ContactMode]:
    """S - u- and the branch, by the definition of the law, independently of the compiled kernels."""
    parts, u = problem.parts, base_balls(problem)[2]
    rows = row_balls(problem, dq)
    at_base = all(x == 0 for x in dq)  # there g = 0, <u-, n> = 0 and gamma = 0 hold exactly, which no ball can show
    v = [x + y for x, y in zip(u, dv, strict=True)]
    w_n, Y_n, a = rows[parts.w_n], rows[parts.Y_n], rows[parts.a]
    v_n = _dot(w_n, dv if at_base else v)
    contact = at_base or not _certain(rows[parts.g] < 0, rows[parts.g] >= 0, "contact")
    if not contact or _certain(v_n >= 0, v_n < 0, "the sign of v_n"):
        return dv, ContactMode.FREE
    if not problem.limit.state.scene.contact.section.dimension:
        return [x - y * v_n / a for x, y in zip(dv, Y_n, strict=True)], ContactMode.FRICTIONLESS
    if problem.limit.state.scene.contact.section.dimension == 2:
        return _law_in_space(problem, rows, v, v_n, dv, at_base)
    H, Y_t = rows[parts.H[0]], rows[parts.Y_t[0]]
    (b,), (C,), (minus, mu_plus, mu_minus) = rows[parts.b], rows[parts.C], rows[parts.section]
    plus, v_t = rows[parts.edge_plus], _dot(H, v)
    determinant = a * C - b * b
    r_n, r_t, branch = (b * v_t - C * v_n) / determinant, (b * v_n - a * v_t) / determinant, ContactMode.STICK
    critical = problem.critical_edge if at_base else 0
    for sense, edge, s, slip in (
        (1, plus, mu_plus, ContactMode.SLIP_PLUS),
        (-1, minus, -mu_minus, ContactMode.SLIP_MINUS),
    ):
        if (
            branch is not ContactMode.STICK
            or sense == critical
            or not _certain(edge > 0, edge <= 0, "the sign of gamma")
        ):
            continue
        excess = sense * (r_t * edge + s * v_n)
        if _certain(excess > 0, excess <= 0, "stick or slip"):
            r_n, r_t, branch = -v_n / edge, -s * v_n / edge, slip
    moved = zip(dv, Y_n, Y_t, strict=True)
    return [x + y * r_n + z * r_t for x, y, z in moved], branch


def _law_in_space(
    problem: LocalProblem, rows: Balls, v: Balls, v_n: flint.arb, dv: Balls, at_base: bool
) -> tuple[Balls, ContactMode]:
    parts = problem.parts
    (H_1, H_2), (Y_1, Y_2) = ([rows[part] for part in columns] for columns in (parts.H, parts.Y_t))
    v_t = _dot(H_1, v), _dot(H_2, v)
    contact = ContactBalls(a=rows[parts.a], b=rows[parts.b], C=rows[parts.C], v=(v_n, *v_t))
    critical, n = problem.critical_edge if at_base else 0, len(rows[parts.section]) // 3
    if n:
        p, s = rows[parts.section][:n], rows[parts.section][n:]
        known = [flint.arb(0) if i + 1 == critical else p[i] for i in range(n)]
        r_n, r_1, r_2, branch = polygon_impulse(contact, [s[2 * i : 2 * i + 2] for i in range(n)], known)
    else:
        r_n, r_1, r_2, branch = conic_impulse(contact, flint.arb(0) if critical else rows[parts.edge_plus])
    moved = zip(dv, rows[parts.Y_n], Y_1, Y_2, strict=True)
    return [x + y * r_n + z_1 * r_1 + z_2 * r_2 for x, y, z_1, z_2 in moved], branch


def _certain(yes: bool, no: bool, what: str) -> bool:
    if not yes and not no:
        raise ArithmeticError(f"{what} cannot be decided with {BITS} bits at these offsets")
    return yes


def _distance_to_limit(problem: LocalProblem, offset: Balls) -> flint.arb:
    zero, jump = [flint.arb(0)] * len(offset), jump_balls(problem)
    to_start, to_end = _norm(offset), _norm([x - y for x, y in zip(offset, jump, strict=True)])
    if problem.limit.kind == "point":
        return to_start
    if problem.limit.kind == "pair":
        return to_start.min(to_end)
    share = _dot(offset, jump) / _dot(jump, jump)
    share = share.max(zero[0]).min(flint.arb(1))
    return _norm([x - share * y for x, y in zip(offset, jump, strict=True)])


def _dot(x: Balls, y: Balls) -> flint.arb:
    total = flint.arb(0)
    for left, right in zip(x, y, strict=True):
        total += left * right
    return total


def _norm(x: Balls) -> flint.arb:
    """The root is taken end by end: of a ball that touches zero it would be undefined."""
    squared = _dot(x, x)
    lower, upper = squared.lower(), squared.upper()
    return (lower.sqrt() if lower > 0 else flint.arb(0)).union(upper.sqrt())
