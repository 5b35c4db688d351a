"""What the distances say of Theorem 1 at each state: a row of bounds at the smallest eps, and the verdict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from painleve.asymptotics.theorem import VerdictStatus
from painleve.sets import Bounds
from painleve.sweep.variables import BRANCHES, STATUSES
from studies.parts import Report
from studies.text_table import text_table

__all__ = ["report"]

COLUMNS = ("scene", "state", "branch", "slope", "verdict", "e(A_eps, A)", "e(A, A_eps) sampled", "witnessed", "seconds")


def report(datasets: Mapping[str, xr.Dataset]) -> Report:
    """Of all datasets of distances."""
    distances = {stem.removeprefix("distances_"): d for stem, d in datasets.items() if d.attrs["kind"] == "distances"}
    rows = [row for name, dataset in distances.items() for row in _rows(name, dataset)]
    eps = next(iter(distances.values()))["eps"].values.tolist()
    return Report(table=_table(rows, min(eps)), data={"eps": eps, "rows": rows}, status=_status(rows))


def _rows(name: str, distances: xr.Dataset) -> Iterator[dict[str, Any]]:
    """What the table says of each state: bounds at the smallest eps, null where a side is unknown."""
    for i, state in enumerate(distances["state"].values):
        one = distances.isel(state=i)
        last = one.isel(eps=int(np.argmin(one["eps"].values)))
        yield {
            "scene": name,
            "state": str(state),
            "branch": _label(one["theorem_branch"], BRANCHES),
            "slope": _known(one["slope"]),
            "verdict": _label(one["verdict"], STATUSES),
            "reason": str(one["verdict_reason"].item()),
            "excess_Aeps_A": _bounds(last, "excess_Aeps_A").as_dict(),
            "excess_A_Aeps": _bounds(last, "excess_A_Aeps").as_dict(),
            "witnessed_upper": _known(last["witnessed_upper"]),
            "half_jump": float(one["half_jump"]),
            "seconds": float(one["seconds"].sum()),
        }


def _label(code: xr.DataArray, labels: tuple[str, ...]) -> str:
    return ("not_run", *labels)[int(code)]


def _known(value: xr.DataArray) -> float | None:
    return None if np.isnan(value) else float(value)


def _bounds(point: xr.Dataset, name: str) -> Bounds:
    return Bounds(lower=_known(point[f"{name}_lower"]), upper=_known(point[f"{name}_upper"]))


def _table(rows: list[dict[str, Any]], eps: float) -> str:
    cells = []
    for row in rows:
        forward, backward = Bounds(**row["excess_Aeps_A"]), Bounds(**row["excess_A_Aeps"])
        witnessed = Bounds.unknown() if row["witnessed_upper"] is None else Bounds.at_most(row["witnessed_upper"])
        cells.append(
            (
                row["scene"],
                row["state"],
                row["branch"],
                "-" if row["slope"] is None else f"{row['slope']:.3f}",
                row["verdict"],
                _short(forward),
                _short(backward) + (" *" if _misleading(row) else ""),
                "none" if witnessed.upper is None else _short(witnessed),
                f"{row['seconds']:.1f}",
            )
        )
    notes = [
        f"Distances at eps = {eps:g}: >= is a lower bound, <= an upper bound. Slopes are those of log e(A_eps, A)",
        "against log eps; in the isolated branch A is replaced by its ends, and e(A, A_eps) tends to half its length.",
    ]
    if any(_misleading(row) for row in rows):
        notes.append("* The sample alone misleads: too few members are near. Witnesses show that this excess vanishes.")
    return "\n".join([text_table(COLUMNS, cells), "", *notes])


def _short(bounds: Bounds) -> str:
    return str(bounds).split(" (")[0].replace("≥", ">=").replace("≤", "<=")


def _misleading(row: dict[str, Any]) -> bool:
    """The sampled upper bound on e(A, A_eps) is larger than e(A_eps, A), although witnesses shadow all of A."""
    sampled, forward, witnessed = row["excess_A_Aeps"]["upper"], row["excess_Aeps_A"]["lower"], row["witnessed_upper"]
    return None not in (sampled, forward, witnessed) and bool(sampled > forward)


def _status(rows: list[dict[str, Any]]) -> str:
    counts = {status.value: sum(row["verdict"] == status.value for row in rows) for status in VerdictStatus}
    said = ", ".join(f"{number} {label}" for label, number in counts.items() if number)
    return f"Theorem 1 at {len(rows)} states: {said}."
