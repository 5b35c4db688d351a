"""Error in d_H against work at one eps, for every method of the toolkit and a naive baseline: the data of a chart."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields

import numpy as np
import xarray as xr

from painleve.asymptotics.distance import Distance
from painleve.asymptotics.methods import METHODS, Method, distance
from painleve.asymptotics.sample import SAMPLERS, check_eps
from painleve.errors import InputError
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.norm_units import ball_unit, velocity_unit
from painleve.mechanics.state import State
from painleve.sets import Bounds
from painleve.store import provenance
from painleve.sweep.variables import BRANCHES, code, coded, text
from painleve.theory.classification import classify
from painleve.theory.limit_set import LimitSet
from studies.benchmark.naive import naive_distance
from studies.benchmark.records import Record, Run, RunOutcome, measure

__all__ = ["NAIVE", "RUN_OUTCOMES", "DistanceEffort", "read_distance", "reference_distance", "sweep_work_precision"]

NAIVE = "naive NumPy"
RUN_OUTCOMES = tuple(o.value for o in RunOutcome)
Measured = Callable[[LimitSet, float], Run]


@dataclass(frozen=True, kw_only=True)
class DistanceEffort:
    """How much work: numbers of samples, of the toolkit and of the naive baseline; relative widths asked of methods
    that enclose, and of the reference; and how often a warm run is timed, within how many seconds."""

    samples: Sequence[int]
    naive_samples: Sequence[int]
    widths: Sequence[float]
    reference_width: float = 1e-6
    repetitions: int = 3
    patience: float = 0.5


@dataclass(frozen=True, kw_only=True)
class _DistanceTrial:
    """A method with its settings; `setting` is the number of samples or the width (NaN: it has neither)."""

    series: str
    setting: float
    run: Measured


def read_distance(found: Distance) -> Run:
    """What a reader takes for d_H: the middle of an enclosure; else, of one-sided bounds, the larger of the lower bound
    on e(A_eps, A) and the upper bound on e(A, A_eps), as if both were exact."""
    bounds = found.hausdorff
    counts = ", ".join(f"{name} {number}" for name, number in found.counts.items())
    sentence = f"{found.ending} ({counts})"
    if bounds.lower is not None and bounds.upper is not None:
        half = (bounds.upper - bounds.lower) / 2.0
        return Run(value=bounds.lower + half, proved=half, evaluations=found.evaluations, sentence=sentence)
    forward, backward = found.excess_Aeps_A.bounds.lower, found.excess_A_Aeps.bounds.upper
    if forward is None or backward is None:
        raise ArithmeticError(f"d_H is unknown: {found.ending}")
    return Run(value=max(forward, backward), evaluations=found.evaluations, sentence=sentence)


def reference_distance(limit: LimitSet, eps: float, *, width: float) -> Bounds:
    """The narrowest enclosure of d_H that the methods reach which can be asked for a width.

    Raises InputError where none of them encloses d_H.
    """
    enclosures: list[Bounds] = []
    for name, method in METHODS.items():
        if "width" in _options(method):
            enclosures.append(distance(limit, eps, name, _given(method, width=width)).hausdorff)
    known = [b for b in enclosures if b.relative_width is not None]
    if not known:
        raise InputError(f"state {limit.state.label}: no method encloses d_H at eps = {eps:g}; there is no reference")
    return min(known, key=lambda b: b.relative_width or 0.0)


def sweep_work_precision(
    states: Sequence[State],
    *,
    eps: float,
    effort: DistanceEffort,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Run every method at every effort on every state, and compare what a reader takes for d_H with the reference.

    A run that fails, or misleads, is kept and marked by its outcome. `progress` is called with a label after each.
    Raises InputError for bad eps, no states, and a state without a reference.
    """
    eps = check_eps(eps)
    if not states:
        raise InputError("states: none are given; give at least one")
    branches = [classify(state) for state in states]
    trials = list(_trials(effort, seed))
    records, references = [], []
    for classification in branches:
        limit = classification.limit
        name = f"{limit.state.scene.name} {limit.state.label}"
        _report(progress, f"{name}: reference")
        reference = reference_distance(limit, eps, width=effort.reference_width)
        references.append(reference)
        records.append([_record(limit, eps, trial, reference, effort, progress) for trial in trials])
    unit = _joined(velocity_unit(s.scene) for s in states)
    variables = _run_variables(records, unit)
    middle, half = _middles(references)
    variables |= {
        "reference": _number(("state",), middle, "middle of the narrowest enclosure of d_H", unit),
        "reference_half_width": _number(("state",), half, "half the width of that enclosure, proved", unit),
        "theorem_branch": coded(
            ["state"],
            np.array([code(c.branch.value, BRANCHES) for c in branches]),
            BRANCHES,
            "branch of Theorem 1, by exact arithmetic",
        ),
        "eps": _number((), np.array(eps), "radius of the two balls", _joined(ball_unit(s.scene) for s in states)),
    }
    coordinates = {
        "state": text(["state"], [f"{s.scene.name} {s.label}" for s in states], "scene and label of the exact state"),
        "series": text(["run"], [t.series for t in trials], "method, with its sampler"),
        "setting": _number(("run",), np.array([t.setting for t in trials]), "samples, or relative width asked", "1"),
    }
    scenes = list(dict.fromkeys(s.scene for s in states))
    source = provenance(
        scene=", ".join(s.name for s in scenes),
        seed=seed,
        command=command,
        scene_digest=", ".join(make_kernels(s).digest for s in scenes),
    )
    title = f"Error in d_H(A, A_eps) against work at eps = {eps:g}"
    return xr.Dataset(variables, coordinates, {"title": title, "kind": "work_precision", **source})


