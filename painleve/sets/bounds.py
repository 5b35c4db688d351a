"""What is known about a non-negative number: a value, a lower bound, an upper bound, an enclosure, or nothing.

Every statement holds up to floating-point rounding: "exact" says that no sampling and no truncation entered the
number, not that its last digits are right. Rigorous rounding is the business of whoever computes the bounds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context
from typing import Literal

__all__ = ["Bounds", "Side", "largest"]

Side = Literal["exact", "lower bound", "upper bound", "enclosure", "unknown"]

_DIGITS = 5


@dataclass(frozen=True, kw_only=True)
class Bounds:
    """The sides on which a distance (non-negative and finite) is known; None is a side that is not known.

    An upper bound of zero leaves only zero, so it is stored as the exact value.

    Raises ValueError for a bound that is NaN, infinite or negative, and where lower > upper.
    """

    lower: float | None
    upper: float | None

    def __post_init__(self) -> None:
        lower, upper = _checked(self.lower, "lower"), _checked(self.upper, "upper")
        if upper == 0.0 and lower is None:
            lower = 0.0
        if lower is not None and upper is not None and lower > upper:
            raise ValueError(f"the lower bound {lower!r} exceeds the upper bound {upper!r}")
        object.__setattr__(self, "lower", lower)
        object.__setattr__(self, "upper", upper)

    @classmethod
    def exactly(cls, value: float) -> Bounds:
        """The number itself, up to floating-point rounding."""
        return cls(lower=value, upper=value)

    @classmethod
    def at_least(cls, value: float) -> Bounds:
        """A lower bound, and nothing about the other side."""
        return cls(lower=value, upper=None)

    @classmethod
    def at_most(cls, value: float) -> Bounds:
        """An upper bound, and nothing about the other side (which zero settles)."""
        return cls(lower=None, upper=value)

    @classmethod
    def between(cls, lower: float, upper: float) -> Bounds:
        """An enclosure."""
        return cls(lower=lower, upper=upper)

    @classmethod
    def unknown(cls) -> Bounds:
        """Neither side is known."""
        return cls(lower=None, upper=None)

    @property
    def side(self) -> Side:
        """Which kind of statement this is."""
        if self.lower is None:
            return "unknown" if self.upper is None else "upper bound"
        if self.upper is None:
            return "lower bound"
        return "exact" if self.lower == self.upper else "enclosure"

    @property
    def relative_width(self) -> float | None:
        """(upper - lower) / upper, from 0 (exact) to 1 (nothing excludes zero); None where a side is unknown."""
        if self.lower is None or self.upper is None:
            return None
        return 0.0 if self.lower == self.upper else (self.upper - self.lower) / self.upper

    def as_dict(self) -> dict[str, float | None]:
        """The two sides by name, ready for JSON."""
        return {"lower": self.lower, "upper": self.upper}

    def __str__(self) -> str:
        """For people, to 5 digits; a printed bound is rounded outwards, so that it stays a bound."""
        if self.lower is None:
            return "unknown" if self.upper is None else f"≤ {_short(self.upper, ROUND_CEILING)} (upper bound)"
        if self.upper is None:
            return f"≥ {_short(self.lower, ROUND_FLOOR)} (lower bound)"
        if self.lower == self.upper:
            return f"= {_short(self.lower, ROUND_HALF_EVEN)} (exact)"
        ends = f"[{_short(self.lower, ROUND_FLOOR)}, {_short(self.upper, ROUND_CEILING)}]"
        return f"in {ends} (enclosure, relative width {self.relative_width:.0e})"


def largest(*bounds: Bounds) -> Bounds:
    """What bounds on several numbers say about their maximum.

    One known lower bound serves; an upper bound needs all of them. Raises ValueError where none is given.
    """
    if not bounds:
        raise ValueError("the largest of no numbers is not defined: give at least one Bounds")
    lowers = [b.lower for b in bounds if b.lower is not None]
    uppers = [b.upper for b in bounds if b.upper is not None]
    return Bounds(lower=max(lowers, default=None), upper=max(uppers) if len(uppers) == len(bounds) else None)


def _checked(value: float | None, name: str) -> float | None:
    if value is None:
        return None
    number = float(value)
    if not math.isfinite(number) or number < 0.0:
        raise ValueError(f"the {name} bound of a distance is a finite number >= 0 or None, not {number!r}")
    return abs(number)  # -0.0 would be printed with its sign


def _short(value: float, rounding: str) -> str:
    if value == 0.0:
        return "0"
    rounded = Context(prec=_DIGITS, rounding=rounding).create_decimal_from_float(value)
    return f"{float(rounded):.{_DIGITS - 1}e}"
