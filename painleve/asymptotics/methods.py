"""The methods of distance, listed once: tests, charts and the command line loop over this list."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from painleve.asymptotics.certify.method import CertifyOptions, certify_distance
from painleve.asymptotics.distance import Distance
from painleve.asymptotics.optimise import OptimiseOptions, optimise_distance
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.errors import InputError, nearest
from painleve.theory.limit_set import LimitSet

__all__ = ["METHODS", "Method", "distance", "find_method"]


@dataclass(frozen=True, kw_only=True)
class Method:
    """A method: measure(limit, eps, options) and the type of its options, all of which have defaults."""

    measure: Callable[..., Distance]
    options: type


METHODS: Mapping[str, Method] = MappingProxyType(
    {
        "sample": Method(measure=sample_distance, options=SampleOptions),
        "optimise": Method(measure=optimise_distance, options=OptimiseOptions),
        "certify": Method(measure=certify_distance, options=CertifyOptions),
    }
)


def find_method(name: str) -> Method:
    """The method of that name. Raises InputError for an unknown one."""
    if name not in METHODS:
        raise InputError(f"method: no {name!r}{nearest(name, METHODS)}; choose one of {', '.join(METHODS)}")
    return METHODS[name]


def distance(limit: LimitSet, eps: float, method: str = "sample", options: object | None = None) -> Distance:
    """Bounds on e(A_eps, A), e(A, A_eps) and d_H by the method of that name, with that method's options.

    Raises InputError for an unknown method, options of another one, eps <= 0 and an undecided limit set.
    """
    chosen = find_method(method)
    if options is not None and not isinstance(options, chosen.options):
        raise InputError(f"method {method}: options must be {chosen.options.__name__}, not {type(options).__name__}")
    return chosen.measure(limit, eps, options)
