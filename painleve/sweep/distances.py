"""Distances between A and A_eps over eps, states and parameters, with the verdict on Theorem 1 at every state."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr

from painleve.asymptotics.distance import Distance
from painleve.asymptotics.methods import distance, find_method
from painleve.asymptotics.sample import check_radii
from painleve.asymptotics.theorem import collect, judge
from painleve.errors import InputError
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number
from painleve.store import provenance
from painleve.sweep.distance_table import DistanceTable
from painleve.sweep.grid import make_grid
from painleve.theory.classification import classify
from painleve.theory.limit_set import LimitSet

__all__ = ["sweep_distances"]


def sweep_distances(
    scene: Scene,
    *,
    eps: Sequence[float],
    states: Sequence[str] = (),
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
    over: Mapping[str, Sequence[Number]] | None = None,
    method: str = "sample",
    options: object | None = None,
    progress: Callable[[str], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Distances at every eps, state and combination of swept values, as a dataset that explains itself.

    `states` are names of the library (none: the one state that `keys` give); `over` maps parameters or state keys to
    exact values. `options` belong to the method; `progress` is called with a label after every eps of every point.
    A side of a bound that is not known is NaN. A point that fails is kept: its outcome is `failed`, with the reason.
    Ctrl-C ends the sweep early, with what was computed until then: the attribute `status` is `interrupted`, no more
    `complete`, and the other points are `not_run`.

    Raises InputError for bad eps, names, values and methods, and where every single point fails.
    """
    radii = np.array(check_radii(eps))
    chosen = find_method(method)
    options = chosen.options() if options is None else options
    grid = make_grid(scene, states=states, keys=keys, parameters=parameters, over=over)
    table = DistanceTable(grid, radii)
    status = "complete"
    try:
        for index in grid.points():
            _run_point(table, index, lambda limit, value: distance(limit, value, method, options), progress)
    except KeyboardInterrupt:
        if not table.outcome.any():
            raise
        status = "interrupted"
    table.refuse_if_all_failed()
    settings = {name: value for name, value in vars(options).items() if isinstance(value, str | int | float)}
    source = provenance(
        scene=scene, scene_digest=make_kernels(scene).digest, seed=int(settings.get("seed", 0)), command=command
    )
    title = f"Distances between the limit set A and A_eps of {scene.name}: {scene.sentence}"
    attributes = {"title": title, "kind": "distances", "method": method, "status": status}
    return table.dataset({**attributes, "settings": json.dumps(settings), **source})


def _run_point(
    table: DistanceTable,
    index: tuple[int, ...],
    measure: Callable[[LimitSet, float], Distance],
    progress: Callable[[str], None] | None,
) -> None:
    """All eps of one state; what a user's input or undecidable arithmetic stops is recorded and not raised."""
    label = table.grid.labels[index[0]]
    try:
        classification = classify(table.grid.state(index))
    except (InputError, ArithmeticError) as error:
        table.fail(index, str(error))
        _report(progress, label, len(table.eps))
        return
    table.put_state(index, classification)
    collected = []
    for j, eps in enumerate(table.eps):
        started = time.perf_counter()
        try:
            evidence = collect(classification, float(eps), measure)
        except (InputError, ArithmeticError) as error:
            table.fail((*index, j), str(error))
        else:
            table.put_evidence((*index, j), evidence, time.perf_counter() - started)
            collected.append(evidence)
        _report(progress, label, 1)
    table.put_verdict(index, judge(classification, collected))


def _report(progress: Callable[[str], None] | None, label: str, times: int) -> None:
    if progress is not None:
        for _ in range(times):
            progress(label)
