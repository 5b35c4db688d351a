"""Which of the limits each scheme chooses at states where the scheme's limit is not unique: jump, lift off or slide."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from painleve.core.motion_codes import Ending
from painleve.dynamics.simulate import simulate
from painleve.dynamics.trajectory import Trajectory
from painleve.kernels.motion.compiled import make_motion
from painleve.mechanics.state import State
from painleve.store import provenance
from painleve.sweep.variables import coded, text

__all__ = ["CHOICES", "SchemeRun", "sweep_schemes"]

CHOICES = ("jump", "lift_off", "slide", "stops")
STUCK = 0.1  # of the first slip: below, the tip has stopped, up to O(h) where a law is taken at the old configuration
HIGH = 1e-4  # m: above, the tip has left the floor; hops of the strict test stay far below


@dataclass(frozen=True, kw_only=True)
class SchemeRun:
    """A scheme with its step (s; of the record for integrators) and, for the compliant one, its stiffness (N/m)."""

    scheme: str
    step: float
    stiffness: float | None = None

    @property
    def label(self) -> str:
        if self.stiffness is not None:
            return f"{self.scheme} k={self.stiffness:.0e}"
        return self.scheme if self.scheme == "event_driven" else f"{self.scheme} h={self.step:.2e}"


def sweep_schemes(
    states: Sequence[tuple[str, State, float]],
    runs: Sequence[SchemeRun],
    *,
    progress: Callable[[int], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """What happens first, and when: the tip stops (jump), lifts off, slides to the end, or the method cannot go on.

    `states`: label, state, and how long to follow it (s). (state, run).
    """
    choices = np.zeros((len(states), len(runs)), np.int8)
    times = np.full(choices.shape, np.nan)
    for i, (_, state, until) in enumerate(states):
        for j, run in enumerate(runs):
            options = None if run.stiffness is None else {"stiffness": run.stiffness}
            made = simulate(state, scheme=run.scheme, step=run.step, until=until, options=options, monitor=False)
            choice, times[i, j] = _first(made)
            choices[i, j] = 1 + CHOICES.index(choice)
            if progress is not None:
                progress(1)
    scene, dims = states[0][1].scene, ("state", "run")
    variables = {
        "choice": coded(dims, choices, CHOICES, "what happens first on the trajectory"),
        "time": xr.Variable(dims, times, {"long_name": "when it happens first", "units": "s"}),
    }
    coordinates = {
        "state": text(["state"], [label for label, *_ in states], "label of the state"),
        "run": text(["run"], [run.label for run in runs], "scheme with step or stiffness"),
    }
    source = provenance(scene=scene, scene_digest=make_motion(scene).digest, seed=0, command=command)
    title = f"Which limit each scheme chooses at states of {scene.name}"
    return xr.Dataset(variables, coordinates, {"title": title, "kind": "scheme_choice", **source})


def _first(made: Trajectory) -> tuple[str, float]:
    """The first thing that happens, and when."""
    known = made.contact_quantities()
    stuck = np.abs(known["v_t"]) < STUCK * abs(known["v_t"][0])
    high = known["g"] < -HIGH
    happened = np.flatnonzero(stuck | high)
    if len(happened):
        i = int(happened[0])
        return ("jump" if stuck[i] else "lift_off"), float(made.t[i])
    return ("slide" if made.ending is Ending.REACHED_END else "stops"), float(made.t[-1])
