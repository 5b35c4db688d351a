"""Distances between A and A_eps: lower bounds point up, upper bounds point down."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from painleve.errors import InputError
from painleve.plotting.style import (
    GREY,
    PALETTE,
    THEOREM_MARKS,
    entitle,
    label_outside,
    legend_below,
    panels,
    spoken,
    with_unit,
)
from painleve.store import labels_of

__all__ = ["draw_distances"]


@dataclass(frozen=True, kw_only=True)
class _Series:
    variable: str
    marker: str
    colour: str
    filled: bool
    label: str
    size: float = 4.0


METHOD = "METHOD"  # in a label: the place of the method's name
TO_LIMIT = _Series(
    variable="excess_Aeps_A_lower",
    marker="^",
    colour=PALETTE["blue"],
    filled=True,
    label="$e(A_\\varepsilon, A)$, lower bound (METHOD)",
)
TO_ENDS = _Series(
    variable="ends_excess_Aeps_A_lower",
    marker="^",
    colour=PALETTE["sky"],
    filled=False,
    size=7.0,
    label="$e(A_\\varepsilon, \\{u^-, \\tilde u\\})$, lower bound (METHOD)",
)
FROM_LIMIT = _Series(
    variable="excess_A_Aeps_upper",
    marker="v",
    colour=PALETTE["vermilion"],
    filled=True,
    label="$e(A, A_\\varepsilon)$, upper bound (METHOD)",
)
WITNESSED = _Series(
    variable="witnessed_upper",
    marker="v",
    colour=PALETTE["green"],
    filled=False,
    label="$e(A, A_\\varepsilon)$, upper bound (witnesses)",
)
FROM_ENDS = _Series(
    variable="ends_excess_A_Aeps_upper",
    marker="v",
    colour=PALETTE["purple"],
    filled=False,
    label="$e(\\{u^-, \\tilde u\\}, A_\\varepsilon)$, upper bound (METHOD)",
)
UPPER = _Series(
    variable="excess_Aeps_A_upper",
    marker="v",
    colour=PALETTE["blue"],
    filled=False,
    label="$e(A_\\varepsilon, A)$, upper bound (METHOD)",
)
LOWER = _Series(
    variable="excess_A_Aeps_lower",
    marker="^",
    colour=PALETTE["vermilion"],
    filled=False,
    label="$e(A, A_\\varepsilon)$, lower bound (METHOD)",
)
# Ball arithmetic gives bounds such as 1e-93 where the truth is 0; drawn to scale, one of them would flatten the rest.
FOOT = 1e-20
STRIP = 0.09  # of a panel's height: where marks stand that have no place on its axis
FIXED = {"state", "eps", "law_branch", "coordinate"}


def draw_distances(dataset: xr.Dataset) -> Figure:
    """Panels by state; along the axis runs eps, or the swept quantity if there is one, then a panel for each eps.

    Raises InputError for more than one swept quantity, and for more panels than can be read.
    """
    swept = [str(dim) for dim in dataset.dims if dim not in FIXED]
    if len(swept) > 1:
        raise InputError(f"figure: {', '.join(swept)} are swept; select values of all but one and draw again")
    x = swept[0] if swept else "eps"
    cases = list(_cases(dataset, x))
    columns = 3 if len(cases) > 4 else 2
    figure, axes = panels(len(cases), columns=columns, height=2.2, shared=True)
    for axis, (title, case) in zip(axes, cases, strict=True):
        axis.set_title(title)
        _draw_panel(axis, case, x)
    _open_strips(axes)
    words = "radius $\\varepsilon$" if x == "eps" else dataset[x].attrs["long_name"].removesuffix(" (swept)")
    label_outside(axes, columns, with_unit(words, dataset[x]), with_unit("distance", dataset["half_jump"]))
    entitle(figure, dataset)
    legend_below(figure, axes, columns=3)
    return figure


def _cases(dataset: xr.Dataset, x: str) -> Iterator[tuple[str, xr.Dataset]]:
    """Title and one-dimensional dataset of each panel."""
    for i, state in enumerate(dataset["state"].values):
        one = dataset.isel(state=i)
        if x == "eps":
            slope = one["slope"].item()
            rate = "" if np.isnan(slope) else f"; slope {slope:.2f}"
            yield f"{spoken(state)}\n{_branch(one)}{rate}", one
        else:
            for j, eps in enumerate(dataset["eps"].values):
                yield f"{spoken(state)}, $\\varepsilon$ = {eps:g}", one.isel(eps=j)


def _branch(one: xr.Dataset) -> str:
    label = labels_of(one["theorem_branch"]).item()
    return THEOREM_MARKS[label].label if label in THEOREM_MARKS else spoken(label)


def _draw_panel(axis: Axes, case: xr.Dataset, x: str) -> None:
    values, isolated = case[x].values, np.atleast_1d(labels_of(case["theorem_branch"])) == "critical_isolated"
    axis.set_yscale("log")
    if x == "eps":
        axis.set_xscale("log")
        axis.plot(values, case["fit"], color=GREY, linestyle="--", linewidth=0.7, label="power law of the slope above")
    if isolated.any():
        half = np.broadcast_to(np.where(isolated, case["half_jump"], np.nan), values.shape)
        axis.plot(values, half, color=PALETTE["black"], linestyle=":", label="$\\frac{1}{2}\\|\\tilde u - u^-\\|$")
    for series in (TO_LIMIT, UPPER, LOWER, FROM_LIMIT, WITNESSED, *((TO_ENDS, FROM_ENDS) if isolated.any() else ())):
        label = series.label.replace(METHOD, str(case.attrs["method"]))
        _draw_series(axis, values, case[series.variable].values, series, label)
    foot = case["witnessed_upper"].values < FOOT
    failed = np.broadcast_to(labels_of(case["outcome"]) == "failed", values.shape)
    _draw_strip(axis, values, foot, "v", WITNESSED.colour, "grey band: $e(A, A_\\varepsilon) < 10^{-20}$ (witnesses)")
    _draw_strip(axis, values, failed, "x", PALETTE["black"], "failed")


def _draw_strip(axis: Axes, x: np.ndarray, shown: np.ndarray, marker: str, colour: str, label: str) -> None:
    """What has no place on the axis, in the strip below it."""
    if shown.any():
        axis.plot(
            x[shown],
            np.full(shown.sum(), STRIP / 2.0),
            linestyle="none",
            marker=marker,
            color=colour,
            markersize=3.5,
            label=label,
            transform=axis.get_xaxis_transform(),
            zorder=3,
        )


def _open_strips(axes: list[Axes]) -> None:
    """A band at the foot of every panel that no datum reaches, told from the axis by its shade and without ticks."""
    if not any(line.get_transform() == axis.get_xaxis_transform() for axis in axes for line in axis.get_lines()):
        return
    bottom, top = axes[0].get_ylim()
    ticks = [tick for tick in axes[0].get_yticks() if bottom <= tick <= top]
    axes[0].set_ylim(bottom * (bottom / top) ** (STRIP / (1.0 - STRIP)), top)
    for axis in axes:
        band = Rectangle((0.0, 0.0), 1.0, STRIP, transform=axis.transAxes, color=GREY, alpha=0.18, linewidth=0.0)
        axis.add_patch(band)
        axis.set_yticks(ticks)


def _draw_series(axis: Axes, x: np.ndarray, y: np.ndarray, series: _Series, label: str) -> None:
    """Only what the axis can show; a series without any such value stays out of the legend."""
    shown = y >= FOOT
    if shown.any():
        axis.plot(
            x[shown],
            y[shown],
            linestyle="none",
            marker=series.marker,
            color=series.colour,
            label=label,
            markerfacecolor=series.colour if series.filled else "none",
            markeredgewidth=0.8,
            markersize=series.size,
        )
