"""Error against work: what accuracy costs with each method, and which runs mislead or fail."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.plotting.draw import Drawing
from painleve.plotting.style import GREY, PALETTE, THEOREM_MARKS, Mark, legend_below, panels, spoken
from painleve.store import labels_of

__all__ = ["DRAWINGS", "draw_work_precision"]

SERIES: Mapping[str, Mark] = MappingProxyType(
    {
        "naive NumPy": Mark(colour=PALETTE["black"], marker="D", label="naive NumPy, uniform"),
        "sample, uniform": Mark(colour=PALETTE["orange"], marker="o", label="sample, uniform"),
        "sample, kronecker": Mark(colour=PALETTE["blue"], marker="s", label="sample, Kronecker"),
        "sample, boundary": Mark(colour=PALETTE["purple"], marker="^", label="sample, boundary"),
        "optimise": Mark(colour=PALETTE["green"], marker="*", label="optimise"),
        "certify": Mark(colour=PALETTE["vermilion"], marker="P", label="certify (error proved by the run)"),
    }
)
WORK = {"seconds": "wall time of a warm run (s)", "evaluations": "evaluations of the law, or boxes bounded"}
STRIP = 0.04  # of an axis: where failed runs stand
FLOOR, CEILING = 1e-12, 1e4


def draw_work_precision(dataset: xr.Dataset) -> Figure:
    """A row for each state: relative error in d_H against wall time and against evaluations.

    Filled marks are fair; hollow ones mislead, by more than a factor of two. Below the grey line the reference resolves
    nothing: what lies there is drawn on it.
    """
    states = dataset.sizes["state"]
    figure, axes = panels(2 * states, columns=2, height=1.65)
    for i in range(states):
        one = dataset.isel(state=i)
        for axis, work in zip(axes[2 * i : 2 * i + 2], WORK, strict=True):
            _draw_panel(axis, one, work)
        name = f"{spoken(one['state'].item())}: {THEOREM_MARKS[labels_of(one['theorem_branch']).item()].label}"
        axes[2 * i].set_title(name, loc="left")
        axes[2 * i].set_ylabel("relative error")
    _share_axes(axes, dataset)
    for axis, label in zip(axes[-2:], WORK.values(), strict=True):
        axis.set_xlabel(label)
    figure.suptitle(f"error in $d_H(A, A_\\varepsilon)$ at $\\varepsilon$ = {dataset['eps'].item():g}", fontsize=8)
    legend_below(figure, axes, columns=3)
    return figure


def _draw_panel(axis: Axes, one: xr.Dataset, work: str) -> None:
    resolved = max(float(one["reference_half_width"] / one["reference"]), FLOOR)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.axhspan(FLOOR / 10.0, resolved, color=GREY, alpha=0.25, linewidth=0.0, label="not resolved by the reference")
    outcomes = labels_of(one["outcome"])
    proved = one["proved"].values
    error = np.where(np.isnan(proved), one["error"].values, proved)
    error = np.clip(error, resolved, CEILING)
    for name, mark in SERIES.items():
        own = one["series"].values == name
        x, misleads = one[work].values, outcomes == "misleading"
        size = 7.0 if mark.marker == "*" else 4.5
        axis.plot(x[own], error[own], color=mark.colour, linewidth=0.7, alpha=0.6, zorder=2)
        fair, hollow = own & (outcomes == "done"), own & misleads
        for chosen, fill, label in ((fair, mark.colour, mark.label), (hollow, "white", None)):
            axis.plot(
                x[chosen],
                error[chosen],
                linestyle="none",
                marker=mark.marker,
                color=mark.colour,
                markersize=size,
                markerfacecolor=fill,
                label=label,
                zorder=3,
            )
    _draw_verdicts(axis, one, outcomes)


def _draw_verdicts(axis: Axes, one: xr.Dataset, outcomes: np.ndarray) -> None:
    """Legend entries of what hollow marks mean, and the failed runs along the lower edge."""
    axis.plot(
        [],
        [],
        linestyle="none",
        marker="o",
        color=PALETTE["black"],
        markerfacecolor="white",
        label="hollow: misleading, off by > 2",
    )
    failed = outcomes == "failed"
    if not failed.any():
        return
    x = np.where(failed, one["first_seconds"].values, np.nan)[failed]
    axis.plot(
        x,
        np.full(failed.sum(), STRIP),
        linestyle="none",
        marker="x",
        color=PALETTE["black"],
        transform=axis.get_xaxis_transform(),
        label="failed",
    )


def _share_axes(axes: list[Axes], dataset: xr.Dataset) -> None:
    """One range of errors for all panels, and one range of work for each column."""
    low = np.min(dataset["reference_half_width"] / dataset["reference"])
    top = np.nanmax(dataset["error"])
    for column, work in enumerate(WORK):
        values = dataset[work].values
        known = values[np.isfinite(values) & (values > 0)]
        for axis in axes[column::2]:
            axis.set_xlim(known.min() / 2.0, known.max() * 2.0)
            axis.set_ylim(max(float(low), FLOOR) / 3.0, min(float(top), CEILING) * 4.0)
            axis.grid(True, which="major", linewidth=0.3, alpha=0.5)
    for axis in axes[:-2]:
        axis.tick_params(labelbottom=False)
    for axis in axes[1::2]:
        axis.tick_params(labelleft=False)


DRAWINGS: Mapping[str, Drawing] = MappingProxyType({"work_precision": draw_work_precision})
