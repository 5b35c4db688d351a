"""A pytest plugin of `make mutants`: no test lives on what an earlier one, or an import, has left in caches.

While mutmut notes which test calls which function, caches are emptied before every test, else the first caller alone
would be noted; a mutant starts with none, else it would meet values of the unchanged code. Caches of rooms that are not
mutated stay, since kernels take long to make.
"""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Iterator

KEPT = ("painleve.kernels", "painleve.mechanics", "painleve.core")


def caches() -> Iterator[functools._lru_cache_wrapper]:
    for name, module in list(sys.modules.items()):
        if (name.startswith("painleve.") and not name.startswith(KEPT)) or name.startswith("test_"):
            yield from (x for x in vars(module).values() if isinstance(x, functools._lru_cache_wrapper))


def pytest_collection_finish() -> None:
    for cache in caches():
        cache.cache_clear()


def pytest_runtest_setup() -> None:
    if os.environ.get("MUTANT_UNDER_TEST") == "stats":
        pytest_collection_finish()
