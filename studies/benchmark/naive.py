"""The distances as they are first written in NumPy: uniform points, plain doubles, closed-form law. A baseline.

Nothing here is used by the toolkit's own methods; studies compare with it, in speed and in rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import sympy as sp
from scipy.spatial import cKDTree

from painleve.core.codes import ContactMode
from painleve.errors import InputError
from painleve.kernels.rows import rows_of
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.sets import LineSegment, Points
from painleve.theory.limit_set import LimitSet

__all__ = ["NaiveMembers", "naive_distance", "naive_members", "point_distances", "uniform_ball"]

GRID = 1001  # points along A whose nearest member is looked up


@dataclass(frozen=True, kw_only=True, eq=False)
class NaiveMembers:
    """S (n, d) at n offset states, with the branch, v_n and the compliances a + mu_+ b, a - mu_- b that decided it."""

    values: np.ndarray
    branch: np.ndarray
    normal_velocity: np.ndarray
    edge_plus: np.ndarray
    edge_minus: np.ndarray


def naive_distance(limit: LimitSet, eps: float, *, samples: int, seed: int = 0) -> tuple[float, float]:
    """(e(A_eps, A), e(A, A_eps)) between a uniform sample of A_eps and A; neither is a bound in this arithmetic.

    Offsets are uniform in both balls of R^d. The second excess is taken over a grid on A.
    Raises InputError for an undecided limit set and for a scene without friction.
    """
    if limit.kind == "undecided":
        raise InputError(f"state {limit.state.label}: no distance to a limit set that is undecided: {limit.reason}")
    random, d = np.random.default_rng(seed), limit.state.scene.dimension
    dq, dv = (uniform_ball(random, samples, d, eps) for _ in range(2))
    values = naive_members(limit, dq, dv).values
    forward = float(point_distances(limit, values).max())
    backward = float(cKDTree(values).query(_grid(limit))[0].max())
    return forward, backward


def naive_members(limit: LimitSet, dq: np.ndarray, dv: np.ndarray) -> NaiveMembers:
    """S(q + dq, u- + dv) of offsets (n, d), in doubles: sums first, differences after. Raises InputError without
    friction."""
    scene, base = limit.state.scene, _rounded(limit)
    v = base.u + dv
    rows, parts = _rows(scene)((base.q + dq).T, base.p), rows_of(derive(scene)).parts
    g, w_n, Y_n, a, plus = (rows[i] for i in (parts.g, parts.w_n, parts.Y_n, parts.a, parts.edge_plus))
    (H,), (Y_t,) = ([rows[part] for part in tangent] for tangent in (parts.H, parts.Y_t))
    (b,), (C,), (minus, mu_plus, mu_minus) = (rows[part] for part in (parts.b, parts.C, parts.section))
    v_n, v_t = np.einsum("jn,nj->n", w_n, v), np.einsum("jn,nj->n", H, v)
    determinant = a * C - b * b
    r_n, r_t = (b * v_t - C * v_n) / determinant, (b * v_n - a * v_t) / determinant
    slip_plus = (plus > 0.0) & (r_t * plus > -mu_plus * v_n)
    slip_minus = ~slip_plus & (minus > 0.0) & (-r_t * minus > -mu_minus * v_n)
    for slips, edge, s in ((slip_plus, plus, mu_plus), (slip_minus, minus, -mu_minus)):
        slip_n = np.divide(-v_n, edge, out=np.zeros_like(v_n), where=slips)
        r_n, r_t = np.where(slips, slip_n, r_n), np.where(slips, s * slip_n, r_t)
    moved = (g >= 0.0) & (v_n < 0.0)
    values = v + np.where(moved, r_n, 0.0)[:, None] * Y_n.T + np.where(moved, r_t, 0.0)[:, None] * Y_t.T
    branch = np.select(
        [~moved, slip_plus, slip_minus],
        [ContactMode.FREE, ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS],
        ContactMode.STICK,
    )
    return NaiveMembers(values=values, branch=branch, normal_velocity=v_n, edge_plus=plus, edge_minus=minus)


def point_distances(limit: LimitSet, values: np.ndarray) -> np.ndarray:
    """Distances of points (n, d) from A."""
    A = _rounded(limit).limit
    if not isinstance(A, LineSegment):
        return np.min([np.linalg.norm(values - point, axis=1) for point in A.members], axis=0)
    jump = A.end - A.start
    share = np.clip((values - A.start) @ jump / (jump @ jump), 0.0, 1.0)
    return np.linalg.norm(values - A.start - share[:, None] * jump, axis=1)


def _grid(limit: LimitSet) -> np.ndarray:
    A = _rounded(limit).limit
    return np.linspace(A.start, A.end, GRID) if isinstance(A, LineSegment) else A.members


class _Rounded(NamedTuple):
    q: np.ndarray
    p: list[float]
    u: np.ndarray
    limit: Points | LineSegment


@lru_cache(maxsize=16)
def _rounded(limit: LimitSet) -> _Rounded:
    """The exact state in doubles; formed once, since a user of plain doubles would have begun with them."""
    state = limit.state
    q = np.array([state.number(x) for x in state.q])
    p = [state.number(state.parameters[s.name]) for s in state.scene.parameters]
    return _Rounded(q, p, limit.u_minus, limit.point_set)


def uniform_ball(random: np.random.Generator, n: int, d: int, eps: float) -> np.ndarray:
    direction = random.standard_normal((n, d))
    radius = eps * random.random(n) ** (1.0 / d)
    return direction * (radius / np.linalg.norm(direction, axis=1))[:, None]


@lru_cache(maxsize=16)
def _rows(scene: Scene) -> Callable[[np.ndarray, list[float]], np.ndarray]:
    """The scene's rows (rows, n) at configurations (d, n), by lambdify."""
    if not scene.contact.section.dimension:
        raise InputError(f"scene {scene.name}: the naive baseline is written for planar friction; choose another scene")
    expressions = rows_of(derive(scene)).expressions
    function = sp.lambdify([*scene.q, *scene.p], expressions, "numpy", cse=True)

    def rows(q: np.ndarray, p: list[float]) -> np.ndarray:
        values = np.empty((len(expressions), q.shape[1]))
        for i, value in enumerate(function(*q, *p)):
            values[i] = value
        return values

    return rows
