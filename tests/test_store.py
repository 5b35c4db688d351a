"""Datasets survive the disk bit for bit, whole or not at all, and explain themselves without this package."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

from painleve.errors import InputError
from painleve.store import check_schema, check_writable, flags, load, origin, provenance, save

# Awkward on purpose: signed zero, a subnormal number, infinity, NaN, and neighbours of one.
# The NaN has a payload: to mask a value that is marked as missing would put another NaN in its place.
MARKED_NAN = np.array([0x7FF8_0000_0000_BEEF], np.uint64).view(np.float64)[0]
NUMBERS = np.array([0.0, -0.0, 5e-324, -np.inf, MARKED_NAN, 1.0 + 2.0**-52])


def make_dataset(shift: float = 0.0) -> xr.Dataset:
    numbers = {"units": "m/s", "long_name": "some awkward floating-point numbers"}
    counts = {"units": "1", "long_name": "large numbers of samples"}
    outcome = {"long_name": "how each point ended", **flags(["done", "failed"])}
    label = {"units": "1", "long_name": "name of each point"}
    seconds = {"units": "s", "long_name": "time that each point took"}
    return xr.Dataset(
        {
            "number": ("point", NUMBERS + shift, numbers),
            "count": ("point", np.arange(6) + 2**53, counts),
            "outcome": ("point", np.array([0, 1, 2, 1, 1, 1], np.int8), outcome),
            "seconds": ("point", np.linspace(0.0, 1.0, 6), seconds),
        },
        {"point": ("point", np.array(["a", "b", "γ", "", "e f", "4/3"], dtype=object), label)},
        {"title": "A test", "kind": "test", **provenance(scene="none", scene_digest="0", seed=7, command="test")},
    )


def test_a_round_trip_is_equal_bit_for_bit(tmp_path: Path) -> None:
    dataset = make_dataset()
    read = load(save(dataset, tmp_path / "a.h5"))
    assert read.identical(dataset)
    for name, variable in dataset.variables.items():
        if variable.dtype != object:
            assert read[name].dtype == variable.dtype
            assert read[name].values.tobytes() == variable.values.tobytes()


def test_a_second_round_trip_changes_nothing(tmp_path: Path) -> None:
    once = load(save(make_dataset(), tmp_path / "a.h5"))
    assert load(save(once, tmp_path / "b.h5")).identical(once)


def test_xarray_alone_reads_numbers_units_flags_and_provenance(tmp_path: Path) -> None:
    path = save(make_dataset(), tmp_path / "a.h5")
    code = (
        "import sys, json, xarray; d = xarray.open_dataset(sys.argv[1], engine='h5netcdf');"
        "assert not any(m.split('.')[0] == 'painleve' for m in sys.modules);"
        "print(json.dumps([str(d.seconds.dtype), d.number.attrs['units'], d.outcome.attrs['flag_meanings'],"
        " d.outcome.attrs['flag_values'].tolist(), d.attrs['seed'], json.loads(d.attrs['library_versions'])['numpy']]))"
    )
    run = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=True)
    expected = ["float64", "m/s", "not_run done failed", [0, 1, 2], "7", np.__version__]
    assert json.loads(run.stdout) == expected


def test_no_value_of_a_variable_is_marked_as_missing(tmp_path: Path) -> None:
    """A NaN or a code 0 is a value here; whoever reads the file masks nothing."""
    with h5py.File(save(make_dataset(), tmp_path / "a.h5"), "r") as file:
        for name in make_dataset().variables:
            assert not {"_FillValue", "missing_value"} & set(file[name].attrs)


def test_a_file_is_on_the_disk_whole_before_it_takes_its_name_and_its_name_after_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the inode, which a rename keeps: what was flushed is the file that the name leads to."""
    flush, move, events = os.fsync, os.replace, []

    def note_flush(handle: int) -> None:
        flush(handle)
        events.append(("flushed", os.fstat(handle).st_ino, os.fstat(handle).st_size))

    def note_move(source: Path, target: Path) -> None:
        move(source, target)
        events.append(("moved", os.stat(target).st_ino, os.stat(target).st_size))

    monkeypatch.setattr(os, "fsync", note_flush)
    monkeypatch.setattr(os, "replace", note_move)
    path = save(make_dataset(), tmp_path / "a.h5")
    inode, size = path.stat().st_ino, path.stat().st_size
    moved = events.index(("moved", inode, size))
    assert ("flushed", inode, size) in events[:moved]
    assert tmp_path.stat().st_ino in [found for what, found, _ in events[moved:] if what == "flushed"]


