"""Contacts for the tests of Coulomb's law: scenes with a given matrix G, and random numbers for the compiled solver."""

from __future__ import annotations

from dataclasses import dataclass

import mpmath
import numpy as np
import sympy as sp

from painleve.core.codes import ContactMode
from painleve.core.space.coulomb import COLUMNS, MOST_SOLUTIONS, coulomb_disc
from painleve.core.space.tangent_plane import Delassus
from painleve.mechanics.friction import Section
from painleve.mechanics.scene import Coordinate, Scene, make_scene

DIGITS = 60


def scene_with(G: list[list[object]], friction: Section | None) -> Scene:
    """A point x_1 >= 0 with M = G^-1: W is the identity, and the contact velocity is the velocity."""
    coordinates = [Coordinate(name=f"x{i}", unit="m", sentence="a coordinate") for i in range(len(G))]
    symbols = [c.symbol for c in coordinates]
    return make_scene(
        name="point",
        sentence="a point with a given inertia",
        source="a test",
        coordinates=coordinates,
        parameters=(),
        inertia=sp.Matrix(G).inv(),
        constraint=-symbols[0],
        tangential_displacements=symbols[1:] if friction else (),
        friction=friction,
    )


def delassus(G: np.ndarray) -> Delassus:
    """A matrix as compiled code takes it."""
    return Delassus(*(float(x) for x in G[np.triu_indices(3)]))


@dataclass(frozen=True)
class Numbers:
    """G = [[a, b], [b, C]] and the contact velocity, for the unit disc."""

    G: np.ndarray
    v: np.ndarray

    @property
    def p(self) -> float:
        return float(self.G[0, 0] - np.hypot(self.G[0, 1], self.G[0, 2]))

    def solve(self) -> np.ndarray:
        """(n, COLUMNS) by the compiled solver."""
        G, found = self.G, np.full((MOST_SOLUTIONS, COLUMNS), np.nan)
        count = coulomb_disc(delassus(G), self.p, tuple(self.v), found)
        return found[:count]

    def slips(self) -> np.ndarray:
        """(n, 3) impulses of the compiled solver's slips, sorted."""
        rows = self.solve()
        slips = rows[rows[:, 0] == ContactMode.SLIP][:, 1:4]
        return slips[np.lexsort(slips.T)]


def random_numbers(seed: int, count: int, *, spread: float = 1.0) -> list[Numbers]:
    """Contacts of all signs of gamma, with v_n = 1 and -1; `spread` of the logarithms of sizes."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        factor = rng.normal(size=(3, 3)) * np.exp(spread * rng.normal(size=3))[:, None]
        friction = np.diag([1.0, *2 * [np.exp(rng.normal())]])
        v_t = rng.normal(size=2) * np.exp(2.0 * rng.normal())
        G = friction @ factor.T @ factor @ friction
        made.append(Numbers((G + G.T) / 2.0, np.array([rng.choice([-1.0, 1.0]), *v_t])))
    return made


def slips_by_the_quartic_in_kappa(contact: Numbers) -> np.ndarray:
    """(n, 3) impulses, sorted, by another elimination and with 60 digits.

    With Q = v_t b^T - v_n C and p = a v_t - v_n b a slip is (Q + x) d = -p, |d| = 1, x = kappa (a + b.d): the quartic
    det(Q + x)^2 = |adj(Q + x) p|^2.
    """
    with mpmath.workdps(DIGITS):
        a, b, C = (
            mpmath.mpf(contact.G[0, 0]),
            mpmath.matrix(contact.G[1:, 0].tolist()),
            mpmath.matrix(contact.G[1:, 1:].tolist()),
        )
        nu, v_t = -mpmath.mpf(contact.v[0]), mpmath.matrix(contact.v[1:].tolist())
        Q, p = v_t * b.T + nu * C, a * v_t + nu * b
        trace, determinant = Q[0, 0] + Q[1, 1], Q[0, 0] * Q[1, 1] - Q[0, 1] * Q[1, 0]
        h = mpmath.matrix([Q[1, 1] * p[0] - Q[0, 1] * p[1], Q[0, 0] * p[1] - Q[1, 0] * p[0]])
        pp, hp, hh = (p.T * p)[0], (h.T * p)[0], (h.T * h)[0]
        quartic = [1, 2 * trace, trace**2 + 2 * determinant - pp, 2 * (trace * determinant - hp), determinant**2 - hh]
        found = []
        for root in mpmath.polyroots(quartic, maxsteps=500, extraprec=300):
            if abs(mpmath.im(root)) > mpmath.mpf(10) ** (-DIGITS // 2) * abs(root):
                continue
            x = mpmath.re(root)
            d = -(h + x * p) / (determinant + trace * x + x**2)
            lever = a + (b.T * d)[0]
            if nu / lever > 0 and x / lever > 0:
                found.append([nu / lever, nu / lever * d[0], nu / lever * d[1]])
        slips = np.array(found, dtype=float).reshape(-1, 3)
    return slips[np.lexsort(slips.T)]


def slips_by_scanning(contact: Numbers, count: int = 30_000) -> int:
    """How many slips a grid of directions sees: sign changes of d x w where lambda > 0 and friction opposes the
    slip."""
    angle = np.linspace(-np.pi, np.pi, count, endpoint=False) + 1.234e-5
    d = np.array([np.cos(angle), np.sin(angle)])
    a, b, C, v_n, v_t = contact.G[0, 0], contact.G[1:, 0], contact.G[1:, 1:], contact.v[0], contact.v[1:]
    lever = a + b @ d
    w = v_t[:, None] * lever - v_n * (b[:, None] + C @ d)
    turning = d[0] * w[1] - d[1] * w[0]
    changes = np.sign(turning) != np.sign(np.roll(turning, -1))
    return int(np.sum(changes & (-v_n * lever > 0.0) & ((d * w).sum(axis=0) * lever < 0.0)))
