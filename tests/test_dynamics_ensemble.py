"""Ensembles: the same on any number of threads, member by member what single trajectories do, and Glocker's rod."""

from __future__ import annotations

import math

import numpy as np
import pytest

from painleve.core.motion_codes import Change, Ending, FixedStep, MemberOutcome
from painleve.core.stepping import SteppingMethod
from painleve.dynamics.ensemble import _Task, run_ensemble
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import as_start
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

ROD = load_scene("slender_rod")
STOSS = make_state(ROD, "stoss")
PARADOX = make_state(ROD, "paradox")


@pytest.mark.parametrize("difference", [{"spread": 1.0}, {"window": 0.1}, {"ball": 1e-3}])
def test_an_ensemble_is_the_same_bit_for_bit_on_any_number_of_threads(difference: dict[str, float]) -> None:
    runs = [
        run_ensemble(STOSS, step=2e-4, count=2000, until=0.9, seed=5, threads=threads, keep=True, **difference)
        for threads in (1, 2, 5)
    ]
    for other in runs[1:]:
        assert other.as_dict() == runs[0].as_dict()
        for name in ("step", "outcome", "time", "steps"):
            np.testing.assert_array_equal(getattr(other.members, name), getattr(runs[0].members, name))
    assert runs[0].as_dict() != run_ensemble(STOSS, step=2e-4, count=2000, until=0.9, seed=6, **difference).as_dict()


@pytest.mark.parametrize(
    ("h", "count", "published", "error"), [(1e-3, 20_000, 0.543, 0.004), (1e-4, 5000, 0.512, 0.006)]
)
def test_the_fraction_of_step_sizes_that_jam_glockers_rod_is_the_measured_one(
    h: float, count: int, published: float, error: float
) -> None:
    found = run_ensemble(STOSS, step=h, count=count, until=1.0, window=0.1, seed=2)
    jams = found.fraction(MemberOutcome.JUMP) + found.fraction(MemberOutcome.STICK)
    assert jams + found.fraction(MemberOutcome.LIFT_OFF) == pytest.approx(1.0, abs=1e-12)
    # two independent samples of the same probability: four standard deviations of their difference
    assert abs(jams - published) < 4 * math.hypot(error / 2, math.sqrt(0.25 / count))
    assert found.jump_time is not None
    assert 0.81455 < found.jump_time[0] <= found.jump_time[1] <= found.jump_time[2] < 0.85


@pytest.mark.parametrize("scheme", ["contact_dynamics", "stewart_trinkle"])
def test_a_member_does_what_its_trajectory_does(scheme: str) -> None:
    found = run_ensemble(STOSS, step=1e-3, count=30, until=1.1, window=0.1, scheme=scheme, keep=True)
    assert found.members is not None
    for h, outcome, time in zip(found.members.step, found.members.outcome, found.members.time, strict=True):
        path = simulate(STOSS, scheme=scheme, step=float(h), until=1.1, monitor=False)
        jumps = [j for j in path.jumps if j.kind is Change.JUMP_WITHOUT_COLLISION]
        assert (outcome == MemberOutcome.JUMP) == bool(jumps)
        if jumps:
            assert jumps[0].time == pytest.approx(time, rel=1e-12)
        else:
            assert outcome == MemberOutcome.LIFT_OFF
            assert path.to_xarray().g.values[path.t >= time].max() < 0.0
    assert set(found.members.outcome) == {MemberOutcome.JUMP, MemberOutcome.LIFT_OFF}


def test_fractions_and_times_are_those_of_the_members() -> None:
    found = run_ensemble(STOSS, step=5e-4, count=3000, until=1.0, spread=0.5, seed=1, keep=True)
    members = found.members
    assert members is not None
    jumps = members.time[members.outcome == MemberOutcome.JUMP]
    assert found.fraction(MemberOutcome.JUMP) == len(jumps) / 3000
    least, median, greatest = found.jump_time
    assert (least, greatest) == (jumps.min(), jumps.max())
    assert abs(median - np.median(jumps)) < 2 * found.resolution
    assert found.steps == members.steps.sum()
    assert 5e-4 <= members.step.min() < members.step.max() <= 5e-4 * 10**0.5
    # log-uniform: the logarithms are uniform on [0, 1/2]
    logs = np.sort(np.log10(members.step / 5e-4)) / 0.5
    assert np.abs(logs - (np.arange(3000) + 0.5) / 3000).max() < 1.95 / math.sqrt(3000)


