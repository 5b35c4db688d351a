"""Jump or lift-off over the step size, and the jam law: measured fractions beside what the local map says."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.core.jam_map import jam_fraction, limit_law
from painleve.plotting.draw import Drawing
from painleve.plotting.style import GREY, PALETTE, labels_of, legend_below, panels

__all__ = ["DRAWINGS", "draw_initial_layer", "draw_jam_law", "draw_step_sizes"]

COLOURS = {"strict": PALETTE["vermilion"], "kept": PALETTE["blue"]}
MARKERS = {"strict": "o", "kept": "s"}
LABELS = {"strict": "strict test $g \\geq 0$", "kept": "tip kept on the floor"}
RATIOS = np.linspace(0.02, 0.98, 33)
GROUP_MARKS = {"drift": "o", "invariance": "^"}


def draw_step_sizes(dataset: xr.Dataset) -> Figure:
    """Fractions by window above; below, for each contact test, the times of the jumps after the exact instant."""
    figure, axes = panels(4, columns=2, height=2.4)
    fractions, narrow, *times = axes
    _draw_fractions(fractions, dataset, wide=True)
    _draw_fractions(narrow, dataset, wide=False)
    for axis, contact in zip(times, ("strict", "kept"), strict=True):
        _draw_times(axis, dataset, contact)
    legend_below(figure, axes, columns=4)
    return figure


def _draw_fractions(axis: Axes, dataset: xr.Dataset, *, wide: bool) -> None:
    chosen = dataset.isel(window=np.flatnonzero((dataset["decades"].values > 0.5) == wide))
    middle = chosen["first_step"].values * 10.0 ** (chosen["decades"].values / 2.0)
    for i, contact in enumerate(labels_of(dataset["contact"])):
        f, colour = chosen["fraction"].values[i], COLOURS[contact]
        error = np.abs(np.array([chosen["lower"].values[i], chosen["upper"].values[i]]) - f)
        axis.errorbar(
            middle,
            f,
            yerr=error,
            color=colour,
            marker=MARKERS[contact],
            linestyle="none",
            capsize=2,
            label=f"{LABELS[contact]} (95 % interval)",
        )
        axis.plot(middle, chosen["local_map"].values[i], color=colour, linestyle="--", label=f"local map, {contact}")
        limit = limit_law(dataset["ratio"].item(), strict=contact == "strict")
        axis.axhline(limit, color=colour, linestyle=":", linewidth=0.8, label=f"limit law, {contact}")
    axis.set_xscale("log" if wide else "linear")
    if not wide:
        axis.locator_params(axis="x", nbins=4)
        axis.ticklabel_format(axis="x", style="sci", scilimits=(0, 0), useMathText=True)
    axis.set_ylim(0.0, 1.0)
    axis.set_title("decades of step sizes" if wide else "narrow windows, 0.7 % wide: parts of a period")
    axis.set_xlabel("step size $h$ (s)")
    axis.set_ylabel("fraction that jumps")


def _draw_times(axis: Axes, dataset: xr.Dataset, contact: str) -> None:
    i = labels_of(dataset["contact"]).tolist().index(contact)
    step, time = dataset["step"].values[i].ravel(), dataset["time"].values[i].ravel()
    jumped = labels_of(dataset["outcome"])[i].ravel() == "jump"
    delay = np.abs(time - dataset["instant"].item())
    axis.scatter(step[jumped], delay[jumped], s=1.5, linewidths=0.0, color=COLOURS[contact], rasterized=True)
    ends = np.array([np.nanmin(step), np.nanmax(step)])
    axis.plot(ends, ends, color=GREY, linestyle="--", label="one step")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_title(f"jumps, {LABELS[contact]}")
    axis.set_xlabel("step size $h$ (s)")
    axis.set_ylabel("distance of the jump from\nthe exact instant (s)")


def draw_jam_law(dataset: xr.Dataset) -> Figure:
    """Fractions over r, over the drift d of the map (strict test), and over h on fixed slips."""
    figure, axes = panels(4, columns=2, height=2.6)
    _draw_ratio(axes[0], dataset)
    _draw_drift(axes[1], dataset)
    _draw_approach(axes[2], dataset)
    _draw_vanishing(axes[3], dataset)
    legend_below(figure, axes, columns=3)
    return figure


def _of(dataset: xr.Dataset, group: str, contact: str | None = None) -> xr.Dataset:
    chosen = dataset["group"].values == group
    if contact is not None:
        chosen &= labels_of(dataset["contact"]) == contact
    return dataset.isel(case=np.flatnonzero(chosen))


def _bars(axis: Axes, x: np.ndarray, one: xr.Dataset, **style: object) -> None:
    f = one["fraction"].values
    error = np.abs(np.array([one["lower"].values - f, one["upper"].values - f]))
    axis.errorbar(x, f, yerr=error, linestyle="none", capsize=2, **style)  # type: ignore[arg-type]


def _draw_ratio(axis: Axes, dataset: xr.Dataset) -> None:
    for contact in ("strict", "kept"):
        strict = contact == "strict"
        curve = [limit_law(float(r), strict=strict) for r in RATIOS]
        law = "$1/(1+r)$" if strict else "$1-r$"
        axis.plot(RATIOS, curve, color=COLOURS[contact], label=f"limit law {law}, 0 for $r \\geq 1$")
        axis.plot([1.0, 2.0], [0.0, 0.0], color=COLOURS[contact], linewidth=2.0 if strict else 1.0)
        one = _of(dataset, "ratio", contact)
        _bars(
            axis,
            one["ratio"].values,
            one,
            color=COLOURS[contact],
            marker=MARKERS[contact],
            label=f"measured, {LABELS[contact]}",
        )
        axis.plot(
            one["ratio"],
            one["local_map"],
            linestyle="none",
            marker="x",
            markersize=7,
            color=PALETTE["black"],
            label="local map at the same $h$",
        )
    axis.set_xlabel("ratio of the eigenvalues $r$")
    axis.set_ylabel("fraction that jams")
    axis.set_title("over step sizes and starts, smallest $h$")


def _draw_drift(axis: Axes, dataset: xr.Dataset) -> None:
    colours = [PALETTE[c] for c in ("blue", "sky", "green", "orange", "vermilion", "purple", "black")]
    grid = np.logspace(-3, 0.7, 25)
    ratios = np.unique(_of(dataset, "drift")["ratio"])
    for ratio, colour in zip(ratios, colours, strict=False):
        curve = [jam_fraction(float(ratio), float(d), strict=True, phases=2000) for d in grid]
        axis.plot(grid, curve, color=colour, linewidth=0.8, label=f"map, $r$ = {ratio:.3g}")
        for group, marker in GROUP_MARKS.items():
            one = _of(dataset, group, "strict")
            one = one.isel(case=np.flatnonzero(one["ratio"].values == ratio))
            _bars(axis, one["drift"].values, one, color=colour, marker=marker)
    axis.set_xscale("log")
    axis.set_xlabel("drift $d$ of the local map, strict test")
    axis.set_ylabel("fraction that jams")
    axis.set_title("triangles: other $\\alpha$, speeds and starts")


def _draw_approach(axis: Axes, dataset: xr.Dataset) -> None:
    for contact in ("strict", "kept"):
        one = _of(dataset, "approach", contact)
        _bars(axis, one["step"].values, one, color=COLOURS[contact], marker=MARKERS[contact])
        axis.plot(one["step"], one["local_map"], color=COLOURS[contact], linestyle="--")
        axis.plot(one["step"], one["law"], color=COLOURS[contact], linestyle=":")
    axis.set_xscale("log")
    axis.set_xlabel("step size $h$ (s)")
    axis.set_ylabel("fraction that jams")
    axis.set_title("one slip, $r < 1$; dashed: map, dotted: limit")


def _draw_vanishing(axis: Axes, dataset: xr.Dataset) -> None:
    one = _of(dataset, "vanishing")
    for ratio, marker in zip(np.unique(one["ratio"]), "ovD", strict=False):
        case = one.isel(case=np.flatnonzero(one["ratio"].values == ratio))
        _bars(
            axis, case["step"].values, case, color=COLOURS["strict"], marker=marker, label=f"measured, $r$ = {ratio:g}"
        )
        axis.plot(case["step"], case["local_map"], color=COLOURS["strict"], linestyle="--")
    axis.set_xscale("log")
    axis.set_xlabel("step size $h$ (s)")
    axis.set_ylabel("fraction that jams")
    axis.set_title("one slip, $r > 1$, strict test; dashed: map")


def draw_initial_layer(dataset: xr.Dataset) -> Figure:
    """For each state the fraction that jumps over eps/h, and below the two excesses between A and right velocities."""
    count = dataset.sizes["state"]
    figure, axes = panels(2 * count, columns=count, height=2.2)
    for i in range(count):
        above, below, one = axes[i], axes[count + i], dataset.isel(state=i)
        for j, (colour, marker) in enumerate(zip(("blue", "green", "vermilion"), "os^", strict=True)):
            if j < dataset.sizes["step"]:
                _draw_layer(above, below, one.isel(step=j), PALETTE[colour], marker)
        above.set_title(str(one["state"].item()))
        above.set_ylabel("fraction that jumps")
        below.set_ylabel(f"excess ({dataset['excess_of_A'].attrs['units']})")
        below.set_yscale("log")
        for axis in (above, below):
            axis.set_xscale("log")
            axis.set_xlabel("$\\varepsilon/h$ (1/s)")
    legend_below(figure, axes, columns=3)
    return figure


def _draw_layer(above: Axes, below: Axes, one: xr.Dataset, colour: str, marker: str) -> None:
    ratio, step = one["ratio"].values, one["step"].item()
    _bars(above, ratio, one, color=colour, marker=marker, label=f"$h$ = {step:g} s")
    below.plot(
        ratio,
        one["excess_from_A"],
        color=colour,
        marker="^",
        linestyle="none",
        label="of right velocities from $A$, lower bound",
    )
    below.plot(
        ratio,
        one["excess_of_A"],
        color=colour,
        marker="v",
        markerfacecolor="none",
        linestyle="none",
        label="of $A$ from right velocities, upper bound",
    )


DRAWINGS: Mapping[str, Drawing] = MappingProxyType(
    {"step_sizes": draw_step_sizes, "jam_law": draw_jam_law, "initial_layer": draw_initial_layer}
)
