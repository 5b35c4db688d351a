"""The distances by optimisation: sup dist(S, A) over the two balls as the small structured problem that it is.

Free members (g < 0, or v_n >= 0) are farthest at exactly eps: dist(v_eps, A) <= |v_eps - u-|, and a direction that
points away from A attains it. Over one configuration in contact the law is piecewise linear in v, and the farthest
member of each branch is found globally (painleve.core.excess). What is left is a search over the shape offsets
and, where the tip slips, over its impulse: a grid on every chart, then a stencil that shrinks about the best places.
The search finds the supremum over the closure, and that is an estimate; the bound is the distance of one true member.
Where the law depends on three coordinates or more it goes along rays (painleve.asymptotics.ray_search).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import product

import flint
import numpy as np

from painleve.asymptotics.ball_arithmetic import BITS, is_inside
from painleve.asymptotics.distance import Attained, Distance
from painleve.asymptotics.free_member import free_member
from painleve.asymptotics.local import Arithmetic, Expansion, LocalProblem, make_local_problem
from painleve.asymptotics.member import Member, base_balls, make_member, row_balls
from painleve.asymptotics.ray_search import RaySearch
from painleve.asymptotics.sample import KINDS, check_eps
from painleve.asymptotics.search import SLIPS, FarthestMember, PlaneSearch
from painleve.asymptotics.sections.listed import asymptotics_of
from painleve.asymptotics.space.optimise import optimise_in_space
from painleve.asymptotics.witness import find_family
from painleve.core.codes import ContactMode
from painleve.core.excess import REACH
from painleve.errors import InputError
from painleve.progress import told
from painleve.sets import Bounds, excess_of_segment_from_profile
from painleve.theory.domain import check_domain
from painleve.theory.limit_set import LimitSet

__all__ = ["OptimiseOptions", "farthest_member", "optimise_distance"]

NUDGES = (0.0, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9)  # off the boundary of a branch, to be inside for certain
SHADOW = 1e-9  # of eps: how near witnesses of e(A, A_eps) are asked to come
ROUNDED = 2.0**-51  # of the jump: witnesses are placed along it by doubles and come no nearer


@dataclass(frozen=True, kw_only=True)
class OptimiseOptions:
    """How to search: how many of the grid's best places are refined, and the arithmetic of the rows."""

    starts: int = 4
    arithmetic: Arithmetic = "automatic"

    def __post_init__(self) -> None:
        if not 1 <= self.starts <= 1000:
            raise InputError(f"starts: {self.starts} must be between 1 and 1000")


@told(lambda limit, *_, **__: f"searching A_eps of {limit.state.scene.name}, {limit.state.label}")
def optimise_distance(limit: LimitSet, eps: float, options: OptimiseOptions | None = None) -> Distance:
    """Both excesses by optimisation: e(A_eps, A) is bounded from below by a true member at the maximum found, whose
    estimate and error are in the settings; e(A, A_eps) from above by witnesses, or by the nearest members found.

    For three shape coordinates and more the search is from many starts and may miss a maximum, as in space.

    Raises InputError for eps <= 0, a state whose limit set is undecided and a ball on which the law is not proved to be
    defined (painleve.theory.domain).
    """
    options, eps = options or OptimiseOptions(), check_eps(eps)
    if limit.kind == "undecided":
        raise InputError(f"state {limit.state.label}: no distance to a limit set that is undecided: {limit.reason}")
    check_domain(limit.state, eps)
    if asymptotics_of(limit.state.scene.contact).branch_excesses is None:
        return optimise_in_space(limit, eps, starts=options.starts, arithmetic=options.arithmetic)
    problem = make_local_problem(limit)
    expansion = problem.expansion(eps, options.arithmetic)
    search, many = _search(problem, eps, expansion, options.starts), len(problem.shape) > 2
    forward, estimate, error = _excess_of_members(search)
    backward, how = _excess_of_limit(search)
    evaluations = sum(search.counts.values())
    member = forward.member
    ending = (
        f"e(A_eps, A) is estimated as {estimate:.12g}, to about {error:.0e} of it"
        f"{' if the search missed no higher maximum' if many else ''}, on the branch "
        f"{member.branch.label if member else 'free'}; its bound is the distance of that member; e(A, A_eps): {how}"
    )
    return Distance(
        limit=limit,
        eps=eps,
        method="optimise",
        excess_Aeps_A=forward,
        excess_A_Aeps=backward,
        counts=dict(search.counts),
        evaluations=evaluations,
        ending=ending,
        settings={
            "estimate": estimate,
            "estimated_error": error,
            "starts": options.starts,
            "arithmetic": f"taylor, order {expansion.order}" if expansion else "plain",
        },
    )


def farthest_member(problem: LocalProblem, eps: float) -> Member:
    """The member of A_eps that is farthest from A among those that the search finds, in the plane."""
    search = _search(problem, eps, problem.expansion(eps), OptimiseOptions().starts)
    member = _excess_of_members(search)[0].member
    assert member is not None
    return member


