"""The one exception that a user's input can raise: a single line that says what, where and what to do."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

__all__ = ["InputError", "nearest"]


class InputError(ValueError):
    """Bad input from a user; its message is one line and ends up on stderr with exit status 2."""


def nearest(name: str, known: Iterable[str]) -> str:
    """For such a message: ` (did you mean NAME?)` where a known name is like this one, else nothing."""
    found = difflib.get_close_matches(name[:40], list(known), n=1)
    return f" (did you mean {found[0]}?)" if found else ""
