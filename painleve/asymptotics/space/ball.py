"""The two balls around a state with friction in space, in units of their radius: S and its conditions in batches.

A point is a pair (x, dv): x (s, n) the offsets of the shape coordinates and, below them, of the carried one if there is
any; dv (d, n) that of the velocity. Contact is taken for granted where S is formed and is a condition of its own.
"""

from __future__ import annotations

import numpy as np

from painleve.asymptotics.local import Expansion, LocalProblem
from painleve.core.ball_maps import cube_to_ball
from painleve.core.lane import BlockResult
from painleve.core.lattice import kronecker_block, kronecker_generators, kronecker_shifts
from painleve.core.reduce import PAIR, POINT

__all__ = ["SpaceBall"]

TOWARDS_SPHERES = 2  # the weight of painleve.core.ball_maps.cube_to_ball
LEAST_APPROACH = 1e-13  # of eps: where v_n would not be below, S is that of a velocity moved there


class SpaceBall:
    """A local problem with friction in space, a radius, and the kind of the limit set (painleve.core.reduce)."""

    def __init__(self, problem: LocalProblem, eps: float, kind: int, expansion: Expansion | None) -> None:
        self.problem, self.eps, self.kind, self.expansion = problem, eps, kind, expansion
        self.shape, self.dimension = len(problem.shape), problem.dimension
        self.places = self.shape + (problem.carried > 0.0)  # rows of x
        self.normal = problem.normal / np.linalg.norm(problem.normal)
        self.evaluations, self.counts = 0, {"free": 0, "stick": 0, "slip": 0}

    def rows(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """All rows and their differences from the base values, (R, n) each."""
        changes = self.problem.differences(self.eps, self.expansion, x[: self.shape])
        return self.problem.base[:, None] + changes, changes

    def contact(self, x: np.ndarray, changes: np.ndarray) -> np.ndarray:
        """g/eps."""
        room = self.problem.carried * x[self.shape] if self.places > self.shape else 0.0
        return changes[self.problem.parts.g] / self.eps + room

    def approach(self, dv: np.ndarray, rows: np.ndarray, changes: np.ndarray) -> np.ndarray:
        """-v_n/eps."""
        w = self.problem.parts.w_n
        return -np.sum(rows[w] * dv, axis=0) - self.problem.u @ changes[w] / self.eps

    def approaching(self, dv: np.ndarray, rows: np.ndarray, changes: np.ndarray, wanted: np.ndarray) -> np.ndarray:
        """dv moved along the normal so that -v_n/eps is as wanted."""
        w = rows[self.problem.parts.w_n]
        lack = wanted - self.approach(dv, rows, changes)
        return dv - w * (lack / np.sum(w * w, axis=0))

    def conditions(self, x: np.ndarray, dv: np.ndarray, rows: np.ndarray, changes: np.ndarray) -> list[np.ndarray]:
        """What is >= 0 where (x, dv) is in the balls, in contact and approaching."""
        return [
            1.0 - np.sum(x * x, axis=0),
            1.0 - np.sum(dv * dv, axis=0),
            self.contact(x, changes),
            self.approach(dv, rows, changes),
        ]

    def values(self, x: np.ndarray, dv: np.ndarray, rows: np.ndarray, changes: np.ndarray) -> tuple[np.ndarray, ...]:
        """dist(S, A)/eps and the branch, over configurations in contact, for velocities made to approach."""
        p, n = self.problem, x.shape[1]
        least = np.maximum(self.approach(dv, rows, changes), LEAST_APPROACH)
        dv = np.ascontiguousarray(self.eps * self.approaching(dv, rows, changes, least))
        branch, measures = np.empty(n, np.int64), np.empty((3, n))
        varying = np.ascontiguousarray(changes[list(p.kernels.rows.varying)])
        p.kernels.law_block(
            varying,
            np.full(n, np.inf),
            dv,
            p.base_state,
            BlockResult(branch, *measures),
        )
        self.evaluations += n
        return self.distance(*measures), branch

    def distance(self, along: np.ndarray, beyond: np.ndarray, across2: np.ndarray) -> np.ndarray:
        """dist(S, A)/eps from the coordinates along A and the square of that across it."""
        if self.kind == POINT:
            ends = along**2
        elif self.kind == PAIR:
            ends = np.minimum(along**2, beyond**2)
        else:
            ends = np.maximum(np.maximum(beyond, -along), 0.0) ** 2
        found: np.ndarray = np.sqrt(across2 + ends) / self.eps
        return found

    def sample(self, size: int) -> tuple[np.ndarray, np.ndarray]:
        """Points of low discrepancy of both balls, weighted towards the spheres, with the greatest room for contact."""
        s, d = self.shape, self.dimension
        points = np.empty((s + d, size))
        kronecker_block(0, kronecker_generators(s + d), kronecker_shifts(0, s + d), points)
        for part in (points[:s], points[s:]):
            if len(part):
                cube_to_ball(part, 1.0, TOWARDS_SPHERES)
        return self.deepest(points[:s]), points[s:]

    def deepest(self, shape: np.ndarray) -> np.ndarray:
        """x with those shape offsets and all the room that the ball leaves to the carried coordinate."""
        if self.places == self.shape:
            return shape
        return np.vstack([shape, np.sqrt(np.maximum(0.0, 1.0 - np.sum(shape * shape, axis=0)))])

    def inside(self, x: np.ndarray) -> np.ndarray:
        """x drawn into the ball, with the greatest room."""
        shape = x[: self.shape]
        return self.deepest(shape / np.maximum(1.0, np.linalg.norm(shape, axis=0)))
