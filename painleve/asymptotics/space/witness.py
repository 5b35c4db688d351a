"""A path of members that shadows the segment A where gamma = 0 in space.

Over one q_eps with p > 0, the least compliance of its cone, S is continuous in v. As nu = -v_n grows from 0 the impulse
does not run along the ray rho of least compliance, as it does in the plane, but it stays near: S = v + x Y rho + z,
0 <= x <= nu/p. For the unit disc rho opposes b, and |r_t| <= r_n with a r_n + b.r_t = nu bounds the rest by
    |z| <= nu/|b| |Y e| + nu/|b| sqrt((a + |b|)/(4 p)) |Y e_perp|,     e = b/|b|;
for a polygon it is at most the largest nu |Y (1, s_j)|/p_j over the other vertices. So with nu up to a multiple of p
the path leaves the line through A by O(sqrt(p)) (a polygon: O(p)). Continuity does the rest: between two members of it
the path takes every place along A.
"""

from __future__ import annotations

from collections.abc import Callable

import flint

from painleve.asymptotics.ball_arithmetic import BITS, Balls, dot, norm
from painleve.asymptotics.local import LocalProblem
from painleve.asymptotics.member import Member, jump_balls, row_balls
from painleve.asymptotics.sections.section import JumpBalls

__all__ = ["path_bound", "path_members"]

REACHES = (2.0, 8.0, 32.0)  # in units of the normal velocity that would give the jump's impulse on the ray
START = 2.0**-64  # of it
MakeMember = Callable[[LocalProblem, Balls, float], Member | None]


def path_members(problem: LocalProblem, dq: Balls, make: MakeMember) -> tuple[Member, Member, float] | None:
    """Two members of the path over q + dq, about at its ends, and the share of the jump's impulse at the second."""
    first, found = make(problem, dq, START), None
    if first is None:
        return None
    for reach in REACHES:
        last = make(problem, dq, reach)
        if last is None:
            break
        found = first, last, reach
        if _along(problem, last) >= _length(problem):
            break
    return found


def path_bound(problem: LocalProblem, dq: Balls, first: Member, last: Member, reach: float) -> float:
    """Upper bound on the distance of any point of A to the members over q + dq between those two."""
    with flint.ctx.workprec(BITS):
        before, beyond = _along(problem, first), _length(problem) - _along(problem, last)
        gap = before.max(beyond).max(flint.arb(0))
        moved = max((norm(_exact(m)) for m in (first, last)), key=lambda x: x.upper())
        jump = JumpBalls(vector=jump_balls(problem), impulse=problem.exact_multiplier, edge=problem.limit.edge)
        away = problem.section.off_the_line(row_balls(problem, dq), problem.parts, jump, reach)
        return float((gap + moved + away).upper()) * (1.0 + 1e-15)


def _exact(member: Member) -> Balls:
    return list(member.preimage[1])


def _along(problem: LocalProblem, member: Member) -> flint.arb:
    with flint.ctx.workprec(BITS):
        return dot(member.enclosure, jump_balls(problem)) / _length(problem)


def _length(problem: LocalProblem) -> flint.arb:
    with flint.ctx.workprec(BITS):
        return norm(jump_balls(problem))
