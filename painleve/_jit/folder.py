"""The folder of generated and compiled code: named by a digest of its sources, and used only if it is the user's own.

What is found there is run, so it has to be the user's: the folders belong to them and nobody else may write in them,
and neither in the files. That is asked of an opened folder, through whose handle its files are then reached: no name
can be exchanged in between.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import platform
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path

from painleve._jit.old_folders import remove_old_folders
from painleve.notes import say
from painleve.whole_file import remove_stale, write_whole

__all__ = ["CACHE", "CacheFolder", "choose_folder"]

# Only these import numba; an import contract of pyproject.toml holds it. What the kernels print from a scene stands in
# files that are named by a digest of their own text.
COMPILED_SOURCES = ("_jit", "core", "kernels")
LIBRARIES = ("numba", "llvmlite", "numpy")
OTHERS_MAY_WRITE = stat.S_IWGRP | stat.S_IWOTH


class CacheFolder:
    """Files by name: what is read was written by this user, and a disk that fails costs time and no answer."""

    def __init__(self, path: Path | None) -> None:
        """`path`: a folder from `choose_folder`, or None: nothing is kept."""
        self.path = path
        self._written = False
        self._reported: set[str] = set()

    def place(self, name: str) -> Path:
        """Where a file of that name stands, or would stand."""
        return (self.path or Path()) / name

    def read(self, name: str) -> bytes | None:
        """The content of a file; None if there is none that can be trusted."""
        if self.path is None:
            return None
        try:
            with _opened(self.path) as folder:
                return _read(name, folder)
        except FileNotFoundError:
            return None
        except OSError as error:
            self.report(name, f"{error.strerror or error}; it is not used")
            return None

    def report(self, name: str, what: str) -> None:
        """A line about a file that is not as it should be; of all that have the same fault, about the first."""
        if what not in self._reported:
            self._reported.add(what)
            say(f"cache {self.place(name)}: {what}")

    def write(self, name: str, content: bytes) -> None:
        """Keep a file; after the first failure, of which a line is said, nothing more is kept."""
        if self.path is None:
            return
        try:
            if not self._written:
                remove_stale(self.path)
                self._written = True
            write_whole(self.path / name, content, durable=False)
        except OSError as error:
            say(f"cache {self.path}: cannot be written ({error.strerror or error}); compiled code stays in memory")
            self.path = None


def choose_folder(digest: str) -> CacheFolder:
    """The folder of that name in the first root that can be used, of all that are tried.

    They are $PAINLEVE_CACHE_DIR, the user's cache folder, and one beside the temporary files. A line says why one was
    passed over.
    """
    refused = ""
    for root in _roots():
        try:
            found = _prepared(root, digest)
        except OSError as error:
            refused = refused or f"cache {root}: {error.strerror or error}"
        else:
            if refused:
                say(f"{refused}; compiled code is kept in {root}")
            return CacheFolder(found)
    say(f"{refused}; compiled code is not kept, and every run compiles anew")
    return CacheFolder(None)


def _roots() -> Iterator[Path]:
    named = os.environ.get("PAINLEVE_CACHE_DIR")
    if named:
        yield Path(os.path.realpath(named))
    base = os.environ.get("XDG_CACHE_HOME")
    with contextlib.suppress(RuntimeError):  # no HOME, and no user of that number
        yield Path(os.path.realpath(base or Path.home() / ".cache")) / "painleve"
    yield Path(tempfile.gettempdir()) / f"painleve-{os.geteuid()}"


def _prepared(root: Path, digest: str) -> Path:
    """The folder, made if need be, with its root. Raises OSError, which says why they cannot be used."""
    root.mkdir(mode=0o700, parents=True, exist_ok=True)
    with _opened(root) as handle:
        try:
            os.mkdir(digest, 0o700, dir_fd=handle)
        except FileExistsError:
            pass
        else:
            remove_old_folders(root, handle, keep=digest)
        with _opened(digest, handle) as folder:
            os.utime(folder)  # when it was last used
    return root / digest


@contextmanager
def _opened(path: Path | str, inside: int | None = None) -> Iterator[int]:
    """A handle of a folder that is the user's own. Raises OSError for any other."""
    handle = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC, dir_fd=inside)
    try:
        _check_own(os.fstat(handle))
        yield handle
    finally:
        os.close(handle)


def _read(name: str, folder: int) -> bytes:
    handle = os.open(name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC, dir_fd=folder)
    with os.fdopen(handle, "rb") as file:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EPERM, "is not a file")
        _check_own(status)
        return file.read()


def _check_own(status: os.stat_result) -> None:
    if status.st_uid != os.geteuid():
        raise PermissionError(errno.EPERM, "belongs to another user")
    if status.st_mode & OTHERS_MAY_WRITE:
        raise PermissionError(errno.EPERM, "others may write there (chmod go-w takes that away)")


def _sources_digest() -> str:
    digest = hashlib.sha256()
    versions = [metadata.version(name) for name in LIBRARIES]
    digest.update(" ".join([*versions, platform.python_version()]).encode())
    root = Path(__file__).parents[1]
    for path in sorted(p for p in root.rglob("*.py") if p.relative_to(root).parts[0] in COMPILED_SOURCES):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


CACHE = choose_folder(_sources_digest())
