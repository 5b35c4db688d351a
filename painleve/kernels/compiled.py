"""From a scene to its compiled kernels: the source is written once, named by its digest, and compiled once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from painleve.core.lane import BlockOffsets, BlockResult
from painleve.kernels.files import load_generated
from painleve.kernels.rows import Rows, rows_of
from painleve.kernels.source import scene_source
from painleve.mechanics.derive import Derivation, derive
from painleve.mechanics.scene import Scene

__all__ = ["Kernels", "make_kernels"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Kernels:
    """A scene's compiled functions (see painleve.kernels.source) and the digest that names their source."""

    derivation: Derivation
    rows: Rows
    digest: str
    path: Path
    rows_at: Callable[..., None]
    varying_block: Callable[..., None]
    law_block: Callable[..., None]
    empty_block: Callable[..., tuple[BlockOffsets, BlockResult]]
    offset_block: Callable[..., None]
    sample_lane: Callable[..., None]
    law_at: Callable[..., int]

    @property
    def scene(self) -> Scene:
        return self.derivation.scene


@lru_cache(maxsize=64)
def make_kernels(scene: Scene) -> Kernels:
    """Generate and load a scene's kernels; compiled at first call, from the disk cache in later processes."""
    derivation = derive(scene)
    rows = rows_of(derivation)
    text = scene_source(scene, rows, derivation.shape)
    module, digest, path = load_generated(f"scene_{scene.name}", text)
    return Kernels(
        derivation=derivation,
        rows=rows,
        digest=digest,
        path=path,
        rows_at=module.rows_at,
        varying_block=module.varying_block,
        law_block=module.law_block,
        empty_block=module.empty_block,
        offset_block=module.offset_block,
        sample_lane=module.sample_lane,
        law_at=module.law_at,
    )
