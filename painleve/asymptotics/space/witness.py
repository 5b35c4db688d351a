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

from painleve.asymptotics.local import BITS, LocalProblem
from painleve.asymptotics.member import Member, jump_balls, row_balls
from painleve.mechanics.friction import Polygon

__all__ = ["path_bound", "path_members"]

REACHES = (2.0, 8.0, 32.0)  # in units of the normal velocity that would give the jump's impulse on the ray
START = 2.0**-64  # of it
Balls = list[flint.arb]
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
        moved = max((_norm(_exact(m)) for m in (first, last)), key=lambda x: x.upper())
        return float((gap + moved + _off_the_line(problem, dq, reach)).upper()) * (1.0 + 1e-15)


def _exact(member: Member) -> Balls:
    return list(member.preimage[1])


def _along(problem: LocalProblem, member: Member) -> flint.arb:
    with flint.ctx.workprec(BITS):
        return _dot(member.enclosure, jump_balls(problem)) / _length(problem)


def _length(problem: LocalProblem) -> flint.arb:
    with flint.ctx.workprec(BITS):
        return _norm(jump_balls(problem))


def _off_the_line(problem: LocalProblem, dq: Balls, reach: float) -> flint.arb:
    """Of S - v from the line through A, for all nu up to `reach` times p times the jump's impulse."""
    rows, names, parts = row_balls(problem, dq), problem.kernels.rows, problem.parts
    p = rows[names.edge(problem.limit.edge)]
    most = flint.arb(reach) * problem.exact_multiplier
    Y_n, (Y_1, Y_2) = rows[parts.Y_n], [rows[part] for part in parts.Y_t]
    friction = problem.limit.state.scene.contact.section
    if isinstance(friction, Polygon):
        corners = [
            (rows[names.index(f"s_1_{i}")], rows[names.index(f"s_2_{i}")]) for i in range(1, 1 + len(friction.vertices))
        ]
        rays = [_combine((Y_n, 1), (Y_1, x), (Y_2, y)) for x, y in corners]
        others = [i for i in range(len(rays)) if i != problem.limit.edge - 1]
        ray = rays[problem.limit.edge - 1]
        rest = max((most * p * _norm(rays[i]) / rows[names.edge(i + 1)] for i in others), key=lambda x: x.upper())
    else:
        b_1, b_2 = rows[parts.b]
        size = (b_1 * b_1 + b_2 * b_2).sqrt()
        e_1, e_2 = b_1 / size, b_2 / size
        ray = _combine((Y_n, 1), (Y_1, -e_1), (Y_2, -e_2))
        along, across = _norm(_combine((Y_1, e_1), (Y_2, e_2))), _norm(_combine((Y_1, -e_2), (Y_2, e_1)))
        rest = most * (p * along + ((2 * size + p) * p / 4).sqrt() * across) / size
    jump = jump_balls(problem)
    share = _dot(ray, jump) / _dot(jump, jump)
    return most * _norm([x - share * y for x, y in zip(ray, jump, strict=True)]) + rest


def _combine(*terms: tuple[Balls, flint.arb | int]) -> Balls:
    return [sum((row[j] * factor for row, factor in terms), flint.arb(0)) for j in range(len(terms[0][0]))]


def _dot(x: Balls | tuple[flint.arb, ...], y: Balls) -> flint.arb:
    return sum((a * b for a, b in zip(x, y, strict=True)), flint.arb(0))


def _norm(x: Balls) -> flint.arb:
    return _dot(x, x).nonnegative_part().sqrt()
