"""Errors of every scheme on motions whose solution is known: observed orders, and error against wall time.

The error is the distance of graphs in (t, u) (painleve.dynamics.graph_distance). Where an event falls within a step is
chance, and moves the error of one step size up and down; so step sizes come in levels of several each, and the order is
the slope through the largest error of each level.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
import xarray as xr

from painleve.core.motion_codes import Ending
from painleve.dynamics.graph_distance import graph_distance, velocity_graph
from painleve.dynamics.scheme import Stepped
from painleve.dynamics.schemes import SCHEME_NAMES, load_scheme
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory
from painleve.kernels.motion.compiled import make_motion
from painleve.mechanics.scene import Scene
from painleve.store import provenance
from painleve.sweep.variables import OUTCOMES, code, coded, text, velocity_unit
from studies.benchmark.records import timed
from studies.convergence.motions import PROBLEMS, Problem, Reference, make_reference

__all__ = ["CONTROLS", "EXPECTED_ORDER", "VERDICTS", "Convergence", "MotionEffort", "sweep_convergence"]

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
class _MotionTrial:
    """One run: a scheme, what it is controlled by and its value, and how to run it; `recorded`, for the distance only,
    where an adaptive method returns few instants when it is timed."""

    scheme: str
    level: int
    control: str
    value: float
    run: Callable[[], Trajectory]
    recorded: Callable[[], Trajectory] | None = None


@dataclass(frozen=True, kw_only=True)
class _Record:
    """What is kept of a run: the enclosure of its error (NaN where it failed), its times and its last sentence."""

    value: float
    lower: float
    upper: float
    first_seconds: float
    seconds: float
    done: bool
    sentence: str


def sweep_convergence(
    problems: Sequence[Problem] = PROBLEMS,
    *,
    effort: MotionEffort | None = None,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Run every scheme on every problem at every effort; runs that fail are kept, without an error.

    `progress` is called with the problem's name after each run. Raises InputError for a problem without a reference.
    """
    effort = effort or MotionEffort()
    references, records, compiling, layout = [], [], [], []
    for problem in problems:
        start = problem.start()
        compiling.append(_compile(start))
        references.append(make_reference(problem, instants=effort.instants))
        layout = list(_trials(problem, start, effort, seed))
        records.append([_record(trial, references[-1], effort, problem.name, progress) for trial in layout])
    schemes = np.array([t.scheme for t in layout])
    levels = np.array([t.level for t in layout])
    variables = _run_variables(records) | _orders(records, references, schemes, levels)
    variables |= _problem_variables(problems, references, compiling)
    coordinates = {
        "problem": text(["problem"], [p.name for p in problems], "name of the motion"),
        "scheme": text(["scheme"], list(SCHEME_NAMES), "name of the scheme"),
        "run_scheme": text(["run"], schemes, "scheme of the run"),
        "level": _number(["run"], levels, "level of the control, from coarse to fine", "1"),
        "control": coded(
            ["run"], np.array([code(t.control, CONTROLS) for t in layout]), CONTROLS, "what the run is controlled by"
        ),
    }
    scenes = list(dict.fromkeys(p.start().scene for p in problems))
    source = provenance(
        scene=", ".join(s.name for s in scenes),
        seed=seed,
        command=command,
        scene_digest=", ".join(make_motion(s).digest for s in scenes),
    )
    title = "Errors of schemes on motions with contact, as distances of graphs in (t, u)"
    attributes = {"title": title, "kind": "convergence", "velocity_units": _units(scenes), **source}
    return xr.Dataset(variables, coordinates, attributes)


def _compile(start: Start) -> float:
    """Seconds until the scene's steps and the distance are ready: apart from all other times."""
    begin = time.perf_counter()
    found = simulate(start, step=1e-4, until=3e-4, monitor=False)
    graph = velocity_graph(found.t, found.u)
    graph_distance(graph, graph)
    return time.perf_counter() - begin


