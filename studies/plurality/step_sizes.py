"""One trajectory at many step sizes: jump or lift-off, and when; the dataset of the paper's question."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from painleve.core.jam_map import jam_fraction, limit_law
from painleve.core.motion_codes import Ending, MemberOutcome
from painleve.dynamics.ensemble import run_ensemble
from painleve.dynamics.genot_brogliato import SingularPoint, singular_point
from painleve.dynamics.simulate import simulate
from painleve.errors import InputError
from painleve.kernels.motion.compiled import make_motion
from painleve.mechanics.state import State
from painleve.store import provenance
from painleve.sweep.variables import coded
from studies.plurality.jam_law import CONTACTS

__all__ = ["Approach", "StepWindow", "find_approach", "sweep_step_sizes"]

NEAR = (1e-4, 1e-3)  # rad: where the amplitude is read off the slip
OUTCOMES = ("jump", "lift_off", "other")
MOST_KEPT = 2000  # members a window that the dataset keeps for its picture
KEPT_TOLERANCE = 0.3  # m: more than the explicit update lifts the tip, c h T/2, at h = 1e-2


@dataclass(frozen=True, kw_only=True)
class Approach:
    """The exact slip into the point: when it arrives (s), and its amplitude K with the spread of the estimate."""

    point: SingularPoint
    instant: float
    amplitude: float
    amplitude_spread: float


@dataclass(frozen=True, kw_only=True)
class StepWindow:
    """Step sizes log-uniform over `decades` from `step` on, `count` of them (a quarter with the tip kept)."""

    step: float
    decades: float
    count: int


def find_approach(state: State, *, until: float) -> Approach:
    """Follow the rod's slip by event-driven integration to the singular point. Raises InputError if it ends elsewhere.

    K is read from beta = -K x^r - D x/(1 - r) at two distances; what they differ by is the spread.
    """
    scene = state.scene
    p = {s.name: float(state.number(state.parameters[s.name])) for s in scene.parameters}
    alpha = p["m"] * p["l"] ** 2 / p["I"]
    point = singular_point(p["mu"], alpha=alpha, gravity=p["gravity"], mass=p["m"], length=p["l"])
    whole = simulate(state, scheme="event_driven", step=until, until=until, monitor=False)
    instant = float(whole.t[-1])
    if whole.ending is not Ending.INCONSISTENT or abs(whole.q[-1, 2] - point.theta) > 1e-6:
        raise InputError(f"state {state.label}: its slip does not run into the singular point: {whole.sentence}")
    times = instant - np.array(sorted(NEAR, reverse=True)) / point.omega
    steps = np.diff([0.0, *times, instant])
    near = simulate(state, scheme="event_driven", step=steps, until=instant, monitor=False)
    estimates = []
    for time in times:
        i = int(np.argmin(np.abs(near.t - time)))
        theta, omega = near.q[i, 2], near.u[i, 2]
        x, beta = point.theta - theta, point.length * omega**2 * np.sin(theta) - point.gravity
        estimates.append((-beta - point.drift * x / (1.0 - point.ratio)) / x**point.ratio)
    spread = abs(estimates[1] - estimates[0])
    return Approach(point=point, instant=instant, amplitude=float(estimates[1]), amplitude_spread=float(spread))


def sweep_step_sizes(
    state: State,
    windows: Sequence[StepWindow],
    *,
    until: float,
    seed: int = 0,
    progress: Callable[[int], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Fractions that jump, jump times and some members, for both contact tests; (contact, window) and (..., member).

    `local_map` is what painleve.core.jam_map predicts from the amplitude of the exact slip, averaged over the window.
    """
    approach = find_approach(state, until=until)
    shape = (len(CONTACTS), len(windows))
    kept = min(MOST_KEPT, max(w.count for w in windows))
    number = {
        name: np.full(shape, np.nan) for name in ("fraction", "lower", "upper", "local_map", "first", "median", "last")
    }
    count = np.zeros(shape, np.int64)
    steps, times = np.full((*shape, kept), np.nan), np.full((*shape, kept), np.nan)
    outcomes = np.zeros((*shape, kept), np.int8)
    for i, contact in enumerate(CONTACTS):
        for j, window in enumerate(windows):
            asked = window.count if contact == "strict" else -(-window.count // 4)
            e = run_ensemble(
                state,
                step=window.step,
                spread=window.decades,
                count=asked,
                until=until,
                seed=seed + j,
                contact_tolerance=0.0 if contact == "strict" else KEPT_TOLERANCE,
                keep=True,
            )
            count[i, j] = e.count
            number["fraction"][i, j] = e.fraction(MemberOutcome.JUMP)
            number["lower"][i, j], number["upper"][i, j] = e.interval(MemberOutcome.JUMP)
            number["local_map"][i, j] = _predicted(approach, window, strict=contact == "strict")
            if e.jump_time is not None:
                number["first"][i, j], number["median"][i, j], number["last"][i, j] = e.jump_time
            assert e.members is not None
            n = min(kept, asked)
            steps[i, j, :n], times[i, j, :n] = e.members.step[:n], e.members.time[:n]
            outcomes[i, j, :n] = 1 + np.select(
                [e.members.outcome[:n] == MemberOutcome.JUMP, e.members.outcome[:n] == MemberOutcome.LIFT_OFF],
                [0, 1],
                2,
            )
            if progress is not None:
                progress(1)
    return _dataset(state, windows, approach, number, count, (steps, times, outcomes), seed, command)


def _predicted(approach: Approach, window: StepWindow, *, strict: bool) -> float:
    """The local map, averaged over the window."""
    point = approach.point
    drift = point.strict_drift if strict else point.kept_drift
    steps = window.step * 10.0 ** (window.decades * (np.arange(9) + 0.5) / 9)
    return float(
        np.mean([jam_fraction(point.ratio, drift(h, approach.amplitude), strict=strict, phases=2000) for h in steps])
    )


def _dataset(
    state: State,
    windows: Sequence[StepWindow],
    approach: Approach,
    number: dict[str, np.ndarray],
    count: np.ndarray,
    members: tuple[np.ndarray, np.ndarray, np.ndarray],
    seed: int,
    command: str | None,
) -> xr.Dataset:
    sentences = {
        "fraction": ("measured fraction of the step sizes that jump", "1"),
        "lower": ("lower end of Wilson's 95 % interval", "1"),
        "upper": ("upper end of Wilson's 95 % interval", "1"),
        "local_map": ("fraction that the local map predicts", "1"),
        "first": ("earliest time of a jump", "s"),
        "median": ("median time of the jumps", "s"),
        "last": ("latest time of a jump", "s"),
    }
    dims, each = ("contact", "window"), ("contact", "window", "member")

    def variable(on: tuple[str, ...], values: object, sentence: str, unit: str) -> xr.Variable:
        return xr.Variable(on, np.asarray(values), {"long_name": sentence, "units": unit})

    variables = {name: variable(dims, number[name], *sentences[name]) for name in sentences}
    variables |= {
        "count": variable(dims, count, "number of step sizes tried", "1"),
        "step": variable(each, members[0], "step sizes of some members", "s"),
        "time": variable(each, members[1], "when the first thing happened to them", "s"),
        "outcome": coded(each, members[2], OUTCOMES, "what happened to them first"),
        "instant": variable((), approach.instant, "when the exact slip reaches the singular point", "s"),
        "amplitude": variable((), approach.amplitude, "amplitude K of the exact slip near the point", "m/(s^2 rad^r)"),
        "amplitude_spread": variable(
            (), approach.amplitude_spread, "how far two estimates of K differ", "m/(s^2 rad^r)"
        ),
        "law": variable(
            ("contact",),
            [limit_law(approach.point.ratio, strict=contact == "strict") for contact in CONTACTS],
            "limit of the fraction as h tends to 0, by the jam law",
            "1",
        ),
        "ratio": variable((), approach.point.ratio, "ratio r of the eigenvalues there", "1"),
    }
    coordinates = {
        "contact": coded(["contact"], np.array([1, 2]), CONTACTS, "contact test: strict, or tip kept on the floor"),
        "first_step": variable(("window",), [w.step for w in windows], "smallest step size of the window", "s"),
        "decades": variable(("window",), [w.decades for w in windows], "width of the window, in decades", "1"),
    }
    scene = state.scene
    source = provenance(scene=scene, scene_digest=make_motion(scene).digest, seed=seed, command=command)
    title = f"Outcome of {scene.name} {state.label} over the step size"
    return xr.Dataset(variables, coordinates, {"title": title, "kind": "step_sizes", **source})
