"""What the Contact Dynamics scheme makes of a tangential state with gamma < 0, known to eps, within a few steps."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr

from painleve import sets
from painleve.core.ball_maps import uniform_ball, uniforms_needed
from painleve.core.motion_codes import Ending, FixedStep
from painleve.core.stepping import SteppingMethod
from painleve.core.streams import uniform_block
from painleve.dynamics.ensemble import wilson_interval
from painleve.dynamics.fixed_step import empty_track
from painleve.dynamics.start import Start, as_start
from painleve.errors import InputError
from painleve.kernels.motion.compiled import make_motion
from painleve.mechanics.norm_units import ball_unit, velocity_unit
from painleve.mechanics.state import State
from painleve.store import provenance
from painleve.sweep.variables import text
from painleve.theory.limit_set import limit_set

__all__ = ["sweep_initial_layer"]

FOLLOWED = 1.6  # sqrt(s)


def sweep_initial_layer(
    states: Mapping[str, State],
    *,
    steps: Sequence[float],
    ratios: Sequence[float],
    count: int,
    seed: int = 0,
    progress: Callable[[int], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Fractions that jump and distances to A over eps/h, by label of the state; (state, step, ratio).

    Initial states are uniform in the balls of radius eps = ratio * h about q and u-, as in the paper's A_eps, whether
    admissible or not; the right velocity of a member is that after 1.6 sqrt(h) seconds, and it has jumped if it is
    nearer to u_tilde than to u-. That time tends to 0 with h as slowly as a member falls onto the obstacle from eps
    above it, in sqrt(2 eps/|beta|) at a free normal acceleration beta < 0: a member has the time to for
    eps/h < 1.6^2 |beta|/2, whatever h. In a fixed number of steps it would not. Strict contact test. A member is
    a true one, so that e(members, A) is a lower bound for all of the ball and e(A, members) an upper bound. Raises
    InputError unless A is a pair at every state.
    """
    shape = (len(states), len(steps), len(ratios))
    names = ("fraction", "lower", "upper", "excess_from_A", "excess_of_A")
    values = {name: np.empty(shape) for name in names}
    for i, state in enumerate(states.values()):
        limit = limit_set(state)
        if limit.kind != "pair":
            raise InputError(f"state {state.label}: gamma is not negative there, or nothing is indeterminate")
        for j, h in enumerate(steps):
            for k, ratio in enumerate(ratios):
                right = _right_velocities(as_start(state), h, ratio * h, count, seed)
                jumps = np.linalg.norm(right - limit.u_plus, axis=1) < np.linalg.norm(right - limit.u_minus, axis=1)
                both = sets.hausdorff(sets.Cloud(right), limit.point_set)
                values["fraction"][i, j, k] = jumps.mean()
                values["lower"][i, j, k], values["upper"][i, j, k] = wilson_interval(jumps.mean(), count)
                values["excess_from_A"][i, j, k] = both.forward.bounds.lower
                values["excess_of_A"][i, j, k] = both.backward.bounds.upper
                if progress is not None:
                    progress(1)
    return _dataset(states, steps, ratios, values, count, seed, command)


def _right_velocities(start: Start, h: float, eps: float, count: int, seed: int) -> np.ndarray:
    """(count, d) velocities after 1.6 sqrt(h) seconds."""
    d, n = len(start.q), math.ceil(FOLLOWED / math.sqrt(h))
    needed = uniforms_needed(d, d)
    uniforms, dq, du = np.empty((2 * needed, count)), np.empty((d, count)), np.empty((d, count))
    uniform_block(seed, 0, uniforms)
    uniform_ball(uniforms[:needed], dq, eps, d)
    uniform_ball(uniforms[needed:], du, eps, d)
    method, track = SteppingMethod(int(FixedStep.CONTACT_DYNAMICS), 0.0, 0.0), empty_track(start, n)
    t, h_all, right = h * np.arange(n + 1), np.full(n, h), np.empty((count, d))
    for i in range(count):
        track.q[0], track.u[0] = start.q + dq[:, i], start.u + du[:, i]
        _, ending, _ = start.motion.run(method, 0, math.inf, t, h_all, h_all, start.p, track)
        if Ending(ending) is not Ending.REACHED_END:
            raise InputError(f"start {start.label}: a step of {h:g} failed: {Ending(ending).sentence}")
        right[i] = track.u[n]
    return right


def _dataset(
    states: Mapping[str, State],
    steps: Sequence[float],
    ratios: Sequence[float],
    values: dict[str, np.ndarray],
    count: int,
    seed: int,
    command: str | None,
) -> xr.Dataset:
    scene, dims = next(iter(states.values())).scene, ("state", "step", "ratio")
    unit = velocity_unit(scene)
    sentences = {
        "fraction": ("fraction of the members that jump within 1.6 sqrt(h) s", "1"),
        "lower": ("lower end of Wilson's 95 % interval", "1"),
        "upper": ("upper end of Wilson's 95 % interval", "1"),
        "excess_from_A": ("lower bound on how far right velocities are from A", unit),
        "excess_of_A": ("upper bound on how far A is from the right velocities", unit),
    }
    variables = {
        name: xr.Variable(dims, values[name], {"long_name": sentence, "units": u})
        for name, (sentence, u) in sentences.items()
    }
    variables["count"] = xr.Variable((), count, {"long_name": "members of each ensemble", "units": "1"})
    coordinates = {
        "state": text(["state"], list(states), "label of the state"),
        "step": xr.Variable(("step",), np.array(steps), {"long_name": "step size of all members", "units": "s"}),
        "ratio": xr.Variable(
            ("ratio",),
            np.array(ratios),
            {"long_name": f"radius eps of the balls ({ball_unit(scene)}) over the step size", "units": "1/s"},
        ),
    }
    source = provenance(scene=scene, scene_digest=make_motion(scene).digest, seed=seed, command=command)
    title = f"The initial layer of {scene.name} at tangential states with gamma < 0"
    return xr.Dataset(variables, coordinates, {"title": title, "kind": "initial_layer", **source})
