"""What a user should know although the answer stands: one line on stderr, short and without control characters."""

from __future__ import annotations

import contextlib
import sys

__all__ = ["one_line", "say"]

HEAD, TAIL = 400, 200  # characters of a long message that are shown: what is wrong stands first, what to do last


def one_line(text: str) -> str:
    """The text on one line of bounded length; what could command a terminal is shown as its escape."""
    line = " ".join(text.split()) if len(text) <= HEAD + TAIL else f"{text[:HEAD]} ... {text[-TAIL:]}"
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in " ".join(line.split()))


def say(text: str) -> None:
    """Print a note; a stream that is gone or full takes nothing away from the answer."""
    with contextlib.suppress(AttributeError, OSError, ValueError):  # pythonw has no stream, a daemon may have closed it
        print(f"painleve: note: {one_line(text)}", file=sys.stderr, flush=True)