@pytest.mark.parametrize("failure", [OSError("no space left"), KeyboardInterrupt(), MemoryError()], ids=repr)
def test_an_exception_while_writing_leaves_the_old_file_and_nothing_else(
    failure: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "output"
    folder.mkdir()
    path, write = save(make_dataset(), folder / "a.h5"), os.write

    def half_written(handle: int, content: memoryview) -> int:
        write(handle, content[: len(content) // 2])
        raise failure

    monkeypatch.setattr(os, "write", half_written)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))  # where the result is kept if the disk is at fault
    with pytest.raises(InputError if isinstance(failure, OSError) else type(failure)):
        save(make_dataset(shift=1.0), path)
    assert list(folder.iterdir()) == [path]
    assert load(path).identical(make_dataset().assign_attrs(load(path).attrs))


@pytest.mark.slow
def test_a_killed_process_never_leaves_an_unreadable_file(tmp_path: Path) -> None:
    path = save(make_dataset(), tmp_path / "a.h5")
    code = (
        "import sys; from painleve.store import load, save; d = load(sys.argv[1]);\n"
        "print('writing', flush=True)\n"
        "while True: save(d, sys.argv[1])"
    )
    for delay in (0.003, 0.011, 0.023):
        with subprocess.Popen([sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE, text=True) as child:
            assert child.stdout is not None
            assert child.stdout.readline() == "writing\n"
            time.sleep(delay)
            child.send_signal(signal.SIGKILL)
        assert load(path).equals(make_dataset())


def without_units(dataset: xr.Dataset) -> None:
    del dataset["number"].attrs["units"]


def without_sentence(dataset: xr.Dataset) -> None:
    dataset["number"].attrs["long_name"] = "number"


def without_meanings(dataset: xr.Dataset) -> None:
    del dataset["outcome"].attrs["flag_meanings"]


def without_not_run(dataset: xr.Dataset) -> None:
    dataset["outcome"].attrs["flag_meanings"] = "began done failed"


def with_a_strange_code(dataset: xr.Dataset) -> None:
    dataset["outcome"].values[0] = 9


def without_a_commit(dataset: xr.Dataset) -> None:
    del dataset.attrs["git_commit"]


def with_a_dict(dataset: xr.Dataset) -> None:
    dataset["number"].attrs["settings"] = {"samples": 3}


def with_a_bool(dataset: xr.Dataset) -> None:
    dataset.attrs["finished"] = True


@pytest.mark.parametrize(
    ("spoil", "named"),
    [
        (without_units, "number lacks units"),
        (without_sentence, "number: .* not a sentence"),
        (without_meanings, "outcome needs flag_values"),
        (without_not_run, "outcome needs flag_values"),
        (with_a_strange_code, r"outcome has values without a meaning: \[9\]"),
        (without_a_commit, "git_commit"),
        (with_a_dict, "settings"),
        (with_a_bool, "finished"),
    ],
)
def test_a_dataset_that_does_not_explain_itself_is_refused_by_name(
    spoil: Callable[[xr.Dataset], None], named: str, tmp_path: Path
) -> None:
    dataset = make_dataset()
    check_schema(dataset)
    spoil(dataset)
    with pytest.raises(ValueError, match=named):
        save(dataset, tmp_path / "a.h5")
    assert list(tmp_path.iterdir()) == []


def test_codes_stay_integers_in_an_outer_merge() -> None:
    left, right = make_dataset().isel(point=slice(0, 3)), make_dataset().isel(point=slice(2, 6))
    codes = xr.align(left["outcome"], right["outcome"], join="outer", fill_value=0)[0]
    assert codes.dtype == np.int8
    assert codes.sel(point="4/3") == left["outcome"].attrs["flag_meanings"].split().index("not_run")


@pytest.mark.parametrize(
    ("place", "says"),
    [(".", "is a folder"), ("missing/a.h5", "there is no folder"), (300 * "a", "cannot be written")],
    ids=["folder", "no parent", "name too long"],
)
def test_an_unwritable_place_is_refused_in_one_line_and_leaves_nothing(place: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=says) as caught:
        check_writable(tmp_path / place)
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_asking_whether_a_file_can_be_written_leaves_it_alone(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    path.write_text("precious")
    assert check_writable(path) == path
    assert [p.read_text() for p in tmp_path.iterdir()] == ["precious"]


@pytest.mark.parametrize(
    ("name", "content"),
    [("a", None), (300 * "a", None), ("a", b""), ("a", b"no HDF5 at all")],
    ids=["missing", "name too long", "empty", "text"],
)
def test_what_save_did_not_write_is_refused_in_one_line(name: str, content: bytes | None, tmp_path: Path) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        load(path)
    assert "\n" not in str(caught.value)


def test_a_foreign_dataset_is_refused_by_what_it_lacks(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    xr.Dataset({"x": ("t", [1.0, 2.0])}).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(InputError, match="variable x lacks units"):
        load(path)


def git(folder: Path, *words: str) -> str:
    identity = ("-c", "user.name=test", "-c", "user.email=test@example.org", "-c", "commit.gpgsign=false")
    run = subprocess.run(["git", "-C", folder, *identity, *words], capture_output=True, text=True, check=True)
    return run.stdout.strip()


def test_a_checkout_that_differs_from_its_commit_is_said_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was computed by edited code must not be taken for the commit's; a file that git does not know is no edit."""

    def recorded() -> str:
        return provenance(scene="none", scene_digest="0", seed=0)["git_commit"]

    package = tmp_path / "painleve"
    package.mkdir()
    monkeypatch.setattr(origin, "__file__", str(package / "store" / "origin.py"))
    assert recorded() == "unknown"
    (package / "law.py").write_text("gamma = 1\n")
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "--quiet", "--message", "first")
    commit = git(tmp_path, "rev-parse", "HEAD")
    assert recorded() == commit
    (tmp_path / "result.h5").write_text("of no commit")
    assert recorded() == commit
    (package / "law.py").write_text("gamma = 2\n")
    assert recorded() == f"{commit} with changes"
    git(tmp_path, "add", ".")
    assert recorded() == f"{commit} with changes"


def test_the_commit_is_that_of_the_checkout() -> None:
    root = Path(__file__).parents[1]
    recorded = provenance(scene="none", scene_digest="0", seed=0)["git_commit"]
    if not (root / ".git").exists():
        assert recorded == "unknown"
    else:
        run = subprocess.run(["git", "-C", root, "rev-parse", "HEAD"], capture_output=True, text=True, check=True)
        assert recorded.split()[0] == run.stdout.strip()
