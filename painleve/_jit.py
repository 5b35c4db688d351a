"""The one decorator for compiled code, and the directory in which compiled code is kept.

Numba's disk cache watches only the file of the function that it stores, so a caller stays stale when a callee in
another file changes. The cache directory is therefore named by a digest of the sources that compiled code can come
from and of the versions that matter, and is set before anything is compiled.
"""

from __future__ import annotations

import hashlib
import os
import platform
import tempfile
from importlib import metadata
from pathlib import Path

import numba

__all__ = ["GENERATED_DIR", "jit"]

# Only these import numba; an import contract of pyproject.toml holds it. What the kernels print from a scene stands in
# files that are named by a digest of their own text.
COMPILED_SOURCES = ("_jit.py", "core", "kernels")


def _sources_digest() -> str:
    digest = hashlib.sha256()
    versions = (numba.__version__, metadata.version("numpy"), platform.python_version())
    digest.update(" ".join(versions).encode())
    root = Path(__file__).parent
    for path in sorted(p for p in root.rglob("*.py") if p.relative_to(root).parts[0] in COMPILED_SOURCES):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _writable_cache_root() -> Path:
    """$PAINLEVE_CACHE_DIR, else the user's cache directory, else a temporary one."""
    named = os.environ.get("PAINLEVE_CACHE_DIR")
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    for root in [Path(named)] if named else [base / "painleve"]:
        try:
            root.mkdir(parents=True, exist_ok=True)
            if os.access(root, os.W_OK):
                return root
        except OSError:
            pass
    return Path(tempfile.mkdtemp(prefix="painleve-"))


GENERATED_DIR = _writable_cache_root() / _sources_digest()
GENERATED_DIR.mkdir(parents=True, exist_ok=True)
numba.config.CACHE_DIR = str(GENERATED_DIR)

# error_model="numpy": a division by zero gives inf, which the law's clamps rely on; without it every division
# carries a branch and nothing vectorises. fastmath stays off: it assumes that NaN and inf do not occur.
jit = numba.njit(cache=True, error_model="numpy", nogil=True)
