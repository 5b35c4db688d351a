"""Ensembles of trajectories: many step sizes, or many initial states, each followed to the first thing that happens.

Member number i is a function of the seed and i, and what is kept of all members does not depend on their order: any
number of threads gives the same result, bit for bit, and memory does not grow with the number of members.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from painleve.core.ball_maps import uniform_ball, uniforms_needed
from painleve.core.motion_codes import Ending, MemberOutcome
from painleve.core.stepping import Fates, Rounding, SteppingMethod
from painleve.core.streams import uniform_block
from painleve.dynamics.grid import check_step, check_until
from painleve.dynamics.outline import depth_rounding, start_notes
from painleve.dynamics.scheme import Stepped
from painleve.dynamics.schemes import scheme_for
from painleve.dynamics.start import Start, as_start
from painleve.errors import InputError
from painleve.lanes import as_they_finish, thread_count
from painleve.mechanics.state import State

__all__ = ["Ensemble", "Members", "run_ensemble", "wilson_interval"]

MOST_MEMBERS = 2**50
MOST_STEPS = 2**40  # of one member: two weeks
LANE_STEPS = 2_000_000  # some tenths of a second, so that progress and Ctrl-C come through
LANE_MEMBERS = 16_384
BINS = 65_536  # of the jump times, for their median
NORMAL_QUANTILE = 1.959963984540054  # of 0.975


@dataclass(frozen=True, kw_only=True, eq=False)
class Members:
    """Every member, where asked for: step size, outcome (codes of MemberOutcome), its time, and the number of steps."""

    step: np.ndarray
    outcome: np.ndarray
    time: np.ndarray
    steps: np.ndarray

    def __repr__(self) -> str:
        return f"Members({len(self.step)})"


@dataclass(frozen=True, kw_only=True, eq=False)
class Ensemble:
    """How many members had each outcome, and when those that jumped did.

    `jump_time` is (least, median, greatest) or None; the median is that of a histogram whose bins have the width
    `resolution`. The fractions estimate probabilities; `interval` is Wilson's for 95 %.
    """

    start: Start
    scheme: str
    settings: Mapping[str, object]
    counts: Mapping[MemberOutcome, int]
    jump_time: tuple[float, float, float] | None
    resolution: float
    steps: int
    ending: Ending
    members: Members | None = None

    def __repr__(self) -> str:
        shares = ", ".join(f"{o.label} {self.fraction(o):.4g}" for o, number in self.counts.items() if number)
        name = f"{self.start.scene.name!r}, {self.start.label!r}, {self.scheme}"
        return f"Ensemble({name}: {self.count} members: {shares or 'none'}; {self.ending.label})"

    @property
    def count(self) -> int:
        """Members that ran."""
        return sum(self.counts.values())

    def fraction(self, outcome: MemberOutcome) -> float:
        return self.counts[outcome] / self.count if self.count else math.nan

    def interval(self, outcome: MemberOutcome) -> tuple[float, float]:
        """Wilson's 95 % confidence interval for the probability of an outcome."""
        return wilson_interval(self.fraction(outcome), self.count) if self.count else (0.0, 1.0)

    def as_dict(self) -> dict[str, object]:
        """Facts for machines: every outcome is listed, those that no member had with the fraction 0."""
        times = self.jump_time and dict(zip(("min", "median", "max"), self.jump_time, strict=True))
        return {
            "status": self.ending.label,
            "ending": self.ending.sentence,
            "notes": list(start_notes(self.start)),
            "count": self.count,
            "fractions": {o.label: self.fraction(o) for o in self.counts},
            "intervals": {o.label: list(self.interval(o)) for o in self.counts},
            "jump_time": times and {**times, "resolution": self.resolution},
            "steps": self.steps,
            "settings": dict(self.settings),
        }


def wilson_interval(fraction: float, n: float) -> tuple[float, float]:
    """Wilson's 95 % confidence interval for a probability, from a fraction of n > 0 independent trials."""
    z2 = NORMAL_QUANTILE**2
    centre = fraction + z2 / (2 * n)
    half = NORMAL_QUANTILE * math.sqrt(fraction * (1.0 - fraction) / n + z2 / (4.0 * n * n))
    return max(0.0, (centre - half) / (1.0 + z2 / n)), min(1.0, (centre + half) / (1.0 + z2 / n))


