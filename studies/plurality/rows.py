"""What the datasets hold, row by row, as tables and programs read it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from painleve.store import labels_of

__all__ = ["choice_rows", "decade_rows", "law_rows", "layer_rows"]


def layer_rows(dataset: xr.Dataset) -> list[dict[str, Any]]:
    """Every point of the initial layer."""
    rows = []
    for i, j, k in np.ndindex(*dataset["fraction"].shape):
        one = dataset.isel(state=i, step=j, ratio=k)
        names = ("step", "ratio", "fraction", "lower", "upper", "excess_from_A", "excess_of_A")
        rows.append({"state": str(one["state"].item()), **{name: float(one[name]) for name in names}})
    return rows


def choice_rows(dataset: xr.Dataset) -> list[dict[str, Any]]:
    """Every run of every scheme."""
    labels = labels_of(dataset["choice"])
    return [
        {
            "state": str(state),
            "run": str(run),
            "choice": str(labels[i, j]),
            "time": float(dataset["time"].values[i, j]),
        }
        for i, state in enumerate(dataset["state"].values)
        for j, run in enumerate(dataset["run"].values)
    ]


def decade_rows(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
    """Each window and contact test: what the table of Glocker's rod says."""
    for i, contact in enumerate(labels_of(dataset["contact"])):
        for j, step in enumerate(dataset["first_step"].values):
            one = dataset.isel(contact=i, window=j)
            lateness = max(abs(float(one[name]) - float(one["instant"])) for name in ("first", "last"))
            yield {
                "contact": str(contact),
                "step": float(step),
                "decades": float(one["decades"]),
                "count": int(one["count"]),
                "fraction": float(one["fraction"]),
                "interval": [float(one["lower"]), float(one["upper"])],
                "map": float(one["local_map"]),
                "median_delay": float(one["median"]) - float(one["instant"]),
                "largest_delay": lateness,
            }


def law_rows(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
    contacts = labels_of(dataset["contact"])
    for i in range(dataset.sizes["case"]):
        one = dataset.isel(case=i)
        names = (
            "ratio",
            "alpha",
            "slip",
            "step",
            "drift",
            "neglected",
            "law",
            "local_map",
            "fraction",
            "lower",
            "upper",
            "count",
            "others",
        )
        yield {"group": str(one["group"].item()), "contact": str(contacts[i]), **{n: float(one[n]) for n in names}}
