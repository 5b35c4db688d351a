"""Configurations of the ball that touch or penetrate, as boxes: where each branch of the law has members.

Shape offsets are measured in units of the ball's radius. The coordinates that only carry the contact give room: g can
be raised by carried * sqrt(1 - |x|^2), so contact is possible where g(x) + room >= 0; a slipping branch needs
a + s b >= 0 too. For one shape coordinate that leaves intervals, for two it leaves arcs of circles about q.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

__all__ = ["Conditions", "PlaneChart", "charts"]

Conditions = Callable[[np.ndarray], np.ndarray]  # (s, n) offsets -> (c, n) values, all >= 0 where there are members

INTERVAL_POINTS = 64  # even: zero itself, where all conditions may vanish, is not among them
ARC_POINTS = 48
RADII = np.linspace(0.0, 1.0, 9)
SMALLEST_RADIUS = 1e-6  # a whole chart shrinks to one point at q
STEPS = 16


@dataclass(frozen=True, kw_only=True, eq=False)
class PlaneChart:
    """A box [0, 1]^size and the offsets (s, n) of its points (size, n); NaN where there are none."""

    size: int
    place: Callable[[np.ndarray], np.ndarray]


def charts(shape: int, conditions: Conditions) -> Iterator[PlaneChart]:
    """The charts for 0, 1 or 2 shape coordinates."""
    if shape == 0:
        if np.all(conditions(np.zeros((0, 1))) >= 0.0):
            yield PlaneChart(size=0, place=lambda box: np.zeros((0, box.shape[1])))
    elif shape == 1:
        for low, high in _intervals(conditions):
            yield PlaneChart(size=1, place=_interval(low, high))
    else:
        most = max(len(arcs) for arcs in _arcs(conditions, RADII[1:]))
        for number in range(most):
            yield PlaneChart(size=2, place=_arc(conditions, number))


def _interval(low: float, high: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda box: low + (high - low) * box[:1]


def _intervals(conditions: Conditions) -> list[tuple[float, float]]:
    x = np.linspace(-1.0, 1.0, INTERVAL_POINTS)
    _, roots = _crossings(lambda _, t: conditions(t[None, :]), np.zeros(1), x)
    return _between(np.sort(roots), -1.0, 1.0, lambda t: conditions(t[None, :]))


def _arc(conditions: Conditions, number: int) -> Callable[[np.ndarray], np.ndarray]:
    def place(box: np.ndarray) -> np.ndarray:
        radius = np.maximum(box[0], SMALLEST_RADIUS)
        different, inverse = np.unique(radius, return_inverse=True)
        ends = np.full((2, different.size), np.nan)
        for i, arcs in enumerate(_arcs(conditions, different)):
            if number < len(arcs):
                ends[:, i] = arcs[number]
        low, high = ends[:, inverse]
        return _polar(radius, low + (high - low) * box[1])

    return place


def _polar(radius: np.ndarray, angle: np.ndarray) -> np.ndarray:
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)])


def _arcs(conditions: Conditions, radii: np.ndarray) -> list[list[tuple[float, float]]]:
    """For each radius the arcs (from, to) on which all conditions hold, by rising angle."""
    angles = np.linspace(0.0, 2.0 * np.pi, ARC_POINTS + 1) + 0.1
    row, roots = _crossings(lambda i, t: conditions(_polar(radii[i], t)), radii, angles)
    found = []
    for i, radius in enumerate(radii):
        here = np.sort(roots[row == i])
        first = here[0] if here.size else angles[0]  # cut the circle where a condition changes sign
        found.append(_between(here, first, first + 2.0 * np.pi, partial(_on_circle, conditions, radius)))
    return found


def _on_circle(conditions: Conditions, radius: float, angle: np.ndarray) -> np.ndarray:
    return conditions(_polar(np.full(angle.shape, radius), angle))


def _between(roots: np.ndarray, low: float, high: float, conditions: Conditions) -> list[tuple[float, float]]:
    """The pieces between consecutive roots on which all conditions hold, joined where they touch."""
    ends = np.unique(np.concatenate([[low], roots, [high]]))
    holds = np.all(conditions(0.5 * (ends[:-1] + ends[1:])) >= 0.0, axis=0)
    pieces: list[tuple[float, float]] = []
    for a, b, inside in zip(ends[:-1], ends[1:], holds, strict=True):
        if inside and pieces and pieces[-1][1] == a:
            pieces[-1] = (pieces[-1][0], b)
        elif inside:
            pieces.append((a, b))
    return pieces


def _crossings(
    conditions: Callable[[np.ndarray, np.ndarray], np.ndarray], lines: np.ndarray, grid: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Where a condition changes sign along each line: (line, place), on all brackets at once."""
    which = np.repeat(np.arange(lines.size), grid.size)
    values = conditions(which, np.tile(grid, lines.size))
    values = values.reshape(len(values), lines.size, grid.size)
    condition, line, cell = np.nonzero((values[..., 1:] >= 0.0) != (values[..., :-1] >= 0.0))
    each = np.arange(cell.size)
    low, high = grid[cell], grid[cell + 1]
    below, above = values[condition, line, cell], values[condition, line, cell + 1]
    side = np.zeros(cell.size)
    for _ in range(STEPS if cell.size else 0):
        share = below / (below - above)  # false position, with the Illinois weights
        middle = low + share * (high - low)
        value = conditions(line, middle)[condition, each]
        upper = (value >= 0.0) == (above >= 0.0)
        again = np.where(side == np.where(upper, 1.0, -1.0), 0.5, 1.0)
        below, above = np.where(upper, again * below, value), np.where(upper, value, again * above)
        side = np.where(upper, 1.0, -1.0)
        low, high = np.where(upper, low, middle), np.where(upper, middle, high)
    return line, np.where(np.abs(below) < np.abs(above), low, high)
