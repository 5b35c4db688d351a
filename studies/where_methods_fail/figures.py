"""Where methods fail: sampled bounds at a hard state, rounding near it, and both sides of a critical value."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from painleve.plotting.draw import Drawing
from painleve.plotting.style import (
    GREY,
    PALETTE,
    THEOREM_MARKS,
    entitle,
    legend_below,
    legend_under,
    panels,
    power_of_ten,
    spoken,
    symbol,
    with_unit,
)
from painleve.store import labels_of

__all__ = ["DRAWINGS", "draw_near_critical", "draw_rounding", "draw_sampled_bound"]

RADIUS = "radius $\\varepsilon$"
COLOURS = (PALETTE["sky"], PALETTE["orange"], PALETTE["blue"], PALETTE["purple"])
LINES = ("-", "--", "-.", ":")
SIZES = (7.5, 5.0, 2.8)  # of marks in one place: all of them are seen
ENCLOSED = 0.999  # of what is read: there e(A, A_eps) is bounded from below too
SMALLEST, LARGEST = 1e-17, 1e2  # relative errors that are shown; an error of 100 or of 1e17 says the same


def draw_sampled_bound(dataset: xr.Dataset) -> Figure:
    """Upper bounds on e(A, A_eps) from samples and from witnesses, and how many samples slip."""
    figure, (left, right) = panels(2, columns=2, height=2.9)
    eps = dataset["eps"].values
    left.axhline(
        dataset["half_jump"].item(),
        color=PALETTE["black"],
        linestyle=":",
        linewidth=0.9,
        label="$\\frac{1}{2}\\|\\tilde u - u^-\\|$: as if no member ever slipped",
    )
    for i, n in enumerate(dataset["samples"].values):
        colour, line = COLOURS[i % len(COLOURS)], LINES[i % len(LINES)]
        style: dict[str, Any] = {"marker": "v", "color": colour, "linestyle": line, "markersize": SIZES[i % len(SIZES)]}
        label = f"upper bound, {power_of_ten(n)} samples"
        left.plot(eps, dataset["sampled_upper"].values[i], markerfacecolor="none", label=label, **style)
        right.plot(eps, dataset["slips"].values[i], markerfacecolor="none", **style)
    left.plot(
        eps,
        dataset["witnessed_upper"],
        color=PALETTE["green"],
        marker="v",
        markerfacecolor="white",
        label="upper bound, witnesses; the truth is 0",
    )
    for axis in (left, right):
        _logarithmic(axis, dataset)
    right.set_xlim(left.get_xlim())
    _count(right)
    left.set_ylabel(with_unit("$e(A, A_\\varepsilon)$", dataset["sampled_upper"]))
    right.set_ylabel("samples that slip")
    legend_below(figure, [left], columns=2)
    entitle(figure, dataset, _state(dataset))
    return figure


def _state(dataset: xr.Dataset) -> str:
    return f"state {spoken(dataset.attrs['state'])}"


def draw_rounding(dataset: xr.Dataset) -> Figure:
    """Relative errors of plain doubles, the signs and the places that they turn wrong, and the slips they invent."""
    figure, axes = panels(4, columns=2, height=2.5)
    drawings = (_draw_errors, _draw_signs, _draw_places, _draw_slips)
    for axis, letter, drawing in zip(axes, "abcd", drawings, strict=True):
        _logarithmic(axis, dataset, labelled=axis in axes[2:])
        drawing(axis, dataset)
        axis.set_title(f"({letter}) {axis.get_title()}", loc="left")
        axis.set_title("")
    entitle(figure, dataset, f"{_state(dataset)}; plain: doubles that know nothing of the base state")
    legend_below(figure, axes, columns=2)
    return figure


def _draw_errors(axis: Axes, dataset: xr.Dataset) -> None:
    eps, quantity = dataset["eps"].values, list(dataset["quantity"].values)
    median = dataset["plain_error_median"].transpose("quantity", "eps").values
    plain, kept = (dataset[f"{name}_error_farthest"].values for name in ("plain", "kept"))
    lines = (
        (median[quantity.index("gamma")], PALETTE["blue"], "o", "-", "plain: $\\gamma$, median"),
        (median[quantity.index("distance")], PALETTE["orange"], "s", "--", "plain: dist$(S, A)$, median"),
        (plain, PALETTE["vermilion"], "D", "-.", "plain: dist$(S, A)$, farthest member"),
        (kept, PALETTE["green"], "^", "-", "cancellation-free: dist$(S, A)$, farthest"),
    )
    for values, colour, marker, line, label in lines:
        axis.plot(eps, np.clip(values, SMALLEST, LARGEST), color=colour, marker=marker, linestyle=line, label=label)
    axis.set_ylim(SMALLEST, LARGEST * 3.0)
    axis.set_title("errors of one evaluation")
    axis.set_ylabel("relative error")


def _draw_signs(axis: Axes, dataset: xr.Dataset) -> None:
    axis.set_yscale("linear")
    axis.plot(
        dataset["eps"],
        dataset["wrong_sign"],
        color=PALETTE["blue"],
        marker="o",
        markerfacecolor="none",
        label="plain: $\\gamma$",
    )
    axis.set_ylim(-0.03, 1.05)
    axis.set_title("signs of $\\gamma$ that are wrong")
    axis.set_ylabel("share of the states tried")


def _draw_places(axis: Axes, dataset: xr.Dataset) -> None:
    axis.set_yscale("linear")
    axis.plot(
        dataset["eps"],
        dataset["witness_error"],
        color=PALETTE["purple"],
        marker="P",
        label="plain: $S$ at witnesses, the largest",
    )
    axis.set_ylim(-0.03, 1.05)
    axis.set_title("members that slip, and miss their place")
    axis.set_ylabel("error of $S$ / length of $A$")


def _draw_slips(axis: Axes, dataset: xr.Dataset) -> None:
    styles = {"plain": (PALETTE["vermilion"], "D", 7.0, "-"), "taylor": (PALETTE["green"], "^", 4.0, "--")}
    for arithmetic in dataset["arithmetic"].values:
        colour, marker, size, line = styles[str(arithmetic)]
        axis.plot(
            dataset["eps"],
            dataset["slips"].sel(arithmetic=arithmetic),
            color=colour,
            marker=marker,
            markersize=size,
            markerfacecolor="none",
            linestyle=line,
            label=f"{'plain' if arithmetic == 'plain' else 'cancellation-free'}: samples that slip",
        )
    _count(axis)
    axis.set_title(f"samples that slip, of {power_of_ten(float(dataset['samples'].max()))}")
    axis.set_ylabel("number of samples")


def _count(axis: Axes) -> None:
    """A logarithmic axis that has a place for none."""
    axis.set_yscale("symlog", linthresh=1.0)
    axis.set_ylim(bottom=-0.2)


def draw_near_critical(dataset: xr.Dataset) -> Figure:
    """d_H as read, max of the lower bound on e(A_eps, A) and the upper bound on e(A, A_eps), by side and gap."""
    figure, axes = panels(dataset.sizes["case"], columns=2, height=3.6)
    for i, axis in enumerate(axes):
        one = dataset.isel(case=i)
        _logarithmic(axis, dataset)
        axis.set_title(_title(one))
        exponents = sorted({_exponent(gap) for gap in one["gap"].values})
        for j, gap in enumerate(one["gap"].values):
            place = exponents.index(_exponent(gap))
            _draw_side(axis, one.isel(value=j), COLOURS[place], LINES[place], SIZES[place])
        legend_under(axis, columns=2)
    axes[0].set_ylabel(with_unit("$d_H(A, A_\\varepsilon)$ as read", dataset["distance_as_read"]))
    figure.legend(handles=_meanings(), loc="outside lower center", ncols=2)
    return figure


def _meanings() -> list[Line2D]:
    """What shapes, fills and dots of all panels mean."""
    forward, backward = "$e(A_\\varepsilon, A)$", "$e(A, A_\\varepsilon)$"
    words = (
        ("^", "none", f"the lower bound on {forward} is the larger one"),
        ("v", "none", f"the upper bound on {backward} is the larger one"),
        ("s", GREY, "filled: above the critical value, else below"),
        (".", "black", f"{backward} is bounded from below too, nearly as high"),
    )
    return [
        Line2D([], [], linestyle="none", marker=marker, color="black", markerfacecolor=face, markersize=5.0, label=said)
        for marker, face, said in words
    ]


def _title(one: xr.Dataset) -> str:
    """What is varied, and what holds on each side."""
    labels, above = labels_of(one["theorem_branch"]), one["gap"].values > 0.0
    sides = [THEOREM_MARKS[str(labels[chosen][0])].label for chosen in (~above, above)]
    scene, _, varied = str(one["parameter"].item()).partition(": ")
    name, _, value = varied.partition(" near ")
    return f"{spoken(scene)}: {symbol(name)} near {value}\nbelow: {sides[0]}; above: {sides[1]}"


def _exponent(gap: float) -> int:
    return round(np.log10(abs(gap)))


def _draw_side(axis: Axes, one: xr.Dataset, colour: str, line: str, size: float) -> None:
    """Upward marks where the lower bound on e(A_eps, A) decides, downward ones where the upper bound on e(A, A_eps)."""
    eps, value = one["eps"].values, one["distance_as_read"].values
    forward = ~(one["excess_A_Aeps_upper"].values > one["excess_Aeps_A_lower"].values)
    gap = one["gap"].item()
    label = f"{'above' if gap > 0 else 'below'} by $10^{{{_exponent(gap)}}}$, relative"
    fill = colour if gap > 0 else "none"
    axis.plot(eps, value, color=colour, linestyle=line, linewidth=0.8, zorder=1)
    style: dict[str, Any] = {"color": colour, "markerfacecolor": fill, "markersize": size}
    for chosen, marker in ((forward, "^"), (~forward, "v")):
        axis.plot(eps[chosen], value[chosen], linestyle="none", marker=marker, **style)
    enclosed = one["excess_A_Aeps_lower"].values > ENCLOSED * value
    axis.plot(eps[enclosed], value[enclosed], linestyle="none", marker=".", color="black", markersize=3.0, zorder=4)
    axis.plot([], [], linestyle=line, marker="^", label=label, **style)


def _logarithmic(axis: Axes, dataset: xr.Dataset, *, labelled: bool = True) -> None:
    axis.set_xscale("log")
    axis.set_yscale("log")
    if labelled:
        axis.set_xlabel(with_unit(RADIUS, dataset["eps"]))
    axis.grid(True, which="major", linewidth=0.3, alpha=0.5)


DRAWINGS: Mapping[str, Drawing] = MappingProxyType(
    {"sampled_bound": draw_sampled_bound, "rounding": draw_rounding, "near_critical": draw_near_critical}
)
