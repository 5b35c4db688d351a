"""Datasets to HDF5 and back: never half a file, never a variable without a unit and a sentence.

Files are written through h5netcdf, so that `xarray.open_dataset(path, engine="h5netcdf")` reads them without this
package. A file is written aside, flushed to the disk and moved into place: who stops the program at any moment finds
the old file or the new one.
"""

from __future__ import annotations

import json
import os
import platform
import shlex
import subprocess
import sys
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from painleve.errors import InputError

if TYPE_CHECKING:
    from painleve.mechanics.scene import Scene

__all__ = [
    "NOT_RUN",
    "PROVENANCE",
    "check_schema",
    "check_writable",
    "flags",
    "labels_of",
    "load",
    "provenance",
    "save",
]

NOT_RUN = 0  # the code of a point that nobody computed, so that an outer merge can fill codes and keep them integers
PROVENANCE = (
    "painleve_version",
    "git_commit",
    "scene",
    "scene_digest",
    "seed",
    "platform",
    "python_version",
    "library_versions",
    "command",
    "created",
)
LIBRARIES = ("numpy", "scipy", "sympy", "numba", "python-flint", "xarray", "h5netcdf", "h5py")
COMPRESSION = {"zlib": True, "complevel": 1, "shuffle": True}


def flags(labels: Sequence[str]) -> dict[str, object]:
    """CF attributes of a code: 0 is `not_run`, the labels count from 1. Store such a variable as int8."""
    values = np.arange(len(labels) + 1, dtype=np.int8)
    return {"flag_values": values, "flag_meanings": " ".join(["not_run", *labels]), "units": "1"}


def labels_of(code: xr.DataArray) -> np.ndarray:
    """The meanings of a variable of codes, in its shape."""
    values = np.atleast_1d(code.attrs["flag_values"]).tolist()
    meanings = dict(zip(values, code.attrs["flag_meanings"].split(), strict=True))
    return np.vectorize(meanings.__getitem__, otypes=[object])(code.values)


def provenance(*, scene: Scene | str, scene_digest: str, seed: int, command: str | None = None) -> dict[str, str]:
    """Where a dataset comes from, as text attributes; `command` defaults to the command line of this process.

    `scene` is the scene, or the names of several. One that was read from a file leaves the file's text as `scene_text`:
    written to a file again, it is the scene of this dataset.
    """
    from_file = {} if isinstance(scene, str) or not scene.text else {"scene_file": scene.file, "scene_text": scene.text}
    versions = {name: metadata.version(name) for name in LIBRARIES}
    line = shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]])
    return {
        "painleve_version": metadata.version("painleve"),
        "git_commit": _git_commit(),
        "scene": scene if isinstance(scene, str) else scene.name,
        "scene_digest": scene_digest,
        "seed": str(seed),
        "platform": platform.platform(),
        "python_version": platform.python_version(),
        "library_versions": json.dumps(versions, sort_keys=True),
        "command": line if command is None else command,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        **from_file,
    }


def check_schema(dataset: xr.Dataset) -> None:
    """Raises ValueError, which names the variable and what it lacks, unless the dataset explains itself.

    Every variable needs `units` and a sentence `long_name`; an int8 variable is a code and needs `flag_values` and
    `flag_meanings` with `not_run`; the dataset needs a title, a kind and its provenance; attributes are text, numbers
    or arrays of numbers.
    """
    for name, variable in dataset.variables.items():
        _check_variable(str(name), variable)
    for name in ("title", "kind", *PROVENANCE):
        value = dataset.attrs.get(name)
        if not (isinstance(value, str) and value):
            raise ValueError(f"the dataset lacks the attribute {name}, which has to be text")
    _check_attributes("the dataset", dataset.attrs)


def check_writable(path: str | Path) -> Path:
    """The path, if a file can be made there; ask before computing. Raises InputError that says why it cannot."""
    target = Path(path)
    try:
        reason = _obstacle(target)
        if reason is None:
            aside = _aside(target)
            aside.touch()
            aside.unlink()
    except (OSError, ValueError) as error:
        reason = f"cannot be written ({_why(error)}); give another place"
    if reason is not None:
        raise InputError(f"output {target}: {reason}")
    return target


