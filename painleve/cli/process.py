"""What a command owes to who started it: it ends when it is told to, and prints what the other side can read."""

from __future__ import annotations

import contextlib
import io
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

__all__ = ["drop_output", "ended_by", "print_anything", "terminable"]


@contextmanager
def terminable() -> Iterator[list[int]]:
    """Inside, SIGTERM interrupts as Ctrl-C does; the list holds it once it was heard.

    Only the first counts, so that what there is can be written: `timeout`, for one, sends it twice. A process that was
    started to ignore the signal goes on ignoring it.
    """
    heard: list[int] = []

    def interrupt(number: int, frame: FrameType | None) -> None:
        if not heard:
            heard.append(number)
            raise KeyboardInterrupt

    listens = threading.current_thread() is threading.main_thread()
    if not listens or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield heard
        return
    signal.signal(signal.SIGTERM, interrupt)
    try:
        yield heard
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def ended_by(number: int) -> int:
    """The exit status of a command that a signal ended."""
    return 128 + number


def print_anything() -> None:
    """What the encoding of an output cannot say is printed as an escape, and stops nobody."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
            stream.reconfigure(errors="backslashreplace")


def drop_output() -> None:
    """Whatever is still to be printed goes nowhere: the reader is gone, or the disk under it is full."""
    with contextlib.suppress(AttributeError, OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
