"""Progress and Ctrl-C: a long simulation can be watched, and whoever stops it keeps what there is."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import painleve.dynamics.fixed_step as fixed_step
import painleve.dynamics.proposition1 as proposition1
from painleve.core.motion_codes import Ending
from painleve.dynamics.proposition1 import Proposition1
from painleve.dynamics.schemes import SCHEME_NAMES
from painleve.dynamics.simulate import simulate
from painleve.dynamics.trajectory import Trajectory
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.store import load

pytestmark = pytest.mark.usefixtures("interruptible")

STEPPED = SCHEME_NAMES[:5]
STOSS = make_state(load_scene("slender_rod"), "stoss")
ARRAYS = ("t", "q", "u", "r", "branch", "change")
PENDULUM = ("two_link_arm", "--q", "phi1=1", "phi2=2", "--set", "depth=3")  # the table is out of reach: it swings on
LONG = {
    "contact_dynamics": ("two_link_arm", "--state", "sliding", "--step", "1e-6", "--until", "10"),
    "event_driven": (*PENDULUM, "--step", "1", "--until", "1e6"),
    "compliant": ("slender_rod", "--state", "sliding", "--step", "1e-6", "--until", "10"),
}
PATIENCE = 120  # s: a process that compiles on a busy machine is not stuck
DRIVER = "import sys; from painleve.cli import main; sys.exit(main())"


@pytest.mark.parametrize("chunk", [1, 7, 599, 600])
@pytest.mark.parametrize("scheme", STEPPED)
def test_a_trajectory_does_not_depend_on_its_chunks(scheme: str, chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
    steps = 1.4e-3 * (1.0 + 0.3 * np.sin(np.arange(700.0)))  # the jump or the lift-off is among them
    whole = simulate(STOSS, scheme=scheme, step=steps, until=0.9)
    monkeypatch.setattr(fixed_step, "CHUNK", chunk)
    parts = simulate(STOSS, scheme=scheme, step=steps, until=0.9)
    assert whole.steps > 600
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(parts, name), getattr(whole, name))
    assert parts.statistics == whole.statistics


@pytest.mark.parametrize("scheme", SCHEME_NAMES)
def test_progress_adds_up_to_the_time_covered(scheme: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fixed_step, "CHUNK", 10)
    heard: list[float] = []
    found = simulate(STOSS, scheme=scheme, step=1e-3, until=0.05, progress=heard.append)
    assert found.ending is Ending.REACHED_END
    assert len(heard) >= 3
    assert min(heard) >= 0.0
    assert sum(heard) == pytest.approx(found.t[-1], rel=1e-12)


def stopped(scheme: str, after: int) -> Trajectory:
    """A run that gets SIGINT when it reports progress for the nth time."""
    count = 0

    def interrupt(covered: float) -> None:
        nonlocal count
        count += 1
        if count == after:
            signal.raise_signal(signal.SIGINT)

    return simulate(STOSS, scheme=scheme, step=1e-3, until=0.5, progress=interrupt)


@pytest.mark.parametrize("scheme", SCHEME_NAMES)
def test_ctrl_c_keeps_the_first_part_of_the_same_trajectory(scheme: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fixed_step, "CHUNK", 10)
    whole = simulate(STOSS, scheme=scheme, step=1e-3, until=0.5)
    part = stopped(scheme, 80 if scheme == "compliant" else 4)
    assert part.ending is Ending.INTERRUPTED
    assert part.sentence == "interrupted: what was computed until then is kept"
    kept = np.isin(part.t, whole.t)
    assert kept.sum() >= len(part.t) - 1  # all but the last place, if that is between two recorded instants
    n = int(kept.sum())
    assert 2 <= n < len(whole.t)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(part, name)[:n], getattr(whole, name)[:n])


def test_ctrl_c_in_the_middle_of_a_step_keeps_the_steps_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    from painleve.dynamics.modes import ContactPoint

    calls, original = 0, ContactPoint.force

    def force(self: ContactPoint, mode: object) -> tuple[float, float]:
        nonlocal calls
        calls += 1
        if calls == 200:
            signal.raise_signal(signal.SIGINT)
        return original(self, mode)  # type: ignore[arg-type]

    monkeypatch.setattr(ContactPoint, "force", force)
    part = simulate(STOSS, scheme="event_driven", step=0.5, until=0.5)
    assert part.ending is Ending.INTERRUPTED
    assert part.steps == 1  # no instant of the grid was passed: the last accepted step is kept all the same
    assert 0.0 < part.t[-1] < 0.5


def test_ctrl_c_while_proposition_1_is_checked_keeps_the_trajectory(monkeypatch: pytest.MonkeyPatch) -> None:
    original, blocks = proposition1._margins, 0

    def margins(*arguments: object) -> np.ndarray:
        nonlocal blocks
        blocks += 1
        if blocks == 3:
            signal.raise_signal(signal.SIGINT)
        return original(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(proposition1, "BLOCK", 100)
    monkeypatch.setattr(proposition1, "_margins", margins)
    found = simulate(STOSS, step=1e-3, until=0.5)
    assert found.ending is Ending.INTERRUPTED
    assert found.sentence.endswith("(Proposition 1 was checked for the first 200 steps)")
    assert found.steps == 500
    assert isinstance(found.proposition1, Proposition1)
    assert found.proposition1.count == 200


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scheme", "number", "status"),
    [*((scheme, signal.SIGINT, 0) for scheme in sorted(LONG)), ("contact_dynamics", signal.SIGTERM, 143)],
)
def test_a_simulation_stopped_from_the_terminal_answers_and_leaves_a_file_that_loads(
    scheme: str, number: int, status: int, tmp_path: Path
) -> None:
    pty, termios = pytest.importorskip("pty"), pytest.importorskip("termios")
    terminal, side = pty.openpty()
    termios.tcsetwinsize(side, (24, 80))  # a bar needs a width
    target = tmp_path / "part.h5"
    words = ("simulate", *LONG[scheme], "--scheme", scheme, "-o", str(target), "--json")
    process = subprocess.Popen([sys.executable, "-c", DRIVER, *words], stdout=subprocess.PIPE, stderr=side)
    os.close(side)
    try:
        wait_for(terminal, b"%|", times=2)  # the bar, and the bar again: some steps are done
        process.send_signal(number)
        process.send_signal(number if number == signal.SIGTERM else 0)  # `timeout` sends it twice
        answer, _ = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    os.close(terminal)
    assert process.returncode == status
    found = json.loads(answer)
    assert found["status"] == "interrupted"
    assert found["steps"] > 0
    kept = load(target)
    assert kept.attrs["status"] == "interrupted"
    assert kept.sizes["time"] == found["steps"] + 1
    assert float(kept["time"][-1]) == found["final"]["t"]


def wait_for(terminal: int, text: bytes, *, times: int) -> None:
    """Read what a process writes to its terminal until the text is there so many times."""
    seen = b""
    while seen.count(text) < times:
        assert select.select([terminal], [], [], PATIENCE)[0], f"no {text!r} in {seen!r}"
        seen += os.read(terminal, 1024)  # raises OSError once the process has ended without it
