"""What was found against what was published, and whether they agree."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import sympy as sp

from painleve.exact.signs import Sign, exact_sign
from studies.reference.facts import Fact, FactKind

__all__ = ["FactStatus", "FoundValue", "Reproduction", "compare"]

NUMERICAL = 1e-12  # how near a numerical second route has to come, relative


class FactStatus(Enum):
    """Agreement, exactly or to every printed digit; disagreement; or what lies outside of what this package models."""

    REPRODUCED = "reproduced"
    DIFFERS = "differs"
    NOT_REPRODUCIBLE = "not reproducible"


@dataclass(frozen=True, kw_only=True)
class FoundValue:
    """A value found without the published one: exact, a float with a bound on its error, or a label.

    `route` says how; `gap` is the largest relative difference from a second, numerical route where there is one;
    `obstacle` says why the fact lies outside, and then `value` is what could be found instead.
    """

    value: sp.Expr | float | str
    route: str
    error: float = 0.0
    gap: float | None = None
    obstacle: str = ""


@dataclass(frozen=True, kw_only=True)
class Reproduction:
    """A fact, what was found, their difference as text (empty for labels) and the status."""

    fact: Fact
    found: FoundValue
    difference: str
    status: FactStatus


def compare(fact: Fact, found: FoundValue) -> Reproduction:
    """Exact values must be equal, decimals round to the printed digits at both ends of their error, labels be the same.

    A numerical second route that is off by more than 1e-12 makes a difference too.
    """
    agrees, difference = _agreement(fact, found)
    if found.gap is not None and not found.gap <= NUMERICAL:
        agrees, difference = False, f"{found.gap:.1e} between routes"
    status = FactStatus.REPRODUCED if agrees else FactStatus.DIFFERS
    if found.obstacle:
        status = FactStatus.NOT_REPRODUCIBLE
    return Reproduction(fact=fact, found=found, difference=difference, status=status)


def _agreement(fact: Fact, found: FoundValue) -> tuple[bool, str]:
    if fact.kind is FactKind.LABEL:
        return found.value == fact.value, ""
    if fact.kind is FactKind.DECIMAL:
        value = float(found.value)
        ends = {f"{value + side * found.error:.{fact.decimals}f}" for side in (-1.0, 1.0)}
        return ends == {fact.value}, f"{value - float(fact.value):+.1e}"
    difference = sp.simplify(sp.sympify(found.value, strict=True) - fact.expression)
    if fact.kind is FactKind.EXACT:
        zero = exact_sign(difference).sign is Sign.ZERO
        return zero, "0, exactly" if zero else f"{float(difference):+.1e}"
    return difference == 0, "0, identically" if difference == 0 else str(difference)
