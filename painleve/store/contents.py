"""What stands in an HDF5 file that is built as this package builds its files; any other is refused by what is strange.

`python contents.py FILE` reads it in a process of its own. Status 0: it can be read. Status STRANGE: it is strange, and
standard output says how. Any other status: the HDF5 library crashed, looped or ran out of memory over bytes that it did
not write, which nothing can prevent from inside. Nothing of the package is imported, so that the process starts fast.
"""

from __future__ import annotations

import contextlib
import os
import resource
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from h5py import h5a, h5d, h5i, h5o, h5r, h5s, h5t, h5z

__all__ = ["Attributes", "Strange", "Variable", "read_contents"]

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

Attributes = Mapping[str, Any]
Variable = tuple[tuple[str, ...], np.ndarray, Attributes]  # names of the dimensions, values, attributes

# How dimensions stand in netCDF-4 files. The class and the list of dimensions are read, the others are not needed.
DIMENSIONS = ("CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST", "_Netcdf4Dimid", "_Netcdf4Coordinates")
INTERNAL = frozenset((*DIMENSIONS, "_NCProperties", "_nc3_strict"))
SCALE, NO_VARIABLE = b"DIMENSION_SCALE", b"This is a netCDF dimension but not a netCDF variable"
FILTERS = frozenset((h5z.FILTER_DEFLATE, h5z.FILTER_SHUFFLE, h5z.FILTER_FLETCHER32))
NUMBERS = tuple(
    h5t.py_create(np.dtype(order + code))
    for code in ("i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f4", "f8")
    for order in "<>"
)


class Strange(ValueError):
    """What is strange about a file."""


def read_contents(
    path: str | Path, allow: Callable[[int], None] = lambda size: None
) -> tuple[dict[str, Variable], Attributes]:
    """(variables, attributes of the file). Raises Strange, or whatever the HDF5 library raises.

    Variables stand in the root, are whole and in the file itself (no links, no groups, no virtual or external data),
    hold plain numbers or text, and so do their attributes, within limits. `allow` hears of the bytes of all numbers
    before they are read.
    """
    with h5py.File(path, "r") as file:
        if len(file) > MOST_VARIABLES:
            raise Strange(f"it holds more than {MOST_VARIABLES} variables")
        attributes = _attributes("the file", file.id)
        found = {name: _variable(file, name) for name in file}
        kept = {name: v for name, v in found.items() if not _string(v, "NAME").startswith(NO_VARIABLE)}
        size = sum(_checked_size(name, variable) for name, variable in kept.items())
        if size > MOST_OF_MEMORY * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"):
            raise Strange(f"its values take {size / 1e9:.3g} GB, more than half of this machine's memory")
        allow(size)
        variables: dict[str, Variable] = {
            n: (_dimensions(n, v, found), _values(v), _attributes(n, v)) for n, v in kept.items()
        }
    if sum(len(t) for _, values, _ in variables.values() if values.dtype == object for t in values.flat) > MOST_TEXTS:
        raise Strange(f"it holds more than {MOST_TEXTS} bytes of text")
    return variables, attributes


def _variable(file: h5py.File, name: str) -> h5d.DatasetID:
    if len(name.encode()) > MOST_NAME or not name.isidentifier():
        raise Strange("a variable has a name that is too long, or no name")
    if not isinstance(file.get(name, getlink=True), h5py.HardLink):
        raise Strange(f"{name} is a link")
    found = h5o.open(file.id, name.encode())
    if not isinstance(found, h5d.DatasetID):
        raise Strange(f"{name} is not a variable")
    return found


def _checked_size(name: str, variable: h5d.DatasetID) -> int:
    """Bytes that the variable takes in memory: all of them in the file, none pressed as no writer presses them."""
    kind, layout = variable.get_type(), variable.get_create_plist()
    if len(variable.shape) > MOST_RANK:
        raise Strange(f"{name} has more than {MOST_RANK} dimensions")
    if not _is_text(kind) and not _is_number(kind):
        raise Strange(f"{name} holds neither numbers nor text")
    if layout.get_layout() not in (h5d.COMPACT, h5d.CONTIGUOUS, h5d.CHUNKED) or layout.get_external_count():
        raise Strange(f"{name} has its values outside of the file")
    if layout.get_layout() == h5d.CHUNKED:
        if not FILTERS.issuperset(layout.get_filter(i)[0] for i in range(layout.get_nfilters())):
            raise Strange(f"{name} is compressed in an unknown way")
        if _product(*layout.get_chunk(), kind.get_size()) > MOST_CHUNK:
            raise Strange(f"{name} is stored in pieces that are too large")
    size = _product(*variable.shape, kind.get_size())
    if size > BEST_COMPRESSION * variable.get_storage_size():
        raise Strange(f"{name} has fewer values than it says")
    return size


