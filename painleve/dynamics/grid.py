"""The instants of a trajectory: constant or given steps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from painleve.errors import InputError

__all__ = ["TimeGrid", "check_step", "check_until", "make_grid"]

ROUNDING = 1e-12  # relative: an instant that close to the end is the end
MOST_STEPS = 10_000_000  # about a gigabyte of trajectory


@dataclass(frozen=True, kw_only=True, eq=False)
class TimeGrid:
    """Steps h (n,) and instants t (n + 1,) from t[0]; t[n] is the end, to rounding.

    `given` (n,) are the steps as they were given, of which the last one may be longer: it says what O(h) is.
    """

    t: np.ndarray
    h: np.ndarray
    given: np.ndarray


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
    """Instants that cover [start, start + until]: equal steps, or the given ones, the last of which ends at the end.

    Steps that reach it to rounding stay as they are; of one that would go beyond it only the part up to it is taken.
    Raises InputError for steps that are not positive, that do not reach the end, or that are too many to keep.
    """
    until = check_until(until)
    if np.ndim(step) == 0:
        h = check_step(float(step))  # type: ignore[arg-type]
        count = math.ceil(until / h * (1.0 - ROUNDING)) if until / h < 2.0**62 else 2**62
        if count > MOST_STEPS:
            raise InputError(
                f"step: {until:g}/{h:g} is more than {MOST_STEPS} steps, too many to keep; "
                "take larger steps or a shorter time"
            )
        return _ended(start + h * np.arange(count + 1), np.full(count, h), start + until, h * count - until, until)
    steps = np.asarray(step, float)
    if steps.ndim != 1 or not (np.isfinite(steps).all() and (steps > 0.0).all()):
        raise InputError("step: every given step must be a positive number")
    instants = np.concatenate([[0.0], np.cumsum(steps)])
    if instants[-1] < until * (1.0 - ROUNDING):
        raise InputError(f"step: the given steps end at {instants[-1]:g}, before until = {until:g}; give more steps")
    count = int(np.searchsorted(instants, until * (1.0 - ROUNDING)))
    if count > MOST_STEPS:
        raise InputError(f"step: more than {MOST_STEPS} steps are too many to keep; take larger ones")
    beyond = float(instants[count]) - until
    return _ended(start + instants[: count + 1], steps[:count], start + until, beyond, until)


def _ended(t: np.ndarray, h: np.ndarray, end: float, beyond: float, until: float) -> TimeGrid:
    """The grid with its last step shortened where it would go beyond the end by more than rounding."""
    given = h
    if beyond > ROUNDING * until:
        h = h.copy()
        t[-1], h[-1] = end, h[-1] - beyond
    return TimeGrid(t=t, h=h, given=given)
