"""Errors of every scheme on motions with contact: against the step, and against wall time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.plotting.draw import Drawing
from painleve.plotting.style import GREY, PALETTE, Mark, legend_below, panels, spoken
from painleve.store import labels_of

__all__ = ["DRAWINGS", "SCHEMES", "draw_convergence"]


@dataclass(frozen=True, kw_only=True)
class SchemeMark(Mark):
    """Open marks of falling size: where schemes agree, and some agree to the last digit, all of them can be seen."""

    size: float


SCHEMES: Mapping[str, SchemeMark] = MappingProxyType(
    {
        "contact_dynamics": SchemeMark(colour=PALETTE["vermilion"], marker="o", label="Contact Dynamics", size=8.5),
        "moreau_jean": SchemeMark(colour=PALETTE["blue"], marker="s", label="Moreau-Jean", size=6.5),
        "stewart_trinkle": SchemeMark(colour=PALETTE["green"], marker="^", label="Stewart-Trinkle", size=5.0),
        "anitescu_potra": SchemeMark(colour=PALETTE["orange"], marker="v", label="Anitescu-Potra", size=4.0),
        "schatzman_paoli": SchemeMark(colour=PALETTE["purple"], marker="D", label="Schatzman-Paoli", size=2.6),
        "event_driven": SchemeMark(colour=PALETTE["black"], marker="*", label="event-driven", size=6.0),
        "compliant": SchemeMark(colour=PALETTE["sky"], marker="P", label="compliant", size=4.5),
    }
)
# The paper's references, by their numbers there, and what they prove (studies.convergence.motions.Situation).
THEOREMS = (
    "proofs of convergence, by their numbers in the paper: "
    "[9] $M = m\\,\\mathrm{Id}$, [5] any $M$, $\\mu = 0$, [15] any $M$, $\\mu > 0$"
)
COLUMNS = 4
STRIP = 0.04  # of an axis: where failed runs stand
FLOOR = 1e-12
LETTERS = "abcdefghijklmnopqrstuvwxyz"


def draw_convergence(dataset: xr.Dataset) -> Figure:
    """The upper half: error against step, or contact time of a compliant contact; the lower half: against wall time.

    Lines go through the largest error of each level, dots are the other runs. Crosses on a line: no convergence to the
    solution of the problem. Errors in the grey band are not resolved by the reference.
    """
    count = dataset.sizes["problem"]
    columns = min(COLUMNS, count)
    figure, axes = panels(2 * count, columns=columns, height=1.75)
    for k, axis in enumerate(axes):
        one, work = dataset.isel(problem=k % count), "value" if k < count else "seconds"
        _draw_panel(axis, one, work)
        axis.set_title(f"({LETTERS[k]}) {_title(one)}", loc="left", fontsize=7)
        axis.set_ylim(_errors(dataset, work))
        axis.set_xlim(_range(dataset, work))
        axis.tick_params(labelleft=k % columns == 0)
        if k % columns == 0:
            axis.set_ylabel("error, graphs in $(t, u)$")
        if k + columns >= len(axes) or count - columns <= k < count:
            axis.set_xlabel("step or contact time (s)" if work == "value" else "wall time, warm (s)")
    figure.suptitle(THEOREMS, fontsize=8)
    legend_below(figure, axes, columns=4)
    return figure


def _title(one: xr.Dataset) -> str:
    """The problem's name, and the number of the theorem that applies to it."""
    return f"{spoken(one['problem'].item())}, {str(one['situation'].item()).rsplit(' ', 1)[-1]}"


def _draw_panel(axis: Axes, one: xr.Dataset, work: str) -> None:
    axis.set_xscale("log")
    axis.set_yscale("log")
    resolution = max(float(one["resolution"]), FLOOR)
    axis.axhspan(
        FLOOR / 100.0, resolution, color=GREY, alpha=0.25, linewidth=0.0, label="not resolved by the reference"
    )
    verdicts = dict(zip(one["scheme"].values, labels_of(one["verdict"]), strict=True))
    for name, mark in SCHEMES.items():
        if work == "seconds" or name != "event_driven":
            _draw_scheme(axis, one, work, name, mark, resolution, stays=verdicts[name] == "does_not_converge")
    if work == "value":
        _draw_slope(axis, one)
    axis.grid(True, which="major", linewidth=0.3, alpha=0.5)


def _draw_scheme(
    axis: Axes, one: xr.Dataset, work: str, name: str, mark: SchemeMark, resolution: float, *, stays: bool
) -> None:
    own = one.isel(run=np.flatnonzero(one["run_scheme"].values == name))
    x, error, worst = own[work].values, np.maximum(own["error_upper"].values, resolution), own["worst"].values == 1
    done = np.isfinite(error)
    axis.plot(x[done], error[done], linestyle="none", marker=".", markersize=1.2, color=mark.colour, alpha=0.35)
    axis.plot(
        x[worst],
        error[worst],
        linewidth=0.7,
        color=mark.colour,
        marker=mark.marker,
        markersize=mark.size,
        markerfacecolor="none",
        markeredgewidth=0.8,
        label=mark.label,
    )
    if stays:
        axis.plot(
            x[worst],
            error[worst],
            linestyle="none",
            marker="x",
            markersize=4.0,
            color=PALETTE["black"],
            zorder=3,
            label="does not converge to the solution",
        )
    if not done.all():
        axis.plot(
            x[~done],
            np.full((~done).sum(), STRIP),
            linestyle="none",
            marker="|",
            markersize=6.0,
            color=mark.colour,
            transform=axis.get_xaxis_transform(),
            label=f"failed: {mark.label}",
        )


def _draw_slope(axis: Axes, one: xr.Dataset) -> None:
    """A line of the expected order, above the data."""
    order = float(one["expected_order"].max())
    steps = labels_of(one["control"]) == "step"
    x = np.array([one["value"].values[steps].min(), one["value"].values[steps].max()])
    top = np.nanmax(one["error_upper"].values[steps] / one["value"].values[steps] ** order)
    axis.plot(x, 5.0 * top * x**order, color=GREY, linestyle="--", linewidth=0.8, label=f"order {order:g}")


def _errors(dataset: xr.Dataset, work: str) -> tuple[float, float]:
    """A range for the errors: against the step without the adaptive methods, and without runs that chance favours."""
    low, top = max(float(np.min(dataset["resolution"])), FLOOR), float(np.nanmax(dataset["error_upper"]))
    if work == "value":
        steps = dataset["error_upper"].values[:, labels_of(dataset["control"]) == "step"]
        low = float(np.nanpercentile(steps, 5.0)) / 3.0
    return low / 3.0, 3.0 * top


def _range(dataset: xr.Dataset, work: str) -> tuple[float, float]:
    values = dataset[work].values
    if work == "value":
        values = values[:, labels_of(dataset["control"]) != "tolerance"]
    return float(values.min()) / 2.0, float(values.max()) * 2.0


DRAWINGS: Mapping[str, Drawing] = MappingProxyType({"convergence": draw_convergence})
