"""Glocker's rod over the step size, the jam law, the initial layer at gamma < 0, and what other schemes choose."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from studies.parts import Progress
from studies.plurality.cases import jam_cases, scheme_runs, windows
from studies.plurality.curves import law_curves
from studies.plurality.initial_layer import sweep_initial_layer
from studies.plurality.jam_law import measure_jam_law
from studies.plurality.scheme_choice import sweep_schemes
from studies.plurality.step_sizes import sweep_step_sizes

__all__ = ["measure"]

PARADOX = {"inconsistent": "0", "indeterminate": "6"}  # omega (rad/s) of the state `paradox`: beta < 0, beta > 0
LAYER = 0.05  # s: how long the schemes are followed at these states
AFTER = 0.86  # s: and on Glocker's rod
UNTIL = 1.0  # s: Glocker's rod reaches the point at 0.81 s
LAYER_STEPS, QUICK_LAYER_STEPS = (1e-3, 1e-4, 1e-5), (1e-3, 1e-5)  # s
LAYER_RATIOS, QUICK_LAYER_RATIOS = np.logspace(-1, 3, 9).tolist(), np.logspace(-1, 3, 5).tolist()  # eps/h in 1/s
LAYER_MEMBERS, QUICK_LAYER_MEMBERS = 400, 100


def measure(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
    """`step_sizes`, `jam_law`, `initial_layer` and `scheme_choice`."""
    rod = load_scene("slender_rod")
    stoss = make_state(rod, "stoss")
    paradoxes = {label: make_state(rod, "paradox", keys={"omega": omega}) for label, omega in PARADOX.items()}
    spans, cases, runs = list(windows(quick=quick)), list(jam_cases(quick=quick)), list(scheme_runs(quick=quick))
    steps, ratios = (QUICK_LAYER_STEPS, QUICK_LAYER_RATIOS) if quick else (LAYER_STEPS, LAYER_RATIOS)
    count = QUICK_LAYER_MEMBERS if quick else LAYER_MEMBERS
    followed = [(label, state, LAYER) for label, state in paradoxes.items()] + [("stoss", stoss, AFTER)]
    progress.expect(2 * len(spans) + len(cases) + len(paradoxes) * len(steps) * len(ratios) + len(followed) * len(runs))
    yield "step_sizes", sweep_step_sizes(stoss, spans, until=UNTIL, seed=seed, progress=progress)
    jams = measure_jam_law(cases, seed=seed, progress=progress)
    mapped = np.unique([case.ratio for case in cases if case.group == "drift"])
    yield "jam_law", jams.assign(law_curves(mapped.tolist()))
    yield (
        "initial_layer",
        sweep_initial_layer(paradoxes, steps=steps, ratios=ratios, count=count, seed=seed, progress=progress),
    )
    yield "scheme_choice", sweep_schemes(followed, runs, progress=progress)
