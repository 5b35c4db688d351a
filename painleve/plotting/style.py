"""One look for all figures: a palette that colour-blind readers and grey printers can tell apart, and labels."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from painleve.errors import InputError

__all__ = [
    "GREY",
    "LAW_MARKS",
    "PALETTE",
    "STYLE",
    "THEOREM_MARKS",
    "Mark",
    "entitle",
    "expressed",
    "label_outside",
    "legend_below",
    "legend_under",
    "lettered",
    "panels",
    "power_of_ten",
    "raised",
    "spoken",
    "symbol",
    "with_unit",
]

# M. Okabe and K. Ito, "Color Universal Design" (2008), and a violet that is darker than all of theirs.
PALETTE = MappingProxyType(
    {
        "black": "#000000",
        "orange": "#E69F00",
        "sky": "#56B4E9",
        "green": "#009E73",
        "yellow": "#F0E442",
        "blue": "#0072B2",
        "vermilion": "#D55E00",
        "purple": "#CC79A7",
        "violet": "#4B0092",
    }
)
GREY = "#777777"
# Any: matplotlib's own type of such a table is a list of all its keys.
STYLE: Any = MappingProxyType(
    {
        "font.size": 8.0,
        "axes.titlesize": 8.0,
        "axes.labelsize": 8.0,
        "legend.fontsize": 7.5,
        "xtick.labelsize": 7.0,
        "ytick.labelsize": 7.0,
        "axes.linewidth": 0.6,
        "lines.linewidth": 1.0,
        "lines.markersize": 4.0,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "figure.dpi": 110,
        "savefig.dpi": 300,
        "pdf.fonttype": 42,
        "mathtext.fontset": "dejavusans",
        "hatch.linewidth": 0.4,
    }
)
GREEK = {name: name for name in ("alpha", "beta", "gamma", "theta", "psi", "mu", "kappa", "xi", "eta", "omega")}
GREEK |= {"phi": "varphi"}
NAME = re.compile(r"(?P<letter>[A-Za-z]+)(?:_(?P<low>\w+)|(?P<number>[0-9]*))")
POWER = re.compile(r"\^(-?[0-9]+)")
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
MOST_PANELS = 24
UNDER = -0.22  # of the height of a panel: where its own legend begins
WIDTH = 7.0  # inches: two columns of a journal


@dataclass(frozen=True, kw_only=True)
class Mark:
    """Colour and marker together, so that either suffices; and what the legend says."""

    colour: str
    marker: str
    label: str


LAW_MARKS = MappingProxyType(
    {
        "free": Mark(colour=PALETTE["sky"], marker="o", label="free: S = v"),
        "stick": Mark(colour=PALETTE["orange"], marker="s", label="stick"),
        "slip_plus": Mark(colour=PALETTE["green"], marker="^", label="slip, friction +μ"),
        "slip_minus": Mark(colour=PALETTE["purple"], marker="v", label="slip, friction −μ"),
        "slip": Mark(colour=PALETTE["violet"], marker="p", label="slip"),
        "frictionless": Mark(colour=PALETTE["blue"], marker="D", label="impact without friction"),
    }
)
THEOREM_MARKS = MappingProxyType(
    {
        "none": Mark(colour=PALETTE["sky"], marker="o", label="nothing indeterminate"),
        "negative": Mark(colour=PALETTE["vermilion"], marker="s", label="γ < 0"),
        "critical_approached": Mark(colour=PALETTE["green"], marker="^", label="γ = 0, approached"),
        "critical_isolated": Mark(colour=PALETTE["yellow"], marker="D", label="γ = 0, isolated"),
        "undecided": Mark(colour=GREY, marker="X", label="undecided"),
    }
)


def spoken(label: object) -> str:
    """A label as words."""
    return str(label).replace("_", " ")


def lettered(text: str) -> str:
    """Values such as "alpha = 8, m2 = 1.06 kg, k = 2/rad^2" with names as formulas and powers raised."""
    return ", ".join(_lettered(part) for part in text.split(", ")) if text else ""


def _lettered(part: str) -> str:
    name, equals, value = part.partition(" = ")
    return f"{symbol(name)} = {raised(value)}" if equals else part


def symbol(name: str) -> str:
    """The name of a coordinate or a parameter as a formula, such as theta, m2 or beta_xx."""
    found = NAME.fullmatch(name)
    if not found:
        return name
    letter, index = found["letter"], found["low"] or found["number"]
    base = f"\\{GREEK[letter]}" if letter in GREEK else letter if len(letter) == 1 else f"\\mathrm{{{letter}}}"
    return f"${base}{f'_{{{index}}}' if index else ''}$"


def expressed(text: str) -> str:
    """The label of a state that is given by its keys, such as "theta=atan(2) mu=4/3", as it is written by hand."""
    words = (word.partition("=") for word in text.split())
    return ", ".join(f"{symbol(n)} = {_written(value)}" if equals else spoken(n) for n, equals, value in words)


def _written(value: str) -> str:
    for code, sign in (("*pi", "π"), ("pi", "π"), ("atan(", "arctan("), ("sqrt(", "√("), ("**", "^"), ("*", " ")):
        value = value.replace(code, sign)
    return raised(value)


def raised(unit: str) -> str:
    """A unit with its powers raised."""
    return POWER.sub(lambda found: found[1].translate(SUPERSCRIPTS), unit)


def with_unit(text: str, variable: xr.DataArray, *, broken: bool = False) -> str:
    """An axis label with the variable's unit; `broken`: with a line for each unit that it mixes."""
    unit = raised(variable.attrs["units"])
    return text if unit == "1" else f"{text} ({unit.replace(', ', ',' + chr(10)) if broken else unit})"


