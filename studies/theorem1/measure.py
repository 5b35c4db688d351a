"""Distances over eps, members of A_eps and maps of gamma, scene by scene."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from painleve.asymptotics.sample import SampleOptions
from painleve.mechanics.library import SCENE_NAMES, load_scene
from painleve.mechanics.scene import Scene
from painleve.sweep import has_gamma_map, map_gamma, sweep_distances, sweep_members
from studies.parts import Progress
from studies.theorem1.overview import overview

__all__ = ["measure", "measure_scene"]

EPS = np.logspace(-1, -6, 16)
QUICK_EPS = np.logspace(-1, -6, 6)
PICTURE_EPS = (1e-1, 1e-2)
SAMPLES, QUICK_SAMPLES, PICTURED = 1_000_000, 20_000, 4096


def measure(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
    """Up to three datasets of each scene, `distances_NAME`, `members_NAME`, `gamma_map_NAME`; and `theorem1` of all."""
    eps = (QUICK_EPS if quick else EPS).tolist()
    scenes = [load_scene(name) for name in SCENE_NAMES]
    progress.expect(sum(len(scene.states) for scene in scenes) * len(eps))
    distances = []
    for scene in scenes:
        for stem, dataset in measure_scene(scene, eps, QUICK_SAMPLES if quick else SAMPLES, seed, progress):
            if dataset.attrs["kind"] == "distances":
                distances.append(dataset)
            yield stem, dataset
    yield "theorem1", overview(distances)


def measure_scene(
    scene: Scene, eps: list[float], samples: int, seed: int, progress: Progress
) -> Iterator[tuple[str, xr.Dataset]]:
    states = [state.name for state in scene.states]
    options = SampleOptions(samples=samples, seed=seed)
    yield (
        f"distances_{scene.name}",
        sweep_distances(
            scene, eps=eps, states=states, options=options, progress=lambda label: progress(f"{scene.name} {label}")
        ),
    )
    cloud = SampleOptions(samples=PICTURED, seed=seed, sampler="uniform")
    yield f"members_{scene.name}", sweep_members(scene, eps=PICTURE_EPS, states=states, options=cloud)
    if has_gamma_map(scene):
        yield f"gamma_map_{scene.name}", map_gamma(scene, states=states)
