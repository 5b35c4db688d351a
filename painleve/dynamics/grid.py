"""The instants of a trajectory: constant or given steps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from painleve.errors import InputError

__all__ = ["TimeGrid", "check_step", "check_until", "make_grid"]

MOST_STEPS = 10_000_000  # about a gigabyte of trajectory


@dataclass(frozen=True, kw_only=True, eq=False)
class TimeGrid:
    """Steps h (n,) and instants t (n + 1,) from t[0]; t[n] is the first instant at or after the end."""

    t: np.ndarray
    h: np.ndarray


def check_step(step: float) -> float:
    """A finite positive step in the scene's unit of time. Raises InputError."""
    value = float(step)
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"step: {step} must be a positive number")
    return value


def check_until(until: float) -> float:
    """A finite duration T >= 0. Raises InputError."""
    value = float(until)
    if not (math.isfinite(value) and value >= 0.0):
        raise InputError(f"until: {until} must be zero or a positive number")
    return value


def make_grid(start: float, step: float | Sequence[float] | np.ndarray, until: float) -> TimeGrid:
    """Instants that cover [start, start + until]: equal steps, or the given ones.

    Raises InputError for steps that are not positive, that do not reach the end, or that are too many to keep.
    """
    until = check_until(until)
    if np.ndim(step) == 0:
        h = check_step(float(step))  # type: ignore[arg-type]
        count = math.ceil(until / h * (1.0 - 1e-12)) if until / h < 2.0**62 else 2**62
        if count > MOST_STEPS:
            raise InputError(
                f"step: {until:g}/{h:g} is more than {MOST_STEPS} steps, too many to keep; "
                "take larger steps or a shorter time"
            )
        return TimeGrid(t=start + h * np.arange(count + 1), h=np.full(count, h))
    steps = np.asarray(step, float)
    if steps.ndim != 1 or not (np.isfinite(steps).all() and (steps > 0.0).all()):
        raise InputError("step: every given step must be a positive number")
    instants = np.concatenate([[0.0], np.cumsum(steps)])
    if instants[-1] < until * (1.0 - 1e-12):
        raise InputError(f"step: the given steps end at {instants[-1]:g}, before until = {until:g}; give more steps")
    count = int(np.searchsorted(instants, until * (1.0 - 1e-12)))
    if count > MOST_STEPS:
        raise InputError(f"step: more than {MOST_STEPS} steps are too many to keep; take larger ones")
    return TimeGrid(t=start + instants[: count + 1], h=steps[:count])
