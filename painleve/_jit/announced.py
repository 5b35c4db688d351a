"""Compiling says what it compiles where it takes a second: numba tells when it does, which the cache spares."""

from __future__ import annotations

import re
from typing import Any

from numba.core import event

from painleve.progress import Work

__all__ = ["announce_compiling"]

_GENERATED = re.compile(r"(scene|motion)_(\w+)_[0-9a-f]{16}")
_WHAT = {"scene": "the kernels", "motion": "the motion"}


class _Compiling(event.Listener):
    """Functions that others call are compiled within their callers: the outermost one names the work."""

    def __init__(self) -> None:
        self.depth, self.work = 0, Work("")

    def on_start(self, event: Any) -> None:
        self.depth += 1
        if self.depth == 1:
            what = _name(event.data["dispatcher"].py_func.__module__)
            if self.work.told and what != self.work.what:
                self.work = Work(what)
            self.work.what = what
            self.work.start()

    def on_end(self, event: Any) -> None:
        self.depth -= 1
        if self.depth == 0:
            self.work.stop()


def announce_compiling() -> None:
    """From now on; called once."""
    event.register("numba:compile", _Compiling())


def _name(module: str) -> str:
    generated = _GENERATED.fullmatch(module)
    what = module if generated is None else f"{_WHAT[generated[1]]} of {generated[2]}"
    return f"compiling {what}, which later runs take from the cache"
