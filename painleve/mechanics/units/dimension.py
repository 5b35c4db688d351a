"""The unit of a formula from those of its symbols: sums need equal units, functions pure numbers.

A unit is a product of powers of base units and a factor, so that millimetres beside metres show, and degrees, which no
formula here takes. Radians are pure numbers. What a number written in a formula stands for is not known: small whole
numbers and fractions of them count as pure, and of any other `lenient` lets the unit be whatever agrees.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from typing import Any

import sympy as sp

from painleve.errors import InputError

__all__ = ["PURE", "Disagreement", "Unit", "read_unit", "unit_of"]

SMALL = 24  # above it a whole number, or a part of a fraction, may be a quantity: 9.81 is 981/100
SAME = 1e-9  # relative, of factors
LONGEST = 60  # characters of a formula in a sentence
_WORD = r"[A-Za-z\u00b0\u00b5\u03a9%]+"
_WRITTEN = re.compile(rf"(?:1|{_WORD}|[*/·() ]|(?:\^|\*\*)-?[0-9])+")


class Disagreement(Exception):
    """Where units do not agree, in one sentence."""


@dataclass(frozen=True)
class Unit:
    """Powers of base units and the logarithm of a factor; `free`: any unit, of a number whose own is not known."""

    powers: Mapping[str, Fraction] = field(default_factory=dict)
    log_factor: float = 0.0
    free: bool = False

    def times(self, other: Unit, power: Fraction = Fraction(1)) -> Unit:
        powers = {
            name: self.powers.get(name, Fraction(0)) + power * other.powers.get(name, Fraction(0))
            for name in {*self.powers, *other.powers}
        }
        kept = {name: p for name, p in powers.items() if p != 0}
        return Unit(kept, self.log_factor + float(power) * other.log_factor, self.free or other.free)

    def agrees(self, other: Unit) -> bool:
        if self.free or other.free:
            return True
        return self.powers == other.powers and abs(self.log_factor - other.log_factor) < SAME

    def __str__(self) -> str:
        if self.free:
            return "any unit"
        words = [name if p == 1 else f"{name}^{p}" for name, p in sorted(self.powers.items())]
        factor = [] if abs(self.log_factor) < SAME else [f"{math.exp(self.log_factor):.6g}"]
        return " ".join([*factor, *words]) or "1"


PURE, ANY = Unit(), Unit(free=True)


@lru_cache(maxsize=1)
def _registry() -> Any:
    try:
        import pint
    except ImportError:
        raise InputError("pint is not installed; painleve[units] brings it, or pip install pint") from None
    return pint.UnitRegistry()


@lru_cache(maxsize=256)
def read_unit(text: str) -> Unit:
    """The unit that a text such as "kg m^2" or "1" names. Raises Disagreement for one that pint does not know.

    Raises InputError without pint.
    """
    registry = _registry()
    if not _WRITTEN.fullmatch(text):
        raise Disagreement(f"{text!r} is not written as a unit")
    try:
        quantity = 1 * registry.parse_units("" if text == "1" else text)
        base = quantity.to_base_units()
        factor = math.log(base.magnitude)
    except Exception as error:  # pint's own are of many kinds, and it knows tokens that are no units at all
        raise Disagreement(f"{text!r} is no unit that is known: {' '.join(str(error).split())[:80]}") from None
    named = {f"{registry.Unit(name):~}": Fraction(power).limit_denominator(100) for name, power in base.unit_items()}
    return Unit({name: power for name, power in named.items() if name != "rad"}, factor)


def unit_of(expression: sp.Expr, units: Mapping[sp.Symbol, Unit], *, lenient: bool) -> Unit:
    """The unit of a formula. Raises Disagreement. `lenient`: numbers that are not small have any unit."""
    if expression.is_Rational:
        small = abs(expression.p) <= SMALL and expression.q <= SMALL
        return ANY if expression == 0 or (lenient and not small) else PURE
    if expression.is_Symbol:
        return units[expression]
    if expression.is_Atom:
        return PURE
    parts = [unit_of(part, units, lenient=lenient) for part in expression.args]
    if expression.is_Add or isinstance(expression, sp.Max | sp.Min):
        return _common(expression, parts)
    if expression.is_Mul:
        total = PURE
        for part in parts:
            total = total.times(part)
        return total
    if expression.is_Pow and expression.exp.is_Rational:
        return PURE.times(parts[0], Fraction(int(expression.exp.p), int(expression.exp.q)))
    if isinstance(expression, sp.Abs):
        return parts[0]
    if isinstance(expression, sp.atan2):
        _common(expression, parts)
        return PURE
    if isinstance(expression, sp.sign):
        return PURE
    for argument, part in zip(expression.args, parts, strict=True):
        if not part.agrees(PURE):
            raise Disagreement(f"{_shown(expression)} is taken of {_shown(argument)}, which has the unit {part}")
    return PURE


def _common(expression: sp.Expr, parts: list[Unit]) -> Unit:
    """The unit of all parts of a sum; one that may have any follows the others."""
    known = [(part, unit) for part, unit in zip(expression.args, parts, strict=True) if not unit.free]
    if not known:
        return ANY
    first, wanted = known[0]
    for part, unit in known[1:]:
        if not unit.agrees(wanted):
            raise Disagreement(f"{_shown(first)} [{wanted}] and {_shown(part)} [{unit}] are added")
    return wanted


def _shown(expression: sp.Expr) -> str:
    text = str(expression)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
