"""Generated modules: written once, by the digest of their text, and loaded by path."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
import tempfile
from pathlib import Path
from types import ModuleType

from painleve._jit import GENERATED_DIR

__all__ = ["load_generated"]


def load_generated(stem: str, text: str) -> tuple[ModuleType, str, Path]:
    """The module with that source, its digest and its file; the file stays, so that its compiled code can be cached."""
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    path = GENERATED_DIR / f"{stem}_{digest}.py"
    _write_once(path, text)
    return _load(path), digest, path


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
