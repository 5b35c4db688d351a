"""Witnesses of asymptotic indeterminacy (paper, eq. 10 and the proof of Theorem 1): built, not waited for.

For a velocity v_bar of A(q, u-) a witness is a pair (q_eps, v_eps) in the balls with S(q_eps, v_eps) near v_bar. Where
gamma = 0 it needs a configuration with gamma(q_eps) > 0 and g(q_eps) >= 0; v_eps then follows from
v_n = -lambda_bar (a + s b)(q_eps). Everything is formed in ball arithmetic, and the offsets are exact dyadic numbers,
so that a witness is one however small eps is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import flint
import numpy as np

from painleve.asymptotics.ball_arithmetic import BITS, is_inside
from painleve.asymptotics.local import LocalProblem, make_local_problem
from painleve.asymptotics.member import Member, base_balls, distance_to_point, make_member, row_balls
from painleve.asymptotics.space.witness import path_bound, path_members
from painleve.core.codes import ContactMode
from painleve.errors import InputError
from painleve.sets import Bounds
from painleve.theory.domain import check_domain
from painleve.theory.limit_set import LimitSet

__all__ = ["Family", "Witness", "find_family", "find_witness"]

# Of the ball's radius: by what, and how far, configurations are drawn towards q. In space a path over q_eps comes
# within sqrt(gamma(q_eps)) of A only: it takes configurations so much nearer.
STEP, SMALLEST_STEP = 2.0**-1, 2.0**-40
SPACE_STEP, SMALLEST_SPACE_STEP = 2.0**-8, 2.0**-240
TILTS = (0.5, 0.1, 0.01)  # towards penetration, where a direction alone would leave contact


@dataclass(frozen=True, kw_only=True, eq=False)
class Witness:
    """A member of A_eps, with an enclosure of its distance to v_bar = u- + fraction (u_tilde - u-); or why none."""

    fraction: float
    eps: float
    member: Member | None
    distance: tuple[float, float] | None
    reason: str

    def __repr__(self) -> str:
        found = f"distance {Bounds.between(*self.distance)}" if self.distance is not None else "none found"
        return f"Witness(fraction = {self.fraction:g}, eps = {self.eps:g}, {found})"


@dataclass(frozen=True, kw_only=True, eq=False)
class Family:
    """Members over one q_eps that shadow the whole segment.

    `bound`: upper bound on the distance of any point of A to these members, hence on e(A, A_eps). In the plane
    lambda_bar -> S(q_eps, v(lambda_bar)) is affine, and the distance between two affine images is convex: the two ends
    decide. In space the path is curved (painleve.asymptotics.space.witness).
    """

    first: Member
    last: Member
    bound: float

    def __repr__(self) -> str:
        return f"Family(e(A, A_eps) {Bounds.at_most(self.bound)})"


def find_witness(limit: LimitSet, fraction: float, eps: float, *, within: float) -> Witness:
    """A witness for v_bar with distance <= `within`, if there is one.

    Raises InputError for a fraction outside [0, 1], eps or `within` <= 0, a v_bar that is not in A, and a ball on which
    the law is not proved to be defined (painleve.theory.domain).
    """
    _check(limit, fraction, eps, within)
    problem = make_local_problem(limit)
    if fraction == 0.0 or limit.kind == "point":
        return _witness(problem, fraction, eps, make_member(problem, _zeros(problem), _zeros(problem)), "u- itself")
    if fraction == 1.0:
        return _witness(problem, fraction, eps, *_towards_sticking(problem, eps, within))
    if limit.kind == "pair":
        raise InputError(f"fraction: {fraction} is not in A = {{u-, u_tilde}}; give 0 or 1")
    for dq in _positive_neighbours(problem, eps):
        member = _slipping_member(problem, dq, fraction, eps)
        if member is not None and distance_to_point(problem, member, fraction)[1] <= within:
            return _witness(problem, fraction, eps, member, "gamma(q_eps) > 0, v_n = -lambda_bar (a + s b)(q_eps)")
    reason = "no touching or penetrating configuration with gamma > 0 was found near q: none exists if q is isolated"
    return Witness(fraction=fraction, eps=eps, member=None, distance=None, reason=reason)


def find_family(limit: LimitSet, eps: float, *, within: float) -> Family | None:
    """Members that shadow all of A within a bound <= `within`: for a pair its two ends, for a segment one family.

    None where the construction finds no such members (a critical state that is isolated).
    """
    _check(limit, 0.0, eps, within)
    problem = make_local_problem(limit)
    start = make_member(problem, _zeros(problem), _zeros(problem))
    if limit.kind == "point":
        return Family(first=start, last=start, bound=0.0)
    if limit.kind == "pair":
        end, _ = _towards_sticking(problem, eps, within)
        return Family(first=start, last=end, bound=distance_to_point(problem, end, 1.0)[1])
    for dq in _positive_neighbours(problem, eps):
        family = _family_over(problem, dq, eps)
        if family is not None and family.bound <= within:
            return family
    return None


def _check(limit: LimitSet, fraction: float, eps: float, within: float) -> None:
    if limit.kind == "undecided":
        raise InputError(f"state {limit.state.label}: no witnesses for a limit set that is undecided: {limit.reason}")
    if not 0.0 <= fraction <= 1.0:
        raise InputError(f"fraction: {fraction} must be between 0 (u-) and 1 (u_tilde)")
    for name, value in (("eps", eps), ("within", within)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"{name}: {value} must be a positive number")
    check_domain(limit.state, eps)


def _zeros(problem: LocalProblem) -> list[flint.arb]:
    return [flint.arb(0)] * problem.dimension


def _witness(problem: LocalProblem, fraction: float, eps: float, member: Member, reason: str) -> Witness:
    distance = distance_to_point(problem, member, fraction)
    return Witness(fraction=fraction, eps=eps, member=member, distance=distance, reason=reason)


def _towards_sticking(problem: LocalProblem, eps: float, within: float) -> tuple[Member, str]:
    """At q itself, v_n -> 0-: the tip sticks, and S is as near to u_tilde as v is to u-, up to a constant."""
    inward = problem.normal / np.linalg.norm(problem.normal)
    size, ratio = 0.5 * eps, STEP if problem.section.affine else SPACE_STEP
    while size > 0.0:
        member = make_member(problem, _zeros(problem), [flint.arb(float(-size * x)) for x in inward])
        if distance_to_point(problem, member, 1.0)[1] <= within:
            return member, "q_eps = q and v_n -> 0-"
        size *= ratio
    raise ArithmeticError(f"no sticking member within {within} of u_tilde: the distance asked for is below rounding")


def _positive_neighbours(problem: LocalProblem, eps: float) -> Iterator[list[flint.arb]]:
    """Exact offsets of configurations in the ball, nearer and nearer to q, with g >= 0 and gamma > 0 proved."""
    if not problem.analytic:
        return  # no derivatives say in which directions gamma grows
    directions = list(_directions(problem))
    ratio, smallest = (STEP, SMALLEST_STEP) if problem.section.affine else (SPACE_STEP, SMALLEST_SPACE_STEP)
    step = 0.5
    while step >= smallest:
        for direction, follow in directions:
            dq = [flint.arb(float(step * eps * x)) for x in direction]
            if follow:
                dq = _onto_constraint(problem, dq, step * eps)
            if _admits_slip(problem, dq) and is_inside(dq, eps):
                yield dq
                break
        step *= ratio


def _directions(problem: LocalProblem) -> Iterator[tuple[np.ndarray, bool]]:
    """Unit directions in which gamma may grow while g >= 0, and whether the constraint must be followed there."""
    grad_p, form_p, grad_g, form_g = _derivatives(problem)
    normal = grad_g / np.linalg.norm(grad_g)
    along = grad_p - min(0.0, float(grad_p @ normal)) * normal
    candidates = [along / np.linalg.norm(along)] if np.linalg.norm(along) > 1e-9 * np.linalg.norm(form_p) else []
    vectors = np.linalg.eigh(form_p)[1].T[::-1]
    candidates += [sign * v for v in vectors for sign in (1.0, -1.0)]
    for direction in candidates:
        if direction @ normal > 1e-9:
            yield direction, False
        for tilt in TILTS:
            yield _unit(direction + tilt * normal), False
    kappa = -float(grad_p @ normal) / float(np.linalg.norm(grad_g))
    tangent = np.eye(len(normal)) - np.outer(normal, normal)
    form = tangent @ (form_p + kappa * form_g) @ tangent
    for direction in np.linalg.eigh(form)[1].T[::-1]:
        yield _unit(tangent @ direction), True
        yield -_unit(tangent @ direction), True


def _unit(x: np.ndarray) -> np.ndarray:
    size = float(np.linalg.norm(x))
    return x / size if size > 0.0 else x


def _derivatives(problem: LocalProblem) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Gradient and Hessian of the critical edge's compliance and of g, in all coordinates."""
    rows = problem.kernels.rows
    grad_p, form_p = _second_order(problem, rows.edges[problem.limit.edge])
    _, form_g = _second_order(problem, rows.parts.g)
    return grad_p, form_p, -problem.normal, form_g


