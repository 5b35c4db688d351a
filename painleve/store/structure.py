"""How an HDF5 file is built, looked at in a process of its own: `python structure.py FILE`.

Status 0: it is built as this package builds its files, and all of it can be read. Status STRANGE: it is not, and
standard output says why. Any other status: the HDF5 library crashed, looped or ran out of memory over it, which
nothing can prevent from inside. This file imports nothing of the package, so that the process starts fast.
"""

from __future__ import annotations

import contextlib
import os
import resource
import sys
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
from h5py import h5a, h5d, h5o, h5s, h5t, h5z

__all__ = ["Strange", "check_structure"]

MOST_VARIABLES = 1000
MOST_ATTRIBUTES = 64  # of one variable
MOST_TEXT = 1 << 16  # bytes of an attribute
MOST_NUMBERS = 1024  # in an attribute
MOST_NAME = 100  # bytes
MOST_RANK = 8
MOST_TEXTS = 1 << 28  # bytes of all text
MOST_OF_MEMORY = 0.5
MOST_CHUNK = 1 << 26  # bytes
BEST_COMPRESSION = 1100  # deflate reaches 1032

STRANGE = 3
SECONDS, MORE_MEMORY = 5, 1 << 30  # of processor, and bytes beyond the libraries, for all that is not numbers
BYTES_PER_SECOND = 20e6  # slower than any disk and any decompression

# How dimensions stand in netCDF-4 files, which h5netcdf reads and nobody else sees.
DIMENSIONS = frozenset(
    (
        *("CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST"),
        *("_Netcdf4Dimid", "_Netcdf4Coordinates", "_NCProperties", "_nc3_strict"),
    )
)
NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable"
FILTERS = frozenset((h5z.FILTER_DEFLATE, h5z.FILTER_SHUFFLE, h5z.FILTER_FLETCHER32))
NUMBERS = tuple(
    h5t.py_create(np.dtype(order + code))
    for code in ("i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f4", "f8")
    for order in "<>"
)


class Strange(ValueError):
    """What is strange about a file."""


def check_structure(path: str | Path, allow: Callable[[int], None] = lambda size: None) -> None:
    """Raises Strange, or whatever the HDF5 library does, unless the file holds variables alone, and can be read.

    Variables stand in the root, are whole and in the file itself (no links, no groups, no virtual or external data),
    hold plain numbers or text, and so do their attributes, within limits. `allow` hears of the size of the numbers
    before they are read.
    """
    with h5py.File(path, "r") as file:
        if len(file) > MOST_VARIABLES:
            raise Strange(f"it holds more than {MOST_VARIABLES} variables")
        _check_attributes("the file", file.id)
        variables = {name: _variable(file, name) for name in file}
        size = sum(_check_variable(name, variable) for name, variable in variables.items())
        if size > MOST_OF_MEMORY * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"):
            raise Strange(f"its values take {size / 1e9:.3g} GB, more than half of this machine's memory")
        allow(size)
        if sum(_read(name, variable) for name, variable in variables.items()) > MOST_TEXTS:
            raise Strange(f"it holds more than {MOST_TEXTS} bytes of text")


def _variable(file: h5py.File, name: str) -> h5d.DatasetID:
    if len(name.encode()) > MOST_NAME or not name.isprintable():
        raise Strange("a variable has a name that is too long, or not printable")
    if not isinstance(file.get(name, getlink=True), h5py.HardLink):
        raise Strange(f"{name} is a link")
    found = h5o.open(file.id, name.encode())
    if not isinstance(found, h5d.DatasetID):
        raise Strange(f"{name} is not a variable")
    return found


def _check_variable(name: str, variable: h5d.DatasetID) -> int:
    """Bytes of the variable in memory."""
    kind, shape = variable.get_type(), variable.shape
    _check_attributes(name, variable)
    if len(shape) > MOST_RANK:
        raise Strange(f"{name} has more than {MOST_RANK} dimensions")
    if not _is_text(kind) and not any(kind.equal(number) for number in NUMBERS):
        raise Strange(f"{name} holds neither numbers nor text")
    size = int(np.prod([*shape, kind.get_size()], dtype=object))
    if _is_dimension_alone(variable):
        return 0
    _check_storage(name, variable, size)
    return size


