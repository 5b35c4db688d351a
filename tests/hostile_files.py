"""Result files as a stranger, a broken program or a broken disk might leave them: seeded mutations of a sound one.

`python tests/hostile_files.py COUNT [SEED]` tries more of them than the tests do, with a process for each file, and
prints how they ended.
"""

from __future__ import annotations

import os
import random
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np

__all__ = ["MUTATIONS", "mutant"]

File = h5py.File
Mutation = Callable[[File, random.Random], object]

ODD_TEXTS = (
    "",
    " ",
    "$",
    "$\\frac{1}$",
    "\\notacommand{$",
    "{0.__class__}",
    "%s %n",
    "line\nbreak",
    "\x1b[31mred\x07",
    "_" * 50,
    "x" * 5000,
    "γ" * 3000,
    "days since 1970-01-01",
    "none",
    "not_run not_run",
)
ODD_NUMBERS = (np.nan, np.inf, -np.inf, 0.0, -1.0, 1e308, -1e308, 5e-324, 1e-300)
ODD_DTYPES = ("i1", "i8", "u8", "f4", ">f8", "S3", "V4", "c16", "?", [("a", "f8"), ("b", "i4")])
ODD_SHAPES = ((), (0,), (1,), (3,), (2, 2), (1, 1, 1))


def _variable(file: File, random: random.Random) -> str:
    return str(random.choice(sorted(file)))


def _owner(file: File, random: random.Random) -> Any:
    """The file or a variable."""
    return file if random.random() < 0.3 else file[_variable(file, random)]


def _replace(file: File, name: str, make: Callable[[], h5py.Dataset | None]) -> None:
    """Another variable of that name, with the attributes of the old one."""
    old = {key: value for key, value in file[name].attrs.items() if key not in ("CLASS", "NAME", "REFERENCE_LIST")}
    types = {key: file[name].attrs.get_id(key).dtype for key in old}
    del file[name]
    new = make()
    for key, value in old.items() if new is not None else ():
        new.attrs.create(key, value, dtype=types[key])


def delete(file: File, random: random.Random) -> None:
    del file[_variable(file, random)]


def rename(file: File, random: random.Random) -> None:
    file.move(_variable(file, random), random.choice(["x0", "eps", "state", "time", "a b", "γ", "n" * 200, "."]) + "_")


def swap(file: File, random: random.Random) -> None:
    one, two = random.sample(sorted(file), 2)
    file.move(one, "swapped")
    file.move(two, one)
    file.move("swapped", two)