def _second_order(problem: LocalProblem, row: int) -> tuple[np.ndarray, np.ndarray]:
    d = problem.dimension
    gradient, form = np.zeros(d), np.zeros((d, d))
    if row not in problem.kernels.rows.varying:
        return gradient, form
    for powers, value in zip(problem.powers, problem.table[problem.kernels.rows.varying.index(row)], strict=True):
        axes = [problem.shape[j] for j, power in enumerate(powers) for _ in range(power)]
        if len(axes) == 1:
            gradient[axes[0]] = value
        elif len(axes) == 2:
            form[axes[0], axes[1]] += value
            form[axes[1], axes[0]] += value
    return gradient, form


def _onto_constraint(problem: LocalProblem, dq: list[flint.arb], size: float) -> list[flint.arb]:
    """Newton steps along grad g onto a slight penetration, g = 1e-9 size^2: gamma changes by no more than that."""
    grad_g = -problem.normal
    squared = float(grad_g @ grad_g)
    with flint.ctx.workprec(BITS):
        wanted = flint.arb(1e-9) * flint.arb(float(size)) ** 2
        for _ in range(4):
            lack = (wanted - row_balls(problem, dq)[problem.parts.g]) / squared
            dq = [flint.arb((x + lack * float(y)).mid()) for x, y in zip(dq, grad_g, strict=True)]
    return dq


