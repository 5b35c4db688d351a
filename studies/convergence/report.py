"""The observed order of every scheme on every motion, and where the references come from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from painleve.sweep.variables import OUTCOMES
from studies.convergence.orders import VERDICTS
from studies.parts import Report
from studies.text_table import text_table

__all__ = ["report"]

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


def report(datasets: Mapping[str, xr.Dataset]) -> Report:
    """A row for each pair of motion and scheme."""
    dataset = datasets["convergence"]
    rows, motions = list(_rows(dataset)), list(_motions(dataset))
    return Report(table=_table(rows, motions), data={"rows": rows, "motions": motions}, status=_status(rows))


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
            row["motion"],
            row["theorem"].rsplit(" ", 1)[-1],
            row["scheme"],
            _order(row),
            f"{row['expected_order']:g}",
            f"{row['stated_order']:g}",
            row["verdict"],
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
