"""Fractions of both outcomes, the jam law beside its map, the initial layer, and what each scheme chooses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import xarray as xr

from studies.parts import Report
from studies.plurality.fits import fits_of
from studies.plurality.rows import choice_rows, decade_rows, law_rows, layer_rows
from studies.text_table import text_table

__all__ = ["report"]

GLOCKER = ("contact", "steps from", "to", "count", "jump (95 % interval)", "local map", "largest |t - t*|")
LAW = ("tests", "contact", "r", "alpha", "slip", "h", "d", "beta/c", "count", "jam (95 % interval)", "map", "law")
LAYER = ("state", "eps/h", "jump (95 % interval)", "e(right velocities, A) >=", "e(A, right velocities) <=")


def report(datasets: Mapping[str, xr.Dataset]) -> Report:
    """Of all four datasets."""
    step_sizes, jam_law = datasets["step_sizes"], datasets["jam_law"]
    decades, laws, fits = list(decade_rows(step_sizes)), list(law_rows(jam_law)), fits_of(jam_law)
    layers, choices = layer_rows(datasets["initial_layer"]), choice_rows(datasets["scheme_choice"])
    instant = float(step_sizes["instant"])
    parts = (
        _glocker_table(float(step_sizes["ratio"]), instant, decades),
        _law_table(laws),
        _fit_text(fits),
        _layer_table(layers),
        _choice_table(choices),
    )
    data = {
        "choices": choices,
        "layer": layers,
        "instant": instant,
        "decades": decades,
        "cases": laws,
        "fits": fits,
    }
    return Report(table="\n\n".join(parts), data=data, status=_status(decades, fits))


def _glocker_table(ratio: float, instant: float, rows: list[dict[str, Any]]) -> str:
    cells = [
        (
            row["contact"],
            f"{row['step']:.0e}",
            f"{10 * row['step']:.0e}",
            str(row["count"]),
            f"{row['fraction']:.3f} ({row['interval'][0]:.3f}-{row['interval'][1]:.3f})",
            f"{row['map']:.3f}",
            f"{row['largest_delay']:.1e}",
        )
        for row in rows
        if row["decades"] == 1.0
    ]
    narrow = [row["fraction"] for row in rows if row["decades"] != 1.0 and row["contact"] == "strict"]
    head = (
        f"Glocker's rod: r = {ratio:.4f}; the exact slip reaches the point at t* = {instant:.8f} s (event-driven).\n"
        f"In {len(narrow)} narrow windows near h = 1e-3 the fraction runs from {min(narrow):.2f} to {max(narrow):.2f}."
    )
    return f"{head}\n{text_table(GLOCKER, cells)}"


def _law_table(rows: list[dict[str, Any]]) -> str:
    cells = [
        (
            row["group"],
            row["contact"],
            f"{row['ratio']:.2f}",
            f"{row['alpha']:g}",
            f"{row['slip']:g}",
            f"{row['step']:.0e}",
            f"{row['drift']:.3f}",
            f"{row['neglected']:.0e}",
            f"{row['count']:.0f}",
            f"{row['fraction']:.4f} ({row['lower']:.4f}-{row['upper']:.4f})",
            f"{row['local_map']:.4f}",
            f"{row['law']:.4f}",
        )
        for row in rows
    ]
    head = (
        "The jam law. Derived: `law` (limit h -> 0) and `map` (finite h, without terms of relative size beta/c).\n"
        "Measured: `jam`, over step sizes and starts, with a 95 % interval from the scatter between starts."
    )
    return f"{head}\n{text_table(LAW, cells)}"


def _fit_text(fits: dict[str, dict[str, Any]]) -> str:
    lines = ["Goodness of fit, measured fractions against the local map:"]
    for contact in ("strict", "kept"):
        fit = fits[contact]
        lines.append(
            f"  {contact}: chi-square {fit['chi_square']:.1f} on {fit['degrees']} degrees of freedom, "
            f"p = {fit['p_value']:.2g}; largest residual {fit['largest_residual']:.3f}; where the map has no jam, "
            f"{fit['jams_where_the_map_has_none']} were seen."
        )
    power = fits["approach"]
    lines.append(
        "Approach to the limit at r = 0.5, fitted powers of h, measured and (by the map): "
        f"strict {power['strict fraction']:.2f} ({power['strict local_map']:.2f}; 1/3 derived for h -> 0), "
        f"kept {power['kept fraction']:.2f} ({power['kept local_map']:.2f}; 1/2 derived for h -> 0)."
    )
    return "\n".join(lines)


def _layer_table(rows: list[dict[str, Any]]) -> str:
    """Fraction that jumps, over eps/h, at the least h."""
    least = min(row["step"] for row in rows)
    cells = [
        (
            row["state"],
            f"{row['ratio']:.3g}",
            f"{row['fraction']:.3f} ({row['lower']:.3f}-{row['upper']:.3f})",
            f"{row['excess_from_A']:.2e}",
            f"{row['excess_of_A']:.2e}",
        )
        for row in rows
        if row["step"] == least
    ]
    head = f"States with gamma < 0 known to eps, h = {least:g}, right velocity after 1.6 sqrt(h) s:"
    return f"{head}\n{text_table(LAYER, cells)}"


def _choice_table(rows: list[dict[str, Any]]) -> str:
    """A row for each run, a column for each state."""
    states, runs = (list(dict.fromkeys(row[name] for row in rows)) for name in ("state", "run"))
    said = {(row["state"], row["run"]): f"{row['choice']} {row['time']:.5f}" for row in rows}
    cells = [(run, *(said[state, run] for state in states)) for run in runs]
    return "What happens first, and when (s):\n" + text_table(("scheme", *states), cells)


def _status(decades: list[dict[str, Any]], fits: dict[str, dict[str, Any]]) -> str:
    wide = [row for row in decades if row["decades"] == 1.0 and row["contact"] == "strict"]
    plural = sum(0.0 < row["fraction"] < 1.0 for row in wide)
    return (
        f"Both outcomes in {plural} of {len(wide)} decades of step sizes; the map is within "
        f"{fits['strict']['largest_residual']:.3f} (strict) and {fits['kept']['largest_residual']:.3f} (kept)."
    )
