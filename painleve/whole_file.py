"""Files that are whole or not there: written aside, flushed to the disk, then moved into their place.

A file aside is called `.NAME.TOKEN.PID.part` and locked while its process writes. What a killed process left behind is
known by that: its owner is the user, its process is gone, and nobody holds the lock, on no machine that shares the
folder. The next file that is written there takes it away.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from painleve.errors import InputError

__all__ = ["flush_folder", "remove_stale", "said_of", "try_place", "write_whole", "written_aside"]

_ASIDE = re.compile(r"\..+\.(?P<pid>[0-9]{1,10})\.part(\.[a-z]+)?", re.ASCII)


def write_whole(target: Path, *content: bytes | memoryview, durable: bool = True) -> None:
    """Make the bytes, one after the other, the content of `target`; an older file stays until then. Raises OSError.

    `durable`: not even a power cut loses both the old file and the new one.
    """
    with _aside(target, "") as (handle, path):
        for part in content:
            left = memoryview(part)
            while left:
                left = left[os.write(handle, left) :]
        if durable:
            os.fsync(handle)
        os.replace(path, target)
    if durable:
        flush_folder(target.parent)


@contextmanager
def written_aside(target: Path, ending: str = "") -> Iterator[Path]:
    """The path of an empty file, for a writer that wants a path; what it wrote there becomes `target` at the end.

    `ending`: of the path's name, for a writer that looks at it. Raises InputError where the file cannot be written.
    """
    with said_of(target), _aside(target, ending) as (_, path):
        yield path
        os.replace(path, target)


@contextmanager
def said_of(target: Path) -> Iterator[None]:
    """Inside, what stops a file from being written is an InputError that names the file."""
    try:
        yield
    except OSError as error:
        raise InputError(
            f"output {target}: cannot be written ({error.strerror or error}); give another place"
        ) from error


def try_place(target: Path) -> None:
    """Raises OSError where no file of that name can be made."""
    with contextlib.suppress(FileNotFoundError):
        os.lstat(target)  # of a name that is too long, say
    with _aside(target, ""):
        pass


def remove_stale(folder: Path) -> None:
    """Take away what killed processes of this user left in a folder; what cannot be looked at or removed stays."""
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            found = _ASIDE.fullmatch(entry.name)
            if found and not _is_running(int(found["pid"])):
                with contextlib.suppress(OSError):
                    _remove_if_left(entry.path)


def flush_folder(folder: Path) -> None:
    """To the disk: a rename that survives a power cut of a file that does not would be worse than none."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def _aside(target: Path, ending: str) -> Iterator[tuple[int, Path]]:
    """An empty, locked file beside the target, opened for writing; it is gone afterwards, unless it was moved."""
    path = target.with_name(f".{target.name[:40]}.{secrets.token_hex(4)}.{os.getpid()}.part{ending}")
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    try:
        with contextlib.suppress(OSError):  # not every file system has locks
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield handle, path
    finally:
        path.unlink(missing_ok=True)
        os.close(handle)


def _is_running(pid: int) -> bool:
    """Whether a process of this user has that number; one of another user did not write the user's file."""
    try:
        os.kill(pid, 0)
    except (OSError, OverflowError):
        return False
    return True


def _remove_if_left(path: str) -> None:
    """Raises OSError where somebody, on this machine or another one, holds the lock."""
    handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        status = os.fstat(handle)
        if stat.S_ISREG(status.st_mode) and status.st_uid == os.geteuid():
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.unlink(path)
    finally:
        os.close(handle)
