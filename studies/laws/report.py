"""How far the two laws part, how many solutions Coulomb's law has, and whether the claimed closed forms hold."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import xarray as xr

from studies.parts import Report
from studies.text_table import text_table

__all__ = ["report"]

APART = 1e-9  # beyond the rounding of both laws, below every distance that the claims speak of
COLUMNS = (
    "state",
    "v_n",
    "1 solution",
    "2",
    "3",
    "largest distance",
    "at gamma > 0",
    "parted",
    "edges missed",
    "exact checks",
)


def report(datasets: Mapping[str, xr.Dataset]) -> Report:
    """A row for each configuration and normal velocity."""
    maps = datasets["laws"]
    rows = [
        _row(maps.isel(state=i, approach=j)) for i in range(maps.sizes["state"]) for j in range(maps.sizes["approach"])
    ]
    return Report(table=_table(rows), data={"rows": rows}, status=_status(rows))


def _row(chosen: xr.Dataset) -> dict[str, Any]:
    below = chosen["friction"] < chosen["critical_friction"]
    solutions = chosen["solutions"]
    return {
        "state": str(chosen["state"].item()),
        "approach": float(chosen["approach"]),
        "shares": {str(n): float((solutions == n).mean()) for n in range(1, int(solutions.max()) + 1)},
        "largest": float(chosen["nearest"].max()),
        "largest_at_positive_gamma": float(chosen["nearest"].where(below, 0.0).max()),
        "parted": float((chosen["nearest"] > APART).mean()),
        "edges_missed": _missed(chosen),
        "checks": int(chosen["checks"]),
        "agree": int(chosen["agree"]),
    }


def _missed(chosen: xr.Dataset) -> int | None:
    """At how many points of the tangential problem the closed forms of the claims are wrong; None of an impact."""
    if float(chosen["approach"]) < 0.0:
        return None
    angle = abs(chosen["direction"])
    jumps = (chosen["solutions"] > 1) == (chosen["sticking"] == 1)
    # False where mu < mu_c, for there both edges are NaN
    parted = (chosen["nearest"] > APART) == ((angle < chosen["projected"]) & (chosen["sticking"] == 0))
    two = (chosen["solutions"] == 2) == (angle < chosen["driven"])
    return int((~(jumps & parted & two)).sum())


def _table(rows: list[dict[str, Any]]) -> str:
    cells = [
        (
            row["state"],
            f"{row['approach']:g}",
            *(f"{100.0 * row['shares'].get(str(n), 0.0):.2f} %" for n in (1, 2, 3)),
            f"{row['largest']:.3f}",
            f"{row['largest_at_positive_gamma']:.3f}",
            f"{100.0 * row['parted']:.1f} %",
            "-" if row["edges_missed"] is None else str(row["edges_missed"]),
            f"{row['agree']} of {row['checks']}",
        )
        for row in rows
    ]
    notes = [
        "Shares of the rectangle |psi| <= pi, 0 < mu < 4. The slip has the speed 1, v_n is measured in it. Distances",
        "are of law (7) from the nearest solution of Coulomb's law, in the scene's units; parted: beyond rounding.",
        "Edges missed: points of the grid at which the closed forms of the claims are wrong.",
    ]
    return "\n".join([text_table(COLUMNS, cells), "", *notes])


def _status(rows: list[dict[str, Any]]) -> str:
    missed = sum(row["edges_missed"] or 0 for row in rows)
    agree, checks = (sum(row[name] for row in rows) for name in ("agree", "checks"))
    return (
        f"The closed forms hold at all but {missed} points of the maps; "
        f"exact arithmetic confirms {agree} of {checks} counts."
    )
