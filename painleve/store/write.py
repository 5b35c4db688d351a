"""Datasets to files: whole or not at all, and where a disk fails, the result is kept on another one."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

import h5netcdf
import h5py
import xarray as xr
from xarray.backends import H5NetCDFStore

from painleve.errors import InputError
from painleve.notes import one_line
from painleve.store import read
from painleve.store.digest import seal
from painleve.store.schema import check_schema
from painleve.whole_file import remove_stale, try_place, write_whole

__all__ = ["check_output", "check_writable", "save"]

COMPRESSION = {"zlib": True, "complevel": 1, "shuffle": True}
SUFFIXES = (".h5", ".hdf5", ".nc", "")


def check_writable(path: str | Path) -> Path:
    """The path, if a file can be made there; ask before computing. Raises InputError that says why it cannot."""
    target = Path(path)
    try:
        reason = _obstacle(target)
        if reason is None:
            remove_stale(target.parent)
            try_place(target)
    except (OSError, ValueError) as error:
        reason = f"cannot be written ({_why(error)}); give another place"
    if reason is not None:
        raise InputError(f"output {one_line(str(target))}: {reason}")
    return target


def check_output(path: str | Path) -> Path:
    """The path, if a dataset can be written there, in a file that does not say it were something else.

    Raises InputError that says why it cannot.
    """
    suffix = Path(path).suffix
    if suffix.lower() not in SUFFIXES:
        raise InputError(f"output {one_line(str(path))}: datasets are HDF5, not {one_line(suffix)}; end it in .h5")
    return check_writable(path)


def save(dataset: xr.Dataset, path: str | Path) -> Path:
    """Write a dataset to HDF5, whole or not at all; an older file of that name is replaced.

    Raises InputError where the file cannot be written, which says where the dataset is kept instead; ValueError for a
    dataset that does not explain itself.
    """
    check_schema(dataset)
    target = check_output(path)
    content = _image(dataset)
    digest = hashlib.sha256(content).hexdigest()
    try:
        write_whole(target, content, seal(digest))
    except OSError as error:
        kept = _keep_elsewhere(target, content, seal(digest))
        raise InputError(f"output {target}: cannot be written ({_why(error)}); {kept}") from error
    read.trust(digest)
    return target


def _image(dataset: xr.Dataset) -> bytes:
    """The bytes of the file, made in memory: HDF5 crashes where a write of its own meets a full disk."""
    with h5py.File("in memory", "w", driver="core", backing_store=False, track_order=True) as file:
        with h5netcdf.File(file, "w") as root:
            dataset.dump_to_store(H5NetCDFStore(root), encoding=_encoding(dataset))
        file.flush()
        image: bytes = file.id.get_file_image()
        return image


def _encoding(dataset: xr.Dataset) -> dict[object, dict[str, object]]:
    """Numbers compressed and without a fill value (NaN stays NaN, bit for bit); text as it is."""
    encoding: dict[object, dict[str, object]] = {}
    for name, variable in dataset.variables.items():
        if variable.dtype.kind in "iuf":
            encoding[name] = {"_FillValue": None, **(COMPRESSION if variable.ndim else {})}
    return encoding


def _keep_elsewhere(target: Path, *content: bytes) -> str:
    """Where else the bytes were written, as the end of a sentence."""
    for folder in _shelters():
        name = ""
        try:
            handle, name = tempfile.mkstemp(dir=folder, prefix=f"painleve-{target.stem[:40]}-", suffix=".h5")
            with os.fdopen(handle, "wb") as file:
                file.writelines(content)
        except OSError:
            if name:
                os.unlink(name)
        else:
            return f"the result is kept in {name}"
    return "nor can the result be kept among the temporary files; free some space and run it again"


def _shelters() -> Iterator[Path]:
    """Folders that may stand on other disks than the one that failed."""
    for find in (lambda: Path(tempfile.gettempdir()), Path.home):
        try:
            yield find()
        except (OSError, RuntimeError):
            continue


def _obstacle(target: Path) -> str | None:
    try:
        os.fspath(target).encode("utf-8")
    except UnicodeEncodeError:
        return "its name is not text in UTF-8; give another name"
    if target.is_dir():
        return "is a folder; give the name of a file in it"
    if not target.parent.is_dir():
        return f"there is no folder {target.parent}; make it first"
    if target.exists() and not (target.is_file() and os.access(target, os.W_OK)):
        return "exists and may not be replaced; give another name"
    return None


def _why(error: Exception) -> str:
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return text.splitlines()[0] if text else type(error).__name__