def save(dataset: xr.Dataset, path: str | Path) -> Path:
    """Write a dataset to HDF5, whole or not at all; an older file of that name is replaced.

    Raises InputError where the file cannot be written, ValueError for a dataset that does not explain itself.
    """
    check_schema(dataset)
    target = check_writable(path)
    aside = _aside(target)
    try:
        dataset.to_netcdf(aside, engine="h5netcdf", encoding=_encoding(dataset))
        _flush(aside)
        os.replace(aside, target)
        _flush(target.parent)
    except OSError as error:
        raise InputError(f"output {target}: cannot be written ({_why(error)}); give another place") from error
    finally:
        aside.unlink(missing_ok=True)
    return target


def load(path: str | Path) -> xr.Dataset:
    """Read a dataset into memory. Raises InputError for a missing file and for one that `save` did not write."""
    source = Path(path)
    try:
        if not source.is_file():
            raise InputError(f"input {source}: there is no such file")
        dataset = xr.load_dataset(source, engine="h5netcdf")
        check_schema(dataset)
    except InputError:
        raise
    except (OSError, ValueError, KeyError) as error:
        raise InputError(f"input {source}: not a dataset of this package ({_why(error)})") from None
    return dataset


def _obstacle(target: Path) -> str | None:
    if target.is_dir():
        return "is a folder; give the name of a file in it"
    if not target.parent.is_dir():
        return f"there is no folder {target.parent}; make it first"
    if target.exists() and not (target.is_file() and os.access(target, os.W_OK)):
        return "exists and may not be replaced; give another name"
    return None


def _check_variable(name: str, variable: xr.Variable) -> None:
    for attribute, meaning in (("units", "a unit (1 if it has none)"), ("long_name", "a sentence")):
        value = variable.attrs.get(attribute)
        if not (isinstance(value, str) and value):
            raise ValueError(f"variable {name} lacks {attribute}: {meaning}")
    if len(variable.attrs["long_name"].split()) < 3:
        raise ValueError(f"variable {name}: its long_name {variable.attrs['long_name']!r} is not a sentence")
    if variable.dtype == np.int8:
        _check_code(name, variable)
    _check_attributes(f"variable {name}", variable.attrs)


def _check_code(name: str, variable: xr.Variable) -> None:
    values = np.atleast_1d(variable.attrs.get("flag_values", np.empty(0, np.int8)))
    meanings = str(variable.attrs.get("flag_meanings", "")).split()
    if len(values) != len(meanings) or dict(zip(values.tolist(), meanings, strict=True)).get(NOT_RUN) != "not_run":
        raise ValueError(f"code {name} needs flag_values and flag_meanings, with {NOT_RUN} for not_run")
    strange = set(np.unique(variable.values).tolist()) - set(values.tolist())
    if strange:
        raise ValueError(f"code {name} has values without a meaning: {sorted(strange)}")


def _check_attributes(where: str, attributes: Mapping[object, object]) -> None:
    for name, value in attributes.items():
        kind = np.asarray(value).dtype.kind
        if not (isinstance(value, str) or kind in "iuf"):
            raise ValueError(f"{where}: attribute {name} is neither text nor numbers; keep it as JSON text")


def _encoding(dataset: xr.Dataset) -> dict[object, dict[str, object]]:
    """Numbers compressed and without a fill value (NaN stays NaN, bit for bit); text as it is."""
    encoding: dict[object, dict[str, object]] = {}
    for name, variable in dataset.variables.items():
        if variable.dtype.kind in "iuf":
            encoding[name] = {"_FillValue": None, **(COMPRESSION if variable.ndim else {})}
    return encoding


def _aside(target: Path) -> Path:
    return target.with_name(f".{target.name}.{os.getpid()}.part")


def _flush(path: Path) -> None:
    """To the disk: a rename that survives a power cut of a file that does not would be worse than none."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _why(error: Exception) -> str:
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return text.splitlines()[0] if text else type(error).__name__


def _git_commit() -> str:
    """The commit of the checkout that this package is imported from, marked if files differ from it; or "unknown"."""
    root = Path(__file__).parents[1]
    if not (root / ".git").exists():
        return "unknown"
    try:
        commit = _git(root, "rev-parse", "HEAD")
        changed = _git(root, "status", "--porcelain", "--untracked-files=no")
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return f"{commit} with changes" if changed else commit


def _git(root: Path, *arguments: str) -> str:
    run = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True, check=True, timeout=10)
    return run.stdout.strip()
