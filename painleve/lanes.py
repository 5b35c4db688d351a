"""Lanes of work on threads: what runs in compiled code without the interpreter's lock."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import TypeVar

__all__ = ["as_they_finish"]

T = TypeVar("T")


def as_they_finish(lane: Callable[[int], T], firsts: Iterable[int], threads: int | None) -> Generator[T, None, None]:
    """lane(first) for every first, in the order in which they finish; None for threads: one a processor.

    A bounded number is in flight, and what has not begun is dropped when the generator is closed.
    """
    count, left = threads or os.cpu_count() or 1, iter(firsts)
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
