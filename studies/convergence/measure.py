"""Every scheme on every motion, at efforts from coarse to fine."""

from __future__ import annotations

from collections.abc import Iterator

import xarray as xr

from studies.convergence.dataset import sweep_convergence
from studies.convergence.runs import MotionEffort
from studies.parts import Progress

__all__ = ["QUICK", "measure"]

QUICK = MotionEffort(
    most=5000,
    levels=4,
    phases=3,
    tolerances=(1e-4, 1e-6, 1e-8, 1e-10),
    stiffnesses=(1e3, 2.5e3, 6.3e3),
    instants=10_000,
    patience=0.0,
)


def measure(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
    """One dataset, `convergence`."""
    yield "convergence", sweep_convergence(effort=QUICK if quick else MotionEffort(), seed=seed, progress=progress)
