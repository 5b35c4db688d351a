"""Files to datasets: checked before they are used, because a result file may be damaged, or made by anybody.

The HDF5 library can crash, loop for ever or take all memory over bytes that it did not write. So a file that this
process does not know is looked at by a short-lived process first (painleve.store.contents), within limits.
"""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any, BinaryIO

import xarray as xr

from painleve.errors import InputError
from painleve.notes import one_line
from painleve.store import contents
from painleve.store.digest import Damaged, content_digest
from painleve.store.schema import check_schema

__all__ = ["load", "trust"]

_trusted: set[str] = set()  # digests of what this process wrote, or had looked at
# Every value is what stands in the file: no fill values, no offsets and scales, no dates.
DECODING: Any = {"mask_and_scale": False, "decode_times": False, "decode_timedelta": False, "concat_characters": False}


def load(path: str | Path) -> xr.Dataset:
    """Read a dataset into memory. Raises InputError for a missing or damaged file, and for one of another build.

    Nothing outside the file is followed, and no more memory is used than half of the machine's.
    """
    source = Path(path)
    try:
        with _opened(source) as file:
            digest = content_digest(file)
        if digest not in _trusted:
            _look_at(source)
            trust(digest)
        dataset = _read(source)
        check_schema(dataset)
    except InputError:
        raise
    except Damaged:
        raise InputError(
            f"input {one_line(str(source))}: was damaged after it was written; take another copy, or compute it again"
        ) from None
    except Exception as error:  # whatever the libraries raise over bytes that are not theirs
        raise InputError(f"input {one_line(str(source))}: not a dataset of this package ({_why(error)})") from None
    return dataset


def trust(digest: str) -> None:
    """From now on, this process reads a file with that content without having it looked at."""
    _trusted.add(digest)


def _opened(source: Path) -> BinaryIO:
    """The file, if it is one: a pipe would make an open() wait for ever."""
    if not os.path.exists(source):
        raise InputError(f"input {one_line(str(source))}: there is no such file")
    handle = os.open(source, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise InputError(f"input {one_line(str(source))}: is not a file")
    return os.fdopen(handle, "rb")


def _look_at(source: Path) -> None:
    """Raises ValueError that says what is strange about a file, found by a process that may fail."""
    command = [sys.executable, "-P", contents.__file__, str(source.absolute())]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    patience = contents.SECONDS + source.stat().st_size / contents.BYTES_PER_SECOND
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=10 * patience, env=environment, check=False
        )
    except subprocess.TimeoutExpired:
        raise ValueError("reading it does not end") from None
    if done.returncode == contents.STRANGE:
        raise ValueError(done.stdout.decode(errors="replace"))
    if done.returncode != 0:
        raise ValueError("reading it takes too long, too much memory, or stops the HDF5 library")


def _read(source: Path) -> xr.Dataset:
    variables, attributes = contents.read_contents(source)
    return xr.decode_cf(xr.Dataset(dict(variables), attrs=dict(attributes)), **DECODING)


def _why(error: Exception) -> str:
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return one_line(text) if text else type(error).__name__
