"""One arc of smooth motion: an integrator of scipy, driven step by step up to the first event.

`solve_ivp` gives nothing back when it is interrupted. Here every accepted step is handed on before the next one begins,
so that Ctrl-C costs no more than the step under way.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from scipy.optimize import brentq

__all__ = ["ArcPoint", "Dense", "Event", "follow"]

ROOT_TOLERANCE = 4 * np.finfo(float).eps  # of the time of an event, as in solve_ivp

Dense = Callable[[float | np.ndarray], np.ndarray]  # t (n,) to y (m, n)


class Event(NamedTuple):
    """A function of (t, y) that falls through zero; values up to `noise` about zero may be rounding.

    An arc that begins with such a value has not begun with the event: it comes when the value falls below -noise, or
    through zero once it has been greater than the noise.
    """

    value: Callable[[float, np.ndarray], float]
    noise: float = 0.0


class ArcPoint(NamedTuple):
    """A time and the state there: one value, so that no interruption can come between the two."""

    t: float
    y: np.ndarray


class Solver(Protocol):
    """What is used of scipy.integrate.OdeSolver."""

    t: float
    y: np.ndarray
    status: str

    def step(self) -> str | None: ...
    def dense_output(self) -> Dense: ...


def follow(solver: Solver, events: Sequence[Event], accept: Callable[[ArcPoint, Dense], None]) -> int | None:
    """Integrate until an event comes; returns its index, or None at the end or at a failure.

    After every step `accept` gets the new place and the interpolant of the step; a step with an event ends there. A
    failure shows in `solver.status`.
    """
    values = [event.value(solver.t, solver.y) for event in events]
    away = [value > event.noise for value, event in zip(values, events, strict=True)]
    while solver.status == "running":
        before = solver.t
        solver.step()
        if solver.status == "failed":
            return None
        dense, place = solver.dense_output(), ArcPoint(solver.t, solver.y)
        old, values = values, [event.value(*place) for event in events]
        levels = [0.0 if far else -event.noise for far, event in zip(away, events, strict=True)]
        fallen = [i for i, level in enumerate(levels) if _falls(old[i], values[i], level, away[i])]
        if fallen:
            times = [_root(events[i].value, levels[i], dense, (before, old[i]), (place.t, values[i])) for i in fallen]
            first = int(np.argmin(times))
            accept(ArcPoint(times[first], dense(times[first])), dense)
            return fallen[first]
        away = [far or value > event.noise for far, value, event in zip(away, values, events, strict=True)]
        accept(place, dense)
    return None


def _falls(old: float, new: float, level: float, away: bool) -> bool:
    """Whether a value falls through the level; one that began there has to go below it."""
    return old >= level >= new if away else old >= level > new


def _root(
    event: Callable[[float, np.ndarray], float],
    level: float,
    dense: Dense,
    low: tuple[float, float],
    high: tuple[float, float],
) -> float:
    """When the event function is at the level within a step; low, high: (time, value), on the two sides or on it.

    The values at the ends are taken as known: those of the interpolant may differ in their last bits, and in sign.
    """
    known = dict((low, high))

    def value(t: float) -> float:
        return (known[t] if t in known else event(t, dense(t))) - level

    return float(brentq(value, low[0], high[0], xtol=ROOT_TOLERANCE, rtol=ROOT_TOLERANCE))
