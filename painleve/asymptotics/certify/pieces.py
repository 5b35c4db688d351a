"""A_eps but for its free members, cut into pieces on which the law is affine in the velocity.

With q_eps = q + eps xi and v_eps = u- + eps w, |xi|, |w| <= 1, the members of a piece are base + eps z, where base is
u- or u_tilde and, for functions c, Q, y, e, m, l of xi that are formed without cancellation,

    z = c + Q w + lam y,    e_k + m_k.w + lam l_k <= 0 (= 0 for the first one of a slip),    lower <= lam <= upper.

Sticking: S = P v with P = 1 - Y G^-1 W^T, where v_n <= 0 and the impulse is in the cone. Slip on the edge s:
S = v + Lambda Y rho with Lambda = -v_n/p >= 0, p = a + s b > 0, and the slip not reversed. Where p may vanish Lambda
is a variable of its own, and v_n + Lambda p = 0 is a constraint: nothing is divided by p. `lam` is Lambda itself (for
the distance from the line through A), Lambda/eps (near u-) or (Lambda - Lambda_tilde)/eps (near u_tilde).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import flint
import numpy as np

from painleve.asymptotics.ball_arithmetic import BITS
from painleve.asymptotics.certify.cover import Cover
from painleve.asymptotics.certify.taylor_models import Models, TaylorModel, expand, make_models, taylor_order
from painleve.asymptotics.local import LocalProblem
from painleve.asymptotics.member import base_balls, jump_balls
from painleve.core.codes import ContactMode
from painleve.core.sections.segment import undivided_stop
from painleve.errors import InputError

__all__ = ["Constraint", "Map", "Piece", "contact_pieces", "stick_piece"]

Directions = Literal["sphere", "beyond", "across", "single"]


@dataclass(frozen=True)
class Constraint:
    """e + m.w + lam l <= 0."""

    e: TaylorModel
    m: Sequence[TaylorModel]
    l: TaylorModel  # noqa: E741 (stands beside e and m)


@dataclass(frozen=True)
class Map:
    """z = c + Q w + lam y."""

    c: Sequence[TaylorModel]
    Q: Sequence[Sequence[TaylorModel]]
    y: Sequence[TaylorModel]


@dataclass(frozen=True, kw_only=True, eq=False)
class Piece:
    """One piece, with the distance that is maximised over it.

    models: the functions c (d), Q (d d), y (d), then e, m (d), l of each constraint, then g/eps and p.
    frame: orthonormal rows; directions: all unit vectors of their span (`sphere`; `across`: orthogonal to A), those
    with a non-negative first component (`beyond` an end of A), or the first row alone (`single`).
    lam: range of the extra variable, None if there is none; then Lambda = shift + unit lam.
    carried: norm of dg with respect to the carried coordinates, which are not among xi; slipping: p > 0 is demanded.
    """

    branch: ContactMode
    label: str
    models: Models
    constraints: int
    equality: bool
    lam: tuple[float, float] | None
    frame: np.ndarray
    directions: Directions
    carried: float
    slipping: bool
    shift: float
    unit: float

    @property
    def dimension(self) -> int:
        return int(self.frame.shape[1])


class _Build:
    """The functions that the pieces share, on the ball of radius eps."""

    def __init__(self, problem: LocalProblem, eps: float) -> None:
        self.problem, self.eps, self.d = problem, eps, problem.dimension
        self.u, self.jump = base_balls(problem)[2], jump_balls(problem)
        self.inverse_eps = 1 / flint.arb(float(eps))
        scene, derivation, d = problem.kernels.scene, problem.kernels.derivation, self.d
        adjugate = scene.inertia.adjugate()  # expanded before it is divided by det M: remainders stay small
        expressions = [scene.contact.constraint, scene.inertia.det(method="berkowitz"), *derivation.normal]
        expressions += [*(adjugate * derivation.normal)]
        H, edges = scene.contact.tangents, scene.contact.section.edges
        expressions += [*H, *(adjugate * H), *(derivation.edge_direction(edge)[0] for edge in edges)]
        found = expand(problem, eps, expressions, taylor_order(len(problem.shape), eps))
        inverse = found[1].reciprocal()
        self.zero = found[0].scale(flint.arb(0))
        self.one = self.zero.shift(flint.arb(1))
        self.g = self.scaled(found[0].vanishing())
        self.w_n, self.Y_n = found[2 : 2 + d], [f * inverse for f in found[2 + d : 2 + 2 * d]]
        self.nu = self.scaled(self.dot(self.w_n, self.u).vanishing())
        self.a = self.product(self.w_n, self.Y_n)
        self.frictional = bool(edges)
        if self.frictional:
            self.H, self.Y_t = found[2 + 2 * d : 2 + 3 * d], [f * inverse for f in found[2 + 3 * d : 2 + 4 * d]]
            self.s = dict(zip(edges, found[2 + 4 * d :], strict=True))
            self.b, self.C = self.product(self.w_n, self.Y_t), self.product(self.H, self.Y_t)
            self.eta = self.dot(self.H, self.u)
            self.one_over_det = (self.a * self.C - self.b * self.b).reciprocal()

    def product(self, f: Sequence[TaylorModel], g: Sequence[TaylorModel]) -> TaylorModel:
        total = self.zero
        for x, y in zip(f, g, strict=True):
            total = total + x * y
        return total

    def dot(self, f: Sequence[TaylorModel], x: Sequence[flint.arb]) -> TaylorModel:
        total = self.zero
        for g, value in zip(f, x, strict=True):
            total = total + g.scale(value)
        return total

    def scaled(self, f: TaylorModel) -> TaylorModel:
        return f.scale(self.inverse_eps)

    def contact(self) -> Cover:
        """Boxes of xi outside which g < 0, whatever the carried coordinates are."""
        cover = Cover(len(self.problem.shape))
        room = self.problem.carried * np.sqrt(np.maximum(0.0, 1.0 - cover.nearest**2)) * (1.0 + 1e-12)
        cover.keep(cover.bounds([self.g])[1][:, 0] + room >= 0.0)
        return cover

    def edge(self, sense: int) -> TaylorModel:
        """p = a + s b, exactly zero at the base of a critical state."""
        p = self.a + self.s[sense] * self.b
        return p.vanishing() if self.problem.critical_edge == sense else p

    def identity(self) -> list[list[TaylorModel]]:
        return [[self.one if i == j else self.zero for j in range(self.d)] for i in range(self.d)]

    def normal_constraint(self) -> Constraint:
        """v_n <= 0, over eps."""
        return Constraint(self.nu, self.w_n, self.zero)

    def stick_impulse(self, v_n: TaylorModel, v_t: TaylorModel) -> tuple[TaylorModel, TaylorModel]:
        """-G^-1 (v_n, v_t)."""
        r_n, r_t = undivided_stop(self.a, self.b, self.C, v_n, v_t)
        return r_n * self.one_over_det, r_t * self.one_over_det

    def cone_constraint(self, sense: int, sign: int) -> Constraint:
        """sign sense (r_t - s r_n) <= 0 for the sticking impulse: on the cone's side of that edge (sign = 1) or not."""
        factor = flint.arb(sign * sense)
        s = self.s[sense]

        def beyond(v_n: TaylorModel, v_t: TaylorModel) -> TaylorModel:
            r_n, r_t = self.stick_impulse(v_n, v_t)
            return (r_t - s * r_n).scale(factor)

        e = beyond(self.dot(self.w_n, self.u).vanishing(), self.eta)
        e = e.vanishing() if self.problem.critical_edge == sense else e
        return Constraint(self.scaled(e), [beyond(n, t) for n, t in zip(self.w_n, self.H, strict=True)], self.zero)

    def stick_map(self) -> Map:
        """S - u_tilde where there is a jump, else S - u-.

        With as many coordinates as directions of the contact, sticking stops them all: S = 0, which is u_tilde.
        """
        jumps = self.problem.multiplier > 0.0
        if self.d == 2:
            c = [self.zero if jumps else self.scaled(self.zero.shift(-x)) for x in self.u]
            return Map(c, [[self.zero] * self.d] * self.d, [self.zero] * self.d)
        c = []
        r_n, r_t = self.stick_impulse(self.dot(self.w_n, self.u).vanishing(), self.eta)
        for y_n, y_t, step in zip(self.Y_n, self.Y_t, self.jump, strict=True):
            moved = (y_n * r_n + y_t * r_t).shift(-step)
            c.append(self.scaled(moved.vanishing() if jumps else moved))
        Q = self.identity()
        for j in range(self.d):
            r_n, r_t = self.stick_impulse(self.w_n[j], self.H[j])
            for i in range(self.d):
                Q[i][j] = Q[i][j] + self.Y_n[i] * r_n + self.Y_t[i] * r_t
        return Map(c, Q, [self.zero] * self.d)

    def ray(self, sense: int) -> list[TaylorModel]:
        """Y rho, rho = (1, s)."""
        s = self.s[sense]
        return [n + s * t for n, t in zip(self.Y_n, self.Y_t, strict=True)]

    def impact_map(self, ray: Sequence[TaylorModel], p: TaylorModel) -> Map:
        """S - u- with Lambda = -v_n/p, where p is positive on the ball."""
        inverse = p.reciprocal()
        gain = [(y * inverse).scale(flint.arb(-1)) for y in ray]
        Q = self.identity()
        for i in range(self.d):
            for j in range(self.d):
                Q[i][j] = Q[i][j] + gain[i] * self.w_n[j]
        return Map([x * self.nu for x in gain], Q, [self.zero] * self.d)

    def frame(self, directions: Directions) -> np.ndarray:
        """Rows: the direction of the jump (left out for `across`), and a basis of its complement."""
        first = self.problem.direction if self.problem.length > 0.0 else np.eye(self.d)[0]
        rest = np.linalg.svd(first[None, :])[2][1:]
        return rest if directions == "across" else np.vstack([first, rest])

    def piece(
        self,
        branch: ContactMode,
        label: str,
        map_: Map,
        constraints: Sequence[Constraint],
        directions: Directions,
        *,
        p: TaylorModel | None = None,
        lam: tuple[float, float] | None = None,
        equality: bool = False,
        shift: float = 0.0,
        unit: float = 1.0,
    ) -> Piece:
        functions = [*map_.c, *(f for row in map_.Q for f in row), *map_.y]
        for constraint in constraints:
            functions += [constraint.e, *constraint.m, constraint.l]
        models = make_models([*functions, self.g, p if p is not None else self.one])
        return Piece(
            branch=branch,
            label=label,
            models=models,
            constraints=len(constraints),
            equality=equality,
            lam=lam,
            frame=self.frame(directions),
            directions=directions,
            carried=self.problem.carried,
            slipping=p is not None,
            shift=shift,
            unit=unit,
        )


