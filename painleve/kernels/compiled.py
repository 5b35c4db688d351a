"""From a scene to its compiled kernels: the source is written once, named by its digest, and compiled once."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import ModuleType

from painleve._jit import GENERATED_DIR
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
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    path = GENERATED_DIR / f"scene_{scene.name}_{digest}.py"
    _write_once(path, text)
    module = _load(path)
    return Kernels(
        derivation=derivation, rows=rows, digest=digest, path=path, rows_at=module.rows_at,
        varying_block=module.varying_block, law_block=module.law_block, offset_block=module.offset_block,
        sample_lane=module.sample_lane, law_at=module.law_at,
    )  # fmt: skip


def _write_once(path: Path, text: str) -> None:
    """Written aside and moved into place, so that no other process ever sees half a file."""
    if path.exists():
        return
    handle, name = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
    with os.fdopen(handle, "w") as file:
        file.write(text)
    os.replace(name, path)


def _load(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module  # numba looks the module of a cached function up by name
    spec.loader.exec_module(module)
    return module
