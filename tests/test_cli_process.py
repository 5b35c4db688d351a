"""A command among other processes: ended by a signal, read by one that leaves, in any encoding, with odd arguments."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import assert_refused

from painleve.asymptotics.theorem import collect
from painleve.cli import main
from painleve.dynamics import fixed_step
from painleve.plotting import draw
from painleve.store import load
from painleve.sweep import distances

DRIVER = "import sys; from painleve.cli import main; sys.exit(main())"
SWEEP = ("sweep", "slender_rod", "--state", "paradox", "sliding", "--eps", "1e-1", "1e-2", "--samples", "1000")


def command(*words: str | bytes, **options: object) -> subprocess.CompletedProcess[bytes]:
    """Run a command in a process of its own."""
    done: subprocess.CompletedProcess[bytes] = subprocess.run(
        [sys.executable, "-c", DRIVER, *words],
        check=False,
        **{"capture_output": True, **options},  # type: ignore[call-overload]
    )
    return done


def stop_at(number: int, count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """This process gets a signal when a sweep measures its nth point."""
    calls = 0

    def stopping(*arguments: object) -> object:
        nonlocal calls
        calls += 1
        if calls == count:
            signal.raise_signal(number)
        return collect(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(distances, "collect", stopping)


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_sweep_that_is_stopped_keeps_the_points_that_it_has(
    number: int, status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = tmp_path / "whole.h5"
    assert main([*SWEEP, "-o", str(whole)]) == 0
    capsys.readouterr()
    stop_at(number, 4, monkeypatch)
    assert main([*SWEEP, "-o", str(tmp_path / "part.h5")]) == status
    found = capsys.readouterr()
    assert found.err == ""
    first, second, last = found.out.splitlines()
    assert first.startswith("paradox: negative; consistent")
    assert second == "sliding: none; interrupted before its verdict"
    assert "interrupted after 3 of 4 points" in last
    part, complete = load(tmp_path / "part.h5"), load(whole)
    assert (part.attrs["status"], complete.attrs["status"]) == ("interrupted", "complete")
    assert part["outcome"].values.tolist() == [[1, 1], [1, 0]]
    for name in ("excess_Aeps_A_lower", "excess_A_Aeps_upper", "slope", "gamma"):
        assert part[name].values[0].tolist() == complete[name].values[0].tolist()
    draw(part)


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_sweep_that_is_stopped_before_its_first_point_leaves_nothing(
    number: int, status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    stop_at(number, 1, monkeypatch)
    assert main([*SWEEP, "-o", str(tmp_path / "part.h5"), "--json"]) == status
    assert capsys.readouterr() == ("", "painleve: interrupted\n")
    assert list(tmp_path.iterdir()) == []


def test_a_trajectory_that_is_terminated_is_printed_written_and_ends_with_143(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from painleve.cli import simulate as command_simulate

    class Stopping:
        """A progress bar that stops the process twice, as `timeout` does."""

        total, n = 0.5, 0

        def __init__(self, **_: object) -> None:
            self.calls = 0

        def __enter__(self) -> Stopping:
            return self

        def __exit__(self, *_: object) -> None:
            pass

        def update(self, _: float) -> None:
            self.calls += 1
            if self.calls == 3:
                signal.raise_signal(signal.SIGTERM)

    import tqdm

    monkeypatch.setattr(tqdm, "tqdm", Stopping)
    monkeypatch.setattr(fixed_step, "CHUNK", 10)
    assert command_simulate is not None
    words = ["simulate", "slender_rod", "--state", "stoss", "--step", "1e-3", "--until", "0.5", "--json"]
    assert main([*words, "-o", str(tmp_path / "a.h5")]) == 143
    facts = json.loads(capsys.readouterr().out)
    assert facts["status"] == "interrupted"
    assert load(tmp_path / "a.h5").sizes["time"] == facts["steps"] + 1
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


def test_a_process_that_was_told_to_ignore_the_signal_ignores_it(capsys: pytest.CaptureFixture[str]) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        assert main(["scenes"]) == 0
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


@pytest.mark.parametrize("words", [("scenes",), ("derive", "slender_rod", "--json"), ("--help",)], ids=" ".join)
def test_a_reader_that_is_gone_is_left_alone(words: tuple[str, ...]) -> None:
    read, write = os.pipe()
    os.close(read)
    done = command(*words, capture_output=False, stdout=write, stderr=subprocess.PIPE)
    os.close(write)
    assert done.stderr == b""
    assert done.returncode in (141, 0 if words == ("--help",) else 141)


def test_an_output_on_a_full_disk_is_said_in_one_line() -> None:
    with Path("/dev/full").open("wb") as full:
        done = command("scenes", capture_output=False, stdout=full, stderr=subprocess.PIPE)
    assert done.returncode == 2
    assert done.stderr == b"painleve: the output cannot be written: No space left on device\n"


@pytest.mark.parametrize("encoding", ["ascii", "cp1251"])
def test_what_an_encoding_cannot_say_is_printed_as_an_escape(encoding: str, capsys: pytest.CaptureFixture[str]) -> None:
    """In the text of a derivation stands an é."""
    assert main(["derive", "slender_rod", "--json"]) == 0
    plain = capsys.readouterr().out
    assert "é" in plain
    environment = {**os.environ, "PYTHONIOENCODING": encoding}
    for words in (("--help",), ("derive", "slender_rod")):
        done = command(*words, env=environment)
        assert (done.returncode, done.stderr) == (0, b"")
        assert "\\xe9" in done.stdout.decode(encoding)
    found = command("derive", "slender_rod", "--json", env=environment)
    assert found.returncode == 0
    assert json.loads(found.stdout.decode(encoding)) == json.loads(plain)


@pytest.mark.parametrize(
    "words", [(*SWEEP, "-o"), ("simulate", "slender_rod", "--state", "stoss", "--step", "1", "--until", "1", "-o")]
)
def test_a_name_that_is_no_text_is_refused_before_anything_is_computed(
    words: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    name = os.fsdecode(b"a\xff.h5")
    line = assert_refused([*words, name], capsys, tmp_path, monkeypatch)
    assert "not text in UTF-8" in line
    assert line.isascii()


def test_a_name_of_a_new_scene_that_is_no_text_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert_refused(["new-scene", "a", "-o", os.fsdecode(b"a\xff.toml")], capsys, tmp_path, monkeypatch)


def test_a_command_with_bytes_that_are_no_text_is_kept_as_escapes(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").symlink_to(tmp_path / "a.toml")
    assert main(["new-scene", "a", "-o", str(tmp_path / "a.toml")]) == 0
    odd = os.fsencode(tmp_path) + b"/\xff.toml"
    os.rename(tmp_path / "a.toml", odd)
    target = tmp_path / "a.h5"
    words = (b"simulate", odd, "--state", "paradox", "--step", "1e-2", "--until", "0.1", "-o", str(target))
    done = command(*words)
    assert (done.returncode, done.stderr) == (0, b"")
    assert "\\udcff.toml" in load(target).attrs["command"]


@pytest.mark.parametrize("suffix", [".csv", ".txt", ".png", ".zarr", ".h5x"])
def test_a_dataset_is_not_written_under_the_name_of_another_format(
    suffix: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    line = assert_refused([*SWEEP, "-o", f"a{suffix}"], capsys, tmp_path, monkeypatch)
    assert "HDF5" in line
    assert ".h5" in line


LONG = "x" * 6000


@pytest.mark.parametrize(
    "words",
    [
        ("classify", LONG, "--state", "paradox"),
        ("classify", "slender_rod", "--state", LONG),
        ("classify", "slender_rod", "--state", "paradox", "--set", f"mu={LONG}"),
        ("distance", "slender_rod", "--state", "paradox", "--eps", LONG),
        (LONG,),
        ("classify", f"--{LONG}"),
        (*SWEEP, "-o", f"{LONG}.h5"),
        ("plot", LONG),
    ],
)
def test_a_line_about_long_input_is_short(
    words: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert len(assert_refused(words, capsys, tmp_path, monkeypatch)) < 1100


ODD_NUMBERS = (
    "1_0e-3",
    "٠.٠١",
    "1e-٢",
    "०.१",
    "1__0",
    "0x10",
    "1e-3j",
    "1,5",
    "",
    ".",
    "e5",
    "1e1_0",
    "½",
    "1 0",
)


@pytest.mark.parametrize("number", ODD_NUMBERS)
def test_what_is_written_as_no_number_is_none(
    number: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    distance = ["distance", "slender_rod", "--state", "paradox"]
    assert_refused([*distance, "--eps", number], capsys, tmp_path, monkeypatch)
    assert_refused([*distance, "--eps", "1e-3", "--samples", number], capsys, tmp_path, monkeypatch)
    assert_refused(["classify", "slender_rod", "--state", f"theta={number}"], capsys, tmp_path, monkeypatch)


@pytest.mark.parametrize("threads", ["1e5", "0", "-1", "257"])
def test_a_number_of_threads_that_no_machine_has_is_refused(
    threads: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    words = ["distance", "slender_rod", "--state", "paradox", "--eps", "1e-2", "--threads", threads]
    assert "at most 256" in assert_refused(words, capsys, tmp_path, monkeypatch)
    words = ["ensemble", "slender_rod", "--state", "stoss", "--step", "1e-2", "--until", "0.1", "--count", "10"]
    assert_refused([*words, "--spread", "1", "--threads", threads], capsys, tmp_path, monkeypatch)


def test_the_package_runs_as_a_module() -> None:
    done = subprocess.run([sys.executable, "-m", "painleve", "scenes"], capture_output=True, text=True, check=True)
    assert "slender_rod" in done.stdout
    bad = subprocess.run([sys.executable, "-m", "painleve", "no"], capture_output=True, text=True, check=False)
    assert bad.returncode == 2
    assert bad.stderr.startswith("painleve: no command")