def _search(problem: LocalProblem, eps: float, expansion: Expansion | None, starts: int) -> PlaneSearch:
    kind = RaySearch if len(problem.shape) > 2 else PlaneSearch
    differences = partial(problem.differences, eps, expansion)
    return kind(problem, eps, KINDS[problem.limit.kind], differences, starts=starts)


def _excess_of_members(search: PlaneSearch) -> tuple[Attained, float, float]:
    """e(A_eps, A): the bound, the estimate of the supremum, and its estimated relative error."""
    free, found = free_member(search.problem, search.eps, away=True), search.best(search.branches, search.kind)
    if found is None or found.value <= 1.0:
        return Attained(bounds=Bounds.at_least(free.distance[0]), member=free), search.eps, 0.0
    member = _member(search, found) or free
    estimate = found.value * search.eps
    lower = member.distance[0]
    error = max(found.error / found.value, abs(estimate - lower) / estimate)
    return Attained(bounds=Bounds.at_least(lower), member=member), estimate, error


def _excess_of_limit(search: PlaneSearch) -> tuple[Attained, str]:
    """An upper bound on e(A, A_eps): from witnesses if there are any, else from the members that reach farthest."""
    problem, eps = search.problem, search.eps
    family = find_family(problem.limit, eps, within=max(SHADOW * eps, ROUNDED * problem.length))
    if family is not None:
        return Attained(bounds=Bounds.at_most(family.bound), member=family.last), "witnesses shadow all of A"
    first, reach = free_member(problem, eps, away=False), search.best((ContactMode.STICK,), REACH)
    last = _member(search, reach) if reach is not None else None
    members = [first] if last is None else [first, last]
    along = [float(m.offset @ problem.direction) for m in members]
    rho = [_above_line(problem, m, t) for m, t in zip(members, along, strict=True)]
    value, place, nearest = excess_of_segment_from_profile(np.array(along), np.array(rho), problem.length)
    point = problem.u + place * problem.direction
    bounds = Bounds.at_most(float(np.nextafter(value * (1.0 + 1e-15), np.inf)))
    return Attained(bounds=bounds, member=members[nearest], point=point), (
        "no witnesses were found; the bound is from the free and the sticking member that come nearest to each other"
    )


def _above_line(problem: LocalProblem, member: Member, along: float) -> float:
    across = member.offset - along * problem.direction
    return float(np.linalg.norm(across))


def _member(search: PlaneSearch, found: FarthestMember) -> Member | None:
    """The true member nearest to what was found, nudged off the boundaries of its branch as little as it takes."""
    for nudge, tilt in sorted(product(NUDGES, repeat=2), key=sum):
        dq = _configuration(search, found, nudge, tilt)
        dv = _velocity(search, found, dq, nudge, tilt)
        if not (is_inside(dq, search.eps) and is_inside(dv, search.eps)):
            continue
        try:
            member = make_member(search.problem, dq, dv)
        except ArithmeticError:
            continue
        if member.branch is found.branch:
            return member
    return None


def _configuration(search: PlaneSearch, found: FarthestMember, nudge: float, tilt: float) -> list[flint.arb]:
    """dq with as much penetration as the ball allows, and a tilt of the shape into it."""
    p = search.problem
    dq = np.zeros(p.dimension)
    dq[list(p.shape)] = found.x * (search.eps * (1.0 - 1e-15 - nudge))
    room = max(0.0, search.eps**2 * (1.0 - 4e-15) - float(dq @ dq))
    dq += p.carried_direction * np.sqrt(room) * (p.carried > 0.0)
    inward = -p.normal
    inward = inward / np.linalg.norm(inward) * (p.carried == 0.0)
    with flint.ctx.workprec(BITS):
        tilted = zip(dq, tilt * search.eps * inward, strict=True)
        return [flint.arb(float(x)) + flint.arb(float(y)) for x, y in tilted]


def _velocity(
    search: PlaneSearch, found: FarthestMember, dq: list[flint.arb], nudge: float, tilt: float
) -> list[flint.arb]:
    """dv; where the tip slips, corrected so that v_n = -lam p to the last digit, however small p is."""
    p = search.problem
    dv = [flint.arb(float(x)) for x in found.dv * (search.eps * (1.0 - 1e-15 - nudge))]
    normal = p.normal
    if found.branch not in SLIPS:
        pull = nudge * search.eps / float(np.linalg.norm(normal))
        return [x - flint.arb(float(pull * y)) for x, y in zip(dv, normal, strict=True)]
    with flint.ctx.workprec(BITS):
        rows, u = row_balls(p, dq), base_balls(p)[2]
        w = rows[p.parts.w_n]
        v_n = sum((x * (y + z) for x, y, z in zip(w, u, dv, strict=True)), flint.arb(0))
        lam = flint.arb(found.impulse) * (1 - flint.arb(tilt)) + flint.arb(nudge * search.eps)
        lack = -lam * rows[p.kernels.rows.edges[SLIPS[found.branch]]] - v_n
        squared = sum((x * x for x in w), flint.arb(0))
        return [flint.arb((x + lack * y / squared).mid()) for x, y in zip(dv, w, strict=True)]
