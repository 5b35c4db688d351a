"""From a scene to its compiled motion: accelerations, one step of each scheme, and the time loops."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from painleve.core.stepping import Step
from painleve.kernels.files import load_generated
from painleve.kernels.motion.rows import MotionRows, motion_rows
from painleve.kernels.motion.source import motion_source
from painleve.mechanics.derive import Derivation, derive
from painleve.mechanics.scene import Scene

__all__ = ["Motion", "make_motion"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """A scene's compiled motion (painleve.kernels.motion.source) and the digest that names its source."""

    derivation: Derivation
    rows: MotionRows
    digest: str
    path: Path
    motion_at: Callable[..., tuple[tuple[float, ...], tuple[float, ...]]]
    rows_at: Callable[..., tuple[float, ...]]
    inertia_at: Callable[..., tuple[float, ...]]
    force_at: Callable[..., tuple[float, ...]]
    drift_at: Callable[..., tuple[float, ...]]
    depths_at: Callable[..., tuple[float, ...]]
    step: Callable[..., Step]
    run: Callable[..., tuple[int, int, int]]
    run_members: Callable[..., None]
    tabulate: Callable[..., None]

    @property
    def scene(self) -> Scene:
        return self.derivation.scene


@lru_cache(maxsize=64)
def make_motion(scene: Scene) -> Motion:
    """Generate and load a scene's motion; compiled at first call, from the disk cache in later processes."""
    derivation = derive(scene)
    rows = motion_rows(derivation)
    module, digest, path = load_generated(f"motion_{scene.name}", motion_source(scene, rows))
    return Motion(
        derivation=derivation,
        rows=rows,
        digest=digest,
        path=path,
        motion_at=module.motion_at,
        rows_at=module.rows_at,
        inertia_at=module.inertia_at,
        force_at=module.force_at,
        drift_at=module.drift_at,
        depths_at=module.depths_at,
        step=module.step,
        run=module.run,
        run_members=module.run_members,
        tabulate=module.tabulate,
    )
