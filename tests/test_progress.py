"""What long work says: after a second, once, on stderr, in a run of the command line and nowhere else."""

from __future__ import annotations

import time

import numba
import pytest

from painleve import load_scene, make_state, progress
from painleve._jit.announced import _Compiling
from painleve.cli import main
from painleve.progress import Work, reporting, told, working


@pytest.fixture(autouse=True)
def speak(monkeypatch):
    monkeypatch.delenv(progress.QUIET, raising=False)


def test_work_speaks_once_it_has_taken_its_time_and_not_before(monkeypatch):
    lines: list[str] = []
    monkeypatch.setattr(progress, "AFTER", 0.05)
    with reporting(lines.append):
        with working("counting"):
            pass
        time.sleep(0.1)
        assert lines == []
        with working("waiting"):
            time.sleep(0.2)
            assert lines == ["waiting"]
            time.sleep(0.1)
    assert lines == ["waiting"]


def test_pieces_of_work_add_up_and_what_fails_falls_silent(monkeypatch):
    lines: list[str] = []
    monkeypatch.setattr(progress, "AFTER", 0.2)
    with reporting(lines.append):
        work = Work("piecework")
        for _ in range(4):
            work.start()
            time.sleep(0.08)
            work.stop()
        assert lines == ["piecework"]
        with pytest.raises(ZeroDivisionError), working("dividing"):
            raise ZeroDivisionError
        time.sleep(0.3)
    assert lines == ["piecework"]


def test_a_function_is_told_by_its_arguments_and_keeps_its_name(monkeypatch):
    lines: list[str] = []
    monkeypatch.setattr(progress, "AFTER", 0.0)

    @told(lambda n, *_, **__: f"sleeping {n}")
    def sleep(n: int, more: int = 0) -> int:
        """Sleeps."""
        time.sleep(0.05)
        return n + more

    with reporting(lines.append):
        assert sleep(1, more=2) == 3
    assert lines == ["sleeping 1"]
    assert sleep.__name__ == "sleep"


def test_the_library_prints_nothing_and_a_command_says_on_stderr_what_it_does(monkeypatch, capsys):
    monkeypatch.setattr(progress, "AFTER", 0.0)
    make_state(load_scene("two_link_arm"), "isolated")
    captured = capsys.readouterr()
    assert captured.out == captured.err == ""
    assert main(["classify", "two_link_arm", "--state", "isolated"]) == 0
    captured = capsys.readouterr()
    assert "critical_isolated" in captured.out
    assert "painleve: checking a state of two_link_arm in exact arithmetic ...\n" in captured.err
    monkeypatch.setenv(progress.QUIET, "1")
    assert main(["classify", "two_link_arm", "--state", "isolated"]) == 0
    assert capsys.readouterr().err == ""


def test_compiling_is_told_by_the_outermost_function_that_is_compiled(monkeypatch):
    lines: list[str] = []
    monkeypatch.setattr(progress, "AFTER", 0.0)
    listener = _Compiling()

    @numba.njit
    def inner(x):
        return x + 1.0

    @numba.njit
    def outer(x):
        return 2.0 * inner(x)

    outer.py_func.__module__ = "scene_my_rod_0123456789abcdef"
    with reporting(lines.append), numba.core.event.install_listener("numba:compile", listener):
        assert outer(1.0) == 4.0
        assert outer(2.0) == 6.0
    mine = [line for line in lines if "my_rod" in line]
    assert mine
    assert set(mine) == {"compiling the kernels of my_rod, which later runs take from the cache"}
    assert listener.depth == 0
