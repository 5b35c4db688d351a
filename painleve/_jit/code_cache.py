"""Compiled functions on the disk, each in a file that begins with the digest of the rest.

This is what numba's dispatcher asks of a cache (load, save, and the switches), with numba's own way to make bytes of a
compiled function. The digest is compared before anything is unpickled or loaded as machine code: a damaged file is
compiled anew. It protects from damage; from other people protects that the folder is the user's own.
"""

from __future__ import annotations

import hashlib
import linecache
import pickle
from collections.abc import Callable
from typing import Any

from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from painleve._jit.folder import CacheFolder

__all__ = ["CodeCache"]

DIGEST_BYTES = 32
ENDING = ".nbc"


class CodeCache:
    """The compiled versions of one function, one for each kind of arguments and each processor."""

    def __init__(self, function: Callable[..., Any], folder: CacheFolder) -> None:
        code = function.__code__
        self._folder = folder
        self._enabled = True
        self._stem = f"{function.__module__.removeprefix('painleve.')}.{function.__name__}-{code.co_firstlineno}"
        linecache.checkcache(code.co_filename)  # an edited module that was loaded again is another one
        text = "".join(linecache.getlines(code.co_filename))
        source = hashlib.sha256(text.encode()).hexdigest()
        self._source = f"{function.__module__} {function.__qualname__} {code.co_firstlineno} {source}"

    @property
    def cache_path(self) -> str | None:
        return None if self._folder.path is None else str(self._folder.path)

    def enable(self) -> None:
        self._enabled = True

    def disable(self) -> None:
        self._enabled = False

    def flush(self) -> None:
        """Nothing is kept back: every version is written when it is compiled."""

    def load_overload(self, signature: Any, target: Any) -> Any:
        """The compiled function; None if there is none on the disk, or a damaged one."""
        target.refresh()
        name = self._name(signature, target.codegen())
        content = self._folder.read(name) if self._enabled else None
        if content is None:
            return None
        payload = memoryview(content)[DIGEST_BYTES:]
        if hashlib.sha256(payload).digest() != content[:DIGEST_BYTES]:
            self._folder.report(name, "the file is damaged; it is compiled anew, as is every other such file")
            return None
        return CompileResult._rebuild(target, *pickle.loads(payload))

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Keep a compiled function, unless it holds an address or is part of another one."""
        if not self._enabled or compiled.lifted or compiled.library.has_dynamic_globals:
            return
        payload = dumps(compiled._reduce())
        self._folder.write(self._name(signature, compiled.codegen), hashlib.sha256(payload).digest() + payload)

    def _name(self, signature: Any, codegen: Any) -> str:
        """Of the file: all that the machine code depends on beyond what names the folder."""
        key = f"{signature!r} {codegen.magic_tuple()!r} {self._source}"
        return f"{self._stem}.{hashlib.sha256(key.encode()).hexdigest()[:32]}{ENDING}"
