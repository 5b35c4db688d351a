"""One row for each run, with what it misses and what it costs; the references; and the lead over naive NumPy."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from studies.benchmark.work_precision import NAIVE, RUN_OUTCOMES
from studies.parts import Report
from studies.text_table import text_table

__all__ = ["report"]

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


def report(datasets: Mapping[str, xr.Dataset]) -> Report:
    """Of the dataset of error against work."""
    dataset = datasets["speed_accuracy"]
    eps, rows = float(dataset["eps"]), list(_rows(dataset))
    references, ratios = list(_references(dataset)), list(_ratios(dataset))
    data = {"eps": eps, "references": references, "rows": rows, "kronecker_against_naive": ratios}
    return Report(table=_table(rows, references, ratios), data=data, status=_status(rows, eps))


def _rows(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
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


def _ratios(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
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


def _references(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
    names = ("state", "reference", "reference_half_width")
    for state, value, half in zip(*(dataset[name].values for name in names), strict=True):
        yield {"state": str(state), "d_H": float(value), "half_width": float(half)}


def _table(rows: list[dict[str, Any]], references: list[dict[str, Any]], ratios: list[dict[str, Any]]) -> str:
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
        for r in references
    ]
    notes.append("Kronecker sample against naive NumPy, warm, at equal numbers of samples:")
    for state in dict.fromkeys(r["state"] for r in ratios):
        own = ", ".join(f"{r['times_faster']:.1f}x at {r['samples']:.0e}" for r in ratios if r["state"] == state)
        notes.append(f"  {state}: {own}")
    notes.append("Misleading: the bounds are true, but read as d_H they are off by more than a factor two.")
    return "\n".join([text_table(COLUMNS, cells), "", *notes])


def _short(number: float, digits: int = 2) -> str:
    return "-" if np.isnan(number) else f"{number:.{digits}g}"


def _status(rows: list[dict[str, Any]], eps: float) -> str:
    counts = {outcome: sum(row["outcome"] == outcome for row in rows) for outcome in RUN_OUTCOMES}
    return f"{len(rows)} runs at eps = {eps:g}: " + ", ".join(f"{n} {name}" for name, n in counts.items()) + "."