def _trials(problem: Problem, start: Start, effort: MotionEffort, seed: int) -> Iterator[_MotionTrial]:
    """The runs on one problem, in the same order for every problem."""
    until = problem.until
    for name in SCHEME_NAMES:
        if isinstance(load_scheme(name), Stepped):
            for level, steps in _step_numbers(effort, seed):
                yield _MotionTrial(
                    scheme=name,
                    level=level,
                    control="step",
                    value=until / steps,
                    run=_runner(start, name, until / steps, until),
                )
        elif name == "event_driven":
            for level, tolerance in enumerate(effort.tolerances):
                options = {"rtol": tolerance, "atol": tolerance / 100.0}
                yield _MotionTrial(
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


def _compliant(start: Start, name: str, level: int, stiffness: float, until: float) -> _MotionTrial:
    """A compliant contact whose slip is regularised over the same scale: contact time 1 m/s^2."""
    a = start.rows[1 + 2 * start.scene.dimension]
    contact_time = 1.0 / math.sqrt(a * stiffness)
    options = {"stiffness": stiffness, "slip_speed": contact_time, "rtol": 1e-6, "atol": 1e-9}
    step = until / math.ceil(2.0 * until / contact_time)
    return _MotionTrial(
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


def _record(
    trial: _MotionTrial, reference: Reference, effort: MotionEffort, label: str, progress: Callable[[str], None] | None
) -> _Record:
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
    return _Record(
        value=trial.value,
        lower=lower,
        upper=upper,
        first_seconds=timing.first_seconds,
        seconds=timing.seconds,
        done=done,
        sentence=found.sentence,
    )


def _orders(
    records: list[list[_Record]], references: list[Reference], schemes: np.ndarray, levels: np.ndarray
) -> dict[str, xr.Variable]:
    """Observed orders with their standard errors, verdicts, and the orders that the schemes state."""
    shape = (len(records), len(SCHEME_NAMES))
    order, error, verdict = np.full(shape, np.nan), np.full(shape, np.nan), np.zeros(shape)
    for i, (row, reference) in enumerate(zip(records, references, strict=True)):
        for j, name in enumerate(SCHEME_NAMES):
            own = np.flatnonzero(schemes == name)
            floor = reference.resolution if name == "event_driven" else reference.chords
            slack = ADAPTIVE_SLACK if name == "event_driven" else SLACK
            order[i, j], error[i, j], said = _judge([row[k] for k in own], levels[own], floor, slack)
            verdict[i, j] = code(said.value, VERDICTS)
    stated = np.array([float(load_scheme(name).order) for name in SCHEME_NAMES])
    return {
        "order": _number(["problem", "scheme"], order, "observed order, a least-squares estimate", "1"),
        "order_error": _number(["problem", "scheme"], error, "standard error of the observed order", "1"),
        "verdict": coded(["problem", "scheme"], verdict, VERDICTS, "what the observed order says"),
        "stated_order": _number(["scheme"], stated, "order of the scheme where the motion is smooth", "1"),
        "expected_order": _number(
            ["scheme"], np.full(len(stated), EXPECTED_ORDER), "order expected where contacts change", "1"
        ),
    }


def _judge(
    runs: list[_Record], levels: np.ndarray, resolution: float, slack: float
) -> tuple[float, float, Convergence]:
    """The slope of log error against log control through the worst run of each level, and what it says."""
    if not all(r.done for r in runs):
        return math.nan, math.nan, Convergence.FAILED
    worst = [
        max((r for r, at in zip(runs, levels, strict=True) if at == level), key=lambda r: r.upper)
        for level in np.unique(levels)
    ]
    fitted = [r for r in worst if r.upper > RESOLVED * resolution]
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


def _run_variables(records: list[list[_Record]]) -> dict[str, xr.Variable]:
    dims = ["problem", "run"]

    def column(name: str, sentence: str, units: str) -> xr.Variable:
        return _number(dims, np.array([[getattr(r, name) for r in row] for row in records]), sentence, units)

    outcomes = np.array([[code("done" if r.done else "failed", OUTCOMES) for r in row] for row in records])
    sentences = np.array([[r.sentence for r in row] for row in records], dtype=object)
    mixed = "s and units of velocity"
    return {
        "value": column("value", "value of the control: step or contact time in s, or relative tolerance", "s or 1"),
        "error_lower": column("lower", "lower bound on the distance to the reference's graph", mixed),
        "error_upper": column("upper", "upper bound on the distance to the reference's graph", mixed),
        "seconds": column("seconds", "wall time of a warm run, median", "s"),
        "first_seconds": column("first_seconds", "wall time of the first run", "s"),
        "outcome": coded(dims, outcomes, OUTCOMES, "whether the run reached the end"),
        "sentence": text(dims, sentences, "how the run says it ended"),
    }


def _problem_variables(
    problems: Sequence[Problem], references: list[Reference], compiling: list[float]
) -> dict[str, xr.Variable]:
    dims = ["problem"]
    unit = "s and units of velocity"
    resolution, chords = (np.array([getattr(r, name) for r in references]) for name in ("resolution", "chords"))
    return {
        "description": text(dims, [p.sentence for p in problems], "what happens in the motion"),
        "situation": text(dims, [p.situation.value for p in problems], "which convergence theorem applies to it"),
        "reference": text(dims, [r.origin for r in references], "where the reference comes from"),
        "resolution": _number(dims, resolution, "how far the reference moves with its tolerance, an estimate", unit),
        "chords": _number(dims, chords, "how far it moves at half as many instants, an estimate", unit),
        "compile_seconds": _number(dims, np.array(compiling), "wall time to compile or load the scene's steps", "s"),
    }


def _units(scenes: Sequence[Scene]) -> str:
    return "; ".join(f"{s.name}: {velocity_unit(s)}" for s in scenes)


def _number(dims: Sequence[str], values: np.ndarray, sentence: str, units: str) -> xr.Variable:
    return xr.Variable(tuple(dims), values, {"units": units, "long_name": sentence})
