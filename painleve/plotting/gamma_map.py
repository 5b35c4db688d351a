"""gamma over a path along the contact and the coefficient of friction, with mu_c and the states."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from painleve.plotting.style import (
    PALETTE,
    THEOREM_MARKS,
    entitle,
    legend_below,
    lettered,
    panels,
    spoken,
    with_unit,
)
from painleve.store import labels_of

__all__ = ["draw_gamma_map"]

LEVELS = 8
SHOWN = 0.98  # of the values: the largest few would take all the colours


def draw_gamma_map(dataset: xr.Dataset) -> Figure:
    """A panel for each curve mu_c; orange below zero, purple above, and lines that a grey print shows too."""
    groups = np.unique(dataset["panel"])
    figure, axes = panels(len(groups), columns=min(3, len(groups)), height=3.0)
    largest = float(np.nanquantile(np.abs(dataset["gamma"]), SHOWN))
    levels = np.asarray(MaxNLocator(LEVELS, symmetric=True).tick_values(-largest, largest))
    for axis, group in zip(axes, groups, strict=True):
        chosen = dataset.isel(state=np.flatnonzero(dataset["panel"] == group))
        filled = axis.contourf(
            chosen["path"],
            chosen["friction"],
            chosen["gamma"][0].T,
            levels=levels,
            cmap="PuOr",
            norm=TwoSlopeNorm(0.0, levels[0], levels[-1]),
            extend="both",
            alpha=0.75,
        )
        _draw_curves(axis, chosen, levels)
        _draw_states(axis, chosen)
        axis.set_title(lettered(str(chosen["panel_title"].values[0])).replace("; ", "\n"))
        axis.set_xlabel(with_unit(dataset.attrs["path_symbol"], dataset["path"]))
    for axis in axes[:: min(3, len(groups))]:
        axis.set_ylabel("coefficient of friction $\\mu$")
    figure.colorbar(filled, ax=axes, label=with_unit("$\\gamma$", dataset["gamma"]), ticks=levels, pad=0.01)
    entitle(figure, dataset, "$\\gamma$ along the contact")
    legend_below(figure, axes, columns=4)
    return figure


def _draw_curves(axis: Axes, chosen: xr.Dataset, levels: np.ndarray) -> None:
    path, critical = chosen["path"].values, chosen["critical_friction"].values[0]
    axis.contour(
        path, chosen["friction"], chosen["gamma"][0].T, levels=levels, colors="black", linewidths=0.3, alpha=0.6
    )
    axis.plot(path, critical, color=PALETTE["black"], linewidth=1.8, label="$\\mu_c$, where $\\gamma = 0$")
    for own in np.unique(chosen["own_friction"].values, axis=0):
        axis.plot(path, own, color=PALETTE["blue"], linestyle="--", linewidth=0.9, label="$\\mu$ of the scene")
    reached = path[np.isfinite(chosen["own_friction"].values[0])]
    axis.set_xlim(reached.min(), reached.max())
    axis.set_ylim(0.0, float(chosen["friction"].max()))


def _draw_states(axis: Axes, chosen: xr.Dataset) -> None:
    """A mark for each state; states in one place have one mark, and a name each."""
    places = list(zip(chosen["state_path"].values.tolist(), chosen["state_friction"].values.tolist(), strict=True))
    branches = labels_of(chosen["theorem_branch"])
    for place in dict.fromkeys(places):
        here = [i for i, other in enumerate(places) if other == place]
        mark = THEOREM_MARKS[branches[here[0]]]
        axis.plot(
            *place,
            marker=mark.marker,
            color=mark.colour,
            markersize=7,
            markeredgecolor="black",
            linestyle="none",
            label=mark.label,
            zorder=4,
        )
        left = place[0] - axis.get_xlim()[0] > 0.45 * np.ptp(axis.get_xlim())  # names stay within the panel
        axis.annotate(
            ",\n".join(spoken(chosen["state"].values[i]) for i in here),
            place,
            textcoords="offset points",
            xytext=(-6 if left else 6, 5),
            horizontalalignment="right" if left else "left",
            fontsize=7.5,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
            zorder=5,
        )
