"""Generated modules: named by the digest of their text, kept as files for who wants to read them, never run from there.

What runs is the text itself, so that no file can change what is computed.
"""

from __future__ import annotations

import hashlib
import linecache
import sys
from pathlib import Path
from types import ModuleType

from painleve._jit import CACHE

__all__ = ["load_generated"]


def load_generated(stem: str, text: str) -> tuple[ModuleType, str, Path]:
    """The module with that source, its digest, and the file that shows the source if it could be written."""
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    name = f"{stem}_{digest}"
    path = CACHE.place(f"{name}.py")
    _keep(path, text.encode())
    return _load(name, text, path), digest, path


def _keep(path: Path, content: bytes) -> None:
    """Written if it is not there; repaired, with a line, if it is not what its name says."""
    there = CACHE.read(path.name)
    if there is not None and there != content:
        CACHE.report(path.name, "the file was changed or damaged; it is written anew, and nothing was computed from it")
    if there != content:
        CACHE.write(path.name, content)


def _load(name: str, text: str, path: Path) -> ModuleType:
    # Tracebacks and inspect find the source here, whatever became of the file.
    linecache.cache[str(path)] = (len(text), None, text.splitlines(keepends=True), str(path))
    module = ModuleType(name)
    module.__file__ = str(path)
    sys.modules[name] = module  # numba looks the module of a cached function up by name
    exec(compile(text, str(path), "exec"), module.__dict__)
    return module