def _trials(effort: DistanceEffort, seed: int) -> Iterator[_DistanceTrial]:
    for n in effort.naive_samples:
        yield _DistanceTrial(series=NAIVE, setting=float(n), run=_naive(n, seed))
    for name, method in METHODS.items():
        options = _options(method)
        if "sampler" in options:
            for sampler in SAMPLERS:
                for n in effort.samples:
                    given = _given(method, samples=n, sampler=sampler, seed=seed)
                    yield _DistanceTrial(series=f"{name}, {sampler}", setting=float(n), run=_of_method(name, given))
        elif "width" in options:
            for width in effort.widths:
                yield _DistanceTrial(series=name, setting=width, run=_of_method(name, _given(method, width=width)))
        else:
            yield _DistanceTrial(series=name, setting=math.nan, run=_of_method(name, _given(method)))


def _options(method: Method) -> set[str]:
    return {f.name for f in fields(method.options)}


def _given(method: Method, **settings: object) -> object:
    """The method's options, with those of the settings that it has."""
    known = _options(method)
    return method.options(**{name: value for name, value in settings.items() if name in known})


def _of_method(name: str, options: object) -> Measured:
    return lambda limit, eps: read_distance(distance(limit, eps, name, options))


def _naive(samples: int, seed: int) -> Measured:
    def run(limit: LimitSet, eps: float) -> Run:
        forward, backward = naive_distance(limit, eps, samples=samples, seed=seed)
        sentence = f"e(A_eps, A) about {forward:.3g}, e(A, A_eps) about {backward:.3g}"
        return Run(value=max(forward, backward), evaluations=samples, sentence=sentence)

    return run


def _record(
    limit: LimitSet,
    eps: float,
    trial: _DistanceTrial,
    reference: Bounds,
    effort: DistanceEffort,
    progress: Callable[[str], None] | None,
) -> Record:
    name = f"{limit.state.scene.name} {limit.state.label}"
    _report(progress, f"{name}: {trial.series}, {trial.setting:g}")
    middle = float(_middles([reference])[0][0])
    return measure(
        name,
        trial.series,
        trial.setting,
        lambda: trial.run(limit, eps),
        reference=middle,
        repetitions=effort.repetitions,
        patience=effort.patience,
    )


def _middles(references: Sequence[Bounds]) -> tuple[np.ndarray, np.ndarray]:
    ends = np.array([[b.lower, b.upper] for b in references], dtype=float)
    return ends.mean(axis=1), np.diff(ends, axis=1)[:, 0] / 2.0


def _run_variables(records: list[list[Record]], unit: str) -> dict[str, xr.Variable]:
    dims = ("state", "run")

    def column(name: str, sentence: str, units: str = "1") -> xr.Variable:
        return _number(dims, np.array([[getattr(r, name) for r in row] for row in records]), sentence, units)

    outcomes = np.array([[code(r.outcome.value, RUN_OUTCOMES) for r in row] for row in records])
    return {
        "value": column("value", "what a reader takes for d_H", unit),
        "error": column("error", "distance of that value to the reference, relative to the reference"),
        "proved": column("proved", "bound on the relative error that the run itself proves; NaN where it proves none"),
        "evaluations": column("evaluations", "evaluations of the law, or pieces of A_eps bounded"),
        "seconds": column("seconds", "wall time of a warm run, median", "s"),
        "first_seconds": column("first_seconds", "wall time of the first run, with what it compiles or loads", "s"),
        "outcome": coded(dims, outcomes, RUN_OUTCOMES, "how the run ended, judged by the reference"),
        "sentence": text(
            dims, np.array([[r.sentence for r in row] for row in records], dtype=object), "how the run says it ended"
        ),
    }


def _joined(units: Iterable[str]) -> str:
    """The units of several scenes."""
    return " or ".join(dict.fromkeys(units))


def _number(dims: tuple[str, ...], values: np.ndarray, sentence: str, units: str) -> xr.Variable:
    return xr.Variable(dims, values, {"units": units, "long_name": sentence})


def _report(progress: Callable[[str], None] | None, label: str) -> None:
    if progress is not None:
        progress(label)
