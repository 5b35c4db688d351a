"""Lanes of work on threads: what runs in compiled code without the interpreter's lock."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import TypeVar

from painleve.errors import InputError

__all__ = ["as_they_finish", "thread_count"]

MOST_THREADS = 256  # or four for each core, if that is more: each takes memory, and beyond the cores none is faster

T = TypeVar("T")


def thread_count(threads: int | None) -> int:
    """The number asked for, by default one for each core. Raises InputError unless it is from 1 to the most."""
    cores = os.cpu_count() or 1
    if threads is None:
        return cores
    most = max(MOST_THREADS, 4 * cores)
    if not 1 <= threads <= most:
        raise InputError(f"threads: {threads} must be at least 1 and at most {most}; this machine has {cores} cores")
    return threads


def as_they_finish(lane: Callable[[int], T], firsts: Iterable[int], threads: int | None) -> Generator[T, None, None]:
    """lane(first) for every first, in the order in which they finish; None for threads: one a processor.

    A bounded number is in flight, and what has not begun is dropped when the generator is closed.
    """
    count, left = thread_count(threads), iter(firsts)
    pool = ThreadPoolExecutor(count)
    pending: set[Future[T]] = set()
    try:
        while True:
            for first in left:
                pending.add(pool.submit(lane, first))
                if len(pending) >= 2 * count:
                    break
            if not pending:
                return
            done, pending = wait(pending, return_when=FIRST_COMPLETED)
            for future in done:
                yield future.result()
    finally:
        pool.shutdown(cancel_futures=True)
