"""Law (7) against Coulomb's law: how many solutions the second has, and how far the first is from the nearest."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator

from painleve.plotting.draw import Drawing
from painleve.plotting.style import PALETTE, entitle, expressed, label_outside, legend_below, panels, with_unit

__all__ = ["DRAWINGS", "draw_laws"]

# Light to dark, so that a grey print tells them apart too.
SHADES = MappingProxyType({1: "#F2F2F2", 2: PALETTE["sky"], 3: PALETTE["blue"]})
DRAWN = 2  # normal velocities, those nearest to the tangential problem
LEVELS = 9
NOTHING = 0.05  # of the first step of colour: a smaller distance stays white
TICKS = (-np.pi, -np.pi / 2.0, 0.0, np.pi / 2.0, np.pi)
DEFINED = "$b = H^\\top M^{-1} w_n$: how a normal impulse moves the tip along the floor; $\\mu_c = a/\\|b\\|$"


def draw_laws(dataset: xr.Dataset) -> Figure:
    """A row for each configuration and normal velocity: the number of solutions, and the distance of the two laws."""
    dataset = dataset.sortby("approach").isel(approach=slice(-DRAWN, None))
    rows = [(s, a) for s in range(dataset.sizes["state"]) for a in range(dataset.sizes["approach"])]
    figure, axes = panels(2 * len(rows), columns=2, height=2.1, shared=True)
    levels = np.array(MaxNLocator(LEVELS).tick_values(0.0, float(dataset["nearest"].max()) or 1.0))
    levels[0] = NOTHING * levels[1]
    for k, (state, approach) in enumerate(rows):
        chosen = dataset.isel(state=state, approach=approach)
        left, right = axes[2 * k : 2 * k + 2]
        _draw_numbers(left, chosen)
        filled = _draw_distances(right, chosen, levels)
        for axis in (left, right):
            _draw_edges(axis, chosen)
            axis.set_xlim(-np.pi, np.pi)
        v_n = float(chosen["approach"])
        problem = "tangential, $v_n = 0$" if v_n == 0.0 else f"impact, $v_n = {v_n:g}\\,|v_t|$"
        for axis in (left, right):
            axis.set_title(f"{expressed(str(chosen['state'].item()))}; {problem}")
    axes[0].set_title(f"Number of solutions of Coulomb's law\n{axes[0].get_title()}")
    axes[1].set_title(f"Distance of law (7) from the nearest of them\n{axes[1].get_title()}")
    direction = with_unit("angle $\\psi$ of the slip against $b$", dataset["direction"])
    label_outside(axes, 2, direction, "coefficient of friction $\\mu$")
    axes[0].set_xticks(TICKS, ["−π", "−π/2", "0", "π/2", "π"])
    label = with_unit(f"distance at a slip of speed 1; white: below {levels[0]:.2g}", dataset["nearest"])
    figure.colorbar(filled, ax=axes[1::2], label=label, format="%.2g", pad=0.02, aspect=40, ticks=levels[1:])
    entitle(figure, dataset, DEFINED)
    legend_below(figure, axes, columns=3)
    return figure


def _draw_numbers(axis: Axes, chosen: xr.Dataset) -> None:
    """Bands between edges that were found for each friction: they are narrower than the points of the map."""
    everywhere: dict[str, Any] = {"facecolor": SHADES[1], "edgecolor": "black", "linewidth": 0.4, "label": "1 solution"}
    axis.add_patch(Rectangle((0.0, 0.0), 1.0, 1.0, transform=axis.transAxes, zorder=0, **everywhere))
    friction = chosen["friction"].values
    for number, (low, high) in zip(chosen["number"].values.tolist(), chosen["several"].values, strict=True):
        if np.isnan(low).all():
            continue
        for side in (1.0, -1.0):
            axis.fill_betweenx(
                friction,
                side * low,
                side * high,
                facecolor=SHADES[number],
                edgecolor=SHADES[number],
                linewidth=0.5,
                label=f"{number} solutions",
            )


def _draw_distances(axis: Axes, chosen: xr.Dataset, levels: np.ndarray) -> QuadContourSet:
    place = chosen["direction"], chosen["friction"], chosen["nearest"]
    filled = axis.contourf(*place, levels=levels, cmap="cividis_r")
    axis.contour(*place, levels=levels[:-1], colors="black", linewidths=0.3, alpha=0.6)
    return filled


def _draw_edges(axis: Axes, chosen: xr.Dataset) -> None:
    critical = float(chosen["critical_friction"])
    axis.axhline(critical, color=PALETTE["vermilion"], linewidth=1.5, label="$\\mu_c$, where $\\gamma = 0$")
    if float(chosen["approach"]) < 0.0:
        return
    curves = {"driven": ("--", "friction would drive the slip inside"), "projected": (":", "law (7) jumps inside")}
    for name, (line, label) in curves.items():
        for side in (1.0, -1.0):
            axis.plot(
                side * chosen[name],
                chosen["friction"],
                color=PALETTE["black"],
                linestyle=line,
                linewidth=1.3,
                label=label,
            )


DRAWINGS: Mapping[str, Drawing] = MappingProxyType({"laws": draw_laws})
