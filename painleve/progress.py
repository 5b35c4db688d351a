"""What long silent work says: one line on stderr after a second, in a run of the command line and nowhere else.

As a library the package prints nothing, unless a program asks for the lines with `reporting`.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from functools import wraps
from threading import Timer
from time import monotonic
from typing import ParamSpec, TypeVar

__all__ = ["Work", "reporting", "told", "working"]

AFTER = 1.0  # seconds of work before it is worth a line
QUIET = "PAINLEVE_QUIET"  # an environment variable: if it is set, nothing is said

P = ParamSpec("P")
T = TypeVar("T")

_sinks: list[Callable[[str], None]] = []


@contextlib.contextmanager
def reporting(sink: Callable[[str], None]) -> Iterator[None]:
    """Within this context long work is told to `sink`, a function of one line of text."""
    _sinks.append(sink)
    try:
        yield
    finally:
        _sinks.remove(sink)


@contextlib.contextmanager
def working(what: str) -> Iterator[None]:
    """Work that says what it is, such as "compiling the kernels of leg3", if it takes longer than a second."""
    work = Work(what)
    work.start()
    try:
        yield
    finally:
        work.stop()


def told(describe: Callable[..., str]) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """A decorator: a call of the function is work that `describe`, a function of the same arguments, puts in words."""

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        @wraps(function)
        def call(*arguments: P.args, **named: P.kwargs) -> T:
            with working(describe(*arguments, **named)):
                return function(*arguments, **named)

        return call

    return decorate


class Work:
    """Work that comes in pieces: it is told once, when the pieces together have taken a second."""

    def __init__(self, what: str) -> None:
        self.what, self.spent, self.told = what, 0.0, False
        self._timer: Timer | None = None

    def start(self) -> None:
        self._since = monotonic()
        if _sinks and not self.told and QUIET not in os.environ:
            self._timer = Timer(max(0.0, AFTER - self.spent), self._tell)
            self._timer.daemon = True
            self._timer.start()

    def stop(self) -> None:
        self.spent += monotonic() - self._since
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _tell(self) -> None:
        self.told = True
        for sink in _sinks[-1:]:
            sink(self.what)
