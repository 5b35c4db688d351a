"""The one decorator for compiled code, and what is kept of it on the disk.

Numba's own disk cache watches only the file of the function that it stores, so a caller stays stale when a callee in
another file changes; it loads whatever stands in its files; and its folder is one for the whole process. So compiled
code is kept here (code_cache) in a folder that is named by a digest of all it can depend on, and that nobody but the
user may write (folder).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba

from painleve._jit.announced import announce_compiling
from painleve._jit.code_cache import CodeCache
from painleve._jit.folder import CACHE

__all__ = ["CACHE", "jit"]

# error_model="numpy": a division by zero gives inf, which the law's clamps rely on; without it every division
# carries a branch and nothing vectorises. fastmath stays off: it assumes that NaN and inf do not occur.
announce_compiling()
_compiled = numba.njit(error_model="numpy", nogil=True)


def jit(function: Callable[..., Any]) -> Any:
    """The function, compiled at its first call for each kind of arguments, or loaded if an earlier process did that."""
    dispatcher = _compiled(function)
    if not numba.config.DISABLE_JIT:
        dispatcher._cache = CodeCache(function, CACHE)
    return dispatcher
