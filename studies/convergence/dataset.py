"""Errors of every scheme on motions whose solution is known: observed orders, and error against wall time.

The error is the distance of graphs in (t, u) (painleve.dynamics.graph_distance).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

from painleve.dynamics.schemes import SCHEME_NAMES, load_scheme
from painleve.kernels.motion.compiled import make_motion
from painleve.mechanics.norm_units import velocity_unit
from painleve.mechanics.scene import Scene
from painleve.store import provenance
from painleve.sweep.variables import OUTCOMES, code, coded, text
from studies.convergence.motions import PROBLEMS, Problem, Reference, make_reference
from studies.convergence.orders import (
    ADAPTIVE_SLACK,
    EXPECTED_ORDER,
    SLACK,
    VERDICTS,
    judge_order,
    worst_of_levels,
)
from studies.convergence.runs import CONTROLS, MotionEffort, MotionRun, compile_motion, run_trial, trials_of

__all__ = ["sweep_convergence"]


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
        compiling.append(compile_motion(start))
        references.append(make_reference(problem, instants=effort.instants))
        layout = list(trials_of(problem, start, effort, seed))
        records.append([run_trial(trial, references[-1], effort, problem.name, progress) for trial in layout])
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


def _orders(
    records: list[list[MotionRun]], references: list[Reference], schemes: np.ndarray, levels: np.ndarray
) -> dict[str, xr.Variable]:
    """Observed orders with their standard errors, verdicts, and the orders that the schemes state."""
    shape = (len(records), len(SCHEME_NAMES))
    order, error, verdict = np.full(shape, np.nan), np.full(shape, np.nan), np.zeros(shape)
    worst = np.zeros((len(records), len(levels)), np.int64)
    for i, (row, reference) in enumerate(zip(records, references, strict=True)):
        for j, name in enumerate(SCHEME_NAMES):
            own = np.flatnonzero(schemes == name)
            floor = reference.resolution if name == "event_driven" else reference.chords
            slack = ADAPTIVE_SLACK if name == "event_driven" else SLACK
            order[i, j], error[i, j], said = judge_order([row[k] for k in own], levels[own], floor, slack)
            verdict[i, j] = code(said.value, VERDICTS)
            worst[i, own[worst_of_levels([row[k] for k in own], levels[own])]] = 1
    stated = np.array([float(load_scheme(name).order) for name in SCHEME_NAMES])
    return {
        "order": _number(["problem", "scheme"], order, "observed order, a least-squares estimate", "1"),
        "order_error": _number(["problem", "scheme"], error, "standard error of the observed order", "1"),
        "verdict": coded(["problem", "scheme"], verdict, VERDICTS, "what the observed order says"),
        "worst": _number(["problem", "run"], worst, "whether the error is the largest of its scheme and level", "1"),
        "stated_order": _number(["scheme"], stated, "order of the scheme where the motion is smooth", "1"),
        "expected_order": _number(
            ["scheme"], np.full(len(stated), EXPECTED_ORDER), "order expected where contacts change", "1"
        ),
    }


def _run_variables(records: list[list[MotionRun]]) -> dict[str, xr.Variable]:
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
