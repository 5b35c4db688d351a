"""Folders of compiled code that nobody uses any more: every change of the sources leaves one behind."""

from __future__ import annotations

import os
import re
import shutil
import stat
import time
from pathlib import Path

__all__ = ["remove_old_folders"]

_DIGEST = re.compile(r"[0-9a-f]{16}", re.ASCII)
DAY = 24 * 3600.0
UNUSED = 60 * DAY  # after which a folder goes
RECENT = DAY  # within which a process may still be using it: it stays
MOST_BYTES = 1 << 30  # of all folders together; the ones used last stay


def remove_old_folders(root: Path, handle: int, *, keep: str) -> None:
    """Take away what the user's own root, opened as `handle`, holds of folders that are old or too much.

    A folder was last used when it was last changed: every process that uses it sets that time. What is not a folder of
    this cache, or not the user's, is left alone, and so is what cannot be removed.
    """
    now, total = time.time(), _size(root / keep)
    for used, name in sorted(_folders(handle), reverse=True):
        if name != keep:
            total += _size(root / name)
            if now - used > UNUSED or (total > MOST_BYTES and now - used > RECENT):
                shutil.rmtree(name, ignore_errors=True, dir_fd=handle)


def _folders(handle: int) -> list[tuple[float, str]]:
    """(last use, name) of the folders of this cache."""
    found = []
    with os.scandir(handle) as entries:
        for entry in entries:
            status = entry.stat(follow_symlinks=False)
            if _DIGEST.fullmatch(entry.name) and stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid():
                found.append((status.st_mtime, entry.name))
    return found


def _size(folder: Path) -> int:
    """Bytes of the files in a folder and in those below."""
    return sum((Path(place) / name).lstat().st_size for place, _, names in os.walk(folder) for name in names)
