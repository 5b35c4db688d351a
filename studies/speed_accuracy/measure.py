"""Error against work at one radius, on states of every branch of Theorem 1."""

from __future__ import annotations

from collections.abc import Iterator

import xarray as xr

from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from studies.benchmark.work_precision import DistanceEffort, sweep_work_precision
from studies.parts import Progress

__all__ = ["measure"]

EPS = 1e-3
STATES = (
    ("slender_rod", "paradox"),
    ("slender_rod", "critical"),
    ("slender_rod", "double_zero"),
    ("worn_tip_rod", "isolated"),
    ("two_link_arm", "isolated"),
)
QUICK_STATES = STATES[:4]
EFFORT = DistanceEffort(
    samples=(10**3, 10**4, 10**5, 10**6, 10**7),
    naive_samples=(10**3, 10**4, 10**5, 10**6),
    widths=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
)
QUICK_EFFORT = DistanceEffort(
    samples=(10**3, 10**5), naive_samples=(10**3, 10**5), widths=(1e-1, 1e-3), reference_width=1e-5, repetitions=1
)


def measure(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
    """One dataset, `speed_accuracy`: every method at every effort on every state."""
    states = [make_state(load_scene(scene), name) for scene, name in (QUICK_STATES if quick else STATES)]
    effort = QUICK_EFFORT if quick else EFFORT
    yield "speed_accuracy", sweep_work_precision(states, eps=EPS, effort=effort, seed=seed, progress=progress)
