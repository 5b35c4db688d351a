"""The search for the farthest member with friction in space: ascents from the best places of a sample on every chart.

Each ascent is sequential quadratic programming (scipy's SLSQP) with gradients by central differences, which a compiled
batch makes cheap; then clouds of points that shrink about the best places, which cross kinks of S that an ascent takes
for smooth, and ascents from there. It is a search: a maximum whose basin holds none of the starts is missed, and
nothing shows that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from painleve.asymptotics.space.ball import SpaceBall
from painleve.asymptotics.space.charts import SpaceChart, charts_of

__all__ = ["SpaceFound", "search_in_space"]

DIFFERENCE = 1e-6
MOST_STEPS = 100
CLOUD, ROUNDS, WIDEST = 256, 48, 1e-2  # points a round, rounds, and the first radius
POLISHED, POLISHES = 3, 4  # the best ascents of a chart, and rounds for each
SETTLED = 1e-9  # relative: a round that adds less is the last
TOLERANCE = 1e-12  # of eps: by what a condition may be missed; the member is moved inside


@dataclass(frozen=True, kw_only=True, eq=False)
class SpaceFound:
    """The best place of a search: dist/eps, where (in units of eps), on which chart, and what refinement added to the
    first ascent's."""

    value: float
    x: np.ndarray
    dv: np.ndarray
    chart: str
    error: float


def search_in_space(ball: SpaceBall, starts: int) -> SpaceFound | None:
    """The best place of all charts; None where no start is a member in contact."""
    found = [_search(chart, starts) for chart in charts_of(ball)]
    return max((f for f in found if f is not None), key=lambda f: f.value, default=None)


def _search(chart: SpaceChart, count: int) -> SpaceFound | None:
    starts = chart.starts(count)
    tops = [_ascend(chart, z) for z in starts.T]
    if not tops:
        return None
    tops.sort(key=lambda top: -top[0])
    ends = [_polished(chart, *top) for top in tops[:POLISHED]]
    value, z, gain = max(ends, key=lambda end: end[0])
    x, dv = chart.place(z[:, None])
    return SpaceFound(value=value, x=x[:, 0], dv=dv[:, 0], chart=chart.name, error=gain)


def _polished(chart: SpaceChart, value: float, z: np.ndarray) -> tuple[float, np.ndarray, float]:
    """(value, place, what was added): clouds and ascents in turn, as long as they add something."""
    first = value
    for _ in range(POLISHES):
        better, place = _cloud(chart, value, z)
        better, place = max((better, place), _ascend(chart, place), key=lambda end: end[0])
        settled = better - value <= SETTLED * better
        value, z = better, place
        if settled:
            break
    return value, z, value - first


def _ascend(chart: SpaceChart, start: np.ndarray) -> tuple[float, np.ndarray]:
    """(value, place): the better one of the start and of where SLSQP goes from there."""
    scale = max(1.0, _safe_value(chart, start))
    steps = np.hstack([np.zeros((start.size, 1)), DIFFERENCE * np.eye(start.size), -DIFFERENCE * np.eye(start.size)])
    known: dict[bytes, tuple[np.ndarray, ...]] = {}

    def local(z: np.ndarray) -> tuple[np.ndarray, ...]:
        """Value, gradient, conditions and their gradients."""
        key = z.tobytes()
        if key not in known:
            known.clear()
            value, conditions = chart.evaluate(z[:, None] + steps)
            n = z.size
            slope = (value[1 : n + 1] - value[n + 1 :]) / (2.0 * DIFFERENCE)
            slopes = (conditions[:, 1 : n + 1] - conditions[:, n + 1 :]) / (2.0 * DIFFERENCE)
            known[key] = value[0], slope, conditions[:, 0], slopes
        return known[key]

    with np.errstate(all="ignore"):
        result = minimize(
            lambda z: (-local(z)[0] / scale, -local(z)[1] / scale),
            start,
            jac=True,
            method="SLSQP",
            bounds=chart.bounds,
            options={"maxiter": MOST_STEPS, "ftol": 1e-14},
            constraints={"type": "ineq", "fun": lambda z: local(z)[2], "jac": lambda z: local(z)[3]},
        )
    ends = [start, chart.repaired(result.x[:, None])[:, 0]] if np.all(np.isfinite(result.x)) else [start]
    return max(((_safe_value(chart, z), z) for z in ends), key=lambda end: end[0])


def _safe_value(chart: SpaceChart, z: np.ndarray) -> float:
    """The value at z, -inf where z is not the place of a member."""
    return float(_values(chart, z[:, None])[0])


def _values(chart: SpaceChart, z: np.ndarray) -> np.ndarray:
    value, conditions = chart.evaluate(z)
    return np.where(conditions.min(axis=0) >= -TOLERANCE, value, -np.inf)


def _cloud(chart: SpaceChart, value: float, z: np.ndarray) -> tuple[float, np.ndarray]:
    rng, radius = np.random.default_rng(0), WIDEST
    lower, upper = np.array(chart.bounds).T
    for _ in range(ROUNDS):
        steps = rng.normal(size=(z.size, CLOUD)) * radius
        tried = chart.repaired(np.clip(z[:, None] + steps, lower[:, None], upper[:, None]))
        values = _values(chart, tried)
        best = int(np.argmax(values))
        if values[best] > value:
            value, z = float(values[best]), tried[:, best]
        else:
            radius *= 0.5
    return value, z
