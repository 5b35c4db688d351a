"""The instants of a motion: the last one is the end, and a last step cut short for that is not taken for an impact."""

from __future__ import annotations

import numpy as np
import pytest

from painleve.core.motion_codes import Change, MemberOutcome
from painleve.dynamics.ensemble import run_ensemble
from painleve.dynamics.grid import make_grid
from painleve.dynamics.schemes import SCHEME_NAMES
from painleve.dynamics.simulate import simulate
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

ROD, ARM = load_scene("slender_rod"), load_scene("two_link_arm")


@pytest.mark.parametrize(("step", "until", "count"), [(2.0, 1.0, 1), (0.3, 1.0, 4), (0.1, 0.3, 3), (1e-3, 1.0, 1000)])
def test_the_last_instant_is_the_end(step: float, until: float, count: int) -> None:
    grid = make_grid(5.0, step, until)
    assert len(grid.h) == len(grid.given) == count
    assert grid.t[-1] == pytest.approx(5.0 + until, rel=1e-15)
    np.testing.assert_allclose(np.diff(grid.t), grid.h, rtol=1e-12)
    assert (grid.given == step).all()
    assert (grid.h[:-1] == step).all()


def test_steps_that_reach_the_end_to_rounding_stay_as_they_are() -> None:
    grid = make_grid(0.0, 0.1, 0.3)  # 3 * 0.1 is not 0.3
    np.testing.assert_array_equal(grid.t, 0.1 * np.arange(4))
    assert (grid.h == 0.1).all()


def test_the_last_of_given_steps_is_shortened() -> None:
    given = np.array([0.2, 0.5, 0.4, 7.0])
    grid = make_grid(1.0, given, 1.0)
    np.testing.assert_allclose(grid.h, [0.2, 0.5, 0.3], rtol=1e-15)
    assert grid.t[-1] == 2.0
    np.testing.assert_array_equal(grid.given, given[:3])
    assert given.tolist() == [0.2, 0.5, 0.4, 7.0]


@pytest.mark.parametrize("scheme", SCHEME_NAMES)
def test_a_motion_ends_at_the_end_and_its_last_step_is_one_of_that_length(scheme: str) -> None:
    state = make_state(ROD, "sliding")
    found = simulate(state, scheme=scheme, step=0.03, until=0.1)
    assert found.t[-1] == 0.1
    given = simulate(state, scheme=scheme, step=[0.03, 0.03, 0.03, 0.1 - 0.09], until=0.1)
    np.testing.assert_allclose(found.q[-1], given.q[-1], rtol=1e-12)
    np.testing.assert_allclose(found.u[-1], given.u[-1], rtol=1e-12)


def test_a_tiny_last_step_is_no_impact_after_a_hop_of_longer_ones() -> None:
    """The tip comes back with a speed of the order of the longer steps, and it may come back in any step."""
    state, kinds = make_state(ARM, "sliding"), set()
    for steps in range(180, 220):
        until = 1e-4 * (steps + 1e-4)
        found = simulate(state, step=1e-4, until=until, monitor=False)
        assert found.steps == steps + 1
        assert (found.change == Change.ORDINARY).all()
        kinds.add(int(found.branch[-1]))
        same = run_ensemble(state, step=1e-4, window=0.0, count=1, until=until, keep=True)
        assert same.counts[MemberOutcome.SLIDE] == 1
        assert same.members.time[0] == until
    assert len(kinds) == 2  # some ended in a contact
