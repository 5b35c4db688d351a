"""Records of error against work: what failed stays visible, and compilation is kept apart."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from painleve.errors import InputError
from studies.benchmark.records import Run, RunOutcome, measure


class Clock:
    """Time that passes only where a run says so."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def run_lasting(clock: Clock, *seconds: float, value: float = 1.0):
    """A run whose calls last so long, the last duration for ever; and the list of its calls."""
    calls = []

    def run() -> Run:
        clock.now += seconds[min(len(calls), len(seconds) - 1)]
        calls.append(clock.now)
        return Run(value=value, evaluations=7)

    return run, calls


def measured(value: float, reference: float, **more):
    return measure("p", "m", 1.0, lambda: Run(value=value, evaluations=1, **more), reference=reference)


def test_the_first_call_is_kept_apart_from_the_median_of_the_warm_ones():
    clock = Clock()
    run, calls = run_lasting(clock, 30.0, 0.25, 0.5, 0.125)
    record = measure("p", "m", 1e3, run, reference=1.0, repetitions=3, patience=10.0, clock=clock)
    assert (record.first_seconds, record.seconds) == (30.0, 0.25)
    assert len(calls) == 4


def test_a_slow_run_is_repeated_once_only():
    clock = Clock()
    run, calls = run_lasting(clock, 5.0)
    record = measure("p", "m", 1e3, run, reference=1.0, repetitions=3, patience=4.0, clock=clock)
    assert len(calls) == 2
    assert record.seconds == 5.0


@pytest.mark.parametrize("error", [ArithmeticError("undecided"), InputError("no such thing")])
def test_a_run_that_fails_is_a_record_with_its_reason_and_the_time_it_took(error):
    clock = Clock()

    def run() -> Run:
        clock.now += 2.0
        raise error

    record = measure("p", "m", 1e3, run, reference=1.0, clock=clock)
    assert record.outcome is RunOutcome.FAILED
    assert record.sentence == str(error)
    assert record.first_seconds == 2.0
    assert math.isnan(record.error)
    assert math.isnan(record.seconds)


def test_a_programming_error_is_not_taken_for_a_failed_run():
    with pytest.raises(TypeError):
        measure("p", "m", 1e3, lambda: Run(value=1.0), reference=1.0)  # no evaluations


@pytest.mark.parametrize(
    ("value", "outcome"),
    [
        (1.9, RunOutcome.DONE),
        (2.1, RunOutcome.MISLEADING),
        (0.51, RunOutcome.DONE),
        (0.49, RunOutcome.MISLEADING),
        (0.0, RunOutcome.MISLEADING),
        (math.nan, RunOutcome.MISLEADING),
    ],
)
def test_a_number_more_than_a_factor_two_off_is_misleading(value, outcome):
    assert measured(value, 1.0).outcome is outcome


@given(value=st.floats(1e-6, 1e6), reference=st.floats(1e-6, 1e6), scale=st.sampled_from([2.0**-40, 2.0**30]))
def test_errors_are_relative_so_a_change_of_units_changes_nothing(value, reference, scale):
    first = measured(value, reference, proved=value)
    second = measured(value * scale, reference * scale, proved=value * scale)
    assert first.error == second.error
    assert first.proved == second.proved
    assert first.outcome is second.outcome


@pytest.mark.parametrize("reference", [0.0, -1.0, math.nan, math.inf])
def test_there_is_no_relative_error_without_a_positive_reference(reference):
    with pytest.raises(ValueError, match="must be positive"):
        measured(1.0, reference)
