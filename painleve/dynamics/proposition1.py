"""Proposition 1 of the paper, checked at every step of a Contact Dynamics trajectory, as margins.

The impulse r = M(u_{i+1} - u_i) - h f is formed anew from the trajectory, not taken from the law.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass

import numpy as np

from painleve.dynamics.contact_rows import directions, nearest_impulse
from painleve.dynamics.start import Start

__all__ = ["Proposition1", "check_proposition1"]

BLOCK = 65536  # steps at a time, so that memory does not grow with the trajectory
MARGINS = ("membership", "dissipation", "norm_bound")


@dataclass(frozen=True, kw_only=True, eq=False)
class Proposition1:
    """Margins of each step (n,), positive where the statement fails; rounding alone gives some 1e-16.

    With s = |u_{i+1}| + |u_i| + h |M^-1 f| in the kinetic norm at q_{i+1}:
    membership: distance of r from R(q_{i+1}) in the norm of M^-1, over s (an upper bound on it: of the part of r that
    W does not span, and of the violations of 0 <= r_n and of r_t in r_n B, B the friction section);
    dissipation: <u_{i+1}, r>/s^2; norm_bound: (|u_{i+1}| - |u_i| - h |M^-1/2| |f|)/s.
    """

    membership: np.ndarray
    dissipation: np.ndarray
    norm_bound: np.ndarray

    @property
    def count(self) -> int:
        """Steps that were checked: all of them, or the first ones where it was interrupted."""
        return len(self.membership)

    def worst(self, name: str) -> tuple[float, int]:
        """The largest margin of that name and the index of the instant at which its step ends."""
        values = getattr(self, name)
        if not len(values):
            return 0.0, 0
        index = int(np.argmax(values))
        return float(values[index]), index + 1

    def as_dict(self) -> dict[str, float]:
        """{name: the worst margin}."""
        return {name: self.worst(name)[0] for name in MARGINS}

    def steps(self) -> dict[str, int]:
        """{name: the step with the worst margin}."""
        return {name: self.worst(name)[1] for name in MARGINS}


def check_proposition1(
    start: Start, t: np.ndarray, h: np.ndarray, q: np.ndarray, u: np.ndarray, tolerance: float
) -> Proposition1:
    """Margins of the steps from row i to row i + 1. t: (n + 1,), h: (n,), q, u: (n + 1, d).

    Ctrl-C ends it with those of the steps until then.
    """
    parts: list[np.ndarray] = []
    with contextlib.suppress(KeyboardInterrupt):
        for i in range(0, len(h), BLOCK):
            old, new = slice(i, min(i + BLOCK, len(h))), slice(i + 1, min(i + BLOCK, len(h)) + 1)
            with np.errstate(over="ignore", invalid="ignore"):  # a motion that leaves the numbers has no margins
                parts.append(_margins(start, t[new], h[old], q[new], u[old], u[new], tolerance))
    table = np.concatenate(parts, axis=1) if parts else np.empty((3, 0))
    return Proposition1(**dict(zip(MARGINS, table, strict=True)))


def _margins(
    start: Start, t: np.ndarray, h: np.ndarray, q: np.ndarray, u: np.ndarray, u1: np.ndarray, tolerance: float
) -> np.ndarray:
    """The three margins (3, n) of n steps."""
    rows, M, f = start.tabulate(t, q, u)
    r = np.einsum("nij,nj->ni", M, u1 - u) - h[:, None] * f
    inverse = np.linalg.inv(M)
    pushed = h[:, None] * np.einsum("nij,nj->ni", inverse, f)
    old, new, push = (_norm(M, x) for x in (u, u1, pushed))
    scale = old + new + push
    scale[scale == 0.0] = 1.0
    bound = old + h * np.linalg.norm(f, axis=1) / np.sqrt(np.linalg.eigvalsh(M)[:, 0])
    outside = _distance_from_cone(start, rows, inverse, r, rows[:, 0] >= -tolerance)
    return np.array([outside / scale, np.einsum("ni,ni->n", u1, r) / scale**2, (new - bound) / scale])


def _norm(A: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.maximum(np.einsum("ni,nij,nj->n", x, A, x), 0.0))


def _distance_from_cone(
    start: Start, rows: np.ndarray, inverse: np.ndarray, r: np.ndarray, touching: np.ndarray
) -> np.ndarray:
    """An upper bound on the distance of r from R(q) in the norm of M^-1."""
    W = np.stack(directions(start.motion, rows), axis=2)
    response = inverse @ W
    parts = np.linalg.solve(np.swapaxes(W, 1, 2) @ response, np.einsum("nik,ni->nk", response, r)[..., None])[..., 0]
    nearest = nearest_impulse(start.motion, rows, parts) * touching[:, None]
    return _norm(inverse, r - np.einsum("nik,nk->ni", W, nearest))
