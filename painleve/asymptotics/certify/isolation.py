"""e(A, A_eps) on both sides at an isolated critical state: the middle of A = [u-, u_tilde] stays away from A_eps.

No slip on the critical edge: p = a + s b < 0 at every other configuration of the ball in contact. With x = q_eps - q,
P = det(M) p, and P + kappa g without a gradient, one of these is shown in every direction of x, in ball arithmetic:
    P(x)/|x| < 0,      or      (P + kappa g)(x)/|x|^2 < 0 where g >= 0,      or      g(x)/|x| < 0,
the last one where no coordinate but those of x can raise g (kappa = 0 where one can).
The members are then free, B(u-, eps), or stick near u_tilde, or slip on the other edge near u-. With a radius R around
u- that holds all members but the sticking ones, and -a.(S - u_tilde) <= eps r over those for a unit vector a, the point
u- + t d, d the direction of A, is at least min(t - R, (L - t) a.d - eps r) away from A_eps; t and a are chosen.
Members near both ends bound e(A, A_eps) from above.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod

import flint
import numpy as np

from painleve.asymptotics.ball_arithmetic import BITS
from painleve.asymptotics.certify.branch_and_bound import BoxSearch
from painleve.asymptotics.certify.pieces import stick_piece
from painleve.asymptotics.certify.preimage import candidate_member
from painleve.asymptotics.local import LocalProblem
from painleve.asymptotics.member import Member, base_balls, make_member
from painleve.asymptotics.witness import find_witness
from painleve.errors import InputError
from painleve.exact.jets import Jet, jets
from painleve.sets import excess_of_segment_from_profile
from painleve.theory.neighbourhood import smooth_indicator

__all__ = ["Apart", "members_apart", "slips_nowhere"]

SECTORS = 2048
TURNS = 4  # of the supporting direction towards the nearest sticking member
CLOSE = 1e-6  # to u_tilde, of one sticking member, in units of eps
REACH = 1e-9  # how sharply the reach of the sticking members is asked for, in units of eps
ROUNDING = 1e-12


@dataclass(frozen=True, kw_only=True, eq=False)
class Apart:
    """lower <= e(A, A_eps) <= upper, and the member nearest to the point of A (d,) that decides the upper bound."""

    lower: float
    upper: float
    member: Member
    point: np.ndarray


def slips_nowhere(problem: LocalProblem, eps: float) -> bool:
    """Whether p < 0 is shown for every q_eps != q of the ball in contact; False: it was not shown.

    The state is critical and isolated: grad p = -kappa grad g holds exactly.
    """
    try:
        forms = _Forms(problem, eps)
    except InputError:  # P or g has no expansion on the ball
        return False
    return all(forms.excludes(direction) for direction in _sectors(len(problem.shape)))


def members_apart(problem: LocalProblem, eps: float, radius: float, effort: int) -> Apart:
    """Bounds on e(A, A_eps) where no member slips on the critical edge; the others but the sticking ones are within
    `radius` of u-. `effort`: rounds of branch and bound for each supporting direction."""
    d, length = problem.direction, problem.length
    sticking = find_witness(problem.limit, 1.0, eps, within=CLOSE * eps).member
    members = [m for m in (make_member(problem, *_free_along(problem, eps)), sticking) if m is not None]
    lower, a = 0.0, d
    for _ in range(TURNS):
        reach, member = _reach(problem, eps, a, effort)
        along = float(a @ d) * (1.0 - ROUNDING)
        place = (along * length - eps * reach + radius) / (1.0 + along)
        lower = max(lower, (place - radius) * (1.0 - ROUNDING))
        if member is None:
            break
        members.append(member)
        towards = (length - place) * d + _from_end(problem, member)
        a = towards / np.linalg.norm(towards)
    return _with_upper(problem, members, lower)


def _with_upper(problem: LocalProblem, members: Sequence[Member], lower: float) -> Apart:
    """From above by the members themselves: their places along the line through A and distances from it."""
    d, length = problem.direction, problem.length
    along = np.array([m.offset @ d for m in members])
    across = np.array([np.linalg.norm(m.offset - x * d) for m, x in zip(members, along, strict=True)])
    value, place, nearest = excess_of_segment_from_profile(along, across, length)
    upper = value * (1.0 + ROUNDING) + ROUNDING * length
    return Apart(lower=max(0.0, lower), upper=upper, member=members[nearest], point=problem.u + place * d)


def _free_along(problem: LocalProblem, eps: float) -> tuple[np.ndarray, np.ndarray]:
    """(dq, dv) of the free member that is farthest along A."""
    grad_g = -problem.normal
    return -0.1 * eps * grad_g / np.linalg.norm(grad_g), eps * (1.0 - 1e-15) * problem.direction


def _from_end(problem: LocalProblem, member: Member) -> np.ndarray:
    return member.offset - problem.length * problem.direction


def _reach(problem: LocalProblem, eps: float, a: np.ndarray, effort: int) -> tuple[float, Member | None]:
    """An upper bound on -a.(S - u_tilde)/eps over the sticking members, and the member that goes farthest."""
    search = BoxSearch(stick_piece(problem, eps, -a))
    for _ in range(effort):
        best = search.best.value if search.best is not None else 0.0
        if search.pending <= best + REACH:
            break
        search.refine(best + REACH, 64)
    return search.upper, None if search.best is None else candidate_member(problem, eps, search.best)


class _Forms:
    """P and g to third order: gradient and second-order terms at q, third-order terms over the whole ball."""

    def __init__(self, problem: LocalProblem, eps: float) -> None:
        self.eps, self.variables = eps, len(problem.shape)
        scene, limit = problem.kernels.scene, problem.limit
        expressions = [smooth_indicator(scene, limit.edge), scene.contact.constraint]
        variables = [scene.q[i] for i in problem.shape]
        q, p, _ = base_balls(problem)
        point = dict(zip(scene.q, q, strict=True)) | dict(zip([x.symbol for x in scene.parameters], p, strict=True))
        with flint.ctx.workprec(BITS):
            ball = point | {x: point[x] + flint.arb(0, eps) for x in variables}
        self.P, self.g = self._orders(
            jets(expressions, variables, point, 2, bits=BITS), jets(expressions, variables, ball, 3, bits=BITS)
        )
        self.carried = problem.carried > 0.0
        self.kappa = flint.arb(0) if self.carried else self._kappa()

    def _orders(self, near: list[Jet], wide: list[Jet]) -> list[list[dict[tuple[int, ...], flint.arb]]]:
        tables = []
        for x, y in zip(near, wide, strict=True):
            orders = [{k: v for k, v in x.terms.items() if sum(k) == n} for n in (1, 2)]
            tables.append([*orders, {k: v for k, v in y.terms.items() if sum(k) == 3}])
        return tables

    def _kappa(self) -> flint.arb:
        """grad P = -kappa grad g; the identity itself was decided exactly."""
        with flint.ctx.workprec(BITS):
            products = [(self.P[0].get(k, flint.arb(0)) * v, v * v) for k, v in self.g[0].items()]
            return -sum((x for x, _ in products), flint.arb(0)) / sum((y for _, y in products), flint.arb(0))

    def excludes(self, e: Sequence[flint.arb]) -> bool:
        """One of the three inequalities, for every x in that sector of the ball."""
        with flint.ctx.workprec(BITS):
            size = flint.arb(self.eps) * flint.arb("0.5 +/- 0.5")
            P, g = [_form(t, e) for t in self.P], [_form(t, e) for t in self.g]
            first_order = (f[0] + size * (f[1] + size * f[2]) for f in ((P,) if self.carried else (P, g)))
            if any(f < 0 for f in first_order):
                return True
            return bool(P[1] + self.kappa * g[1] + size * (P[2] + self.kappa * g[2]) < 0)


def _form(terms: dict[tuple[int, ...], flint.arb], e: Sequence[flint.arb]) -> flint.arb:
    total = flint.arb(0)
    for powers, value in terms.items():
        total += prod((x**k for x, k in zip(e, powers, strict=True)), start=value)
    return total


def _sectors(variables: int) -> list[list[flint.arb]]:
    """Directions of x: both senses of a line, or sectors of the plane."""
    if variables == 1:
        return [[flint.arb(1)], [flint.arb(-1)]]
    with flint.ctx.workprec(BITS):
        width = 2 * flint.arb.pi() / SECTORS
        angles = [width * k + width * flint.arb("0.5 +/- 0.5") for k in range(SECTORS)]
        return [[x.cos(), x.sin()] for x in angles]