def contact_pieces(problem: LocalProblem, eps: float) -> Iterator[Piece]:
    """The pieces of members in contact, each with every distance that may be its distance to A.

    Raises InputError where the ball is too large for expansions to converge, or the scene has too many coordinates.
    """
    with flint.ctx.workprec(BITS):
        build = _Build(problem, eps)
        if not build.frictional:
            yield _impact(build)
            return
        yield from _sticking(build)
        for sense, branch in ((1, ContactMode.SLIP_PLUS), (-1, ContactMode.SLIP_MINUS)):
            yield from _slipping(build, sense, branch)


def stick_piece(problem: LocalProblem, eps: float, direction: np.ndarray) -> Piece:
    """The sticking members, for the largest direction.(S - u_tilde)/eps over them."""
    with flint.ctx.workprec(BITS):
        piece = next(_sticking(_Build(problem, eps)))
    return replace(piece, frame=direction[None, :], directions="single", label="sticking, along one direction")


def _impact(build: _Build) -> Piece:
    map_ = build.impact_map(build.Y_n, build.a)
    return build.piece(ContactMode.FRICTIONLESS, "impact", map_, [build.normal_constraint()], "sphere")


def _sticking(build: _Build) -> Iterator[Piece]:
    map_ = build.stick_map()
    constraints = [build.normal_constraint(), build.cone_constraint(1, 1), build.cone_constraint(-1, 1)]
    near_end = build.eps * _longest_value(build, map_) < build.problem.length  # so no member is beyond the other end
    if build.problem.limit.kind == "segment" and near_end:
        yield build.piece(ContactMode.STICK, "sticking, beyond u_tilde", map_, constraints, "beyond")
        yield build.piece(ContactMode.STICK, "sticking, beside A", map_, constraints, "across")
    else:
        yield build.piece(ContactMode.STICK, "sticking", map_, constraints, "sphere")


