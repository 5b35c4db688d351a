"""Rigorous enclosures of e(A_eps, A), e(A, A_eps) and d_H, for scenes with k <= 1 and one or two shape coordinates.

e(A_eps, A) is the larger of eps, its value over the free members, and the suprema over the pieces of members in contact
(`pieces` in this room), each bounded from above by branch and bound (`branch_and_bound`). The free members are the
closed ball B(u-, eps): a direction orthogonal to A attains eps, and no point of the ball is farther from u-. The lower
bounds are members evaluated in ball arithmetic.

e(A, A_eps) = 0 exactly where A_eps shadows A for every eps: S(q, u-) = u- is a member; u_tilde is the limit of the
members over q_eps = q with v_n -> 0- (sticking); and where every ball holds q_eps in contact with gamma > 0, the
witnesses of Theorem 1 over such q_eps tend to every point of A as the ball shrinks, and the members of a smaller ball
are members of this one. At an isolated state see `isolation`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from painleve.asymptotics.certify.branch_and_bound import BoxSearch, Candidate
from painleve.asymptotics.certify.isolation import members_apart, slips_nowhere
from painleve.asymptotics.certify.pieces import contact_pieces
from painleve.asymptotics.certify.preimage import candidate_member, free_member
from painleve.asymptotics.distance import Attained, Distance
from painleve.asymptotics.local import LocalProblem, make_local_problem
from painleve.asymptotics.member import Member
from painleve.asymptotics.optimise import farthest_member
from painleve.asymptotics.sample import check_eps
from painleve.asymptotics.sections.listed import asymptotics_of
from painleve.asymptotics.witness import find_family
from painleve.core.codes import ContactMode
from painleve.errors import InputError
from painleve.progress import told
from painleve.sets import Bounds
from painleve.theory.domain import check_domain
from painleve.theory.limit_set import LimitSet
from painleve.theory.neighbourhood import Neighbourhood, Neighbours, neighbours

__all__ = ["CertifyOptions", "certify_distance"]

BATCH = 1024
ROUNDS = 60  # of branch and bound for each supporting plane of the sticking members


@dataclass(frozen=True, kw_only=True)
class CertifyOptions:
    """width: relative width (upper - lower)/upper at which to stop; budget: the most boxes that are bounded."""

    width: float = 1e-6
    budget: int = 60_000

    def __post_init__(self) -> None:
        if not 0.0 < self.width < 1.0:
            raise InputError(f"width: {self.width} must be between 0 and 1")
        if self.budget < 1:
            raise InputError(f"budget: {self.budget} must be at least 1")


@dataclass(frozen=True, kw_only=True, eq=False)
class _Enclosure:
    """What the searches found, in units of velocity."""

    lower: float
    upper: float
    member: Member
    searches: tuple[BoxSearch, ...]

    @property
    def evaluations(self) -> int:
        return sum(s.evaluations for s in self.searches)


@told(lambda limit, *_, **__: f"enclosing the distances at {limit.state.scene.name}, {limit.state.label}")
def certify_distance(limit: LimitSet, eps: float, options: CertifyOptions | None = None) -> Distance:
    """Enclosures of both excesses; the relative widths that were reached are in the ending.

    Raises InputError for eps <= 0, a state whose limit set is undecided, friction in space, scenes with more than two
    shape coordinates, and where the ball is so large that the law is not proved to be defined on it
    (painleve.theory.domain) or expansions about its centre do not converge.
    """
    options, eps = options or CertifyOptions(), check_eps(eps)
    if limit.kind == "undecided":
        raise InputError(f"state {limit.state.label}: no distance to a limit set that is undecided: {limit.reason}")
    if asymptotics_of(limit.state.scene.contact).branch_excesses is None:
        raise InputError(
            f"certify: scene {limit.state.scene.name} has friction in space, which this method does not "
            "search; use the methods sample or optimise"
        )
    check_domain(limit.state, eps)
    problem = make_local_problem(limit)
    near = neighbours(limit.state, limit.edge) if limit.critical else None
    apart = near is not None and near.kind is Neighbourhood.ISOLATED and slips_nowhere(problem, eps)
    found = _excess_of_members(problem, eps, _critical(limit) if apart else None, options)
    backward, note = _excess_of_limit(problem, eps, near, apart, found.searches)
    counts = {b.label: sum(s.evaluations for s in found.searches if s.piece.branch is b) for b in ContactMode}
    bounds = Bounds.between(found.lower, found.upper)
    return Distance(
        limit=limit,
        eps=eps,
        method="certify",
        counts={name: n for name, n in counts.items() if n},
        excess_Aeps_A=Attained(bounds=bounds, member=found.member),
        excess_A_Aeps=backward,
        evaluations=found.evaluations,
        ending=f"{_ending(bounds, found.evaluations, options)}; {note}",
        settings={"width": options.width, "budget": options.budget},
    )


def _critical(limit: LimitSet) -> ContactMode:
    """Slip on the edge on which gamma = 0."""
    return ContactMode.SLIP_PLUS if limit.edge == 1 else ContactMode.SLIP_MINUS


def _ending(bounds: Bounds, evaluations: int, options: CertifyOptions) -> str:
    width = bounds.relative_width or 0.0
    reached = f"e(A_eps, A) is enclosed to a relative width of {width:.1e} after {evaluations} boxes"
    return reached if width <= options.width else f"{reached}: the budget ended before {options.width:.1e} was reached"


def _excess_of_members(
    problem: LocalProblem, eps: float, excluded: ContactMode | None, options: CertifyOptions
) -> _Enclosure:
    """Refine the piece of largest bound until it is near enough to the farthest member, or the budget ends: then the
    member that an optimiser finds may be farther."""
    searches = tuple(BoxSearch(piece) for piece in contact_pieces(problem, eps) if piece.branch is not excluded)
    member = free_member(problem, eps)
    tried: set[Candidate] = set()
    while True:
        member = _farthest(problem, eps, member, searches, tried)
        target = member.distance[0] / eps * (1.0 + options.width / 2.0)
        worst = max(searches, key=lambda s: s.pending)
        if worst.pending <= target:
            break
        if sum(s.evaluations for s in searches) >= options.budget:
            member = max(member, farthest_member(problem, eps), key=lambda m: m.distance[0])
            break
        worst.refine(target, BATCH)
    upper = max([1.0, *(s.upper for s in searches)])
    return _Enclosure(
        lower=member.distance[0], upper=float(np.nextafter(eps * upper, np.inf)), member=member, searches=searches
    )


def _farthest(
    problem: LocalProblem, eps: float, member: Member, searches: Iterable[BoxSearch], tried: set[Candidate]
) -> Member:
    """The member of largest certain distance among this one and those that the searches propose."""
    for search in searches:
        candidate = search.best
        if candidate is None or candidate in tried or eps * candidate.value <= member.distance[0]:
            continue
        tried.add(candidate)
        found = candidate_member(problem, eps, candidate)
        if found is not None and found.distance[0] > member.distance[0]:
            member = found
    return member


def _excess_of_limit(
    problem: LocalProblem, eps: float, near: Neighbours | None, apart: bool, searches: Sequence[BoxSearch]
) -> tuple[Attained, str]:
    """e(A, A_eps), and how it is known; apart: no member slips on the critical edge."""
    limit = problem.limit
    if limit.kind != "segment" or near is None:
        return Attained(bounds=Bounds.exactly(0.0)), "e(A, A_eps) = 0: u- is a member, u_tilde a limit of members"
    if near.kind is Neighbourhood.APPROACHED:
        family = find_family(limit, eps, within=eps)
        if family is None:
            return Attained(bounds=Bounds.exactly(0.0)), f"e(A, A_eps) = 0 by Theorem 1: {near.reason}"
        note = f"e(A, A_eps) = 0: {near.reason}; witnesses in this ball come within {family.bound:.1e} of all of A"
        return Attained(bounds=Bounds.exactly(0.0), member=family.last), note
    others = [s.upper for s in searches if s.piece.branch not in (ContactMode.STICK, _critical(limit))]
    found = members_apart(problem, eps, eps * max([1.0, *others]), ROUNDS)
    bounds = Bounds.between(found.lower if apart else 0.0, found.upper)
    note = f"e(A, A_eps) is enclosed to a relative width of {bounds.relative_width:.1e}"
    note += ": no member slips on the critical edge" if apart else ": slip on the critical edge was not excluded"
    return Attained(bounds=bounds, member=found.member, point=found.point), note
