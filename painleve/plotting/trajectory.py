"""A trajectory: the body over time, gamma on its way, the velocities of the contact point, and energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from painleve.plotting.style import GREY, PALETTE, WIDTH, legend_below, with_unit
from painleve.store import labels_of

__all__ = ["draw_body", "draw_trajectory", "frame_body", "spaced"]

SHOWN = 12  # instants at which the body is drawn
LIGHT, DARK = 0.80, 0.0  # greys of the first and the last
MARGIN = 0.05  # around the body, of its extent
JUMPS = {
    "impact": ("impact", PALETTE["sky"], (0, (1, 1))),
    "frictional_impact": ("frictional impact", PALETTE["blue"], (0, (4, 2))),
    "jump_without_collision": ("jump without collision", PALETTE["vermilion"], (0, (5, 1, 1, 1))),
}


@dataclass(frozen=True, kw_only=True)
class PlottedLine:
    """A variable over time: how it is drawn and what the legend says."""

    name: str
    label: str
    colour: str
    style: str = "-"


# Panels from the top, with the label of their axis; a curve is drawn if the dataset has it.
CURVES = (
    ("$\\gamma$", (PlottedLine(name="gamma", label="$\\gamma$", colour=PALETTE["purple"]),)),
    (
        "velocity",
        (
            PlottedLine(name="v_n", label="contact point, normal $v_n$", colour=PALETTE["blue"]),
            PlottedLine(name="v_t", label="contact point, tangential $v_t$", colour=PALETTE["orange"], style="--"),
            PlottedLine(name="v_t1", label="contact point, tangential $v_{t1}$", colour=PALETTE["orange"], style="--"),
            PlottedLine(name="v_t2", label="contact point, tangential $v_{t2}$", colour=PALETTE["green"], style="-."),
        ),
    ),
    (
        "contact force",
        (PlottedLine(name="contact_force", label="normal contact force", colour=PALETTE["sky"]),),
    ),
    (
        "energy",
        (
            PlottedLine(name="kinetic_energy", label="kinetic energy", colour=PALETTE["green"]),
            PlottedLine(name="contact_work", label="work of the contact", colour=PALETTE["black"], style="--"),
            PlottedLine(name="splitting_loss", label="lost by the scheme", colour=GREY, style=":"),
        ),
    ),
)
FORCE = [label for label, _ in CURVES].index("contact force")


def draw_trajectory(dataset: xr.Dataset) -> Figure:
    """The body at some instants, light to dark, and four panels over time, with every jump marked by its kind."""
    body = "outline_x" in dataset
    heights = ([1.7] if body else []) + [1.15] * len(CURVES)
    figure = Figure(figsize=(WIDTH, sum(heights) + 1.0), layout="constrained")
    axes: list[Axes] = list(figure.subplots(len(heights), 1, squeeze=False, height_ratios=heights).flat)
    over_time = axes[1:] if body else axes
    if body:
        _draw_bodies(axes[0], dataset)
    for axis, (label, curves) in zip(over_time, CURVES, strict=True):
        _draw_panel(axis, dataset, label, curves)
        axis.sharex(over_time[0])
        axis.tick_params(labelbottom=axis is over_time[-1])
    if dataset.attrs.get("steps_in_hops"):
        _say_hops(over_time[FORCE], dataset)
    over_time[-1].set_xlabel(with_unit("time $t$", dataset["time"]))
    names = dataset.attrs["scene"].replace("_", " "), dataset.attrs["start"], dataset.attrs["scheme"].replace("_", " ")
    figure.suptitle(f"{', '.join(filter(None, names))}: {dataset.attrs['status'].replace('_', ' ')}", fontsize=8)
    figure.align_ylabels(axes)
    legend_below(figure, axes, columns=3)
    return figure


def _say_hops(axis: Axes, dataset: xr.Dataset) -> None:
    """Above the contact force: it is an average, for the impulses that it is made of come in hops."""
    hops, steps = dataset.attrs["steps_in_hops"], dataset.sizes["time"] - 1
    words = f"impulses come in hops, off the floor in {hops} of {steps} steps between contacts: each over its hop"
    axis.set_title(words, loc="left", fontsize=7, color=GREY)


def spaced(time: np.ndarray, count: int) -> np.ndarray:
    """Indices of at most `count` instants, evenly spaced in time, the first and the last among them."""
    nearest = np.searchsorted(time, np.linspace(time[0], time[-1], count)).clip(max=len(time) - 1)
    return np.unique([*nearest, len(time) - 1])


def draw_body(axis: Axes, dataset: xr.Dataset, index: int, shade: float, label: str | None = None) -> Line2D:
    """The outline at one instant, with its joints, in a grey between 0 and 1."""
    x, y = dataset["outline_x"].values[index], dataset["outline_y"].values[index]
    (line,) = axis.plot(
        x, y, color=str(shade), linewidth=1.8, marker="o", markersize=2.5, solid_capstyle="round", label=label
    )
    return line


def frame_body(axis: Axes, dataset: xr.Dataset) -> None:
    """Floor, labels, and limits that hold the body at all instants."""
    floor = float(dataset["floor"])
    axis.axhline(floor, color=GREY, linewidth=1.2, zorder=0)
    x, y = dataset["outline_x"].values.ravel(), dataset["outline_y"].values.ravel()
    axis.update_datalim(np.column_stack([x, y]))
    axis.margins(MARGIN)
    axis.autoscale_view()
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_xlabel(with_unit("$x$", dataset["outline_x"]))
    axis.set_ylabel(with_unit("height", dataset["outline_y"]))


def _draw_bodies(axis: Axes, dataset: xr.Dataset) -> None:
    frame_body(axis, dataset)
    shown = spaced(dataset["time"].values, SHOWN)
    for k, index in enumerate(shown):
        shade = LIGHT + (DARK - LIGHT) * k / max(len(shown) - 1, 1)
        label = {0: "body at the start", len(shown) - 1: "body at the end"}.get(k)
        draw_body(axis, dataset, int(index), shade, label)
    kinds = labels_of(dataset["change"])
    for kind, (_, colour, _) in JUMPS.items():
        chosen = np.flatnonzero(kinds == kind)
        lines = np.stack([dataset["outline_x"].values[chosen], dataset["outline_y"].values[chosen]], axis=-1)
        axis.add_collection(LineCollection(list(lines), colors=colour, linewidths=1.0, zorder=3), autolim=False)


def _draw_panel(axis: Axes, dataset: xr.Dataset, label: str, curves: tuple[PlottedLine, ...]) -> None:
    axis.axhline(0.0, color=GREY, linewidth=0.5, zorder=0)
    for curve in (c for c in curves if c.name in dataset):
        axis.plot(dataset["time"], dataset[curve.name], color=curve.colour, linestyle=curve.style, label=curve.label)
    kinds = labels_of(dataset["change"])
    for kind, (name, colour, style) in JUMPS.items():
        times = dataset["time"].values[kinds == kind]
        if times.size:
            axis.vlines(
                times,
                0.0,
                1.0,
                transform=axis.get_xaxis_transform(),
                colors=colour,
                linestyles=style,
                linewidths=0.9,
                label=name,
            )
    axis.locator_params(axis="y", nbins=5)
    axis.set_ylabel(with_unit(label, dataset[curves[0].name], broken=True))
