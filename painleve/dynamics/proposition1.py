"""Proposition 1 of the paper, checked at every step of a Contact Dynamics trajectory, as margins.

The impulse r = M(u_{i+1} - u_i) - h f is formed anew from the trajectory, not taken from the law.

Margins are relative to the sizes that enter a step, so that rounding gives some 1e-16 whatever the masses and units:

    e = |u_{i+1}| + |u_i| + |h M^-1 f| + |M^-1 W| L,   L = |r'|, and L = |G^-1| |G| |r'| where the contact sticks,

component by component, with r' the impulses of the contact and G = W^T M^-1 W. A sticking impulse is -G^-1 W^T v: where
G is close to singular, as for a light body on a heavy board, rounding moves it by |G^-1| |G| times as much. A margin is
divided by s = sqrt(e . |M| e), the kinetic norm of these sizes, or by its square.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass

import numpy as np

from painleve.dynamics.contact_rows import directions, nearest_impulse
from painleve.dynamics.start import Start

__all__ = ["MARGINS", "MARGIN_SCALE", "Proposition1", "check_proposition1"]

BLOCK = 65536  # steps at a time, so that memory does not grow with the trajectory
MARGIN_SCALE = (
    "it is relative to the velocities, forces and impulses that enter its step: rounding alone gives some 1e-16"
)
MARGINS = ("membership", "dissipation", "norm_bound")


@dataclass(frozen=True, kw_only=True, eq=False)
class Proposition1:
    """Margins of each step (n,), positive where the statement fails; rounding alone gives some 1e-16.

    With s the kinetic norm of the sizes that enter (above), at q_{i+1}:
    membership: distance of r from R(q_{i+1}) in the norm of M^-1, over s (an upper bound on it: of the part of r that
    W does not span, and of the violations of 0 <= r_n and of r_t in r_n B, B the friction section);
    dissipation: <u_{i+1}, r>/s^2; norm_bound: (|u_{i+1}| - |u_i| - h |M^-1/2| |f|)/s, in the kinetic norm.
    """

    membership: np.ndarray
    dissipation: np.ndarray
    norm_bound: np.ndarray

    def __repr__(self) -> str:
        worst = ", ".join(f"{name} {margin:.2g}" for name, margin in self.as_dict().items())
        return f"Proposition1({self.count} steps; worst margins: {worst})"

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

    def attributes(self) -> dict[str, str | float]:
        """The worst margins as attributes of a dataset, and what they are relative to."""
        worst: dict[str, str | float] = {f"proposition1_{name}": margin for name, margin in self.as_dict().items()}
        sentence = f"the worst of all steps, positive where a statement fails; {MARGIN_SCALE}"
        return worst | {"proposition1_margins": sentence}


def check_proposition1(
    start: Start,
    t: np.ndarray,
    h: np.ndarray,
    q: np.ndarray,
    u: np.ndarray,
    sticks: np.ndarray,
    tolerance: float,
) -> Proposition1:
    """Margins of the steps from row i to row i + 1. t, sticks: (n + 1,), h: (n,), q, u: (n + 1, d).

    `sticks` says of a step whether its contact stuck; row 0 is not used.

    Ctrl-C ends it with those of the steps until then.
    """
    parts: list[np.ndarray] = []
    with contextlib.suppress(KeyboardInterrupt):
        for i in range(0, len(h), BLOCK):
            old, new = slice(i, min(i + BLOCK, len(h))), slice(i + 1, min(i + BLOCK, len(h)) + 1)
            with np.errstate(over="ignore", invalid="ignore"):  # a motion that leaves the numbers has no margins
                parts.append(_margins(start, t[new], h[old], q[new], u[old], u[new], sticks[new], tolerance))
    table = np.concatenate(parts, axis=1) if parts else np.empty((3, 0))
    return Proposition1(**dict(zip(MARGINS, table, strict=True)))


def _margins(
    start: Start,
    t: np.ndarray,
    h: np.ndarray,
    q: np.ndarray,
    u: np.ndarray,
    u1: np.ndarray,
    sticks: np.ndarray,
    tolerance: float,
) -> np.ndarray:
    """The three margins (3, n) of n steps."""
    rows, M, f = start.tabulate(t, q, u)
    root, W = _inverse_root(M), np.stack(directions(start.motion, rows), axis=2)
    A, turned = root @ W, np.swapaxes(root, 1, 2)  # the columns of W in the norm of M^-1
    back = np.linalg.pinv(A)
    r, pushed = _times(M, u1 - u) - h[:, None] * f, _times(turned, _times(root, h[:, None] * f))
    given = _times(root, r)
    parts = _times(back, given)
    nearest = _times(A, nearest_impulse(start.motion, rows, parts) * (rows[:, 0] >= -tolerance)[:, None])
    outside = np.linalg.norm(given - nearest * _along(nearest, given)[:, None], axis=1)
    bound = _kinetic(M, u) + h * np.linalg.norm(f, axis=1) * np.linalg.norm(root, ord=2, axis=(1, 2))
    sizes = np.abs(u1) + np.abs(u) + np.abs(pushed)
    scale = _kinetic(np.abs(M), sizes + _times(np.abs(turned @ A), _blurred(A, back, parts, sticks)))
    scale[scale == 0.0] = 1.0
    return np.array([outside / scale, (u1 * r).sum(axis=1) / scale**2, (_kinetic(M, u1) - bound) / scale])


def _blurred(A: np.ndarray, back: np.ndarray, parts: np.ndarray, sticks: np.ndarray) -> np.ndarray:
    """L (n, 1 + k), the sizes of the impulses, from A = M^-1/2 W and its inverse `back`."""
    sizes = np.abs(parts)
    G, inverse = (np.abs(x @ np.swapaxes(x, 1, 2)) for x in (np.swapaxes(A, 1, 2), back))
    return np.where(sticks[:, None], _times(inverse, _times(G, sizes)), sizes)


def _along(ray: np.ndarray, point: np.ndarray) -> np.ndarray:
    """t >= 0 (n,) for which t ray is the nearest to the point; a ray of the cone stays in it."""
    squared = (ray**2).sum(axis=1)
    return np.maximum(np.divide((ray * point).sum(axis=1), squared, out=np.zeros_like(squared), where=squared > 0.0), 0)


def _inverse_root(M: np.ndarray) -> np.ndarray:
    """L^-1 with M = L L^T (n, d, d): |L^-1 x| is the norm of M^-1, |L^-1| that of M^-1/2; NaN where there is none.

    Masses of very different size do not spoil the light ones, as they do an eigenvalue of M.
    """
    sound = np.isfinite(M).all(axis=(1, 2))
    sound[sound] = np.linalg.eigvalsh(M[sound])[:, 0] > 0.0
    root = np.full_like(M, np.nan)
    root[sound] = np.linalg.inv(np.linalg.cholesky(M[sound]))
    return root


def _times(A: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.asarray((A @ x[..., None])[..., 0])


def _kinetic(M: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.maximum((x * _times(M, x)).sum(axis=1), 0.0))