def test_the_median_is_the_time_of_the_middle_member_to_half_a_bin() -> None:
    for seed in range(40):
        found = run_ensemble(PARADOX, step=1e-3, count=1 + seed, until=0.1, spread=1.5, seed=seed, keep=True)
        times = np.sort(found.members.time[found.members.outcome == MemberOutcome.JUMP])
        assert len(times) > seed / 2
        assert abs(found.jump_time[1] - times[(len(times) - 1) // 2]) <= found.resolution * (0.5 + 1e-9)


def test_initial_states_fill_the_two_balls() -> None:
    start = as_start(PARADOX)
    task = _Task(
        start=start,
        scheme="contact_dynamics",
        method=SteppingMethod(int(FixedStep.CONTACT_DYNAMICS), 0.0, 0.0),
        step=1e-3,
        until=1.0,
        count=4000,
        seed=0,
        spread=None,
        window=None,
        ball=0.1,
    )
    h, q, u = task.draw(0, 4000)
    assert (h == 1e-3).all()
    for values, centre in ((q, start.q), (u, start.u)):
        radii = np.linalg.norm(values - np.array(centre), axis=1)
        assert radii.max() <= 0.1 * (1 + 1e-12)
        assert np.mean((radii / 0.1) ** 2) == pytest.approx(3 / 5, abs=0.02)  # uniform in a ball of R^3


def test_the_paradox_jumps_at_every_step_size_and_sliding_at_none() -> None:
    always = run_ensemble(PARADOX, step=1e-5, count=500, until=1e-2, spread=2)
    assert always.fraction(MemberOutcome.JUMP) == 1.0
    assert always.interval(MemberOutcome.JUMP)[0] > 0.99
    state = make_state(ROD, keys={"theta": "pi/3", "slip": -3, "omega": 1}, parameters={"mu": "3/10"})
    never = run_ensemble(state, step=1e-5, count=500, until=1e-2, spread=2)
    assert never.fraction(MemberOutcome.SLIDE) == 1.0
    assert never.jump_time is None


def test_wilsons_interval_is_the_root_of_its_equation() -> None:
    found = run_ensemble(STOSS, step=1e-3, count=200, until=1.0, window=0.1)
    p, n = found.fraction(MemberOutcome.JUMP), 200
    for bound in found.interval(MemberOutcome.JUMP):
        assert abs(p - bound) == pytest.approx(1.959963984540054 * math.sqrt(bound * (1 - bound) / n), rel=1e-12)


def test_control_c_ends_an_ensemble_with_what_there_is() -> None:
    done: list[int] = []

    def interrupt(members: int) -> None:
        done.append(members)
        if len(done) == 3:
            raise KeyboardInterrupt

    found = run_ensemble(STOSS, step=1e-4, count=5000, until=1.0, window=0.1, threads=2, keep=True, progress=interrupt)
    assert found.ending is Ending.INTERRUPTED
    assert found.count == sum(done) < 5000
    assert found.members is not None
    assert (found.members.outcome == MemberOutcome.NOT_RUN).sum() == 5000 - found.count


BAD = [
    ({"step": -1.0}, "step: -1.0 must be a positive number"),
    ({"until": math.inf}, "until: inf must be zero or a positive number"),
    ({"count": 0}, "count: 0 must be between"),
    ({"seed": -1}, "seed: -1 must be between"),
    ({"threads": 0}, "threads: 0 must be at least 1"),
    ({"window": None}, "give one of spread"),
    ({"ball": 1.0}, "give one of spread"),
    ({"window": 1.0}, "window: 1.0 must be zero or a positive number below 1"),
    ({"step": 1e-14}, "more than 2^40 steps"),
    ({"scheme": "event_driven"}, "ensembles need a fixed-step scheme"),
]


@pytest.mark.parametrize(("change", "words"), BAD)
def test_bad_input_to_an_ensemble_is_refused_in_one_line(change: dict, words: str) -> None:
    arguments = {"step": 1e-3, "count": 10, "until": 1.0, "window": 0.1, **change}
    with pytest.raises(InputError) as refusal:
        run_ensemble(STOSS, **arguments)
    assert words in str(refusal.value)
    assert "\n" not in str(refusal.value)
