"""Found against published: the table of facts, the routes to them, and their sources."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from studies.parts import Report
from studies.reference.compare import FactStatus
from studies.reference.dataset import STATUSES
from studies.text_table import text_table

__all__ = ["report"]

COLUMNS = ("fact", "published", "found", "difference", "status", "basis")
WORDS = dict(zip(STATUSES, (status.value for status in FactStatus), strict=True))


def report(datasets: Mapping[str, xr.Dataset]) -> Report:
    """A row for each fact."""
    rows = list(_rows(datasets["reference"]))
    table = "\n\n".join([_table(rows), _routes(rows), _sources(rows)])
    facts = [{name: value for name, value in row.items() if name not in ("value_kind", "source_read")} for row in rows]
    return Report(table=table, data={"facts": facts}, status=_status(rows))


def _rows(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
    names = ("statement", "published", "found", "route", "basis", "source", "says", "value_kind", "source_read")
    for i, fact in enumerate(dataset["fact"].values):
        one = dataset.isel(fact=i)
        row: dict[str, Any] = {"id": str(fact), **{name: str(one[name].item()) for name in names}}
        difference, gap = str(one["difference"].item()), float(one["gap"])
        row["difference"] = None if difference == "-" else difference
        row["gap"] = None if np.isnan(gap) else gap
        row["obstacle"] = str(one["obstacle"].item()) or None
        row["status"] = WORDS[("not_run", *STATUSES)[int(one["status"])]]
        yield row


def _table(rows: list[dict[str, Any]]) -> str:
    cells = [
        (row["statement"], row["published"], _found(row), row["difference"] or "-", row["status"], row["basis"])
        for row in rows
    ]
    notes = (
        "basis: where the published value was seen: in the abstract, in the source text of a test, or named there and\n"
        "recomputed for this project. Differences are found minus published value; labels are compared as words."
    )
    return f"{text_table(COLUMNS, cells)}\n\n{notes}"


def _found(row: dict[str, Any]) -> str:
    """The found value; of a formula that equals the published one, in whatever form, that it does."""
    if row["status"] == FactStatus.REPRODUCED.value and row["value_kind"] == "formula":
        return "the same expression"
    return f"{float(row['found']):.12g}" if row["value_kind"] == "decimal" else str(row["found"])


def _routes(rows: Iterable[dict[str, Any]]) -> str:
    lines = ["How:"]
    for row in rows:
        lines.append(f"  {row['id']}: {row['route']}")
        if row["gap"] is not None:
            lines.append(f"    second route: within {row['gap']:.0e}, relative")
        if row["obstacle"]:
            lines.append(f"    {row['status']}: {row['obstacle']}")
    return "\n".join(lines)


def _sources(rows: Iterable[dict[str, Any]]) -> str:
    by_source: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        by_source.setdefault(row["source"], []).append(row)
    lines = ["Sources:"]
    for citation, entries in by_source.items():
        lines.append(f"  {citation} [read: {entries[0]['source_read']}]")
        lines.append(f"    {', '.join(row['id'] for row in entries)}")
    return "\n".join(lines)


def _status(rows: list[dict[str, Any]]) -> str:
    counts = {status.value: sum(row["status"] == status.value for row in rows) for status in FactStatus}
    said = ", ".join(f"{number} {status}" for status, number in counts.items() if number)
    return f"{len(rows)} published facts: {said}."