def _check_storage(name: str, variable: h5d.DatasetID, size: int) -> None:
    """All data in the file, none invented, and no compression that no writer reaches."""
    layout = variable.get_create_plist()
    if layout.get_layout() not in (h5d.COMPACT, h5d.CONTIGUOUS, h5d.CHUNKED) or layout.get_external_count():
        raise Strange(f"{name} has its values outside of the file")
    chunked = layout.get_layout() == h5d.CHUNKED
    used = [layout.get_filter(i)[0] for i in range(layout.get_nfilters())] if chunked else []
    if not FILTERS.issuperset(used):
        raise Strange(f"{name} is compressed in an unknown way")
    if chunked and np.prod([*layout.get_chunk(), variable.get_type().get_size()], dtype=object) > MOST_CHUNK:
        raise Strange(f"{name} is stored in pieces that are too large")
    if size > BEST_COMPRESSION * variable.get_storage_size():
        raise Strange(f"{name} has fewer values than it says")


def _check_attributes(where: str, owner: h5py.h5g.GroupID | h5d.DatasetID) -> None:
    count = h5a.get_num_attrs(owner)
    if count > MOST_ATTRIBUTES + len(DIMENSIONS):
        raise Strange(f"{where} has too many attributes")
    for index in range(count):
        attribute = h5a.open(owner, index=index)
        name = attribute.name.decode()
        if len(attribute.name) > MOST_NAME or not name.isprintable():
            raise Strange(f"{where} has an attribute whose name is too long, or not printable")
        if attribute.get_storage_size() > MOST_TEXT:
            raise Strange(f"{where}: attribute {name} is too long")
        if name not in DIMENSIONS:
            _check_attribute(f"{where}: attribute {name}", attribute)


def _check_attribute(where: str, attribute: h5a.AttrID) -> None:
    kind, space = attribute.get_type(), attribute.get_space()
    if isinstance(kind, h5t.TypeStringID):
        if space.get_simple_extent_type() != h5s.SCALAR:
            raise Strange(f"{where} is a list of texts")
        value = np.empty((), attribute.dtype)
        attribute.read(value)
        text = value.item()
        if len(text if isinstance(text, bytes) else str(text).encode()) > MOST_TEXT:
            raise Strange(f"{where} is too long")
    elif not any(kind.equal(number) for number in NUMBERS):
        raise Strange(f"{where} is neither text nor numbers")
    elif space.get_simple_extent_ndims() > 1 or not 0 < space.get_simple_extent_npoints() <= MOST_NUMBERS:
        raise Strange(f"{where} is not a short list of numbers")


def _is_text(kind: h5t.TypeID) -> bool:
    return isinstance(kind, h5t.TypeStringID) and bool(kind.is_variable_str())


def _is_dimension_alone(variable: h5d.DatasetID) -> bool:
    """Whether it only says how long a dimension is: such a one has no values."""
    name = h5py.Dataset(variable).attrs.get("NAME", b"")
    return bool(isinstance(name, bytes) and name.startswith(NO_VARIABLE))


def _read(name: str, variable: h5d.DatasetID) -> int:
    """Read all of a variable and its attributes; bytes of its text."""
    dataset = h5py.Dataset(variable)
    for attribute in dataset.attrs:
        dataset.attrs[attribute]
    for reference in dataset.attrs.get("DIMENSION_LIST", ()):
        for target in reference:
            if not isinstance(dataset.file[target], h5py.Dataset):
                raise Strange(f"{name} has a dimension that is none")
    if _is_dimension_alone(variable):
        return 0
    values = dataset[...]
    return sum(len(text) for text in values.flat if text.decode()) if _is_text(variable.get_type()) else 0


def _limit(size: int) -> None:
    """Let this process use little more time and memory than the libraries and so many bytes of numbers take."""
    limits = {resource.RLIMIT_CPU: int(SECONDS + size / BYTES_PER_SECOND), resource.RLIMIT_CORE: 0}
    with contextlib.suppress(OSError):  # only Linux says, and limits, how much memory is used
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        limits[resource.RLIMIT_AS] = used + 2 * size + MORE_MEMORY
    for what, limit in limits.items():
        most = resource.getrlimit(what)[1]
        resource.setrlimit(what, (limit if most == resource.RLIM_INFINITY else min(limit, most), most))


def main(path: str) -> int:
    _limit(0)
    try:
        check_structure(path, _limit)
    except Exception as error:
        print(str(error) or type(error).__name__)
        return STRANGE
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