def retype(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    values = np.zeros(file[name].shape, random.choice(ODD_DTYPES))
    _replace(file, name, lambda: file.create_dataset(name, data=values))


def to_text(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    shape, text = file[name].shape, random.choice(ODD_TEXTS)
    values = np.full(shape, text, object)
    _replace(file, name, lambda: file.create_dataset(name, data=values, dtype=h5py.string_dtype()))


def to_numbers(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    values = np.full(file[name].shape, random.choice(ODD_NUMBERS))
    _replace(file, name, lambda: file.create_dataset(name, data=values))


def to_references(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    _replace(file, name, lambda: file.create_dataset(name, data=[file.ref], dtype=h5py.ref_dtype))


def to_enumeration(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    dtype = h5py.enum_dtype({"a": 0, "b": 1})
    _replace(file, name, lambda: file.create_dataset(name, (2,), dtype))


def reshape(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    dtype, shape = file[name].dtype, random.choice(ODD_SHAPES)
    _replace(file, name, lambda: file.create_dataset(name, shape, dtype))


def longer(file: File, random: random.Random) -> None:
    """One value more along the first dimension, which others share."""
    name = _variable(file, random)
    values = file[name][...]
    if values.ndim:
        values = np.concatenate([values, values[-1:]])
    dtype = file[name].dtype
    _replace(file, name, lambda: file.create_dataset(name, data=values, dtype=dtype))


def bomb(file: File, random: random.Random) -> None:
    """Terabytes that no disk holds."""
    name = _variable(file, random)
    shape = random.choice([(2**40,), (2**20, 2**20), (2**33, 3)])
    chunks = random.choice([None, (3,) * len(shape)])
    pressed = {"compression": "gzip"} if chunks else {}
    _replace(file, name, lambda: file.create_dataset(name, shape, "f8", chunks=chunks, **pressed))


def to_group(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    del file[name]
    file.create_group(name)


def more(file: File, random: random.Random) -> None:
    for k in range(random.choice([1, 1500])):
        file.create_dataset(f"more_{k}", data=1.0)


def soft_link(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    target = random.choice([f"/{name}", "/nowhere", "/", f"/{_variable(file, random)}"])
    del file[name]
    file[name] = h5py.SoftLink(target)


def external_link(file: File, random: random.Random) -> None:
    """To a pipe: who follows it waits for ever."""
    name = _variable(file, random)
    del file[name]
    file[name] = h5py.ExternalLink(str(Path(file.filename).with_name("pipe")), f"/{name}")


def circle(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    del file[name]
    file[name] = file["/"]


def external_data(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    pipe = os.fsencode(Path(file.filename).with_name("pipe"))
    _replace(file, name, lambda: file.create_dataset(name, (4,), "f8", external=[(pipe, 0, 32)]))


def virtual(file: File, random: random.Random) -> None:
    name = _variable(file, random)
    layout = h5py.VirtualLayout((4,), "f8")
    layout[:] = h5py.VirtualSource(str(Path(file.filename).with_name("pipe")), "x", (4,))
    _replace(file, name, lambda: file.create_virtual_dataset(name, layout))


def drop_attribute(file: File, random: random.Random) -> None:
    owner = _owner(file, random)
    if len(owner.attrs):
        del owner.attrs[random.choice(sorted(owner.attrs))]


def odd_attribute(file: File, random: random.Random) -> None:
    owner = _owner(file, random)
    name = random.choice([*sorted(owner.attrs), "units", "_FillValue", "scale_factor", "coordinates", "dtype"])
    value = random.choice(
        [*ODD_TEXTS, *ODD_NUMBERS, [1.0, 2.0], [[1, 2], [3, 4]], 7, b"\xff\xfe", ["a", "b"], True, h5py.Empty("f8")]
    )
    if name in owner.attrs:
        del owner.attrs[name]
    owner.attrs[name] = value


def long_attribute(file: File, random: random.Random) -> None:
    owner = _owner(file, random)
    name = random.choice(sorted({*owner.attrs, "title"} - {"REFERENCE_LIST", "DIMENSION_LIST", "CLASS"}))
    if name in owner.attrs:
        del owner.attrs[name]
    owner.attrs[name] = random.choice(["x", "long "]) * random.choice([20_000, 2_000_000])


def reference_attribute(file: File, random: random.Random) -> None:
    owner = _owner(file, random)
    owner.attrs.create("pointing", file.ref, dtype=h5py.ref_dtype)


def many_attributes(file: File, random: random.Random) -> None:
    owner = _owner(file, random)
    for k in range(200):
        owner.attrs[f"a{k}"] = k


def odd_dimensions(file: File, random: random.Random) -> None:
    owner = file[_variable(file, random)]
    name = random.choice(["_Netcdf4Coordinates", "_Netcdf4Dimid", "CLASS", "NAME", "DIMENSION_LIST"])
    if name in owner.attrs:
        del owner.attrs[name]
    if random.random() < 0.6:
        owner.attrs[name] = random.choice([np.array([7, 7, 7], np.int32), -1, 2**30, "DIMENSION_SCALE", b"x"])


def odd_values(file: File, random: random.Random) -> None:
    """Some values, of the right type."""
    variable = file[_variable(file, random)]
    values = variable[...]
    if values.size == 0:
        return
    where = random.randrange(values.size) if random.random() < 0.5 else slice(None)
    if values.dtype.kind == "f":
        values.flat[where] = random.choice(ODD_NUMBERS)
    elif values.dtype.kind in "iu":
        values.flat[where] = random.choice([0, 1, -1, 3, 100])
    elif values.dtype.kind == "O":
        values.flat[where] = random.choice(ODD_TEXTS)
    variable[...] = values


MUTATIONS: tuple[Mutation, ...] = (
    *(delete, rename, swap, retype, to_text, to_numbers, to_references, to_enumeration, reshape, longer, bomb),
    *(to_group, more, soft_link, external_link, circle, external_data, virtual),
    *(drop_attribute, odd_attribute, long_attribute, reference_attribute, many_attributes, odd_dimensions, odd_values),
)


def mutant(source: Path, folder: Path, seed: int) -> tuple[Path, str]:
    """A copy of a sound file with one mutation, and its name; beside it lies a pipe that nobody writes to."""
    chance = random.Random(seed)
    mutation = MUTATIONS[seed % len(MUTATIONS)]
    path = folder / f"{source.stem}_{seed}_{mutation.__name__}.h5"
    shutil.copyfile(source, path)
    if not (folder / "pipe").exists():
        os.mkfifo(folder / "pipe")
    with h5py.File(path, "r+") as file:
        mutation(file, chance)
    return path, mutation.__name__