def _admits_slip(problem: LocalProblem, dq: list[flint.arb]) -> bool:
    rows = row_balls(problem, dq)
    return bool(rows[problem.parts.g] >= 0) and bool(rows[problem.kernels.rows.edges[problem.limit.edge]] > 0)


def _slipping_velocity(problem: LocalProblem, dq: list[flint.arb], fraction: float) -> list[flint.arb]:
    """The least dv with v_n = -fraction lambda_tilde (a + s b)(q_eps)."""
    edge = problem.kernels.rows.edges[problem.limit.edge]
    with flint.ctx.workprec(BITS):
        rows, (_, _, u), impulse = row_balls(problem, dq), base_balls(problem), problem.exact_multiplier
        w_n = rows[problem.parts.w_n]
        v_n = sum((x * y for x, y in zip(w_n, u, strict=True)), flint.arb(0))
        excess = v_n + flint.arb(float(fraction)) * impulse * rows[edge]
        squared = sum((x * x for x in w_n), flint.arb(0))
        return [flint.arb((-excess * x / squared).mid()) for x in w_n]


def _slipping_member(problem: LocalProblem, dq: list[flint.arb], fraction: float, eps: float) -> Member | None:
    dv = _slipping_velocity(problem, dq, fraction)
    if not is_inside(dv, eps):
        return None
    try:
        return make_member(problem, dq, dv)
    except ArithmeticError:
        return None


def _path_over(problem: LocalProblem, dq: list[flint.arb], eps: float) -> Family | None:
    """A path of members over one configuration that shadows the segment."""
    found = path_members(problem, dq, partial(_slipping_member, eps=eps))
    if found is None:
        return None
    first, last, reach = found
    return Family(first=first, last=last, bound=path_bound(problem, dq, first, last, reach))


def _family_over(problem: LocalProblem, dq: list[flint.arb], eps: float) -> Family | None:
    """Members over one configuration from lambda_bar = 0+ to nearly lambda_tilde, all of them slipping."""
    if not problem.section.affine:
        return _path_over(problem, dq, eps)
    slip = ContactMode.SLIP_PLUS if problem.limit.edge == 1 else ContactMode.SLIP_MINUS
    size = max(abs(float(x.mid())) for x in dq)
    first = _slipping_member(problem, dq, size, eps)
    if first is None or first.branch is not slip:
        return None
    gap = 0.0
    while gap < 0.5:
        last = _slipping_member(problem, dq, 1.0 - gap, eps)
        if last is not None and last.branch is slip:
            ends = (0.0, size, 1.0 - gap, 1.0)
            members = (first, first, last, last)
            bound = max(distance_to_point(problem, m, f)[1] for m, f in zip(members, ends, strict=True))
            return Family(first=first, last=last, bound=bound)
        gap = 2.0 * gap if gap else size
    return None
