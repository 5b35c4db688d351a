"""Error against work: small typed records, so that a chart shows what accuracy costs and which runs failed."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Generic, TypeVar

import numpy as np

__all__ = ["MISLEADING_FACTOR", "Record", "Run", "RunOutcome", "Timed", "measure", "timed"]

Result = TypeVar("Result")

MISLEADING_FACTOR = 2.0  # a number further off than this is no estimate of the reference, whatever it bounds


class RunOutcome(Enum):
    """How a run ended. MISLEADING: it ended well, and its number is more than MISLEADING_FACTOR off the reference."""

    DONE = "done"
    MISLEADING = "misleading"
    FAILED = "failed"


@dataclass(frozen=True, kw_only=True)
class Run:
    """What one run of a method found: the number a reader takes from it, and the evaluations spent.

    `proved`: a proved bound on the distance of that number to the truth; NaN where the method proves none.
    """

    value: float
    evaluations: int
    proved: float = math.nan
    sentence: str = ""


@dataclass(frozen=True, kw_only=True)
class Record:
    """One point of a work-precision chart; `error` and `proved` are relative to the reference, NaN if the run failed.

    `seconds` is the median over warm runs, `first_seconds` the first call, with whatever it compiles or loads.
    """

    problem: str
    method: str
    setting: float
    value: float
    reference: float
    error: float
    proved: float
    evaluations: int
    first_seconds: float
    seconds: float
    outcome: RunOutcome
    sentence: str


@dataclass(frozen=True, kw_only=True)
class Timed(Generic[Result]):
    """What a run returned first, and its wall times: of that run, and the median of the warm ones after it."""

    result: Result
    first_seconds: float
    seconds: float


def timed(
    run: Callable[[], Result],
    *,
    repetitions: int = 3,
    patience: float = 1.0,
    clock: Callable[[], float] = time.perf_counter,
) -> Timed[Result]:
    """Run once cold, then warm: `repetitions` times, or until `patience` seconds are spent, but once at least."""
    start = clock()
    result = run()
    first = clock() - start
    return Timed(result=result, first_seconds=first, seconds=_warm_runs(run, repetitions, patience, clock))


def measure(
    problem: str,
    method: str,
    setting: float,
    run: Callable[[], Run],
    *,
    reference: float,
    repetitions: int = 3,
    patience: float = 1.0,
    clock: Callable[[], float] = time.perf_counter,
) -> Record:
    """Time a method as `timed` does, and compare its number with the reference.

    An ArithmeticError or a ValueError of the run becomes a failed record with its message: a chart shows it.
    Raises ValueError unless the reference is positive and finite.
    """
    if not (math.isfinite(reference) and reference > 0.0):
        raise ValueError(f"{problem}: the reference {reference} must be positive for errors to be relative to it")
    start = clock()
    try:
        timing = timed(run, repetitions=repetitions, patience=patience, clock=clock)
        found, first, warm = timing.result, timing.first_seconds, timing.seconds
        outcome = _judge(found.value, reference)
    except (ArithmeticError, ValueError) as error:
        found = Run(value=math.nan, evaluations=0, sentence=str(error))
        first, warm, outcome = clock() - start, math.nan, RunOutcome.FAILED
    return Record(
        problem=problem,
        method=method,
        setting=setting,
        value=found.value,
        reference=reference,
        error=abs(found.value - reference) / reference,
        proved=found.proved / reference,
        evaluations=found.evaluations,
        first_seconds=first,
        seconds=warm,
        outcome=outcome,
        sentence=found.sentence,
    )


def _warm_runs(run: Callable[[], object], repetitions: int, patience: float, clock: Callable[[], float]) -> float:
    seconds: list[float] = []
    while not seconds or (len(seconds) < repetitions and sum(seconds) < patience):
        start = clock()
        run()
        seconds.append(clock() - start)
    return float(np.median(seconds))


def _judge(value: float, reference: float) -> RunOutcome:
    near = reference / MISLEADING_FACTOR <= value <= reference * MISLEADING_FACTOR
    return RunOutcome.DONE if near else RunOutcome.MISLEADING