def _longest_value(build: _Build, map_: Map) -> float:
    """A bound on |c + Q w|."""
    lower, upper = build.contact().bounds([*map_.c, *(f for row in map_.Q for f in row)])
    size = np.maximum(np.abs(lower), np.abs(upper))
    return float((np.linalg.norm(size[:, : build.d], axis=1) + np.linalg.norm(size[:, build.d :], axis=1)).max())


def _slipping(build: _Build, sense: int, branch: ContactMode) -> Iterator[Piece]:
    p, cover = build.edge(sense), build.contact()
    lowest, highest = cover.bounds([p])
    if lowest.min() > 0.0:
        constraints = [build.normal_constraint(), build.cone_constraint(sense, -1)]
        map_ = build.impact_map(build.ray(sense), p)
        yield build.piece(branch, f"{branch.label}, from u-", map_, constraints, "sphere")
        return
    cover.keep(highest[:, 0] >= 0.0)
    if len(cover.xi):
        yield from _slipping_near_zero(build, cover, sense, branch, p)


def _slipping_near_zero(
    build: _Build, cover: Cover, sense: int, branch: ContactMode, p: TaylorModel
) -> Iterator[Piece]:
    """Slip where p may vanish: Lambda runs from 0 to where the tip comes to rest."""
    eps, problem = build.eps, build.problem
    ray = build.ray(sense)
    stop = (build.b + build.C * build.s[sense]).scale(flint.arb(sense))
    slip = build.eta.scale(flint.arb(sense))
    most = _longest(build, cover, slip, stop, p)
    normal = Constraint(build.nu, build.w_n, p)
    tangents = [h.scale(flint.arb(sense)) for h in build.H]
    near = Map([build.zero] * build.d, build.identity(), ray)
    from_start = [normal, Constraint(build.scaled(slip), tangents, stop)]
    name = branch.label
    if problem.limit.kind == "point" or sense != problem.limit.edge:
        yield build.piece(
            branch, f"{name}, from u-", near, from_start, "sphere", p=p, lam=(0.0, most / eps), equality=True, unit=eps
        )
        return
    from_end, end = _towards_the_end(build, sense, p, ray, slip, stop)
    total = problem.multiplier
    if problem.limit.kind == "pair":
        yield build.piece(
            branch,
            f"{name}, from u-",
            near,
            from_start,
            "sphere",
            p=p,
            lam=(0.0, total / (2.0 * eps)),
            equality=True,
            unit=eps,
        )
        lam = (-total / (2.0 * eps), (most - total) / eps)
        yield build.piece(
            branch, f"{name}, from u_tilde", end, from_end, "sphere", p=p, lam=lam, equality=True, shift=total, unit=eps
        )
        return
    drift = [build.scaled(y.shift(-y.near.constant()).vanishing()) for y in ray]
    beside = [
        Constraint(build.nu, build.w_n, build.scaled(p)),
        Constraint(slip, [t.scale(flint.arb(eps)) for t in tangents], stop),
    ]
    across = Map([build.zero] * build.d, build.identity(), drift)
    yield build.piece(branch, f"{name}, beside A", across, beside, "across", p=p, lam=(0.0, most), equality=True)
    # A member is beyond an end of A only if its impulse is within O(eps) of that end's.
    forward = _positive(build, cover, _along(build, ray))
    turned = build.piece(
        branch,
        f"{name}, beyond u-",
        near,
        from_start,
        "beyond",
        p=p,
        lam=(0.0, 1.001 / forward),
        equality=True,
        unit=eps,
    )
    yield replace(turned, frame=turned.frame * np.array([-1.0] + [1.0] * (build.d - 1))[:, None])
    reach = max(abs(x) for x in _along(build, end.c).bounds)
    lam = (-1.001 * (1.0 + reach) / forward, (most - total) / eps)
    yield build.piece(
        branch, f"{name}, beyond u_tilde", end, from_end, "beyond", p=p, lam=lam, equality=True, shift=total, unit=eps
    )


