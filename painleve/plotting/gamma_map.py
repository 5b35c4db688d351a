"""gamma over a path along the contact and the coefficient of friction, with mu_c and the states."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from painleve.plotting.style import PALETTE, THEOREM_MARKS, labels_of, legend_below, panels, spoken, with_unit

__all__ = ["draw_gamma_map"]

LEVELS = 11


def draw_gamma_map(dataset: xr.Dataset) -> Figure:
    """A panel for each curve mu_c; orange below zero, purple above, and lines that a grey print shows too."""
    groups = np.unique(dataset["panel"])
    figure, axes = panels(len(groups), columns=3, height=3.0)
    largest = float(np.nanquantile(np.abs(dataset["gamma"]), 0.98))
    norm = TwoSlopeNorm(0.0, -largest, largest)
    levels = np.linspace(-largest, largest, LEVELS)
    for axis, group in zip(axes, groups, strict=True):
        chosen = dataset.isel(state=np.flatnonzero(dataset["panel"] == group))
        filled = axis.contourf(
            chosen["path"],
            chosen["friction"],
            chosen["gamma"][0].T,
            levels=levels,
            cmap="PuOr",
            norm=norm,
            extend="both",
            alpha=0.75,
        )
        _draw_states(axis, chosen, levels)
        axis.set_xlabel(with_unit(dataset.attrs["path_symbol"], dataset["path"]))
    axes[0].set_ylabel("coefficient of friction $\\mu$")
    figure.colorbar(filled, ax=axes, label=with_unit("$\\gamma$", dataset["gamma"]), format="%.2g", pad=0.01)
    legend_below(figure, axes, columns=4)
    return figure


def _draw_states(axis: Axes, chosen: xr.Dataset, levels: np.ndarray) -> None:
    path, top = chosen["path"].values, float(chosen["friction"].max())
    critical = chosen["critical_friction"].values[0]
    axis.contour(
        path, chosen["friction"], chosen["gamma"][0].T, levels=levels, colors="black", linewidths=0.3, alpha=0.6
    )
    axis.plot(path, critical, color=PALETTE["black"], linewidth=1.8, label="$\\mu_c$, where $\\gamma = 0$")
    for own in np.unique(chosen["own_friction"].values, axis=0):
        axis.plot(path, own, color=PALETTE["blue"], linestyle="--", linewidth=0.9, label="$\\mu$ of the scene")
    for i, label in enumerate(labels_of(chosen["theorem_branch"])):
        mark, x, y = THEOREM_MARKS[label], chosen["state_path"].values[i], chosen["state_friction"].values[i]
        axis.plot(
            x,
            y,
            marker=mark.marker,
            color=mark.colour,
            markersize=7,
            markeredgecolor="black",
            linestyle="none",
            label=mark.label,
            zorder=4,
        )
        axis.annotate(
            spoken(chosen["state"].values[i]),
            (x, y),
            textcoords="offset points",
            xytext=(6, 5),
            fontsize=7.5,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
            zorder=5,
        )
    reached = path[np.isfinite(chosen["own_friction"].values[0])]
    axis.set_xlim(reached.min(), reached.max())
    axis.set_ylim(0.0, top)
