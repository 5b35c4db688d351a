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

from painleve.asymptotics.ball_arithmetic import BITS, Balls, certain, dot, norm
from painleve.asymptotics.local import LocalProblem
from painleve.core.codes import ContactMode
from painleve.exact.balls import ball, make_ball_function
from painleve.sets import Bounds

__all__ = ["Member", "base_balls", "distance_to_point", "jump_balls", "make_member", "row_balls"]


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
        return _outward(norm([x - share * y for x, y in zip(member.enclosure, jump, strict=True)]))


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
    v_n = dot(rows[parts.w_n], dv if at_base else v)
    contact = at_base or not certain(rows[parts.g] < 0, rows[parts.g] >= 0, "contact")
    if not contact or certain(v_n >= 0, v_n < 0, "the sign of v_n"):
        return dv, ContactMode.FREE
    velocity = [v_n, *(dot(rows[part], v) for part in parts.H)]
    return problem.section.offset(rows, parts, dv, velocity, problem.critical_edge if at_base else 0)


def _distance_to_limit(problem: LocalProblem, offset: Balls) -> flint.arb:
    zero, jump = [flint.arb(0)] * len(offset), jump_balls(problem)
    to_start, to_end = norm(offset), norm([x - y for x, y in zip(offset, jump, strict=True)])
    if problem.limit.kind == "point":
        return to_start
    if problem.limit.kind == "pair":
        return to_start.min(to_end)
    share = dot(offset, jump) / dot(jump, jump)
    share = share.max(zero[0]).min(flint.arb(1))
    return norm([x - share * y for x, y in zip(offset, jump, strict=True)])