def _towards_the_end(
    build: _Build, sense: int, p: TaylorModel, ray: Sequence[TaylorModel], slip: TaylorModel, stop: TaylorModel
) -> tuple[list[Constraint], Map]:
    """The same members written from u_tilde: Lambda = Lambda_tilde + eps lam."""
    impulse, critical = build.problem.exact_multiplier, build.problem.critical_edge == sense
    moved = [y.scale(impulse).shift(-step) for y, step in zip(ray, build.jump, strict=True)]
    rest = slip + stop.scale(impulse)
    if critical:
        moved, rest = [f.vanishing() for f in moved], rest.vanishing()
    tangents = [h.scale(flint.arb(sense)) for h in build.H]
    constraints = [
        Constraint(build.nu + build.scaled(p.scale(impulse)), build.w_n, p),
        Constraint(build.scaled(rest), tangents, stop),
    ]
    return constraints, Map([build.scaled(f) for f in moved], build.identity(), ray)


def _longest(build: _Build, cover: Cover, slip: TaylorModel, stop: TaylorModel, p: TaylorModel) -> float:
    """The largest impulse: Lambda p = -v_n, and slip + eps H.w + Lambda stop <= 0 (with the sense's sign)."""
    lower, upper = cover.bounds([p, stop, slip, build.nu, *build.w_n, *build.H])
    size, d = np.maximum(np.abs(lower), np.abs(upper)), build.d
    normal = build.eps * (size[:, 3] + np.linalg.norm(size[:, 4 : 4 + d], axis=1))
    rest = np.maximum(build.eps * np.linalg.norm(size[:, 4 + d :], axis=1) - lower[:, 2], 0.0)
    bounds = [
        np.where(f > 0.0, x / np.where(f > 0.0, f, 1.0), np.inf)
        for f, x in ((lower[:, 0], normal), (lower[:, 1], rest))
    ]
    most = float(np.minimum(*bounds).max())
    if not np.isfinite(most):
        raise _too_large(build)
    return 1.001 * most + build.eps


def _along(build: _Build, f: Sequence[TaylorModel]) -> TaylorModel:
    """The component along the jump."""
    return build.dot(f, [flint.arb(float(x)) for x in build.problem.direction])


def _positive(build: _Build, cover: Cover, f: TaylorModel) -> float:
    lowest = float(cover.bounds([f])[0].min())
    if lowest <= 0.0:
        raise _too_large(build)
    return lowest


def _too_large(build: _Build) -> InputError:
    return InputError(
        f"certify: eps = {build.eps:g} is too large at this state: the law changes its kind in the ball; use sample"
    )
