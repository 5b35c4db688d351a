"""A disk that is full costs the file and not the result: one line says where it is, and nothing is left half done."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from small_disk import fill, small_disk

from painleve.cli import main
from painleve.errors import InputError
from painleve.store import load, provenance, save

SAVE = """
import sys
{before}
from painleve.errors import InputError
from painleve.store import load, save
dataset = load(sys.argv[1])
try:
    save(dataset, sys.argv[2])
except InputError as error:
    sys.exit(str(error))
"""


def make_dataset(size: int = 100_000) -> xr.Dataset:
    """Numbers that cannot be compressed."""
    noise = np.random.default_rng(1).random(size)
    number = ("sample", noise, {"units": "1", "long_name": "numbers of no meaning"})
    attributes = {"title": "Noise", "kind": "noise", **provenance(scene="none", scene_digest="0", seed=1, command="")}
    return xr.Dataset({"number": number}, attrs={**attributes, "command": "test"})


@pytest.fixture
def shelter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of temporary files."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    monkeypatch.setenv("TMPDIR", str(folder))
    return folder


def kept_in(line: str) -> Path:
    found = re.search(r"the result is kept in (\S+)$", line)
    assert found is not None, line
    return Path(found[1])


def test_a_dataset_that_does_not_fit_on_its_disk_is_kept_elsewhere(tmp_path: Path, shelter: Path) -> None:
    dataset = make_dataset()
    with small_disk(tmp_path / "disk", 96) as disk:
        with pytest.raises(InputError, match="No space left on device") as caught:
            save(dataset, disk / "a.h5")
        assert list(disk.iterdir()) == []
    kept = kept_in(str(caught.value))
    assert kept.parent == shelter
    assert load(kept).identical(dataset)
    assert kept.stat().st_mode & 0o077 == 0  # the folder of temporary files is everybody's


@pytest.mark.parametrize("limit", [1, 5_000, 100_000])
def test_a_limit_on_the_size_of_files_ends_in_one_line_and_no_crash(limit: int, tmp_path: Path) -> None:
    """In a process of its own: HDF5 used to crash it."""
    source = save(make_dataset(), tmp_path / "source.h5")
    (tmp_path / "output").mkdir()
    before = f"import resource; resource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit}))"
    command = [sys.executable, "-c", SAVE.format(before=before), str(source), str(tmp_path / "output" / "a.h5")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert "File too large" in done.stderr
    assert "free some space" in done.stderr
    assert list((tmp_path / "output").iterdir()) == []


def test_where_no_disk_has_room_the_line_says_so_and_the_old_file_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with small_disk(tmp_path / "disk", 96) as disk:
        monkeypatch.setattr(tempfile, "tempdir", str(disk))
        monkeypatch.setenv("HOME", str(disk))
        path = save(make_dataset(100), disk / "a.h5")
        with pytest.raises(InputError, match="nor can the result be kept"):
            save(make_dataset(), path)
        assert list(disk.iterdir()) == [path]
        assert load(path).sizes == {"sample": 100}


def test_a_sweep_onto_a_full_disk_prints_its_verdicts_and_says_where_its_dataset_is(
    tmp_path: Path, shelter: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["sweep", "slender_rod", "--state", "paradox", "--eps", "1e-1", "1e-2", "--samples", "1e4"]
    with small_disk(tmp_path / "disk", 32) as disk:
        assert main([*words, "-o", str(disk / "a.h5")]) == 2
        assert list(disk.iterdir()) == []
    found = capsys.readouterr()
    assert found.out.startswith("paradox: negative; consistent")
    assert found.err.count("\n") == 1
    assert load(kept_in(found.err.strip())).sizes["eps"] == 2


def test_a_trajectory_onto_a_full_disk_is_printed_and_kept(
    tmp_path: Path, shelter: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with small_disk(tmp_path / "disk", 32) as disk:
        words = ["simulate", "slender_rod", "--state", "stoss", "--step", "1e-3", "--until", "0.9"]
        assert main([*words, "-o", str(disk / "a.h5")]) == 2
        assert list(disk.iterdir()) == []
    found = capsys.readouterr()
    assert "jump without collision" in found.out.replace("_", " ")
    assert load(kept_in(found.err.strip())).sizes["time"] > 100


def test_a_figure_onto_a_full_disk_leaves_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["simulate", "slender_rod", "--state", "stoss", "--step", "1e-1", "--until", "0.9"]
    assert main([*words, "-o", str(tmp_path / "a.h5")]) == 0
    capsys.readouterr()
    with small_disk(tmp_path / "disk", 16) as disk:
        for name, more in (("a.png", []), ("a.pdf", []), ("a.gif", ["--animate"])):
            assert main(["plot", str(tmp_path / "a.h5"), "-o", str(disk / name), *more]) == 2
            found = capsys.readouterr()
            assert found.out == ""
            assert found.err.count("\n") == 1
            assert "No space left on device" in found.err
            assert list(disk.iterdir()) == []


def test_a_new_scene_on_a_full_disk_is_not_there_and_can_be_written_later(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with small_disk(tmp_path / "disk", 16) as disk:
        fill(disk)
        assert main(["new-scene", "a", "-o", str(disk / "a.toml")]) == 2
        assert "No space left on device" in capsys.readouterr().err
        assert [p.name for p in disk.iterdir()] == ["filling"]
        (disk / "filling").unlink()
        assert main(["new-scene", "a", "-o", str(disk / "a.toml")]) == 0
        assert os.path.getsize(disk / "a.toml") > 1000
