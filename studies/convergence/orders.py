"""The order that is observed: the slope of log error against log control, and what it says of convergence.

Where an event falls within a step is chance, and moves the error of one step size up and down; so step sizes come in
levels of several each, and the order is the slope through the largest error of each level.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum

import numpy as np

from studies.convergence.runs import MotionRun

__all__ = ["ADAPTIVE_SLACK", "EXPECTED_ORDER", "SLACK", "VERDICTS", "Convergence", "judge_order", "worst_of_levels"]

EXPECTED_ORDER = 1.0
"""In what each scheme is controlled by: a jump or a kink within a step costs up to a step, whatever the order is where
the motion is smooth; a compliant contact lasts for its own time scale; an adaptive error follows its tolerance."""
SLACK = 0.1  # below the expected order, beside two standard errors: levels are few
ADAPTIVE_SLACK = 0.5  # an adaptive method follows its tolerance roughly: it takes few steps, and not always its longest
STAGNANT = 0.25  # an order below: the error does not vanish in any way that a user could wait for
RESOLVED = 10.0  # errors below so many times what the reference resolves are not fitted
LEAST_LEVELS = 3


class Convergence(Enum):
    """What the observed order says; UNRESOLVED: fewer than three levels stand out from the reference's resolution."""

    AS_EXPECTED = "as_expected"
    SLOWER = "slower"
    STAGNANT = "does_not_converge"
    UNRESOLVED = "unresolved"
    FAILED = "failed"


VERDICTS = tuple(v.value for v in Convergence)


def worst_of_levels(runs: Sequence[MotionRun], levels: np.ndarray) -> list[int]:
    """The run with the largest error of each level, among those that ended well."""
    done = np.array([r.done for r in runs])
    errors = np.array([r.upper for r in runs])
    kept = [np.flatnonzero(done & (levels == level)) for level in np.unique(levels)]
    return [int(k[np.argmax(errors[k])]) for k in kept if len(k)]


def judge_order(
    runs: Sequence[MotionRun], levels: np.ndarray, resolution: float, slack: float
) -> tuple[float, float, Convergence]:
    """The slope of log error against log control through the worst run of each level, and what it says."""
    if not all(r.done for r in runs):
        return math.nan, math.nan, Convergence.FAILED
    fitted = [r for r in (runs[k] for k in worst_of_levels(runs, levels)) if r.upper > RESOLVED * resolution]
    if len(fitted) < LEAST_LEVELS:
        return math.nan, math.nan, Convergence.UNRESOLVED
    x, y = np.log([r.value for r in fitted]), np.log([r.upper for r in fitted])
    slope, error = _slope(x, y)
    if slope < STAGNANT:
        return slope, error, Convergence.STAGNANT
    enough = slope >= EXPECTED_ORDER - slack - 2.0 * error
    return slope, error, Convergence.AS_EXPECTED if enough else Convergence.SLOWER


def _slope(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Least-squares slope and its standard error."""
    spread = x - x.mean()
    slope = float(spread @ y / (spread @ spread))
    residual = y - y.mean() - slope * spread
    return slope, math.sqrt(float(residual @ residual) / (len(x) - 2) / float(spread @ spread))
