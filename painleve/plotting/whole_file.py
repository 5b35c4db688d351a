"""Files that are whole or not there: written aside, then moved into their place."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from painleve.errors import InputError

__all__ = ["written_aside"]


@contextmanager
def written_aside(target: Path, aside: Path) -> Iterator[None]:
    """What is written to `aside` inside becomes `target`. Raises InputError where the file cannot be written."""
    try:
        yield
        os.replace(aside, target)
    except OSError as error:
        raise InputError(
            f"output {target}: cannot be written ({error.strerror or error}); give another place"
        ) from error
    finally:
        aside.unlink(missing_ok=True)
