"""The runs of every scheme on one motion, at every effort, and the error and the time of each."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from painleve.core.motion_codes import Ending
from painleve.dynamics.graph_distance import graph_distance, velocity_graph
from painleve.dynamics.scheme import Stepped
from painleve.dynamics.schemes import SCHEME_NAMES, load_scheme
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory
from studies.benchmark.records import timed
from studies.convergence.motions import Problem, Reference

__all__ = ["CONTROLS", "MotionEffort", "MotionRun", "MotionTrial", "compile_motion", "run_trial", "trials_of"]

CONTROLS = ("step", "tolerance", "contact_time")


@dataclass(frozen=True, kw_only=True)
class MotionEffort:
    """How much work. Numbers of steps run from `fewest` to `most` in `levels`, `phases` numbers near each.

    `tolerances` are those of the event-driven method, `stiffnesses` (N/m) those of the compliant one; `instants`:
    how finely references are recorded; a warm run is repeated within `patience` seconds.
    """

    fewest: int = 100
    most: int = 50_000
    levels: int = 8
    phases: int = 6
    tolerances: Sequence[float] = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11)
    stiffnesses: Sequence[float] = (1e3, 1e4, 1e5, 1e6)
    instants: int = 20_000
    patience: float = 0.02


@dataclass(frozen=True, kw_only=True)
class MotionTrial:
    """One run: a scheme, what it is controlled by and its value, and how to run it; `recorded`, for the distance only,
    where an adaptive method returns few instants when it is timed."""

    scheme: str
    level: int
    control: str
    value: float
    run: Callable[[], Trajectory]
    recorded: Callable[[], Trajectory] | None = None


@dataclass(frozen=True, kw_only=True)
class MotionRun:
    """What is kept of a run: the enclosure of its error (NaN where it failed), its times and its last sentence."""

    value: float
    lower: float
    upper: float
    first_seconds: float
    seconds: float
    done: bool
    sentence: str


def compile_motion(start: Start) -> float:
    """Seconds until the scene's steps and the distance are ready: apart from all other times."""
    begin = time.perf_counter()
    found = simulate(start, step=1e-4, until=3e-4, monitor=False)
    graph = velocity_graph(found.t, found.u)
    graph_distance(graph, graph)
    return time.perf_counter() - begin


def trials_of(problem: Problem, start: Start, effort: MotionEffort, seed: int) -> Iterator[MotionTrial]:
    """The runs on one problem, in the same order for every problem."""
    until = problem.until
    for name in SCHEME_NAMES:
        if isinstance(load_scheme(name), Stepped):
            for level, steps in _step_numbers(effort, seed):
                yield MotionTrial(
                    scheme=name,
                    level=level,
                    control="step",
                    value=until / steps,
                    run=_runner(start, name, until / steps, until),
                )
        elif name == "event_driven":
            for level, tolerance in enumerate(effort.tolerances):
                options = {"rtol": tolerance, "atol": tolerance / 100.0}
                yield MotionTrial(
                    scheme=name,
                    level=level,
                    control="tolerance",
                    value=tolerance,
                    run=_runner(start, name, until, until, options),
                    recorded=_runner(start, name, until / effort.instants, until, options),
                )
        else:
            for level, stiffness in enumerate(effort.stiffnesses):
                yield _compliant(start, name, level, stiffness, until)


def _step_numbers(effort: MotionEffort, seed: int) -> Iterator[tuple[int, int]]:
    """(level, number of steps): several within a tenth of each level, at random."""
    random = np.random.default_rng(seed)
    for level, centre in enumerate(np.geomspace(effort.fewest, effort.most, effort.levels)):
        for factor in random.uniform(0.9, 1.1, effort.phases):
            yield level, round(centre * factor)


def _compliant(start: Start, name: str, level: int, stiffness: float, until: float) -> MotionTrial:
    """A compliant contact whose slip is regularised over the same scale: contact time 1 m/s^2."""
    a = start.rows[start.motion.rows.parts.a]
    contact_time = 1.0 / math.sqrt(a * stiffness)
    options = {"stiffness": stiffness, "slip_speed": contact_time, "rtol": 1e-6, "atol": 1e-9}
    step = until / math.ceil(2.0 * until / contact_time)
    return MotionTrial(
        scheme=name,
        level=level,
        control="contact_time",
        value=contact_time,
        run=_runner(start, name, step, until, options),
    )


def _runner(
    start: Start, scheme: str, step: float, until: float, options: dict[str, float] | None = None
) -> Callable[[], Trajectory]:
    return lambda: simulate(start, scheme=scheme, step=step, until=until, options=options, monitor=False)


def run_trial(
    trial: MotionTrial, reference: Reference, effort: MotionEffort, label: str, progress: Callable[[str], None] | None
) -> MotionRun:
    timing = timed(trial.run, patience=effort.patience)
    found = trial.recorded() if trial.recorded else timing.result
    done = found.ending is Ending.REACHED_END
    lower = upper = math.nan
    if done:
        bounds = graph_distance(velocity_graph(found.t, found.u), reference.graph).bounds
        assert bounds.lower is not None
        assert bounds.upper is not None
        lower, upper = bounds.lower, bounds.upper
    if progress is not None:
        progress(label)
    return MotionRun(
        value=trial.value,
        lower=lower,
        upper=upper,
        first_seconds=timing.first_seconds,
        seconds=timing.seconds,
        done=done,
        sentence=found.sentence,
    )