@dataclass
class _EnsembleTally:
    """What is kept of the members; sums, least and greatest values do not depend on the order."""

    counts: np.ndarray = field(default_factory=lambda: np.zeros(len(MemberOutcome), np.int64))
    histogram: np.ndarray = field(default_factory=lambda: np.zeros(BINS, np.int64))
    first: float = math.inf
    last: float = -math.inf
    steps: int = 0

    def add(self, outcome: np.ndarray, time: np.ndarray, steps: np.ndarray, bins: np.ndarray) -> None:
        self.counts += np.bincount(outcome, minlength=len(MemberOutcome))
        self.steps += int(steps.sum())
        jumps = outcome == MemberOutcome.JUMP
        if jumps.any():
            self.histogram += np.bincount(bins[jumps], minlength=BINS)
            self.first, self.last = min(self.first, time[jumps].min()), max(self.last, time[jumps].max())


@dataclass(frozen=True, kw_only=True)
class _Task:
    """One ensemble: what its members have in common and how member i differs."""

    start: Start
    scheme: str
    method: SteppingMethod
    step: float
    until: float
    count: int
    seed: int
    spread: float | None
    window: float | None
    ball: float | None

    @property
    def lane(self) -> int:
        """Members a lane: a number that does not depend on the threads."""
        return max(1, min(LANE_MEMBERS, int(LANE_STEPS * self.step / self.until) if self.until else LANE_MEMBERS))

    def run(self, first: int) -> tuple[int, Members]:
        """Members first ... first + lane - 1, as far as there are any."""
        n = min(self.lane, self.count - first)
        h, q, u = self.draw(first, n)
        fates = Fates(outcome=np.empty(n, np.int8), time=np.empty(n), steps=np.empty(n, np.int64))
        s = self.start
        rounding = Rounding(s.rounding, depth_rounding(s))
        s.motion.run_members(self.method, rounding, s.t, self.until, h, q, u, s.p, fates)
        return first, Members(step=h, **fates._asdict())

    def draw(self, first: int, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Steps (n,) and initial q, u (n, d)."""
        d = len(self.start.q)
        q, u = np.tile(self.start.q, (n, 1)), np.tile(self.start.u, (n, 1))
        if self.ball is not None:
            needed = uniforms_needed(d, d)
            uniforms, dq, du = np.empty((2 * needed, n)), np.empty((d, n)), np.empty((d, n))
            uniform_block(self.seed, first, uniforms)
            uniform_ball(uniforms[:needed], dq, self.ball, d)
            uniform_ball(uniforms[needed:], du, self.ball, d)
            return np.full(n, self.step), q + dq.T, u + du.T
        draws = np.empty((1, n))
        uniform_block(self.seed, first, draws)
        if self.spread is not None:
            return self.step * 10.0 ** (self.spread * draws[0]), q, u
        assert self.window is not None
        return self.step * (1.0 + self.window * (2.0 * draws[0] - 1.0)), q, u


def run_ensemble(
    start: Start | State,
    *,
    step: float,
    count: int,
    until: float,
    spread: float | None = None,
    window: float | None = None,
    ball: float | None = None,
    seed: int = 0,
    scheme: str = "contact_dynamics",
    contact_tolerance: float = 0.0,
    options: Mapping[str, float] | None = None,
    threads: int | None = None,
    keep: bool = False,
    progress: Callable[[int], None] | None = None,
) -> Ensemble:
    """Follow `count` members to their first jump, sticking contact, collision or lift-off, or to the end.

    They differ in one thing: the step size, log-uniform in [step, step 10^spread] or uniform in step [1 - window,
    1 + window], or the initial state, uniform in balls of radius `ball` about q and about u. `keep` returns them all;
    `progress` is called with the number of members done since the last call. Ctrl-C ends it with what there is.
    Raises InputError for bad input.
    """
    beginning = as_start(start)
    stepped = scheme_for(beginning.scene, scheme)
    if not isinstance(stepped, Stepped):
        raise InputError(f"scheme: ensembles need a fixed-step scheme, and {scheme} is not one")
    settings = stepped.settings(contact_tolerance, options)
    task = _Task(
        start=beginning,
        scheme=scheme,
        method=SteppingMethod(int(stepped.code), stepped.theta(settings), contact_tolerance),
        step=check_step(step),
        until=check_until(until),
        count=_checked_count(count),
        seed=_checked_seed(seed),
        spread=spread,
        window=window,
        ball=ball,
    )
    _check_difference(task)
    return _collect(task, threads, keep, progress)


def _checked_count(count: int) -> int:
    if not 1 <= count <= MOST_MEMBERS:
        raise InputError(f"count: {count} must be between 1 and 2^50")
    return int(count)


def _checked_seed(seed: int) -> int:
    if not 0 <= seed < 2**63:
        raise InputError(f"seed: {seed} must be between 0 and 2^63 - 1")
    return int(seed)


def _check_difference(task: _Task) -> None:
    """Exactly one way in which the members differ, in range."""
    given = {name: getattr(task, name) for name in ("spread", "window", "ball")}
    given = {name: value for name, value in given.items() if value is not None}
    if len(given) != 1:
        raise InputError("ensemble: give one of spread (decades of step sizes), window (relative) and ball (a radius)")
    ((name, value),) = given.items()
    if not (math.isfinite(value) and value >= 0.0) or (name == "window" and value >= 1.0):
        below = " below 1" if name == "window" else ""
        raise InputError(f"{name}: {value} must be zero or a positive number{below}")
    if name == "ball" and value < 1e-300:
        raise InputError(f"ball: {value} must be at least 1e-300")
    if name == "spread" and value > 300.0:
        raise InputError(f"spread: {value} decades of step sizes are more than numbers have")
    least = task.step * (1.0 - (task.window or 0.0))
    if task.until / least > MOST_STEPS:
        raise InputError(f"step: {task.until:g}/{least:g} is more than 2^40 steps for one member; take larger steps")


def _collect(task: _Task, threads: int | None, keep: bool, progress: Callable[[int], None] | None) -> Ensemble:
    thread_count(threads)
    tally, ending = _EnsembleTally(), Ending.REACHED_END
    width = (task.until or 1.0) / (BINS - 1)  # the end itself is in the last bin
    kept = _empty_members(task.count) if keep else None
    lanes = as_they_finish(task.run, range(0, task.count, task.lane), threads)
    try:
        for first, members in lanes:
            bins = np.clip((members.time - task.start.t) / width, 0, BINS - 1).astype(np.int64)
            tally.add(members.outcome, members.time, members.steps, bins)
            if kept is not None:
                for name in ("step", "outcome", "time", "steps"):
                    getattr(kept, name)[first : first + len(members.step)] = getattr(members, name)
            if progress is not None:
                progress(len(members.step))
    except KeyboardInterrupt:
        ending = Ending.INTERRUPTED
    finally:
        lanes.close()
    varied = {"spread": task.spread, "window": task.window, "ball": task.ball}
    return Ensemble(
        start=task.start,
        scheme=task.scheme,
        ending=ending,
        steps=tally.steps,
        resolution=width,
        members=kept,
        counts={o: int(tally.counts[o]) for o in MemberOutcome if o is not MemberOutcome.NOT_RUN},
        jump_time=_jump_time(tally, task.start.t, width),
        settings={
            "step": task.step,
            "until": task.until,
            "count": task.count,
            "seed": task.seed,
            "contact_tolerance": task.method.tolerance,
            "theta": task.method.theta,
            **{name: value for name, value in varied.items() if value is not None},
        },
    )


def _empty_members(count: int) -> Members:
    """Room for all members, none of which has run."""
    return Members(
        step=np.full(count, np.nan),
        outcome=np.full(count, int(MemberOutcome.NOT_RUN), np.int8),
        time=np.full(count, np.nan),
        steps=np.zeros(count, np.int64),
    )


def _jump_time(tally: _EnsembleTally, start: float, width: float) -> tuple[float, float, float] | None:
    jumps = int(tally.histogram.sum())
    if jumps == 0:
        return None
    middle = int(np.searchsorted(np.cumsum(tally.histogram), (jumps + 1) // 2))
    median = min(max(start + (middle + 0.5) * width, tally.first), tally.last)
    return float(tally.first), float(median), float(tally.last)
