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

Event = Callable[[float, np.ndarray], float]
Dense = Callable[[float | np.ndarray], np.ndarray]  # t (n,) to y (m, n)


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
    """Integrate until an event function falls through zero; returns its index, or None at the end or at a failure.

    After every step `accept` gets the new place and the interpolant of the step; a step with an event ends there. A
    failure shows in `solver.status`.
    """
    values = [event(solver.t, solver.y) for event in events]
    while solver.status == "running":
        before = solver.t
        solver.step()
        if solver.status == "failed":
            return None
        dense, place = solver.dense_output(), ArcPoint(solver.t, solver.y)
        old, values = values, [event(*place) for event in events]
        fallen = [i for i, pair in enumerate(zip(old, values, strict=True)) if pair[0] >= 0.0 >= pair[1]]
        if fallen:
            times = [_root(events[i], dense, (before, old[i]), (place.t, values[i])) for i in fallen]
            first = int(np.argmin(times))
            accept(ArcPoint(times[first], dense(times[first])), dense)
            return fallen[first]
        accept(place, dense)
    return None


def _root(event: Event, dense: Dense, low: tuple[float, float], high: tuple[float, float]) -> float:
    """When the event function vanishes within a step; low, high: (time, value), of opposite signs or zero.

    The values at the ends are taken as known: those of the interpolant may differ in their last bits, and in sign.
    """
    known = dict((low, high))

    def value(t: float) -> float:
        return known[t] if t in known else event(t, dense(t))

    return float(brentq(value, low[0], high[0], xtol=ROOT_TOLERANCE, rtol=ROOT_TOLERANCE))
