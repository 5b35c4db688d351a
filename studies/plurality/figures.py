"""Jump or lift-off over the step size, and the jam law: measured fractions beside what the local map says."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.plotting.draw import Drawing
from painleve.plotting.style import GREY, PALETTE, legend_below, legend_under, panels, power_of_ten, with_unit
from painleve.store import labels_of

__all__ = ["DRAWINGS", "draw_initial_layer", "draw_jam_law", "draw_step_sizes"]

COLOURS = {"strict": PALETTE["vermilion"], "kept": PALETTE["blue"]}
MARKERS = {"strict": "o", "kept": "s"}
LABELS = {"strict": "strict test $g \\geq 0$", "kept": "tip kept on the floor"}
GROUP_MARKS = {"drift": ("o", "measured"), "invariance": ("^", "other $\\alpha$, speeds, starts")}
SHORT = {"strict": "strict", "kept": "kept"}
LINES = {"strict": "-", "kept": "--"}
APART = 1.35  # between neighbouring step sizes, on a logarithmic axis


def draw_step_sizes(dataset: xr.Dataset) -> Figure:
    """Fractions by window above; below, for each contact test, the times of the jumps after the exact instant."""
    figure, axes = panels(4, columns=2, height=2.4)
    fractions, narrow, *times = axes
    _draw_fractions(fractions, dataset, wide=True)
    _draw_fractions(narrow, dataset, wide=False)
    for axis, contact in zip(times, ("strict", "kept"), strict=True):
        _draw_times(axis, dataset, contact)
    low, high = (f(axis.get_ylim()[k] for axis in times) for k, f in enumerate((min, max)))
    for axis in times:
        axis.set_ylim(low, high)
    figure.suptitle(f"Glocker's rod, $r$ = {dataset['ratio'].item():.3f}", fontsize=8.5)
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
        axis.axhline(
            float(dataset["law"][i]), color=colour, linestyle=":", linewidth=0.8, label=f"limit law, {contact}"
        )
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
    """Fractions over r, over the drift d of the map (strict test), and over h on fixed slips; each with its legend."""
    figure, axes = panels(4, columns=2, height=3.3)
    drawings = (_draw_ratio, _draw_drift, _draw_approach, _draw_vanishing)
    for axis, letter, drawing in zip(axes, "abcd", drawings, strict=True):
        drawing(axis, dataset)
        axis.set_title(f"({letter}) {axis.get_title()}", loc="left")
        axis.set_title("")
        axis.set_ylabel("fraction that jams")
        legend_under(axis, columns=2)
    return figure


def _of(dataset: xr.Dataset, group: str, contact: str | None = None, ratio: float | None = None) -> xr.Dataset:
    chosen = dataset["group"].values == group
    if contact is not None:
        chosen &= labels_of(dataset["contact"]) == contact
    if ratio is not None:
        chosen &= dataset["ratio"].values == ratio
    return dataset.isel(case=np.flatnonzero(chosen))


def _bars(axis: Axes, x: np.ndarray, one: xr.Dataset, **style: object) -> None:
    f = one["fraction"].values
    error = np.abs(np.array([one["lower"].values - f, one["upper"].values - f]))
    axis.errorbar(x, f, yerr=error, linestyle="none", capsize=2, **style)  # type: ignore[arg-type]


def _draw_ratio(axis: Axes, dataset: xr.Dataset) -> None:
    for i, contact in enumerate(("strict", "kept")):
        law = "$1/(1+r)$" if contact == "strict" else "$1-r$"
        colour, one = COLOURS[contact], _of(dataset, "ratio", contact)
        axis.plot(
            dataset["law_ratio"],
            dataset["limit_law"].values[i],
            color=colour,
            linestyle=LINES[contact],
            label=f"limit {law}; 0 for $r \\geq 1$",
        )
        _bars(
            axis, one["ratio"].values, one, color=colour, marker=MARKERS[contact], label=f"measured, {SHORT[contact]}"
        )
        axis.plot(
            one["ratio"],
            one["local_map"],
            linestyle="none",
            marker="x",
            markersize=7,
            color=PALETTE["black"],
            label="local map, both tests",
        )
    axis.set_xlabel("ratio of the eigenvalues $r$")
    axis.set_title("over step sizes and starts, $h$ small")


def _draw_drift(axis: Axes, dataset: xr.Dataset) -> None:
    styles = zip(("blue", "sky", "green", "orange"), ("-", "--", "-.", ":"), strict=True)
    for ratio, curve, (name, line) in zip(
        dataset["map_ratio"].values, dataset["map_fraction"].values, styles, strict=False
    ):
        axis.plot(
            dataset["map_drift"], curve, color=PALETTE[name], linestyle=line, label=f"local map, $r$ = {ratio:.3g}"
        )
        for group, (marker, _) in GROUP_MARKS.items():
            one = _of(dataset, group, "strict", ratio)
            _bars(axis, one["drift"].values, one, color=PALETTE[name], marker=marker)
    for marker, label in GROUP_MARKS.values():
        axis.plot([], [], linestyle="none", marker=marker, color=GREY, label=label)
    axis.set_xscale("log")
    axis.set_xlabel("drift $d$ of the local map")
    axis.set_title("at any step size, strict test")


def _draw_approach(axis: Axes, dataset: xr.Dataset) -> None:
    for contact in ("strict", "kept"):
        colour, one = COLOURS[contact], _of(dataset, "approach", contact)
        _bars(axis, one["step"].values, one, color=colour, marker=MARKERS[contact], label=f"measured, {SHORT[contact]}")
        axis.plot(one["step"], one["local_map"], color=colour, linestyle="--", label=f"local map, {SHORT[contact]}")
        axis.plot(one["step"], one["law"], color=colour, linestyle=":", label=f"limit, {SHORT[contact]}")
    axis.set_xscale("log")
    axis.set_xlabel("step size $h$ (s)")
    axis.set_title(f"one slip, $r$ = {_ratios(dataset, 'approach')}")


def _draw_vanishing(axis: Axes, dataset: xr.Dataset) -> None:
    ratios = np.unique(_of(dataset, "vanishing")["ratio"])
    for ratio, marker, name in zip(ratios, "^vD", ("purple", "green", "black"), strict=False):
        one, colour = _of(dataset, "vanishing", ratio=ratio), PALETTE[name]
        _bars(axis, one["step"].values, one, color=colour, marker=marker, label=f"measured, $r$ = {ratio:g}")
        axis.plot(one["step"], one["local_map"], color=colour, linestyle="--", label=f"local map, $r$ = {ratio:g}")
    axis.set_xscale("log")
    axis.set_ylim(bottom=0.0)
    axis.set_xlabel("step size $h$ (s)")
    axis.set_title(f"one slip, $r$ = {_ratios(dataset, 'vanishing')}, strict test; the limit is 0")


def _ratios(dataset: xr.Dataset, group: str) -> str:
    return " or ".join(f"{ratio:g}" for ratio in np.unique(_of(dataset, group)["ratio"]))


def draw_initial_layer(dataset: xr.Dataset) -> Figure:
    """For each state the fraction that jumps over eps/h, and below the two excesses between A and right velocities.

    Step sizes stand beside each other at each eps/h, for their marks would cover each other.
    """
    count, steps = dataset.sizes["state"], dataset["step"].values
    figure, axes = panels(2 * count, columns=count, height=2.2)
    for i in range(count):
        above, below, one = axes[i], axes[count + i], dataset.isel(state=i)
        for j, (step, name, marker) in enumerate(zip(steps, ("blue", "green", "vermilion"), "os^", strict=False)):
            beside = APART ** (j - (len(steps) - 1) / 2.0)
            _draw_layer(above, below, one.isel(step=j), beside, PALETTE[name], marker, f"$h$ = {power_of_ten(step)} s")
        above.set_title(str(one["state"].item()))
        for axis in (above, below):
            axis.set_xscale("log")
        above.set_ylim(-0.03, 1.03)
        above.tick_params(labelbottom=False)
        below.set_yscale("log")
        below.set_ylim(_span(dataset))
        below.set_xlabel("$\\varepsilon/h$ (1/s)")
        below.plot([], [], linestyle="none", marker="^", color=GREY, label="of right velocities from $A$, lower bound")
        below.plot(
            [],
            [],
            linestyle="none",
            marker="v",
            markerfacecolor="none",
            color=GREY,
            label="of $A$ from right velocities, upper bound",
        )
    axes[0].set_ylabel("fraction that jumps\n(95 % interval)")
    axes[count].set_ylabel(with_unit("excess", dataset["excess_of_A"], broken=True))
    legend_below(figure, axes, columns=3)
    return figure


def _span(dataset: xr.Dataset) -> tuple[float, float]:
    """The range of both excesses."""
    values = np.concatenate([dataset[name].values.ravel() for name in ("excess_from_A", "excess_of_A")])
    positive = values[values > 0.0]
    return float(positive.min()) / 1.5, float(positive.max()) * 1.5


def _draw_layer(above: Axes, below: Axes, one: xr.Dataset, beside: float, colour: str, marker: str, label: str) -> None:
    place = one["ratio"].values * beside
    _bars(above, place, one, color=colour, marker=marker, label=label)
    below.plot(place, one["excess_from_A"], color=colour, marker="^", linestyle="none")
    below.plot(place, one["excess_of_A"], color=colour, marker="v", markerfacecolor="none", linestyle="none")


DRAWINGS: Mapping[str, Drawing] = MappingProxyType(
    {"step_sizes": draw_step_sizes, "jam_law": draw_jam_law, "initial_layer": draw_initial_layer}
)
