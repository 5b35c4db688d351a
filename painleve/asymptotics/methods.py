"""The methods of distance, listed once: tests, charts and the command line loop over this list."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from painleve.asymptotics.distance import Distance
from painleve.asymptotics.limit_set import LimitSet
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.errors import InputError

__all__ = ["METHODS", "distance"]

METHODS: Mapping[str, Callable[..., Distance]] = MappingProxyType({"sample": sample_distance})


def distance(limit: LimitSet, eps: float, method: str = "sample", options: SampleOptions | None = None) -> Distance:
    """Bounds on e(A_eps, A), e(A, A_eps) and d_H by the method of that name. Raises InputError for an unknown one."""
    if method not in METHODS:
        raise InputError(f"method: no {method!r}; choose one of {', '.join(METHODS)}")
    return METHODS[method](limit, eps, options)
