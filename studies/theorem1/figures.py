"""The whole theorem in one figure: both excesses over eps, a column for each branch."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.plotting.draw import Drawing
from painleve.plotting.style import GREY, PALETTE, THEOREM_MARKS, legend_below, panels
from painleve.store import labels_of

__all__ = ["DRAWINGS", "draw_theorem1"]

BRANCHES = ("none", "negative", "critical_approached", "critical_isolated")
LOWEST = 1e-13  # where witnesses are exact their bounds are zero, or would flatten the rest
# Lines of the plane are full and those of space dashed, so that a grey print tells them apart.
KINDS = (
    (lambda tangents: tangents < 2, PALETTE["blue"], "-", "a state in the plane"),
    (lambda tangents: tangents == 2, PALETTE["vermilion"], "--", "a state in space"),
)


def draw_theorem1(dataset: xr.Dataset) -> Figure:
    """Above e(A_eps, A), from the ends of A in the isolated branch; below the least known bound on e(A, A_eps)."""
    figure, axes = panels(2 * len(BRANCHES), columns=len(BRANCHES), height=2.1)
    above, below = axes[: len(BRANCHES)], axes[len(BRANCHES) :]
    branches = labels_of(dataset["theorem_branch"])
    for upper, lower, branch in zip(above, below, BRANCHES, strict=True):
        chosen = dataset.isel(case=np.flatnonzero(branches == branch))
        upper.set_title(f"{THEOREM_MARKS[branch].label}\n{chosen.sizes['case']} states")
        _draw_lines(upper, chosen, "to_limit")
        _draw_lines(lower, chosen, "of_limit")
        _draw_guides(upper, dataset)
        if branch == "critical_isolated":
            _draw_halves(lower, chosen)
            upper.annotate("from the ends of $A$", (0.04, 0.93), xycoords="axes fraction", fontsize=7.0)
        upper.tick_params(labelbottom=False)
        lower.set_xlabel("radius $\\varepsilon$")
    above[0].set_ylabel("$e(A_\\varepsilon, A)$,\nlower bounds")
    below[0].set_ylabel("$e(A, A_\\varepsilon)$,\nupper bounds")
    for axis in axes:
        axis.set_xlim(below[-1].get_xlim())
    _share(above, float(dataset["to_limit"].max()), 0.03 * float(dataset["eps"].min()))
    _share(below, float(dataset["of_limit"].max()), LOWEST)
    figure.suptitle(
        f"Theorem 1 at {dataset.sizes['case']} states of {len(dataset.attrs['scene'].split(', '))} scenes; "
        "distances in the units of each scene",
        fontsize=8.5,
    )
    legend_below(figure, axes, columns=4)
    return figure


def _share(axes: list[Axes], top: float, bottom: float) -> None:
    """One range for a row of panels."""
    for axis in axes:
        axis.set_ylim(bottom, 5.0 * top)
        axis.tick_params(labelleft=axis is axes[0])


def _draw_lines(axis: Axes, chosen: xr.Dataset, name: str) -> None:
    axis.set_xscale("log")
    axis.set_yscale("log")
    for belongs, colour, style, label in KINDS:
        for one in chosen[name].values[belongs(chosen["tangents"].values)]:
            shown = np.where(one > LOWEST, one, np.nan)
            axis.plot(chosen["eps"], shown, color=colour, linestyle=style, linewidth=0.8, alpha=0.7, label=label)
    below = int((chosen[name].values <= LOWEST).all(axis=1).sum())
    if below:
        said = f"at most $10^{{{round(np.log10(LOWEST))}}}$ at {below} states"
        axis.annotate(said, (0.04, 0.04), xycoords="axes fraction", fontsize=7.0)


def _draw_guides(axis: Axes, dataset: xr.Dataset) -> None:
    """The slopes that occur, through one point below the data."""
    eps = dataset["eps"].values
    for power, style, label in ((1.0, ":", "slope 1"), (0.5, "-.", "slope 1/2")):
        guide = 0.1 * eps.min() * (eps / eps.min()) ** power
        axis.plot(eps, guide, color=GREY, linestyle=style, linewidth=1.0, label=label)


def _draw_halves(axis: Axes, chosen: xr.Dataset) -> None:
    for half in np.unique(chosen["half_jump"].values):
        label = "$\\frac{1}{2}\\|\\tilde u - u^-\\|$ of a state"
        axis.axhline(half, color=PALETTE["black"], linestyle=(0, (1, 2)), linewidth=0.9, label=label)


DRAWINGS: Mapping[str, Drawing] = MappingProxyType({"theorem1": draw_theorem1})
