"""What a session shows of motions: one short line, and on the command line a text for a person."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import pytest

from painleve.dynamics.ensemble import Ensemble, run_ensemble
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import as_start
from painleve.dynamics.trajectory import Trajectory
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state


@cache
def stoss() -> Trajectory:
    return simulate(make_state(load_scene("slender_rod"), "stoss"), step=1e-3, until=0.9)


@cache
def jams() -> Ensemble:
    return run_ensemble(stoss().start, step=1e-3, window=0.1, count=50, until=1.0, keep=True)


SHOWN: dict[str, tuple[Callable[[], object], str]] = {
    "Start": (lambda: as_start(stoss().start), r"Start\('slender_rod', 'stoss'\)"),
    "Trajectory": (
        stoss,
        r"Trajectory\('slender_rod', 'stoss', contact_dynamics: 900 steps to t = 0\.9 s, 1 jump; reached_end\)",
    ),
    "Jump": (lambda: stoss().jumps[0], r"Jump\(jump_without_collision at t = 0\.815 s, gamma = 0\.0011\)"),
    "Proposition1": (
        lambda: stoss().proposition1,
        r"Proposition1\(900 steps; worst margins: membership \S+, dissipation \S+, norm_bound -\S+\)",
    ),
    "Ensemble": (
        jams,
        r"Ensemble\('slender_rod', 'stoss', contact_dynamics: 50 members: jump 0\.\d+, lift_off 0\.\d+; reached_end\)",
    ),
    "Members": (lambda: jams().members, r"Members\(50\)"),
}


@pytest.mark.parametrize(("make", "line"), SHOWN.values(), ids=SHOWN)
def test_a_motion_shows_itself_in_one_short_line(make: Callable[[], object], line: str) -> None:
    shown = repr(make())
    assert re.fullmatch(line, shown), shown
    assert len(shown) <= 200
