"""Files are whole or not there, and what killed processes left is taken away, and nothing else."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from small_disk import NOBODY, fill, need_root, small_disk

from painleve.errors import InputError
from painleve.whole_file import remove_stale, write_whole, written_aside


def dead_pid() -> int:
    """The number of a process that has ended."""
    with subprocess.Popen(["true"]) as process:
        pass
    return process.pid


def test_a_full_disk_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    with small_disk(tmp_path / "disk", 64) as disk:
        target = disk / "a.bin"
        write_whole(target, b"old")
        with pytest.raises(OSError, match="No space left"):
            write_whole(target, bytes(100_000))
        with pytest.raises(InputError, match="No space left"), written_aside(target) as path:
            path.write_bytes(bytes(100_000))
        fill(disk)
        with pytest.raises(OSError, match="No space left"):
            write_whole(target, b"new")
        assert target.read_bytes() == b"old"
        assert sorted(p.name for p in disk.iterdir()) == ["a.bin", "filling"]


def test_what_is_written_at_the_path_aside_becomes_the_file(tmp_path: Path) -> None:
    with written_aside(tmp_path / "a.gif", ".gif") as path:
        assert path.suffix == ".gif"
        path.write_bytes(b"new")
    assert [p.name for p in tmp_path.iterdir()] == ["a.gif"]
    assert (tmp_path / "a.gif").read_bytes() == b"new"


def test_what_a_killed_process_left_is_taken_away(tmp_path: Path) -> None:
    code = (
        "import sys, pathlib; from painleve.whole_file import written_aside\n"
        "with written_aside(pathlib.Path(sys.argv[1])) as path:\n"
        "    path.write_bytes(b'half'); print('writing', flush=True); sys.stdin.read()"
    )
    command = [sys.executable, "-c", code, str(tmp_path / "a.png")]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == b"writing\n"
        remove_stale(tmp_path)
        assert len(list(tmp_path.iterdir())) == 1  # its process runs
        child.send_signal(signal.SIGKILL)
    assert len(list(tmp_path.iterdir())) == 1
    remove_stale(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_only_files_of_dead_processes_that_nobody_holds_are_stale(tmp_path: Path) -> None:
    dead = dead_pid()
    for name in (f".a.h5.{dead}.part", f".a.gif.0123abcd.{dead}.part.gif"):
        (tmp_path / name).touch()
    kept = {f".a.h5.{os.getpid()}.part", f"a.h5.{dead}.part", ".a.h5.part", f".a.h5.{dead}.part2", ".profile"}
    for name in kept:
        (tmp_path / name).touch()
    (tmp_path / f".folder.{dead}.part").mkdir()
    os.mkfifo(tmp_path / f".pipe.{dead}.part")
    (tmp_path / f".link.{dead}.part").symlink_to(tmp_path / ".profile")
    odd = {f".{kind}.{dead}.part" for kind in ("folder", "pipe", "link")}
    remove_stale(tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == kept | odd


def test_a_file_that_a_process_on_another_machine_writes_stays(tmp_path: Path) -> None:
    """Its number says nothing here; its lock does."""
    path = tmp_path / f".a.h5.{dead_pid()}.part"
    code = "import fcntl, sys; f = open(sys.argv[1], 'w'); fcntl.flock(f, 2); print(1, flush=True); sys.stdin.read()"
    command = [sys.executable, "-c", code, str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as writer:
        assert writer.stdout is not None
        writer.stdout.readline()
        remove_stale(tmp_path)
        assert path.exists()
        writer.communicate(b"")
    remove_stale(tmp_path)
    assert not path.exists()


def test_what_another_user_left_stays(tmp_path: Path) -> None:
    need_root()
    path = tmp_path / f".a.h5.{dead_pid()}.part"
    path.touch()
    os.chown(path, NOBODY, NOBODY)
    remove_stale(tmp_path)
    assert path.exists()
