"""The picture of a map of friction: mu_c by the sense of the slip, and where gamma < 0 at the scene's friction."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.plotting.style import GREY, PALETTE, with_unit

__all__ = ["draw_friction_map"]

TITLES = {"plus": "slip $v_t > 0$", "minus": "slip $v_t < 0$"}
YES = 2  # the code of that answer
GREATEST = 5.0  # mu_c that is told apart by colour


def draw_friction_map(dataset: xr.Dataset) -> Figure:
    """A panel for each sense of the slip that has a critical friction anywhere (in space they are one)."""
    senses = dataset.attrs.get("drawn_senses", "plus minus").split()
    if int(dataset.attrs["friction_dimension"]) > 1:
        senses = senses[:1]
    axes = dataset["admitted"].dims
    if len(axes) == 1:
        return _curves(dataset, senses, str(axes[0]))
    figure = Figure(figsize=(3.4 * len(senses) + 0.6, 3.1), layout="constrained")
    panels = figure.subplots(1, len(senses), squeeze=False)[0]
    images = [_panel(panel, dataset, sense) for panel, sense in zip(panels, senses, strict=True)]
    if int(dataset.attrs["friction_dimension"]) == 1:
        for panel, sense in zip(panels, senses, strict=True):
            panel.set_title(TITLES[sense])
    bar = figure.colorbar(images[0], ax=list(panels), extend="max")
    bar.set_label(r"critical friction $\mu_c$")
    grey = "grey: no friction is critical"
    if (dataset["admitted"].values != YES).any():
        grey += ", or (beyond the dotted line) another part is below the plane"
    figure.suptitle(f"{dataset.attrs['scene']}; hatched: γ < 0 at the scene's friction; {grey}", fontsize=8.0)
    return figure


def _panel(panel: Axes, dataset: xr.Dataset, sense: str) -> Any:
    across, up = (str(d) for d in dataset["admitted"].dims)
    x, y = dataset[across].values, dataset[up].values
    critical = dataset[f"critical_friction_{sense}"].values.T
    shown = np.ma.masked_invalid(np.where(np.isinf(critical), np.nan, critical))
    panel.set_facecolor("#F2F2F2")  # where no friction is critical, or no configuration is admitted
    image = panel.pcolormesh(x, y, shown, cmap="cividis", vmin=0.0, vmax=GREATEST, rasterized=True, shading="nearest")
    negative = dataset[f"gamma_negative_{sense}"].values.T == YES
    if negative.any():
        panel.contourf(x, y, negative, levels=[0.5, 1.5], colors="none", hatches=["////"])
        panel.contour(x, y, negative, levels=[0.5], colors="white", linewidths=1.2)
        panel.contour(x, y, negative, levels=[0.5], colors=PALETTE["vermilion"], linewidths=0.7)
    admitted = dataset["admitted"].values.T == YES
    if not admitted.all():
        panel.contour(x, y, admitted, levels=[0.5], colors=GREY, linewidths=0.6, linestyles=":")
    if shown.count():
        j, i = np.unravel_index(int(np.ma.argmin(shown)), shown.shape)
        panel.plot(
            x[i],
            y[j],
            marker="*",
            color="white",
            markeredgecolor="black",
            markersize=9,
            linestyle="none",
            clip_on=False,
        )
        panel.annotate(
            rf"least on the grid, $\mu_c$ = {shown[j, i]:.4g}",
            (x[i], y[j]),
            xytext=(0.03, 0.03),
            textcoords="axes fraction",
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.5},
        )
    panel.set_xlabel(_label(dataset, across))
    panel.set_ylabel(_label(dataset, up))
    return image


def _curves(dataset: xr.Dataset, senses: list[str], axis: str) -> Figure:
    figure = Figure(figsize=(4.6, 3.0), layout="constrained")
    panel = figure.subplots()
    colours = {"plus": PALETTE["blue"], "minus": PALETTE["vermilion"]}
    for sense, style in zip(senses, ("-", "--"), strict=False):
        values = dataset[f"critical_friction_{sense}"].values
        panel.plot(
            dataset[axis].values,
            np.where(np.isinf(values), np.nan, values),
            style,
            color=colours[sense],
            label=TITLES[sense],
        )
    panel.set_ylim(0.0, GREATEST)
    panel.set_xlabel(_label(dataset, axis))
    panel.set_ylabel(r"critical friction $\mu_c$")
    panel.set_title(dataset.attrs["scene"])
    panel.legend()
    return figure


def _label(dataset: xr.Dataset, name: str) -> str:
    return with_unit(name, dataset[name])
