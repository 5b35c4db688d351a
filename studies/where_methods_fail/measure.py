"""Sampled bounds, rounding and both sides of critical values; and error against work, from which advice is drawn."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from painleve.asymptotics.certify.method import CertifyOptions
from painleve.asymptotics.optimise import OptimiseOptions
from painleve.asymptotics.sample import SampleOptions
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from studies.benchmark.work_precision import DistanceEffort, sweep_work_precision
from studies.parts import Progress
from studies.where_methods_fail.facts import PROOF
from studies.where_methods_fail.near_critical import NearCase, sweep_near_critical
from studies.where_methods_fail.rounding import sweep_rounding
from studies.where_methods_fail.sampled_bound import sweep_sampled_bound

__all__ = ["measure", "near_cases"]

HARD = ("slender_rod", "double_zero")
STATES = (
    ("slender_rod", "paradox"),
    ("slender_rod", "critical"),
    HARD,
    ("worn_tip_rod", "isolated"),
    ("two_link_arm", "approached"),
    ("two_link_arm", "isolated"),
)


@dataclass(frozen=True, kw_only=True)
class StudySize:
    """How much is run."""

    bound_eps: Sequence[float]
    bound_samples: Sequence[int]
    rounding_eps: Sequence[float]
    members: int
    rounding_samples: int
    near_eps: Sequence[float]
    near_samples: int
    guide_eps: Sequence[float]
    states: Sequence[tuple[str, str]]
    effort: DistanceEffort


FULL = StudySize(
    bound_eps=np.logspace(-1, -7, 13).tolist(),
    bound_samples=(10**3, 10**5, 10**7),
    rounding_eps=np.logspace(-1, -14, 14).tolist(),
    members=100,
    rounding_samples=10**7,
    near_eps=np.logspace(-1, -8, 15).tolist(),
    near_samples=200_000,
    guide_eps=(1e-3, 1e-9),
    states=STATES,
    effort=DistanceEffort(
        samples=(10**4, 10**6), naive_samples=(10**5,), widths=(1e-1, PROOF), reference_width=1e-5, repetitions=1
    ),
)
QUICK = StudySize(
    bound_eps=np.logspace(-1, -7, 4).tolist(),
    bound_samples=(10**3, 10**5),
    rounding_eps=np.logspace(-2, -14, 5).tolist(),
    members=20,
    rounding_samples=10**5,
    near_eps=np.logspace(-1, -8, 5).tolist(),
    near_samples=20_000,
    guide_eps=(1e-3,),
    states=STATES[1:3],
    effort=DistanceEffort(
        samples=(10**4,), naive_samples=(10**4,), widths=(PROOF,), reference_width=1e-4, repetitions=1
    ),
)


def measure(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
    """`sampled_bound`, `rounding`, `near_critical`, and `methods_EPS` for each radius of the advice."""
    size, hard = QUICK if quick else FULL, make_state(load_scene(HARD[0]), HARD[1])
    yield (
        "sampled_bound",
        sweep_sampled_bound(hard, eps=size.bound_eps, samples=size.bound_samples, seed=seed, progress=progress),
    )
    yield (
        "rounding",
        sweep_rounding(
            hard,
            eps=size.rounding_eps,
            members=size.members,
            samples=size.rounding_samples,
            seed=seed,
            progress=progress,
        ),
    )
    methods = {"optimise": OptimiseOptions(), "sample": SampleOptions(samples=size.near_samples, seed=seed)}
    enclosing = {"certify": CertifyOptions(width=1e-1)}
    yield (
        "near_critical",
        sweep_near_critical(near_cases(), eps=size.near_eps, methods=methods, isolated=enclosing, progress=progress),
    )
    states = [make_state(load_scene(scene), name) for scene, name in size.states]
    for eps in size.guide_eps:
        yield (
            f"methods_{eps:.0e}",
            sweep_work_precision(states, eps=eps, effort=size.effort, seed=seed, progress=progress),
        )


def near_cases() -> tuple[NearCase, NearCase]:
    """mu beside the least critical friction, and k beside the value from which on the worn tip's state is isolated."""
    rod, worn, keys = load_scene("slender_rod"), load_scene("worn_tip_rod"), {"theta": "atan(2)"}
    return (
        NearCase(scene=rod, keys=keys, parameter="mu", critical="4/3", exponents=(2, 4, 6)),
        NearCase(scene=worn, keys=keys, parameter="k", critical="25/6", exponents=(1, 2, 3)),
    )
