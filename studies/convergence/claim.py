"""Convergence: the observed order of every scheme on motions with contact, and what accuracy costs.

Claim: where the solution is unique, the Contact Dynamics scheme converges as the step h -> 0. It is proved in three
situations (L. Paoli, IFIP AICT 494 (2016), references [9], [5], [15]): M = m Id with friction or without, any M without
friction, any M with friction. The order is the project's own observation: 1 in the distance of graphs in (t, u), in
which a jump shifted by one step costs a step; and so it is for every fixed-step scheme, also for those of higher order
where nothing touches.

Motions: impacts without rebound, frictional impacts, smooth sliding, slip to stick; M constant and M(q). References are
closed forms for the point mass, else an event-driven integration at rtol 1e-13. The event-driven method is thus judged
by itself at a tighter tolerance wherever the reference is not a closed form.
The order is the slope of log error against log h through the largest error of several step sizes near each level; of
the event-driven method against its tolerance, of the compliant contact against its time scale 1/sqrt(a k).

Command:  painleve study convergence [--quick]
Expected: order 1 within the errors stated for all fixed-step schemes and motions. The event-driven method is exact to
          rounding on the point mass. The compliant contact (damping ratio 1) converges with order 1 where there is no
          collision; after a collision it rebounds with exp(-2) = 0.135 of the speed, at any stiffness: its limit is
          another law of impact, and its error does not fall.
Time:     two to three minutes, with --quick half a minute; half a minute more where the scenes are not yet compiled.
Files:    convergence.h5, .pdf and .png.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from tqdm import tqdm

from painleve.plotting import draw, save_figure
from painleve.store import check_writable, save
from painleve.sweep.variables import OUTCOMES
from studies.convergence.figures import DRAWINGS
from studies.convergence.measure import VERDICTS, MotionEffort, sweep_convergence
from studies.study import StudyResult
from studies.text_table import text_table

QUICK = MotionEffort(
    most=5000,
    levels=4,
    phases=3,
    tolerances=(1e-4, 1e-6, 1e-8, 1e-10),
    stiffnesses=(1e3, 2.5e3, 6.3e3),
    instants=10_000,
    patience=0.0,
)
COLUMNS = (
    "motion",
    "theorem",
    "scheme",
    "order observed",
    "expected",
    "stated",
    "verdict",
    "runs",
    "failed",
    "least error",
    "its wall time s",
)


def run(output: Path, *, quick: bool = False, seed: int = 0) -> StudyResult:
    """Measure, draw and tabulate; `output` is an existing folder."""
    check_writable(output / "convergence.h5")
    with tqdm(leave=False, disable=None, file=sys.stderr, unit="run") as bar:

        def progress(label: str) -> None:
            bar.set_description(label)
            bar.update()

        dataset = sweep_convergence(effort=QUICK if quick else MotionEffort(), seed=seed, progress=progress)
    figure = draw(dataset, DRAWINGS)
    files = [save(dataset, output / "convergence.h5")]
    files += [save_figure(figure, output / f"convergence.{suffix}") for suffix in ("pdf", "png")]
    rows = list(_rows(dataset))
    motions = list(_motions(dataset))
    data = {"rows": rows, "motions": motions}
    return StudyResult(table=_table(rows, motions), files=tuple(files), data=data, status=_status(rows))


def _rows(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
    """Every scheme on every motion; null where there is no order or no run that ended well."""
    for i in range(dataset.sizes["problem"]):
        for j, scheme in enumerate(dataset["scheme"].values):
            one = dataset.isel(problem=i, scheme=j, run=np.flatnonzero(dataset["run_scheme"].values == scheme))
            failed = one["outcome"].values == OUTCOMES.index("failed") + 1
            error = np.where(failed, np.inf, one["error_upper"].values)
            best = None if failed.all() else int(np.argmin(error))
            yield {
                "motion": str(one["problem"].item()),
                "theorem": str(one["situation"].item()),
                "scheme": str(scheme),
                "order": _known(one["order"].item()),
                "order_error": _known(one["order_error"].item()),
                "expected_order": float(one["expected_order"]),
                "stated_order": float(one["stated_order"]),
                "verdict": ("not_run", *VERDICTS)[int(one["verdict"])],
                "runs": len(failed),
                "failed": int(failed.sum()),
                "endings": sorted(set(one["sentence"].values[failed].tolist())),
                "least_error": None if best is None else float(error[best]),
                "seconds": None if best is None else float(one["seconds"][best]),
            }


def _motions(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
    for i in range(dataset.sizes["problem"]):
        one = dataset.isel(problem=i)
        names = ("description", "situation", "reference", "resolution", "chords", "compile_seconds")
        yield {"motion": str(one["problem"].item()), **{name: one[name].item() for name in names}}


def _known(value: float) -> float | None:
    return None if np.isnan(value) else value


def _table(rows: list[dict[str, Any]], motions: list[dict[str, Any]]) -> str:
    cells = [
        (
            str(row["motion"]),
            str(row["theorem"]).rsplit(" ", 1)[-1],
            str(row["scheme"]),
            _order(row),
            f"{row['expected_order']:g}",
            f"{row['stated_order']:g}",
            str(row["verdict"]),
            str(row["runs"]),
            str(row["failed"]),
            _short(row["least_error"]),
            _short(row["seconds"]),
        )
        for row in rows
    ]
    notes = ["Orders are estimates with their standard errors; errors are upper bounds on the distance of graphs."]
    notes += [
        f"  {m['motion']}: {m['description']}; {m['situation']}; reference: {m['reference']}, resolved to about "
        f"{m['resolution']:.0e}, {m['chords']:.0e} between instants; compiled or loaded in {m['compile_seconds']:.1f} s"
        for m in motions
    ]
    endings = sorted({f"  {row['scheme']} on {row['motion']}: {text}" for row in rows for text in row["endings"]})
    return "\n".join(
        [text_table(COLUMNS, cells), "", *notes, *(["Failed runs ended so:", *endings] if endings else [])]
    )


def _order(row: dict[str, Any]) -> str:
    return "-" if row["order"] is None else f"{row['order']:.2f} +- {row['order_error']:.2f}"


def _short(value: float | None) -> str:
    return "-" if value is None else f"{value:.2g}"


def _status(rows: list[dict[str, Any]]) -> str:
    counts = {verdict: sum(row["verdict"] == verdict for row in rows) for verdict in VERDICTS}
    said = ", ".join(f"{number} {verdict}" for verdict, number in counts.items() if number)
    return f"Orders of {len(rows)} pairs of scheme and motion: {said}."
