"""Where methods fail: sampled bounds at a hard state, rounding near it, and both sides of a critical value."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.plotting.draw import Drawing
from painleve.plotting.style import PALETTE, THEOREM_MARKS, labels_of, legend_below, panels, spoken, with_unit

__all__ = ["DRAWINGS", "draw_near_critical", "draw_rounding", "draw_sampled_bound"]

RADIUS = "radius $\\varepsilon$ of the balls"
COLOURS = (PALETTE["sky"], PALETTE["orange"], PALETTE["blue"], PALETTE["purple"])
LINES = ("-", "--", "-.", ":")
SLIPS = ("slip_plus", "slip_minus")
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
        bound, slips = dataset["sampled_upper"].values[i], dataset["slips"].values[i].astype(float)
        colour, line = COLOURS[i % len(COLOURS)], LINES[i % len(LINES)]
        left.plot(eps, bound, marker="v", color=colour, linestyle=line, label=f"upper bound, {_power(n)} samples")
        right.plot(eps, np.where(slips > 0.0, slips, np.nan), marker="o", color=colour, linestyle=line)
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
    left.set_ylabel(with_unit("$e(A, A_\\varepsilon)$", dataset["sampled_upper"]))
    right.set_ylabel("samples that slip (lines end at none)")
    legend_below(figure, [left], columns=2)
    return figure


def draw_rounding(dataset: xr.Dataset) -> Figure:
    """Relative errors of plain doubles, what they turn wrong, and the slips that they invent."""
    figure, axes = panels(3, columns=3, height=2.9)
    for axis in axes:
        _logarithmic(axis, dataset, labelled=False)
    axes[1].set_xlabel(with_unit(RADIUS, dataset["eps"]))
    _draw_errors(axes[0], dataset)
    _draw_wrong(axes[1], dataset)
    _draw_slips(axes[2], dataset)
    legend_below(figure, axes, columns=2)
    return figure


def _draw_errors(axis: Axes, dataset: xr.Dataset) -> None:
    eps, quantity = dataset["eps"].values, list(dataset["quantity"].values)
    median = dataset["plain_error_median"].transpose("quantity", "eps").values
    lines = (
        (median[quantity.index("gamma")], PALETTE["blue"], "o", "plain: $\\gamma$, median"),
        (median[quantity.index("distance")], PALETTE["orange"], "s", "plain: dist$(S, A)$, median"),
        (dataset["plain_error_farthest"].values, PALETTE["vermilion"], "D", "plain: dist$(S, A)$, farthest member"),
        (dataset["kept_error_farthest"].values, PALETTE["green"], "^", "cancellation-free: dist$(S, A)$, farthest"),
    )
    for values, colour, marker, label in lines:
        axis.plot(eps, np.clip(values, SMALLEST, LARGEST), color=colour, marker=marker, label=label)
    axis.set_ylim(SMALLEST, LARGEST * 3.0)
    axis.set_ylabel("relative error")


def _draw_wrong(axis: Axes, dataset: xr.Dataset) -> None:
    eps = dataset["eps"].values
    axis.set_yscale("linear")
    axis.plot(
        eps, dataset["wrong_sign"], color=PALETTE["blue"], marker="v", label="plain: share of wrong signs of $\\gamma$"
    )
    axis.plot(
        eps,
        dataset["witness_error"],
        color=PALETTE["purple"],
        marker="P",
        label="plain: error of $S$ at witnesses, in lengths of $A$",
    )
    axis.set_ylim(-0.03, 1.05)
    axis.set_ylabel("share; lengths of $A$")


def _draw_slips(axis: Axes, dataset: xr.Dataset) -> None:
    eps, names = dataset["eps"].values, list(dataset["law_branch"].values)
    slips = [names.index(name) for name in SLIPS]
    total = int(np.maximum(dataset["counts"].values, 0)[0, 0].sum())
    styles = {"plain": (PALETTE["vermilion"], "D", "white", 7.0), "taylor": (PALETTE["green"], "^", None, 4.0)}
    for i, arithmetic in enumerate(dataset["arithmetic"].values):
        counts = dataset["counts"].transpose("arithmetic", "eps", "law_branch").values[i][:, slips].sum(axis=1)
        colour, marker, fill, size = styles[str(arithmetic)]
        name, line = ("plain", "-") if arithmetic == "plain" else ("cancellation-free", "--")
        axis.plot(
            eps,
            np.where(counts > 0, counts, np.nan),
            color=colour,
            marker=marker,
            markersize=size,
            markerfacecolor=fill or colour,
            linestyle=line,
            label=f"{name}: samples that slip",
        )
    axis.set_ylabel(f"samples that slip, of {_power(total)}")


def draw_near_critical(dataset: xr.Dataset) -> Figure:
    """d_H as read, max of the lower bound on e(A_eps, A) and the upper bound on e(A, A_eps), by side and gap."""
    figure, axes = panels(dataset.sizes["case"], columns=2, height=3.3)
    for i, axis in enumerate(axes):
        one = dataset.isel(case=i)
        _logarithmic(axis, dataset)
        axis.set_title(_title(one))
        exponents = sorted({_exponent(gap) for gap in one["gap"].values})
        for j, gap in enumerate(one["gap"].values):
            place = exponents.index(_exponent(gap))
            _draw_side(axis, one.isel(value=j), COLOURS[place], LINES[place])
        axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=2)
    figure.supylabel(with_unit("$d_H(A, A_\\varepsilon)$ as read", dataset["excess_Aeps_A_lower"]), fontsize=8)
    forward, backward = "$e(A_\\varepsilon, A)$", "$e(A, A_\\varepsilon)$"
    figure.suptitle(
        f"▲ the lower bound on {forward} decides, ▼ the upper bound on {backward}; filled above the\n"
        f"critical value, hollow below; black dot: {backward} is bounded from below too",
        fontsize=7.5,
    )
    return figure


def _title(one: xr.Dataset) -> str:
    """What is varied, and what holds on each side."""
    labels, above = labels_of(one["theorem_branch"]), one["gap"].values > 0.0
    sides = [THEOREM_MARKS[str(labels[chosen][0])].label for chosen in (~above, above)]
    return f"{spoken(one['parameter'].item())}\nbelow: {sides[0]}; above: {sides[1]}"


def _exponent(gap: float) -> int:
    return round(np.log10(abs(gap)))


def _draw_side(axis: Axes, one: xr.Dataset, colour: str, line: str) -> None:
    """Upward marks where the lower bound on e(A_eps, A) decides, downward ones where the upper bound on e(A, A_eps)."""
    eps, lower, upper = (one[name].values for name in ("eps", "excess_Aeps_A_lower", "excess_A_Aeps_upper"))
    value, forward = np.fmax(lower, upper), ~(upper > lower)
    gap = one["gap"].item()
    label = f"{'above' if gap > 0 else 'below'} by $10^{{{_exponent(gap)}}}$, relative"
    fill = colour if gap > 0 else "white"
    axis.plot(eps, value, color=colour, linestyle=line, linewidth=0.8, zorder=1)
    for chosen, marker in ((forward, "^"), (~forward, "v")):
        axis.plot(eps[chosen], value[chosen], linestyle="none", marker=marker, color=colour, markerfacecolor=fill)
    enclosed = one["excess_A_Aeps_lower"].values > ENCLOSED * value
    axis.plot(eps[enclosed], value[enclosed], linestyle="none", marker=".", color="black", markersize=2.5, zorder=4)
    axis.plot([], [], color=colour, linestyle=line, marker="^", markerfacecolor=fill, label=label)


def _logarithmic(axis: Axes, dataset: xr.Dataset, *, labelled: bool = True) -> None:
    axis.set_xscale("log")
    axis.set_yscale("log")
    if labelled:
        axis.set_xlabel(with_unit(RADIUS, dataset["eps"]))
    axis.grid(True, which="major", linewidth=0.3, alpha=0.5)


def _power(n: float) -> str:
    exponent = round(np.log10(n))
    return f"$10^{{{exponent}}}$" if n == 10**exponent else f"{n:g}"


DRAWINGS: Mapping[str, Drawing] = MappingProxyType(
    {"sampled_bound": draw_sampled_bound, "rounding": draw_rounding, "near_critical": draw_near_critical}
)
