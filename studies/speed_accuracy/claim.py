"""Speed against accuracy: the error in d_H(A, A_eps) that each method leaves, and what it costs.

Claim (the project's own): at one radius eps, optimising finds d_H to the resolution of a proved reference in a fraction
of a second, and certifying proves it in about a second; from ten thousand times the samples, uniform points gain one
digit and points weighted towards the spheres two. At a critical state a sample misses the rare slips: its bounds are
true, and a reader who takes them for d_H is misled by orders of magnitude.

What is compared is the number that a reader takes for d_H: the middle of an enclosure where the method gives one, else
max(lower bound on e(A_eps, A), upper bound on e(A, A_eps)), as if these were exact. The naive baseline is what one
writes first in NumPy. The reference is the narrowest enclosure that is proved; its half width is stated, and drawn as a
band.

Command:  painleve study speed_accuracy [--quick]
Expected: optimise within the band at all states; certify down to 1e-6; sampled numbers off by more than a factor two,
          marked as misleading, at `critical` below 1e5 samples, and at `double_zero` even with a million; at the
          isolated states every method finds d_H, about half the length of A, to 1e-3.
Time:     two to three minutes, with --quick half a minute; more where the scenes are not yet compiled.
Files:    speed_accuracy.h5, .pdf and .png.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr
from tqdm import tqdm

from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw, save_figure
from painleve.store import check_writable, save
from studies.benchmark.work_precision import NAIVE, RUN_OUTCOMES, DistanceEffort, sweep_work_precision
from studies.speed_accuracy.figures import DRAWINGS
from studies.study import StudyResult
from studies.text_table import text_table

EPS = 1e-3
STATES = (
    ("slender_rod", "paradox"),
    ("slender_rod", "critical"),
    ("slender_rod", "double_zero"),
    ("worn_tip_rod", "isolated"),
    ("two_link_arm", "isolated"),
)
QUICK_STATES = STATES[:4]
EFFORT = DistanceEffort(
    samples=(10**3, 10**4, 10**5, 10**6, 10**7),
    naive_samples=(10**3, 10**4, 10**5, 10**6),
    widths=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
)
QUICK_EFFORT = DistanceEffort(
    samples=(10**3, 10**5), naive_samples=(10**3, 10**5), widths=(1e-1, 1e-3), reference_width=1e-5, repetitions=1
)
COLUMNS = (
    "state",
    "method",
    "setting",
    "evaluations",
    "first call s",
    "warm s",
    "d_H as read",
    "relative error",
    "proved",
    "outcome",
)
RIVAL = "sample, kronecker"


def run(output: Path, *, quick: bool = False, seed: int = 0) -> StudyResult:
    """Measure, draw and tabulate; `output` is an existing folder."""
    check_writable(output / "speed_accuracy.h5")
    states = [make_state(load_scene(scene), name) for scene, name in (QUICK_STATES if quick else STATES)]
    with tqdm(leave=False, disable=None, file=sys.stderr, unit="run") as bar:

        def progress(label: str) -> None:
            bar.set_description(label)
            bar.update()

        effort = QUICK_EFFORT if quick else EFFORT
        dataset = sweep_work_precision(states, eps=EPS, effort=effort, seed=seed, progress=progress)
    figure = draw(dataset, DRAWINGS)
    files = [save(dataset, output / "speed_accuracy.h5")]
    files += [save_figure(figure, output / f"speed_accuracy.{suffix}") for suffix in ("pdf", "png")]
    rows, ratios = list(_rows(dataset)), list(_ratios(dataset))
    return StudyResult(
        table=_table(dataset, rows, ratios),
        files=tuple(files),
        status=_status(rows),
        data={"eps": EPS, "references": _references(dataset), "rows": rows, "kronecker_against_naive": ratios},
    )


def _rows(dataset: xr.Dataset) -> Iterator[dict[str, object]]:
    """One row for each run, failed and misleading ones included."""
    for i, state in enumerate(dataset["state"].values):
        for j, series in enumerate(dataset["series"].values):
            one = dataset.isel(state=i, run=j)
            numbers = ("setting", "evaluations", "first_seconds", "seconds", "value", "error", "proved")
            yield {
                "state": str(state),
                "method": str(series),
                **{name: float(one[name]) for name in numbers},
                "outcome": ("not_run", *RUN_OUTCOMES)[int(one["outcome"])],
                "sentence": str(one["sentence"].item()),
            }


def _ratios(dataset: xr.Dataset) -> Iterator[dict[str, object]]:
    """How many times faster than naive NumPy the Kronecker sample is, warm and at equal numbers of samples."""
    for i, state in enumerate(dataset["state"].values):
        seconds = {
            (str(series), float(setting)): float(s)
            for series, setting, s in zip(
                dataset["series"].values, dataset["setting"].values, dataset["seconds"].values[i], strict=True
            )
        }
        for (series, n), naive in seconds.items():
            if series == NAIVE and (RIVAL, n) in seconds:
                yield {"state": str(state), "samples": n, "times_faster": naive / seconds[RIVAL, n]}


def _references(dataset: xr.Dataset) -> list[dict[str, object]]:
    table = zip(
        dataset["state"].values, dataset["reference"].values, dataset["reference_half_width"].values, strict=True
    )
    return [{"state": str(s), "d_H": float(value), "half_width": float(half)} for s, value, half in table]


def _table(dataset: xr.Dataset, rows: list[dict[str, object]], ratios: list[dict[str, object]]) -> str:
    cells = [
        (
            row["state"],
            row["method"],
            _short(row["setting"]),
            f"{row['evaluations']:.0f}",
            f"{row['first_seconds']:.2g}",
            _short(row["seconds"]),
            _short(row["value"], 5),
            _short(row["error"]),
            _short(row["proved"]),
            row["outcome"],
        )
        for row in rows
    ]
    notes = ["Reference, proved:"]
    notes += [
        f"  {r['state']}: d_H = {r['d_H']:.9g} +- {r['half_width']:.1e}, relative {r['half_width'] / r['d_H']:.1e}"
        for r in _references(dataset)
    ]
    notes.append("Kronecker sample against naive NumPy, warm, at equal numbers of samples:")
    for state in dict.fromkeys(r["state"] for r in ratios):
        own = ", ".join(f"{r['times_faster']:.1f}x at {r['samples']:.0e}" for r in ratios if r["state"] == state)
        notes.append(f"  {state}: {own}")
    notes.append("Misleading: the bounds are true, but read as d_H they are off by more than a factor two.")
    return "\n".join([text_table(COLUMNS, cells), "", *notes])


def _short(value: object, digits: int = 2) -> str:
    number = float(str(value))
    return "-" if np.isnan(number) else f"{number:.{digits}g}"


def _status(rows: list[dict[str, object]]) -> str:
    counts = {outcome: sum(row["outcome"] == outcome for row in rows) for outcome in RUN_OUTCOMES}
    return f"{len(rows)} runs at eps = {EPS:g}: " + ", ".join(f"{n} {name}" for name, n in counts.items()) + "."
