"""Two laws of friction: where the paper's projection (7) and Coulomb's maximal dissipation part, on a rod in space.

Claims (the project's own; the rod is uniform, in space, on a floor with a disc of friction of radius mu; psi is the
angle of the slip against b, the coupling of the normal to the tangents, and mu_c = a/|b|):
- tangential problem, v_n = 0. Law (7) has a jump exactly where mu > mu_c and |psi| < pi/2 + arccos(mu_c/mu). Coulomb's
  law has one exactly where sticking is in the friction cone, and then law (7) sticks too: two solutions where friction
  would drive the slip (mu cos psi > mu_c), else three, for a slip joins u- and sticking. Between the two edges law (7)
  jumps and Coulomb's law stays at u-;
- impacts, v_n < 0: Coulomb's law has one solution or three, three only near the tangential problem. The two laws part
  at gamma > 0 as well. They are one where the tip sticks, and where the slip is parallel to b.

Command:  painleve study laws [--quick]
Expected: no point of the grid beside the edges of the claims, and every count confirmed that exact arithmetic checks.
          Largest distances at a slip of speed 1: 1.08 at 45 degrees and 1.66 at tan theta = 2 for v_n = 0; at
          gamma > 0 0.74 and 0.68 for v_n = -0.01, 0.09 and 0.10 for v_n = -1. Three solutions on 6.4 % and 3.7 % of
          the rectangle |psi| <= pi, mu < 4 for v_n = 0, on 3.2 % and 1.1 % for v_n = -0.01.
Time:     half a minute, with --quick a few seconds; a change of the sources compiles the two laws first.
Files:    the maps of two configurations and four normal velocities (HDF5), and a figure of two of them (PDF and PNG).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import State, make_state
from painleve.plotting import draw, save_figure
from painleve.store import check_writable, save
from painleve.theory.coulomb.one_step import Enumeration, coulomb_solutions
from studies.laws.figures import DRAWINGS
from studies.laws.measure import map_laws
from studies.study import StudyResult
from studies.text_table import text_table

INCLINATIONS = ("pi/4", "atan(2)")
APPROACHES = (-1.0, -0.1, -0.01, 0.0)
DRAWN = (-0.01, 0.0)
LARGEST_FRICTION = 4.0
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


def run(output: Path, *, quick: bool = False, seed: int = 0) -> StudyResult:
    """Map, draw, check and tabulate; `output` is an existing folder."""
    check_writable(output / "laws.h5")
    scene = load_scene("spatial_rod")
    states = [make_state(scene, keys={"theta": theta}) for theta in INCLINATIONS]
    size = 60 if quick else 300
    frictions = LARGEST_FRICTION * (np.arange(size) + 0.5) / size
    maps = map_laws(states, approaches=APPROACHES, frictions=frictions, directions=2 * size + 1)
    figure = draw(maps.sel(approach=list(DRAWN)), DRAWINGS)
    files = [save(maps, output / "laws.h5"), *(save_figure(figure, output / f"laws.{s}") for s in ("pdf", "png"))]
    generator = np.random.default_rng(seed)
    rows = [
        _row(maps.isel(state=i, approach=j), state, 3 if quick else 20, generator)
        for i, state in enumerate(states)
        for j in range(len(APPROACHES))
    ]
    return StudyResult(table=_table(rows), files=tuple(files), data={"rows": rows}, status=_status(rows))


def _row(chosen: xr.Dataset, state: State, checks: int, generator: np.random.Generator) -> dict[str, object]:
    below = chosen["friction"] < chosen["critical_friction"]
    solutions = chosen["solutions"]
    return {
        "state": state.label,
        "approach": float(chosen["approach"]),
        "shares": {str(n): float((solutions == n).mean()) for n in range(1, int(solutions.max()) + 1)},
        "largest": float(chosen["nearest"].max()),
        "largest_at_positive_gamma": float(chosen["nearest"].where(below, 0.0).max()),
        "parted": float((chosen["nearest"] > APART).mean()),
        "edges_missed": _missed(chosen),
        "checks": checks,
        "agree": sum(_agrees(chosen, state, generator) for _ in range(checks)),
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


def _agrees(chosen: xr.Dataset, state: State, generator: np.random.Generator) -> bool:
    """Whether exact arithmetic counts as many solutions at a random point of the grid, read as decimals."""
    point = chosen.isel(
        friction=generator.integers(chosen.sizes["friction"]), direction=generator.integers(chosen.sizes["direction"])
    )
    angle = float(point["direction"])
    found = _exactly(state, angle, float(point["approach"]), float(point["friction"]))
    return found == int(point["solutions"])


def _exactly(state: State, angle: float, v_n: float, mu: float) -> int | None:
    """b points away from the centre, against the first axis, at the azimuth 0; a translation has v_n = u_z."""
    scene: Scene = state.scene
    v = [-float(np.cos(angle)), -float(np.sin(angle)), v_n, 0, 0]
    found = coulomb_solutions(scene, state.q, v, parameters={"mu": mu})
    return len(found.solutions) if found.enumeration is Enumeration.COMPLETE else None


def _table(rows: list[dict[str, object]]) -> str:
    lines = []
    for row in rows:
        shares = [f"{100.0 * row['shares'].get(str(n), 0.0):.2f} %" for n in (1, 2, 3)]
        missed = "-" if row["edges_missed"] is None else str(row["edges_missed"])
        lines.append(
            (
                row["state"],
                f"{row['approach']:g}",
                *shares,
                f"{row['largest']:.3f}",
                f"{row['largest_at_positive_gamma']:.3f}",
                f"{100.0 * row['parted']:.1f} %",
                missed,
                f"{row['agree']} of {row['checks']}",
            )
        )
    notes = [
        "Shares of the rectangle |psi| <= pi, 0 < mu < 4. The slip has the speed 1, v_n is measured in it. Distances",
        "are of law (7) from the nearest solution of Coulomb's law, in the scene's units; parted: beyond rounding.",
        "Edges missed: points of the grid at which the closed forms of the claims are wrong.",
    ]
    return "\n".join([text_table(COLUMNS, lines), "", *notes])


def _status(rows: list[dict[str, object]]) -> str:
    missed = sum(row["edges_missed"] or 0 for row in rows)
    agree, checks = (sum(row[name] for row in rows) for name in ("agree", "checks"))
    return (
        f"The closed forms hold at all but {missed} points of the maps; "
        f"exact arithmetic confirms {agree} of {checks} counts."
    )
