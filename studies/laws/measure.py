"""Maps of the two laws at two inclinations of a rod in space, and counts of solutions again by exact arithmetic."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from painleve.mechanics.library import load_scene
from painleve.mechanics.state import State, make_state
from painleve.theory.coulomb.one_step import Enumeration, coulomb_solutions
from studies.laws.two_laws import map_laws
from studies.parts import Progress

__all__ = ["measure", "measure_laws"]

INCLINATIONS = ("pi/4", "atan(2)")
APPROACHES = (-1.0, -0.1, -0.01, 0.0)
LARGEST_FRICTION = 4.0
POINTS, QUICK_POINTS = 300, 60  # frictions of a map; twice as many directions
CHECKS, QUICK_CHECKS = 20, 3  # of each map


def measure(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
    """One dataset, `laws`: maps over friction and direction, by configuration and normal velocity."""
    size, checks = (QUICK_POINTS, QUICK_CHECKS) if quick else (POINTS, CHECKS)
    yield "laws", measure_laws(size=size, checks=checks, seed=seed, progress=progress)


def measure_laws(*, size: int, checks: int, seed: int, progress: Progress) -> xr.Dataset:
    """Maps of so many frictions, and `checks` points of each counted by exact arithmetic."""
    scene = load_scene("spatial_rod")
    states = [make_state(scene, keys={"theta": theta}) for theta in INCLINATIONS]
    frictions = LARGEST_FRICTION * (np.arange(size) + 0.5) / size
    maps = map_laws(states, approaches=APPROACHES, frictions=frictions.tolist(), directions=2 * size + 1)
    return maps.assign(_checks(maps, states, checks, seed, progress))


def _checks(
    maps: xr.Dataset, states: Sequence[State], count: int, seed: int, progress: Progress
) -> dict[str, xr.Variable]:
    """At how many random points of each map exact arithmetic counts as many solutions, of how many."""
    generator, agree = np.random.default_rng(seed), np.zeros((len(states), maps.sizes["approach"]), np.int64)
    progress.expect(agree.size)
    for i, state in enumerate(states):
        for j in range(agree.shape[1]):
            chosen = maps.isel(state=i, approach=j)
            agree[i, j] = sum(_agrees(chosen, state, generator) for _ in range(count))
            progress(state.label)
    sentence = "random points of the map at which exact arithmetic counts as many solutions"
    return {
        "checks": xr.Variable((), count, {"long_name": "random points of each map that were checked", "units": "1"}),
        "agree": xr.Variable(("state", "approach"), agree, {"long_name": sentence, "units": "1"}),
    }


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
    v = [-float(np.cos(angle)), -float(np.sin(angle)), v_n, 0, 0]
    found = coulomb_solutions(state.scene, state.q, v, parameters={"mu": mu})
    return len(found.solutions) if found.enumeration is Enumeration.COMPLETE else None
