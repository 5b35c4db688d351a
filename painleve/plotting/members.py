"""A and sampled members of A_eps in the space of velocities."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.plotting.style import GREY, LAW_MARKS, PALETTE, entitle, legend_below, panels, spoken, symbol
from painleve.store import labels_of

__all__ = ["draw_members"]

RARE = 0.02  # share of the sample below which marks are drawn larger
ONE_POINT = 1e-9  # extent, in units of velocity, below which a cloud would be drawn as one small mark


def draw_members(dataset: xr.Dataset) -> Figure:
    """A row for each state, a column for each eps; offsets from u-, projected on the plane of two unit vectors.

    The first vector stands over the first column of its row, the second over the last.
    """
    count = dataset.sizes["eps"]
    figure, axes = panels(dataset.sizes["state"] * count, columns=count, height=1.75)
    for k, axis in enumerate(axes):
        one = dataset.isel(state=k // count, eps=k % count)
        first, last = k % count == 0, k % count == count - 1
        eps = f"$\\varepsilon$ = {one['eps'].item():g}"
        vectors = [f"$e_1$ = {_vector(one['axis_along'])}"] * first + [f"$e_2$ = {_vector(one['axis_across'])}"] * last
        axis.set_title(f"{spoken(one['state'].item())}, {eps}" if first else eps, loc="left")
        axis.set_title(", ".join(vectors), loc="right", fontsize=7.0)
        _draw_panel(axis, one)
        axis.locator_params(nbins=6)
        axis.margins(0.08)
        axis.set_xlabel("along $e_1$")
        if first:
            axis.set_ylabel("along $e_2$")
    unit, names = dataset["along"].attrs["units"], ", ".join(symbol(str(name)) for name in dataset["coordinate"].values)
    entitle(figure, dataset, f"components of $v - u^-$ ({unit}) along unit vectors in ({names})")
    legend_below(figure, axes, columns=4)
    return figure


def _draw_panel(axis: Axes, one: xr.Dataset) -> None:
    length, kind = one["jump_length"].item(), labels_of(one["limit_set"]).item()
    if kind == "segment":
        axis.plot(
            [0.0, length],
            [0.0, 0.0],
            color=GREY,
            linewidth=5.0,
            alpha=0.35,
            solid_capstyle="butt",
            label="$A = [u^-, \\tilde u]$",
            zorder=1,
        )
    branches = labels_of(one["law_branch"])
    for name, mark in LAW_MARKS.items():
        chosen = branches == name
        if chosen.any():
            x, y = one["along"].values[chosen], one["across"].values[chosen]
            axis.scatter(
                x,
                y,
                s=_size(x, y, branches.size),
                c=mark.colour,
                marker=mark.marker,
                linewidths=0.0,
                zorder=2,
                rasterized=True,
            )
            axis.plot([], [], linestyle="none", marker=mark.marker, color=mark.colour, label=mark.label)
    if np.isfinite(one["witness_along"]).all() and kind == "segment":
        axis.plot(
            one["witness_along"],
            one["witness_across"],
            color=PALETTE["black"],
            linestyle=(0, (2, 2)),
            linewidth=0.9,
            label="witnesses over one $q_\\varepsilon$",
            zorder=3,
        )
    _draw_end(axis, 0.0, "+", "$u^-$")
    if kind != "point":
        _draw_end(axis, length, "x", "$\\tilde u$")


def _size(x: np.ndarray, y: np.ndarray, of: int) -> float:
    """A handful of slips among thousands of others, or thousands of members in one point, must not be overlooked."""
    if x.size <= RARE * of:
        return 12.0
    return 60.0 if max(np.ptp(x), np.ptp(y)) < ONE_POINT else 3.0


def _draw_end(axis: Axes, x: float, marker: str, label: str) -> None:
    axis.plot(
        x,
        0.0,
        marker=marker,
        color=PALETTE["black"],
        markersize=7,
        markeredgewidth=1.4,
        linestyle="none",
        label=label,
        zorder=4,
    )


def _vector(axis: xr.DataArray) -> str:
    return "(" + ", ".join("0" if abs(x) < 5e-3 else f"{x:.2f}".replace("-", "−") for x in axis.values) + ")"