def _dimensions(name: str, variable: h5d.DatasetID, found: Mapping[str, h5d.DatasetID]) -> tuple[str, ...]:
    """Names of the dimensions: of variables of one dimension, as long as this one."""
    if len(variable.shape) == 1 and _string(variable, "CLASS") == SCALE:
        return (name,)
    if not variable.shape:
        return ()
    if not h5a.exists(variable, b"DIMENSION_LIST"):
        raise Strange(f"{name} has dimensions without names")
    listed = h5a.open(variable, b"DIMENSION_LIST")
    kind = listed.get_type()
    if listed.shape != (len(variable.shape),) or not isinstance(kind, h5t.TypeVlenID):
        raise Strange(f"{name} has dimensions without names")
    values = np.empty(listed.shape, listed.dtype)
    listed.read(values)
    names = tuple(_referred(name, references, variable) for references in values)
    for dimension, length in zip(names, variable.shape, strict=True):
        if dimension not in found or found[dimension].shape != (length,):
            raise Strange(f"{name} is not as long as its dimensions")
    return names


def _referred(name: str, references: Any, variable: h5d.DatasetID) -> str:
    """The name of the one thing that is referred to."""
    if len(references) != 1 or not isinstance(references[0], h5r.Reference):
        raise Strange(f"{name} has dimensions without names")
    target = h5r.dereference(references[0], variable)
    return str(h5i.get_name(target).decode().removeprefix("/")) if target else ""


def _values(variable: h5d.DatasetID) -> np.ndarray:
    dataset = h5py.Dataset(variable)
    return np.asarray(dataset.asstr()[...] if _is_text(variable.get_type()) else dataset[...])


def _attributes(where: str, owner: h5py.h5g.GroupID | h5d.DatasetID) -> dict[str, Any]:
    count = h5a.get_num_attrs(owner)
    if count > MOST_ATTRIBUTES + len(INTERNAL):
        raise Strange(f"{where} has too many attributes")
    found: dict[str, Any] = {}
    for index in range(count):
        attribute = h5a.open(owner, index=index)
        name = attribute.name.decode()
        if len(attribute.name) > MOST_NAME or not name.isprintable():
            raise Strange(f"{where} has an attribute whose name is too long, or not printable")
        if attribute.get_storage_size() > MOST_TEXT:
            raise Strange(f"{where}: attribute {name} is too long")
        if name not in INTERNAL:
            found[name] = _attribute(f"{where}: attribute {name}", attribute)
    return found


def _attribute(where: str, attribute: h5a.AttrID) -> Any:
    """Text, a number, or an array of numbers."""
    kind, space = attribute.get_type(), attribute.get_space()
    text = isinstance(kind, h5t.TypeStringID)
    if not text and not _is_number(kind):
        raise Strange(f"{where} is neither text nor numbers")
    if space.get_simple_extent_type() == h5s.NULL:
        raise Strange(f"{where} is empty")
    if (text and attribute.shape != ()) or len(attribute.shape) > 1 or _product(*attribute.shape) > MOST_NUMBERS:
        raise Strange(f"{where} is more than one text or a short list of numbers")
    values = np.empty(attribute.shape, attribute.dtype)
    attribute.read(values)
    if not text:
        return values if values.size != 1 else values.ravel()[0]
    value = values.item()
    read = value if isinstance(value, bytes) else str(value).encode("utf-8", "surrogateescape")
    if len(read) > MOST_TEXT:
        raise Strange(f"{where} is too long")
    return read.decode()


def _string(variable: h5d.DatasetID, name: str) -> bytes:
    """A short attribute of fixed length; empty if there is none."""
    if not h5a.exists(variable, name.encode()):
        return b""
    attribute = h5a.open(variable, name.encode())
    kind = attribute.get_type()
    if (
        not isinstance(kind, h5t.TypeStringID)
        or kind.is_variable_str()
        or attribute.shape != ()
        or kind.get_size() > 256
    ):
        return b""
    value = np.empty((), attribute.dtype)
    attribute.read(value)
    return bytes(value.item())


def _is_text(kind: h5t.TypeID) -> bool:
    return isinstance(kind, h5t.TypeStringID) and bool(kind.is_variable_str())


def _is_number(kind: h5t.TypeID) -> bool:
    return any(kind.equal(number) for number in NUMBERS)


def _product(*sizes: int) -> int:
    return int(np.prod(sizes, dtype=object))


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
        read_contents(path, _limit)
    except Exception as error:
        print(str(error) or type(error).__name__)
        return STRANGE
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