def entitle(figure: Figure, dataset: xr.Dataset, more: str = "") -> None:
    """The scene's name over the figure, and what else all panels share."""
    figure.suptitle(": ".join(filter(None, [spoken(dataset.attrs.get("scene", "")), more])), fontsize=8.5)


def panels(count: int, *, columns: int, height: float, shared: bool = False) -> tuple[Figure, list[Axes]]:
    """A figure with `count` panels, `columns` side by side, `height` inches each; the rest of the grid stays empty.

    `shared`: all have the same two axes, and only the outer ones are labelled.
    """
    if count > MOST_PANELS:
        raise InputError(f"figure: {count} panels are too many to read; select at most {MOST_PANELS} of the dataset")
    columns = min(columns, count)
    rows = -(-count // columns)
    figure = Figure(figsize=(WIDTH, height * rows + 0.7), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, sharex=shared, sharey=shared)
    axes: list[Axes] = list(grid.flat)
    for spare in axes[count:]:
        spare.remove()
    return figure, axes[:count]


def label_outside(axes: list[Axes], columns: int, x: str, y: str) -> None:
    """Labels on the left and under the lowest panel of each column, for panels that share their axes."""
    for k, axis in enumerate(axes):
        if k % columns == 0:
            axis.set_ylabel(y)
        if k + columns >= len(axes):
            axis.set_xlabel(x)
            axis.tick_params(labelbottom=True)


def legend_under(axis: Axes, columns: int) -> None:
    """A legend of one panel, under its axis; every label once."""
    entries: dict[str, Artist] = {}
    for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
        entries.setdefault(label, handle)
    axis.legend(list(entries.values()), list(entries), loc="upper center", bbox_to_anchor=(0.5, UNDER), ncols=columns)


def power_of_ten(number: float) -> str:
    """1e-05 as a power; other numbers as they are."""
    exponent = round(math.log10(number))
    return f"$10^{{{exponent}}}$" if math.isclose(number, 10.0**exponent, rel_tol=1e-9) else f"{number:g}"


def legend_below(figure: Figure, axes: Iterable[Axes], columns: int) -> None:
    """One legend for all panels, outside of them, so that it covers no data; every label once."""
    entries: dict[str, Artist] = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    figure.legend(list(entries.values()), list(entries), loc="outside lower center", ncols=columns)
