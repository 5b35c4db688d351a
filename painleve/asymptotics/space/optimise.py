"""The distances by optimisation where friction is in space.

In the plane S is piecewise linear in v over one configuration, and the farthest member of each branch is found globally
(painleve.asymptotics.optimise). In space slips are on a conic, and the farthest member is sought in all variables at
once (painleve.asymptotics.space.search): what comes out is a bound by a true member, and an estimate that holds if the
search did not miss the basin of the supremum. The estimated error says how well the maximum found is resolved, and
nothing about others.
"""

from __future__ import annotations

import flint
import numpy as np

from painleve.asymptotics.ball_arithmetic import is_inside
from painleve.asymptotics.distance import Attained, Distance
from painleve.asymptotics.free_member import free_member
from painleve.asymptotics.local import Arithmetic, make_local_problem
from painleve.asymptotics.member import Member, make_member
from painleve.asymptotics.sample import KINDS, SampleOptions, sample_distance
from painleve.asymptotics.space.ball import SpaceBall
from painleve.asymptotics.space.search import SpaceFound, search_in_space
from painleve.asymptotics.witness import find_family
from painleve.sets import Bounds
from painleve.theory.limit_set import LimitSet

__all__ = ["optimise_in_space"]

NUDGES = (0.0, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8)  # towards a point well inside
ATTAINED = 1e-10  # relative: a member that near to the value found will do
SHADOW = 1e-9  # of eps: how near witnesses of e(A, A_eps) are asked to come
ROUNDED = 2.0**-51  # of the jump: witnesses are placed along it by doubles and come no nearer
NEARBY_SAMPLES = 100_000  # for e(A, A_eps) where there are no witnesses


def optimise_in_space(limit: LimitSet, eps: float, *, starts: int, arithmetic: Arithmetic) -> Distance:
    """Both excesses: e(A_eps, A) from below by a true member at the maximum found, whose estimate and error are in the
    settings; e(A, A_eps) from above by witnesses, or by the nearest members of a sample.

    starts: ascents from each branch on each chart. Raises InputError for a section without area.
    """
    problem = make_local_problem(limit)
    expansion = problem.expansion(eps, arithmetic)
    ball = SpaceBall(problem, eps, KINDS[limit.kind], expansion)
    found = search_in_space(ball, starts)
    member, estimate, error, where = _farthest(ball, found)
    backward, how = _excess_of_limit(limit, eps, problem.length)
    ending = (
        f"e(A_eps, A) is estimated as {estimate:.12g}, to about {error:.0e} of it if the search missed no higher "
        f"maximum, on the branch {member.branch.label} (chart: {where}); its bound is the distance of that member; "
        f"e(A, A_eps): {how}"
    )
    return Distance(
        limit=limit,
        eps=eps,
        method="optimise",
        excess_A_Aeps=backward,
        ending=ending,
        counts=dict(ball.counts),
        excess_Aeps_A=Attained(bounds=Bounds.at_least(member.distance[0]), member=member),
        evaluations=ball.evaluations,
        settings={
            "estimate": estimate,
            "estimated_error": error,
            "starts": starts,
            "arithmetic": f"taylor, order {expansion.order}" if expansion else "plain",
        },
    )


def _farthest(ball: SpaceBall, found: SpaceFound | None) -> tuple[Member, float, float, str]:
    """The member, the estimate of the supremum, its estimated relative error, and where it is attained."""
    if found is not None and found.value > 1.0:
        member = _member(ball, found)
        if member is not None and member.distance[0] > ball.eps:
            estimate = found.value * ball.eps
            error = max(found.error / found.value, abs(estimate - member.distance[0]) / estimate)
            return member, estimate, error, found.chart
    return free_member(ball.problem, ball.eps, away=True), ball.eps, 0.0, "free"


def _excess_of_limit(limit: LimitSet, eps: float, length: float) -> tuple[Attained, str]:
    """An upper bound on e(A, A_eps)."""
    family = find_family(limit, eps, within=max(SHADOW * eps, ROUNDED * length))
    if family is not None:
        return Attained(bounds=Bounds.at_most(family.bound), member=family.last), "witnesses shadow all of A"
    nearest = sample_distance(limit, eps, SampleOptions(samples=NEARBY_SAMPLES, threads=1)).excess_A_Aeps
    return nearest, f"no witnesses were found; the bound is from the nearest of {NEARBY_SAMPLES} samples"


def _member(ball: SpaceBall, found: SpaceFound) -> Member | None:
    """The true member nearest to what was found, drawn into the balls as little as it takes."""
    best: Member | None = None
    for nudge in NUDGES:
        dq, dv = _offsets(ball, found, nudge)
        if not (is_inside(dq, ball.eps) and is_inside(dv, ball.eps)):
            continue
        try:
            member = make_member(ball.problem, dq, dv)
        except ArithmeticError:
            continue
        if best is None or member.distance[0] > best.distance[0]:
            best = member
        if best.distance[0] >= found.value * ball.eps * (1.0 - ATTAINED):
            break
    return best


def _offsets(ball: SpaceBall, found: SpaceFound, nudge: float) -> tuple[list[flint.arb], list[flint.arb]]:
    """dq and dv as exact numbers: a little towards penetration and approach."""
    p, eps, d = ball.problem, ball.eps, ball.dimension
    dq = np.zeros(d)
    dq[list(p.shape)] = found.x[: ball.shape]
    if ball.places > ball.shape:
        dq += p.carried_direction * found.x[ball.shape]
    size = eps * (1.0 - 1e-15 - nudge)
    exact_q = [flint.arb(float(size * x - nudge * eps * y)) for x, y in zip(dq, ball.normal, strict=True)]
    return exact_q, [flint.arb(float(size * x - nudge * eps * y)) for x, y in zip(found.dv, ball.normal, strict=True)]
