"""Between which directions of the slip Coulomb's law has two solutions, or three: bands that a grid would break."""

from __future__ import annotations

import numpy as np

from painleve.core.space.two_laws import compare_laws

__all__ = ["NUMBERS", "bands"]

NUMBERS = (2, 3)  # of solutions beside the usual one
SCAN = 1001  # directions on the half circle: a band narrower than pi/1000 may be missed
HALVINGS = 30


def bands(G: np.ndarray, Y: np.ndarray, v_n: float, frictions: np.ndarray) -> np.ndarray:
    """(number, edge, friction): the least and the largest angle in [0, pi] with that many solutions; NaN for none.

    A map is mirrored at b, and on the half circle the angles with one number are an interval. The edges are found to
    pi/SCAN by a scan, then by bisection. Raises ArithmeticError where the angles are no interval.
    """
    angles = np.linspace(0.0, np.pi, SCAN)
    counts = _counts(G, Y, v_n, frictions, angles)
    found = np.full((len(NUMBERS), 2, len(frictions)), np.nan)
    for k, number in enumerate(NUMBERS):
        for i, row in enumerate(counts == number):
            inside = np.flatnonzero(row)
            if not inside.size:
                continue
            first, last = int(inside[0]), int(inside[-1])
            if not row[first : last + 1].all():
                raise ArithmeticError(f"mu = {frictions[i]:g}: directions with {number} solutions are no interval")
            mu = frictions[i : i + 1]
            found[k, 0, i] = _edge(G, Y, v_n, mu, number, angles[first], angles[first - 1] if first else None)
            found[k, 1, i] = _edge(G, Y, v_n, mu, number, angles[last], angles[last + 1] if last + 1 < SCAN else None)
    return found


def _edge(
    G: np.ndarray, Y: np.ndarray, v_n: float, mu: np.ndarray, number: int, inside: float, outside: float | None
) -> float:
    """The last angle with that number from the inside; `outside` is None at an end of the half circle."""
    if outside is None:
        return inside
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        if _counts(G, Y, v_n, mu, np.array([middle]))[0, 0] == number:
            inside = middle
        else:
            outside = middle
    return inside


def _counts(G: np.ndarray, Y: np.ndarray, v_n: float, frictions: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """(friction, angle): the numbers of solutions at angles of the slip against b."""
    b = G[0, 1:] / np.linalg.norm(G[0, 1:])
    slips = np.outer(np.cos(angles), b) + np.outer(np.sin(angles), [-b[1], b[0]])
    shape = (len(frictions), len(angles))
    counts, sticks, apart = np.zeros(shape, np.int64), np.zeros(shape, np.int64), np.zeros((*shape, 2))
    compare_laws(G, Y, v_n, slips, frictions, counts, sticks, apart)
    return counts
