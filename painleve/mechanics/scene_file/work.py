"""What keeps the algebra on a stranger's formulas bounded: sizes counted before they are made, and a budget of calls.

The budget counts calls and not seconds, so that a file is accepted or refused whatever else the machine does.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from types import FrameType

import sympy as sp

__all__ = ["TooMuchWork", "limited_calls", "nodes_of", "terms_of"]


class TooMuchWork(BaseException):
    """The budget of calls is used up. Not an Exception, so that no handler on the way takes it for one of its own."""


def terms_of(expression: sp.Expr) -> int:
    """A bound on the number of terms that expanding an expression makes, in it or in any part of it."""
    return max(_terms(expression, {}))


def _terms(expression: sp.Expr, known: dict[sp.Expr, tuple[int, int]]) -> tuple[int, int]:
    """(terms of the expanded expression, the most terms of any part of it)."""
    if expression not in known:
        known[expression] = _count(expression, [_terms(part, known) for part in expression.args])
    return known[expression]


def _count(expression: sp.Expr, parts: list[tuple[int, int]]) -> tuple[int, int]:
    most = max((m for _, m in parts), default=1)
    terms = 1
    if expression.is_Add:
        terms = sum(n for n, _ in parts)
    elif expression.is_Mul:
        terms = math.prod(n for n, _ in parts)
    elif expression.is_Pow and expression.exp.is_Rational:
        whole = abs(expression.exp.p) // expression.exp.q
        expanded = math.comb(parts[0][0] + whole - 1, whole)
        terms, most = (expanded if expression.exp > 0 else 1), max(most, expanded)
    return terms, max(most, terms)


def nodes_of(expressions: Iterable[sp.Expr]) -> int:
    """Numbers, names and operations of the expressions as they would be written out, repeated parts each time."""
    known: dict[sp.Basic, int] = {}

    def count(expression: sp.Basic) -> int:
        if expression not in known:
            known[expression] = 1 + sum(count(part) for part in expression.args)
        return known[expression]

    return sum(count(expression) for expression in expressions)


@contextmanager
def limited_calls(most: int) -> Iterator[None]:
    """Raises TooMuchWork from whatever runs inside once it has made `most` calls of Python functions.

    Counted by the hook for profilers, which interrupts algebra anywhere, in any thread and on any system; where a
    profiler already uses it, somebody watches, and nothing is counted.
    """
    left = most

    def hook(frame: FrameType, event: str, argument: object) -> None:
        nonlocal left
        if event == "call":
            left -= 1
            if left < 0:
                raise TooMuchWork

    def rearm(swallowed: sys.UnraisableHookArgs) -> None:
        """A finaliser cannot raise: Python drops what the hook raised there, and the hook with it."""
        if swallowed.exc_type is TooMuchWork:
            sys.setprofile(hook)
        else:
            previous(swallowed)

    if sys.getprofile() is not None:
        yield
        return
    previous = sys.unraisablehook
    sys.unraisablehook = rearm
    sys.setprofile(hook)
    try:
        yield
    finally:
        sys.setprofile(None)
        sys.unraisablehook = previous
