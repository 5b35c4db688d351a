"""Published facts on what was computed: mu_c of rods over the angle, and contact forces on slips towards the edge."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.plotting.draw import Drawing
from painleve.plotting.style import GREY, PALETTE, entitle, legend_under, panels

__all__ = ["DRAWINGS", "draw_reference"]

ROD_STYLES = (("purple", ":"), ("orange", "-."), ("black", "-"), ("blue", "--"))
UNIFORM = 3.0


def draw_reference(dataset: xr.Dataset) -> Figure:
    """Left: lines from the derivation, marks from the reference data. Right: slips below and above mu_C."""
    figure, (left, right) = panels(2, columns=2, height=3.2)
    _draw_friction(left, dataset)
    _draw_forces(right, dataset)
    left.set_title("lines: derived; marks: published")
    right.set_title("smooth slips towards the edge of the band")
    entitle(figure, dataset)
    return figure


def _draw_friction(axis: Axes, dataset: xr.Dataset) -> None:
    degrees = np.degrees(dataset["theta"].values)
    for i, (alpha, (colour, dash)) in enumerate(zip(dataset["alpha"].values, ROD_STYLES, strict=True)):
        axis.plot(
            degrees,
            dataset["critical_friction"][i],
            color=PALETTE[colour],
            linestyle=dash,
            linewidth=1.8 if alpha == UNIFORM else 1.0,
            label=f"$\\mu_c$, $\\alpha$ = {alpha:g}",
        )
    marks: dict[str, Any] = {"markeredgecolor": "black", "linestyle": "none", "zorder": 4}
    axis.plot(
        np.degrees(dataset["least_friction_angle"]),
        dataset["least_friction"],
        marker="o",
        color=PALETTE["vermilion"],
        label="$\\mu_P$, published",
        **marks,
    )
    for edges in np.degrees(dataset["edges"]):
        axis.plot(
            edges, dataset["edge_friction"], marker="s", color=PALETTE["sky"], label="band edge, published", **marks
        )
    axis.plot(
        60.0,
        dataset["sixty_degrees_friction"],
        marker="D",
        color=PALETTE["yellow"],
        label="rod at 60°, published",
        **marks,
    )
    axis.axhline(
        float(dataset["singular_friction"]), color=GREY, linewidth=0.8, label="$\\mu_C$, published ($\\alpha$ = 3)"
    )
    axis.set_ylim(0.0, 4.0)
    axis.set_xlim(0.0, 90.0)
    axis.set_xticks(range(0, 91, 15))
    axis.set_xlabel("inclination $\\theta$ (degrees)")
    axis.set_ylabel("coefficient of friction")
    legend_under(axis, columns=2)


def _draw_forces(axis: Axes, dataset: xr.Dataset) -> None:
    below = float(dataset["singular_friction"])
    for mu, force in zip(dataset["slip_friction"].values, dataset["slip_force"].values, strict=True):
        colour, dash = ("blue", "--") if mu < below else ("vermilion", "-")
        side = "below" if mu < below else "above"
        axis.plot(
            dataset["distance"],
            force,
            color=PALETTE[colour],
            linestyle=dash,
            linewidth=0.8,
            label=f"$\\mu$ = {mu:.3g}, {side} $\\mu_C$",
        )
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_ylim(1e-2, 1e5)
    axis.invert_xaxis()
    axis.set_xlabel("distance to the edge of the band (rad)")
    axis.set_ylabel("contact force / (mass × gravity)")
    legend_under(axis, columns=2)


DRAWINGS: Mapping[str, Drawing] = MappingProxyType({"reference": draw_reference})
