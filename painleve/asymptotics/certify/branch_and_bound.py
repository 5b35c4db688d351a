"""Upper bounds on the distance over one piece of A_eps, by branch and bound with a Lagrangian bound on each box.

For a unit vector a and fixed (xi, lam) the largest a.z over the velocities is that of a linear function on a ball cut
by half-spaces. Weak duality: for every choice of multipliers sigma (>= 0 for an inequality)

    a.z <= U = |Q^T a - sum sigma_k m_k| + a.c - sum sigma_k e_k + lam (a.y - sum sigma_k l_k),

so floating-point multipliers, those that are exact at the centre of a box, give a rigorous bound; and by duality it is
sharp to second order. With the functions linearised in xi, U is convex in xi and linear in lam: its largest value is at
a vertex of the box. What the linearisation leaves out is bounded by second derivatives over the whole ball.

Directions are cut into cells: where z points into a cell of centre a0 and half-angle phi, |z| <= a0.z / cos(phi).

Rounding: U is a chain of fewer than 300 double operations, so it is wrong by less than ROUNDING times the sum of the
moduli that enter it (N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2002, lemma 3.1); that is added.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise, product

import numpy as np

from painleve.asymptotics.certify.pieces import Piece

__all__ = ["BoxSearch", "Candidate"]

ROUNDING = 1e-13
# Where the constraints leave no room for w, exact multipliers are infinite; finite ones then prove that a box is empty.
FLOORS = (1e-12, 1e-6, 1e-3, 3e-2)
OVERLAP = 2.0**-20  # by which half spheres are widened: their pole is known to rounding only
Array = np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class Candidate:
    """A point (xi, lam, w) of a piece whose distance, in units of eps and to rounding, is `value`."""

    piece: Piece
    value: float
    xi: Array
    lam: float
    w: Array


@dataclass
class _Boxes:
    """Boxes of (xi, lam, direction in a face); xi is polar (radius, angle) where there are two of them."""

    lo: Array
    hi: Array
    face: Array
    upper: Array
    widest: Array

    def __getitem__(self, index: Array) -> _Boxes:
        return _Boxes(self.lo[index], self.hi[index], self.face[index], self.upper[index], self.widest[index])

    def join(self, other: _Boxes) -> _Boxes:
        pairs = ((getattr(self, n), getattr(other, n)) for n in ("lo", "hi", "face", "upper", "widest"))
        return _Boxes(*(np.concatenate(p) for p in pairs))


class BoxSearch:
    """Branch and bound over one piece; every call of `refine` bisects the boxes that matter most.

    upper: a rigorous bound, in units of eps, on the distance over the piece, never growing; best: the candidate of the
    largest distance so far; evaluations: boxes bounded so far.
    """

    def __init__(self, piece: Piece) -> None:
        self.piece, self.evaluations = piece, 0
        self.best: Candidate | None = None
        self.dropped = 0.0
        self.shape = piece.models.powers.shape[1]
        self.faces = _faces(piece)
        self.boxes = self._bounded(self._roots(), np.inf)

    @property
    def upper(self) -> float:
        return max(self.dropped, float(self.boxes.upper.max(initial=0.0)))

    @property
    def pending(self) -> float:
        """The largest bound among boxes that could still be refined."""
        return float(self.boxes.upper.max(initial=0.0))

    def refine(self, target: float, batch: int) -> None:
        """Drop what is at most `target`, and bisect the `batch` boxes of largest bound among the rest."""
        self._drop(target)
        order = np.argsort(-self.boxes.upper, kind="stable")
        chosen, rest = self.boxes[order[:batch]], self.boxes[order[batch:]]
        self.boxes = rest.join(self._bounded(_bisected(chosen), target))

    def _drop(self, target: float) -> None:
        small = self.boxes.upper <= target
        self.dropped = max(self.dropped, float(self.boxes.upper[small].max(initial=0.0)))
        self.boxes = self.boxes[~small]

    def _roots(self) -> _Boxes:
        """The whole domain: xi, lam, and each face of the directions, cut coarsely."""
        axes = _coordinate_axes(self.shape)
        if self.shape == 1:
            axes = [self._admissible()]
        if self.piece.lam is not None:
            axes.append(np.linspace(*self.piece.lam, 3))
        lo, hi, face = [], [], []
        for number, (_, limits) in enumerate(self.faces):
            cuts = axes + [np.linspace(a, b, 3) for a, b in limits]
            for cell in product(*(list(pairwise(c)) for c in cuts)):
                lo.append([x for x, _ in cell])
                hi.append([y for _, y in cell])
                face.append(number)
        n, width = len(face), len(axes) + len(self.faces[0][1])
        corner = np.array(lo, dtype=float).reshape(n, width), np.array(hi, dtype=float).reshape(n, width)
        return _Boxes(*corner, np.array(face, dtype=int), np.full(n, np.inf), np.zeros(n, dtype=int))

    def _admissible(self) -> Array:
        """For one xi: cuts of the least interval outside which g < 0, or p < 0, for sure."""
        first, last = self._outermost(-1.0), self._outermost(1.0)
        return np.array([]) if first is None or last is None else np.linspace(first, last, 5)

    def _outermost(self, side: float) -> float | None:
        """The end on that side, by bisection to well below any width that is asked for; None: nothing is left."""
        stack = [(-1.0, 1.0)]
        while stack:
            lo, hi = stack.pop()
            if self._excluded(lo, hi):
                continue
            if hi - lo < 1e-10:
                return lo if side < 0.0 else hi
            middle = 0.5 * (lo + hi)
            halves = [(lo, middle), (middle, hi)]
            stack += halves if side > 0.0 else halves[::-1]
        return None

    def _excluded(self, lo: float, hi: float) -> bool:
        xi, half = np.array([[0.5 * (lo + hi)]]), 0.5 * (hi - lo)
        value, slope = self.piece.models.at(xi)
        m = self.piece.models
        most = value[0] + np.abs(slope[0, 0]) * half + m.bend * half**2 / 2.0 + m.remainder + ROUNDING * m.size
        inner = 0.0 if lo <= 0.0 <= hi else min(abs(lo), abs(hi))
        room = self.piece.carried * np.sqrt(max(0.0, 1.0 - inner**2)) * (1.0 + 1e-12)
        return bool(most[-2] + room < 0.0 or (self.piece.slipping and most[-1] < 0.0))

    def _bounded(self, boxes: _Boxes, target: float) -> _Boxes:
        """The boxes with bounds, without those that hold no member; candidates are tried at the most promising."""
        if not len(boxes.face):
            return boxes
        self.evaluations += len(boxes.face)
        sheet = _Sheet(self.piece, self.faces, boxes)
        upper, spread = sheet.bound()
        boxes.upper = np.minimum(boxes.upper, upper)
        boxes.widest = sheet.axis_to_cut(spread, upper)
        promising = np.argsort(-upper, kind="stable")[:64]
        for candidate in sheet.candidates(promising, spread):
            if self.best is None or candidate.value > self.best.value:
                self.best = candidate
        return boxes[upper > -np.inf]


def _coordinate_axes(shape: int) -> list[Array]:
    if shape == 0:
        return []
    if shape == 1:
        return [np.linspace(-1.0, 1.0, 5)]
    return [np.linspace(0.0, 1.0, 3), np.linspace(0.0, 2.0 * np.pi, 17)]


def _faces(piece: Piece) -> list[tuple[Array, list[tuple[float, float]]]]:
    """Faces of a cube around the sphere of directions: a matrix (m, d) whose first row points to the face and whose
    other rows span it, with the range of each of those."""
    frame, m = piece.frame, len(piece.frame)
    if piece.directions == "single":
        return [(frame, [])]
    faces = []
    for axis, sign in product(range(m), (1.0, -1.0)):
        if piece.directions == "beyond" and axis == 0 and sign < 0.0:
            continue
        others = [i for i in range(m) if i != axis]
        half = piece.directions == "beyond" and axis != 0
        limits = [(-OVERLAP, 1.0) if half and i == 0 else (-1.0, 1.0) for i in others]
        faces.append((np.vstack([sign * frame[axis], frame[others]]), limits))
    return faces


def _bisected(boxes: _Boxes) -> _Boxes:
    n = np.arange(len(boxes.face))
    middle = 0.5 * (boxes.lo[n, boxes.widest] + boxes.hi[n, boxes.widest])
    left, right = boxes.hi.copy(), boxes.lo.copy()
    left[n, boxes.widest], right[n, boxes.widest] = middle, middle
    return _Boxes(boxes.lo, left, boxes.face, boxes.upper, boxes.widest).join(
        _Boxes(right, boxes.hi, boxes.face, boxes.upper, boxes.widest)
    )


class _Sheet:
    """All that is computed for a batch of boxes, one array axis for the boxes."""

    def __init__(self, piece: Piece, faces: list[tuple[Array, list[tuple[float, float]]]], boxes: _Boxes) -> None:
        self.piece, self.boxes = piece, boxes
        self.d, self.k = piece.dimension, piece.constraints
        self.shape = piece.models.powers.shape[1]
        self.first_direction = self.shape + (piece.lam is not None)
        self._place_xi()
        self._place_lam()
        self._place_directions(faces)
        value, slope = piece.models.at(self.xi)
        self.value, self.slope = value, slope
        self.vertex = value[:, None, :] + np.einsum("nvs,nsj->nvj", self.step, slope)
        m = piece.models
        reach = (self.step**2).sum(axis=2).max(axis=1, initial=0.0)[:, None]
        self.error = 0.5 * m.bend * reach + m.remainder + ROUNDING * m.size

    def _place_xi(self) -> None:
        """Centres (n, s) and steps from them to the vertices (n, v, s) of a polygon around each box."""
        lo, hi = self.boxes.lo[:, : self.shape], self.boxes.hi[:, : self.shape]
        if self.shape < 2:
            self.xi = 0.5 * (lo + hi)
            self.step = np.stack([lo - self.xi, hi - self.xi], axis=1) if self.shape else np.zeros((len(lo), 1, 0))
            return
        middle = 0.5 * (lo + hi)
        self.xi = middle[:, :1] * np.stack([np.cos(middle[:, 1]), np.sin(middle[:, 1])], axis=1)
        half = 0.5 * (hi[:, 1] - lo[:, 1])
        corners = []
        # The outer arc lies below its tangent in the middle, the inner one above its chord.
        for radius, angle in product((lo[:, 0], hi[:, 0] / np.cos(half)), (lo[:, 1], hi[:, 1])):
            corners.append(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        self.step = np.stack(corners, axis=1) - self.xi[:, None, :]

    def _place_lam(self) -> None:
        if self.piece.lam is None:
            self.lam = np.zeros((len(self.xi), 1))
        else:
            self.lam = np.stack([self.boxes.lo[:, self.shape], self.boxes.hi[:, self.shape]], axis=1)

    def _place_directions(self, faces: list[tuple[Array, list[tuple[float, float]]]]) -> None:
        """Unit centres (n, d) of the cells and the cosines (n,) of their half-angles."""
        basis = np.stack([matrix for matrix, _ in faces])[self.boxes.face]
        lo, hi = self.boxes.lo[:, self.first_direction :], self.boxes.hi[:, self.first_direction :]

        def point(s: Array) -> Array:
            vector = basis[:, 0] + np.einsum("ni,nij->nj", s, basis[:, 1:])
            return vector / np.linalg.norm(vector, axis=1)[:, None]

        self.a = point(0.5 * (lo + hi))
        ends = [np.where(np.array(c, dtype=bool), hi, lo) for c in product((0, 1), repeat=lo.shape[1])]
        self.cosine = np.min([np.einsum("ni,ni->n", self.a, point(s)) for s in ends], axis=0) * (1.0 - 1e-15)
        if not lo.shape[1]:
            self.cosine = np.ones(len(lo))

    def _columns(self, table: Array) -> tuple[Array, Array, Array, Array, Array, Array]:
        """c, Q, y and e, m, l of the constraints, from the last axis of a table of the models."""
        d, k, front = self.d, self.k, table.shape[:-1]
        c, Q, y = table[..., :d], table[..., d : d + d * d], table[..., d + d * d : 2 * d + d * d]
        rest = table[..., 2 * d + d * d : -2].reshape(*front, k, d + 2)
        return c, Q.reshape(*front, d, d), y, rest[..., 0], rest[..., 1 : 1 + d], rest[..., 1 + d]

    def bound(self) -> tuple[Array, Array]:
        """(upper (n,), values of U at the vertices (n, v, ends of lam)); -inf: no members."""
        best = np.full(len(self.xi), np.inf)
        spread = np.zeros((len(self.xi), self.step.shape[1], self.lam.shape[1]))
        centre, lam = self._columns(self.value), self.lam.mean(axis=1)
        for active, floor in product(self._active_sets(), FLOORS):
            if not active and floor != FLOORS[0]:
                continue
            sigma = self._multipliers(centre, lam, self.a, active, floor)[0]
            for U, slack in self._lagrangians(sigma):
                upper = np.maximum(0.0, U.max(axis=(1, 2)) + slack) / self.cosine
                better = upper < best
                best, spread = np.where(better, upper, best), np.where(better[:, None, None], U, spread)
        return np.where(self._empty(), -np.inf, best), spread

    def _active_sets(self) -> Iterator[tuple[int, ...]]:
        """Sets of constraints that may hold with equality at the maximum: at most two, with the equality in all."""
        start = 1 if self.piece.equality else 0
        for size in range(3 - start):
            for more in combinations(range(start, self.k), size):
                yield (*range(start), *more)

    def _multipliers(
        self, columns: tuple[Array, ...], lam: Array, a: Array, active: tuple[int, ...], floor: float
    ) -> tuple[Array, Array, Array]:
        """Multipliers (n, k) and maximiser w (n, d), exact where just these constraints bind; feasible (n,)."""
        _, Q, _, e, m, l = columns  # noqa: E741
        o = np.einsum("nij,ni->nj", Q, a)
        sigma = np.zeros((len(o), self.k))
        level = -(e + lam[:, None] * l)
        M, h = m[:, active, :], level[:, active]
        gram = np.einsum("nkj,nlj->nkl", M, M)
        inverse = _inverse(gram)
        shadow = np.einsum("nkj,nj->nk", M, o)
        w = np.einsum("nkj,nkl,nl->nj", M, inverse, h)
        across = o - np.einsum("nkj,nkl,nl->nj", M, inverse, shadow)
        room = 1.0 - (w**2).sum(axis=1)
        size = np.linalg.norm(across, axis=1)
        mu = size / np.sqrt(np.maximum(room, floor))
        with np.errstate(over="ignore"):
            sigma[:, active] = np.einsum("nkl,nl->nk", inverse, shadow - mu[:, None] * h)
        start = 1 if self.piece.equality else 0
        sigma[:, start:] = np.maximum(sigma[:, start:], 0.0)
        w = w + across * (np.sqrt(np.maximum(room, 0.0)) / np.where(size > 0.0, size, 1.0))[:, None]
        others = np.einsum("nkj,nj->nk", m, w) - level
        allowed = 1e-12 * (1.0 + np.abs(level))
        feasible = (room >= 0.0) & ((w**2).sum(axis=1) <= 1.0 + 1e-12)
        feasible &= np.all((others <= allowed)[:, start:], axis=1) & np.isfinite(sigma).all(axis=1)
        return np.nan_to_num(sigma, nan=0.0, posinf=0.0, neginf=0.0), w, feasible

    def _lagrangians(self, sigma: Array) -> Iterator[tuple[Array, Array]]:
        """U at the vertices (n, v, ends) and what is to be added for linearisation and rounding (n,), for these
        multipliers and for some of g >= 0 and p >= 0."""
        c, Q, y, e, m, l = self._columns(self.vertex)  # noqa: E741
        r = np.einsum("nvij,ni->nvj", Q, self.a) - np.einsum("nk,nvkj->nvj", sigma, m)
        A = np.einsum("nvi,ni->nv", c, self.a) - np.einsum("nk,nvk->nv", sigma, e)
        B = np.einsum("nvi,ni->nv", y, self.a) - np.einsum("nk,nvk->nv", sigma, l)
        U = (np.linalg.norm(r, axis=2) + A)[:, :, None] + B[:, :, None] * self.lam[:, None, :]
        slack = self._slack(sigma)
        yield U, slack
        if self.shape == 2 and self.piece.carried == 0.0:
            for column in (-2, -1) if self.piece.slipping else (-2,):
                yield self._with_sign_condition(U, slack, column)

    def _slack(self, sigma: Array) -> Array:
        c, Q, y, e, m, l = self._columns(self.error)  # noqa: E741
        size = self._columns(self.piece.models.size)
        lam, weight = np.abs(self.lam).max(axis=1), np.abs(sigma)
        norm = np.linalg.norm
        left_out = norm(Q, axis=(1, 2)) + norm(c, axis=1) + lam * norm(y, axis=1)
        left_out = left_out + (weight * (norm(m, axis=2) + e + lam[:, None] * l)).sum(axis=1)
        moduli = norm(size[1]) + norm(size[0]) + lam * norm(size[2])
        moduli = moduli + (weight * (norm(size[4], axis=1) + size[3] + lam[:, None] * size[5])).sum(axis=1)
        return left_out + ROUNDING * moduli

    def _with_sign_condition(self, U: Array, slack: Array, column: int) -> tuple[Array, Array]:
        """g >= 0 or p >= 0 with the multiplier that turns the slope of U along its gradient to zero."""
        mean, step = U.mean(axis=2), self.step
        centred = step - step.mean(axis=1, keepdims=True)
        gram = np.einsum("nvs,nvt->nst", centred, centred)
        slope = np.einsum("nst,nt->ns", _inverse(gram), np.einsum("nvs,nv->ns", centred, mean))
        gradient = self.slope[:, :, column]
        squared = (gradient**2).sum(axis=1)
        zeta = np.maximum(0.0, -(slope * gradient).sum(axis=1) / np.where(squared > 0.0, squared, 1.0))
        size = self.piece.models.size[column]
        return U + zeta[:, None, None] * self.vertex[:, :, column, None], slack + zeta * (
            self.error[:, column] + ROUNDING * size
        )

    def _empty(self) -> Array:
        """Boxes without members: g < 0, p < 0, or a constraint that no w can meet."""
        most = self.vertex.max(axis=1) + self.error
        room = self.piece.carried * np.sqrt(np.maximum(0.0, 1.0 - self._innermost() ** 2)) * (1.0 + 1e-12)
        empty = most[:, -2] + room < 0.0
        if self.piece.slipping:
            empty |= most[:, -1] < 0.0
        _, _, _, e, m, l = self._columns(self.vertex)  # noqa: E741
        _, _, _, e_error, m_error, l_error = self._columns(self.error)
        level = e[:, :, None, :] + self.lam[:, None, :, None] * l[:, :, None, :]
        reach = np.linalg.norm(m, axis=3).max(axis=1) + np.linalg.norm(m_error, axis=2) + e_error
        reach = reach + np.abs(self.lam).max(axis=1)[:, None] * l_error
        empty |= (level.min(axis=(1, 2)) > reach * (1.0 + 1e-12)).any(axis=1)
        if self.piece.equality:
            empty |= level[..., 0].max(axis=(1, 2)) < -reach[:, 0] * (1.0 + 1e-12)
        return empty

    def _innermost(self) -> Array:
        """A lower bound on |xi| in each box."""
        if self.shape == 2:
            return self.boxes.lo[:, 0]
        outside = np.maximum(self.boxes.lo[:, : self.shape], -self.boxes.hi[:, : self.shape])
        return np.maximum(0.0, outside.max(axis=1, initial=0.0))

    def axis_to_cut(self, spread: Array, upper: Array) -> Array:
        """The axis along which the bound loses most, by estimate."""
        n = len(upper)
        if self.shape == 2:
            grid = spread.reshape(n, 2, 2, -1)
            differences = (grid[:, 0] - grid[:, 1], grid[:, :, 0] - grid[:, :, 1])
            along, around = (np.abs(x).max(axis=(1, 2)) for x in differences)
            # The polygon is longer than the box by the height of its arcs, which only narrower angles reduce.
            length = self.boxes.hi[:, 0] - self.boxes.lo[:, 0]
            half = 0.5 * (self.boxes.hi[:, 1] - self.boxes.lo[:, 1])
            share = length / (self.boxes.hi[:, 0] / np.cos(half) - self.boxes.lo[:, 0])
            loss = [along * share, around + along * (1.0 - share)]
        else:
            loss = [np.abs(spread[:, 0] - spread[:, 1]).max(axis=1)] if self.shape else []
        if self.piece.lam is not None:
            loss.append(np.abs(spread[:, :, 0] - spread[:, :, 1]).max(axis=1))
        width = self.boxes.hi - self.boxes.lo
        finite = np.where(np.isfinite(upper), upper, 0.0)
        cells = width[:, self.first_direction :] ** 2
        total = np.maximum(cells.sum(axis=1), 1e-300)
        for i in range(cells.shape[1]):
            loss.append(finite * (1.0 / self.cosine - 1.0) * cells[:, i] / total * 2.0)
        if not loss:
            return np.zeros(n, dtype=int)
        return np.argmax(np.stack(loss, axis=1), axis=1)

    def candidates(self, chosen: Array, spread: Array) -> Iterator[Candidate]:
        """Members at the centres of the chosen boxes and at the vertices of the largest U."""
        flat = spread[chosen].reshape(len(chosen), -1).argmax(axis=1)
        vertex, end = np.unravel_index(flat, spread.shape[1:])
        corner = self.xi[chosen] + self.step[chosen, vertex]
        length = np.linalg.norm(corner, axis=1)[:, None] if self.shape else np.ones((len(chosen), 1))
        places = (
            (self.xi[chosen], self.lam[chosen].mean(axis=1)),
            (corner / np.maximum(length, 1.0), self.lam[chosen, end]),
            (corner / np.maximum(length, 1.0), self.lam[chosen].mean(axis=1)),
        )
        for xi, lam in places:
            value, _ = self.piece.models.at(xi)
            for active in self._active_sets():
                _, w, feasible = self._multipliers(self._columns(value), lam, self.a[chosen], active, FLOORS[0])
                distance = np.where(feasible & self._admissible(xi, value), self._distance(value, lam, w), -np.inf)
                best = int(np.argmax(distance))
                if distance[best] > 0.0:
                    yield Candidate(
                        piece=self.piece, value=float(distance[best]), xi=xi[best], lam=float(lam[best]), w=w[best]
                    )

    def _admissible(self, xi: Array, value: Array) -> Array:
        room = self.piece.carried * np.sqrt(np.maximum(0.0, 1.0 - (xi**2).sum(axis=1)))
        return (value[:, -2] + room >= 0.0) & ((value[:, -1] > 0.0) | (not self.piece.slipping))

    def _distance(self, value: Array, lam: Array, w: Array) -> Array:
        c, Q, y, *_ = self._columns(value)
        z = c + np.einsum("nij,nj->ni", Q, w) + lam[:, None] * y
        seen = z @ self.piece.frame.T
        if self.piece.directions == "single":
            return seen[:, 0]
        beside = np.linalg.norm(seen[:, 1:], axis=1)
        norm = np.linalg.norm(seen, axis=1)
        return np.where(seen[:, 0] >= 0.0, norm, beside) if self.piece.directions == "beyond" else norm


def _inverse(gram: Array) -> Array:
    """Inverses of (n, k, k) matrices, k <= 2; any finite numbers serve where one is singular."""
    k = gram.shape[1]
    if k == 0:
        return gram
    if k == 1:
        return 1.0 / np.where(gram > 0.0, gram, 1.0)
    determinant = gram[:, 0, 0] * gram[:, 1, 1] - gram[:, 0, 1] * gram[:, 1, 0]
    determinant = np.where(determinant > 1e-10 * gram[:, 0, 0] * gram[:, 1, 1], determinant, np.inf)
    swapped = np.stack([np.stack([gram[:, 1, 1], -gram[:, 0, 1]], 1), np.stack([-gram[:, 1, 0], gram[:, 0, 0]], 1)], 1)
    return swapped / determinant[:, None, None]
