"""Coordinates in which the farthest members with friction in space are smooth maxima, so that an ascent finds them.

`Whole`: the product of the balls as it is. It serves wherever S is smooth: at gamma != 0, and at gamma = 0 for the
members beyond the end of A, O(sqrt(eps)) from it, which take an open set of (dq, dv) of the size of the balls.

`Along`: where gamma = 0 at the base state, members over p = a - |b| > 0 by v_n = -lambda_bar p. The slips along A
change to what lies beyond its end in a layer of the relative thickness eps, and p itself matters on the scale of eps
as well as on that of eps^2: lambda_bar = (1 + eps sinh(m)) of the jump's, and x along grad p is eps sinh(k), which are
linear in the layer and logarithmic outside of it.

`Sticking`: the sticking map under the condition that its impulse is in the cone. Where slip sets in, S has a kink; the
maxima on it are smooth maxima of that map on the edge of the condition.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from painleve.asymptotics.space.ball import SpaceBall
from painleve.core.codes import ContactMode
from painleve.core.rows import RowParts
from painleve.core.sections.conic import ConicBase

__all__ = ["Along", "SpaceChart", "Sticking", "Whole", "charts_of"]

SAMPLE = 16384
APART = 0.4  # two starts, at the least
PASSES, TINY = 4, 1e-300
VANISHING = 1e-12  # relative to all slopes: p has none, but for the rounding of balls
DEPTHS = 15  # values of m that a start is tried with


class SpaceChart(Protocol):
    """Coordinates z (size, n) of some pairs (x, dv)."""

    name: str
    ball: SpaceBall
    bounds: list[tuple[float, float]]

    def place(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x, dv."""

    def evaluate(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """dist/eps (n,), and conditions (c, n), which are >= 0 where z is the place of members."""

    def repaired(self, z: np.ndarray) -> np.ndarray:
        """z with x and dv scaled back into the balls, and all the room for contact that is left."""

    def starts(self, count: int) -> np.ndarray:
        """The best places of a sample (size, <= count), far from one another."""


class Whole:
    """z = (x, dv)."""

    def __init__(self, ball: SpaceBall) -> None:
        self.name, self.ball = "whole", ball
        self.bounds = [(-1.0, 1.0)] * (ball.places + ball.dimension)

    def place(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return z[: self.ball.places], z[self.ball.places :]

    def evaluate(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x, dv = self.place(z)
        rows, changes = self.ball.rows(x)
        value, _ = self.ball.values(x, dv, rows, changes)
        return value, np.array(self.ball.conditions(x, dv, rows, changes))

    def repaired(self, z: np.ndarray) -> np.ndarray:
        x, dv = self.place(z)
        return np.vstack([self.ball.inside(x), dv / np.maximum(1.0, np.linalg.norm(dv, axis=0))])

    def starts(self, count: int) -> np.ndarray:
        """The best of each branch."""
        x, dv = self.ball.sample(SAMPLE)
        rows, changes = self.ball.rows(x)
        inside = np.min(self.ball.conditions(x, dv, rows, changes)[2:], axis=0) >= 0.0
        value, branch = self.ball.values(x, dv, rows, changes)
        branch = np.where(inside, branch, ContactMode.FREE)
        z, chosen = np.vstack([x, dv]), [np.empty((len(x) + len(dv), 0))]
        for code in (ContactMode.STICK, ContactMode.SLIP):
            self.ball.counts[code.label] += int(np.sum(branch == code))
            chosen.append(_best(z, np.where(branch == code, value, -np.inf), count))
        self.ball.counts["free"] += int(np.sum(branch == ContactMode.FREE))
        return np.hstack(chosen)


class Along:
    """z = (k, the rest of x, m, y): y the part of dv across the normal at the base."""

    def __init__(self, ball: SpaceBall) -> None:
        self.name, self.ball = "along A", ball
        self.edge = ball.problem.kernels.rows.edges[ball.problem.critical_edge]
        self.across = np.linalg.svd(ball.normal[None, :])[2][1:].T
        slopes = np.abs(ball.problem.gradients)
        slope = ball.problem.gradients[self.edge]
        self.sloping = bool(np.max(slopes[self.edge], initial=0.0) > VANISHING * np.max(slopes, initial=0.0))
        self.turn = np.linalg.svd(slope[None, :])[2] if self.sloping else np.eye(ball.shape)
        self.most = float(np.arcsinh(1.0 / ball.eps))  # x up to 1, and lambda_bar up to twice the jump's
        self.bounds = [(-1.0, 1.0)] * ball.places + [(-self.most, self.most)] + [(-1.0, 1.0)] * (ball.dimension - 1)
        if self.sloping:
            self.bounds[0] = (-self.most, self.most)

    def place(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x = self._unscaled(z[: self.ball.places])
        rows, changes = self.ball.rows(x)
        return x, self._velocity(z, rows, changes)

    def _unscaled(self, scaled: np.ndarray) -> np.ndarray:
        """x of the first coordinates of z."""
        shape = scaled[: self.ball.shape].copy()
        if self.sloping:
            shape[0] = self.ball.eps * np.sinh(shape[0])
        return np.vstack([self.turn.T @ shape, scaled[self.ball.shape :]])

    def _scaled(self, x: np.ndarray) -> np.ndarray:
        shape = self.turn @ x[: self.ball.shape]
        if self.sloping:
            shape[0] = np.arcsinh(shape[0] / self.ball.eps)
        return np.vstack([shape, x[self.ball.shape :]])

    def _velocity(self, z: np.ndarray, rows: np.ndarray, changes: np.ndarray) -> np.ndarray:
        share = 1.0 + self.ball.eps * np.sinh(z[self.ball.places])
        wanted = share * self.ball.problem.multiplier * rows[self.edge] / self.ball.eps
        return self.ball.approaching(self.across @ z[self.ball.places + 1 :], rows, changes, wanted)

    def evaluate(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x = self._unscaled(z[: self.ball.places])
        rows, changes = self.ball.rows(x)
        dv = self._velocity(z, rows, changes)
        value, _ = self.ball.values(x, dv, rows, changes)
        return value, np.array([*self.ball.conditions(x, dv, rows, changes)[:3], rows[self.edge] / self.ball.eps])

    def repaired(self, z: np.ndarray) -> np.ndarray:
        places = self.ball.places
        x, y = self.ball.inside(self._unscaled(z[:places])), z[places + 1 :]
        scaled, m = self._scaled(x), z[places : places + 1]
        rows, changes = self.ball.rows(x)
        for _ in range(PASSES):  # y moves what is along the normal by O(eps) of it
            dv = self._velocity(np.vstack([scaled, m, y]), rows, changes)
            along, across = self.ball.normal @ dv, np.linalg.norm(y, axis=0)
            y = y * np.minimum(1.0, np.sqrt(np.maximum(0.0, 1.0 - along**2)) / np.maximum(across, TINY))
        return np.vstack([scaled, m, y])

    def starts(self, count: int) -> np.ndarray:
        x, dv = self.ball.sample(SAMPLE // DEPTHS)
        depths = np.linspace(-0.99, 0.99, DEPTHS) * self.most
        y, scaled = self.across.T @ dv, self._scaled(x)
        z = np.hstack([np.vstack([scaled, np.full((1, x.shape[1]), m), y]) for m in depths])
        value, conditions = self.evaluate(z)
        return _best(z, np.where(conditions.min(axis=0) >= 0.0, value, -np.inf), count)


class Sticking:
    """z = (x, dv); discs and ellipses."""

    def __init__(self, ball: SpaceBall) -> None:
        self.name, self.ball = "sticking", ball
        self.bounds = [(-1.0, 1.0)] * (ball.places + ball.dimension)
        p = ball.problem
        assert isinstance(p.impulse, ConicBase)
        self.stick = np.array([p.impulse.stick_n, p.impulse.stick_1, p.impulse.stick_2])
        self.across, self.at_end = p.impulse.stick_across, p.impulse.jump_sticks

    def place(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return z[: self.ball.places], z[self.ball.places :]

    def evaluate(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x, dv = self.place(z)
        rows, changes = self.ball.rows(x)
        conditions = self.ball.conditions(x, dv, rows, changes)
        parts = self.ball.problem.parts
        G, dG = _delassus(rows, parts), _delassus(changes, parts)
        change = self._impulse_change(dv, rows, changes, G, dG)
        conditions.append(self._in_cone(rows, changes, change, conditions[3]))
        return self._distance(dv, rows, changes, change), np.array(conditions)

    def _impulse_change(
        self, dv: np.ndarray, rows: np.ndarray, changes: np.ndarray, G: np.ndarray, dG: np.ndarray
    ) -> np.ndarray:
        """(3, n): how the sticking impulse differs from the base state's, over eps."""
        parts, u = self.ball.problem.parts, self.ball.problem.u
        moved = []
        for block in (parts.w_n, *parts.H):
            moved.append(np.sum(rows[block] * dv, axis=0) + u @ changes[block] / self.ball.eps)
        lack = np.array(moved).T + dG @ self.stick / self.ball.eps
        return np.linalg.solve(G, -lack[:, :, None])[:, :, 0].T

    def _in_cone(self, rows: np.ndarray, changes: np.ndarray, change: np.ndarray, approach: np.ndarray) -> np.ndarray:
        """nu - p |r_t| - (|b||r_t| + b.r_t), over eps, without cancellation where r_t opposes b at the base."""
        eps, parts = self.ball.eps, self.ball.problem.parts
        p, b, db = rows[parts.edge_plus], rows[parts.b], changes[parts.b]
        e, s = eps * change[1:], self.stick[1:, None]
        r, size = s + e, np.hypot(*b)
        length, along = np.hypot(*r), b[0] * r[0] + b[1] * r[1]
        across = self.across + db[0] * s[1] - db[1] * s[0] + b[0] * e[1] - b[1] * e[0]
        far = size * length - along
        near = np.where(along < 0.0, across**2 / np.where(far > 0.0, far, 1.0), size * length + along)
        found: np.ndarray = approach - (p * length + near) / eps
        return found

    def _distance(self, dv: np.ndarray, rows: np.ndarray, changes: np.ndarray, change: np.ndarray) -> np.ndarray:
        p, d, eps = self.ball.problem, self.ball.dimension, self.ball.eps
        z, start = eps * dv, np.zeros(d)
        for k, block in enumerate((p.parts.Y_n, *p.parts.Y_t)):
            z = z + changes[block] * self.stick[k] + rows[block] * (eps * change[k])
            start += p.base[block] * self.stick[k]
        if not self.at_end:
            z = z + start[:, None]
        tau = 1.0 if self.at_end else 0.0
        dot = p.direction @ z
        across2 = np.sum((z - np.outer(p.direction, dot)) ** 2, axis=0)
        return self.ball.distance(dot + tau * p.length, dot + (tau - 1.0) * p.length, across2)

    def repaired(self, z: np.ndarray) -> np.ndarray:
        x, dv = self.place(z)
        return np.vstack([self.ball.inside(x), dv / np.maximum(1.0, np.linalg.norm(dv, axis=0))])

    def starts(self, count: int) -> np.ndarray:
        z = np.vstack(self.ball.sample(SAMPLE // 4))
        value, conditions = self.evaluate(z)
        return _best(z, np.where(conditions[2:].min(axis=0) >= 0.0, value, -np.inf), count)


def charts_of(ball: SpaceBall) -> list[SpaceChart]:
    """The charts that a problem needs."""
    found: list[SpaceChart] = [Whole(ball)]
    if ball.problem.critical_edge and ball.problem.length > 0.0:
        found += [Along(ball)]
    if ball.problem.section.curved:
        found.append(Sticking(ball))
    return found


def _delassus(rows: np.ndarray, parts: RowParts) -> np.ndarray:
    """(n, 3, 3) from the rows a, b, C."""
    a, (b_1, b_2), (C_11, C_12, C_22) = rows[parts.a], rows[parts.b], rows[parts.C]
    return np.moveaxis(np.array([[a, b_1, b_2], [b_1, C_11, C_12], [b_2, C_12, C_22]]), 2, 0)


def _best(z: np.ndarray, value: np.ndarray, count: int) -> np.ndarray:
    """Places with the highest finite values, no two within a distance of APART."""
    order = np.argsort(-value, kind="stable")[: 64 * count]
    chosen: list[int] = []
    for i in order[np.isfinite(value[order])]:
        if all(np.linalg.norm(z[:, i] - z[:, j]) > APART for j in chosen):
            chosen.append(int(i))
        if len(chosen) == count:
            break
    return z[:, chosen]
