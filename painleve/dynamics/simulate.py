"""One trajectory by any scheme."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Ending
from painleve.dynamics.grid import make_grid
from painleve.dynamics.outline import allowed_depth, depth_through, where_through
from painleve.dynamics.proposition1 import check_proposition1
from painleve.dynamics.schemes import scheme_for
from painleve.dynamics.start import Start, as_start
from painleve.dynamics.trajectory import Trajectory
from painleve.mechanics.state import State

__all__ = ["simulate"]


def simulate(
    start: Start | State,
    *,
    scheme: str = "contact_dynamics",
    step: float | Sequence[float] | np.ndarray,
    until: float,
    contact_tolerance: float = 0.0,
    options: Mapping[str, float] | None = None,
    monitor: bool = True,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """The trajectory from `start` over the time `until`, by the scheme of that name with constant or given steps.

    Contact is where g(q) >= -contact_tolerance; 0 is the paper's test. `monitor` adds the margins of Proposition 1,
    which is about the scheme contact_dynamics. `progress` hears, now and then, of the time (s) covered since its last
    call. A method that cannot go on ends with a value that says why, and Ctrl-C ends it with what there is. Raises
    InputError for bad input.
    """
    beginning = as_start(start)
    method = scheme_for(beginning.scene, scheme)
    settings = method.settings(contact_tolerance, options)
    grid = make_grid(beginning.t, step, until)
    result = _above_floor(method.run(beginning, grid, contact_tolerance, settings, progress or _ignore))
    if not monitor or scheme != "contact_dynamics":
        return result
    steps, sticks = grid.h[: result.steps], result.branch == ContactMode.STICK
    margins = check_proposition1(beginning, result.t, steps, result.q, result.u, sticks, contact_tolerance)
    if margins.count < result.steps:
        detail = f"Proposition 1 was checked for the first {margins.count} steps"
        result = replace(result, ending=Ending.INTERRUPTED, detail=detail)
    return replace(result, proposition1=margins)


def _above_floor(found: Trajectory) -> Trajectory:
    """The trajectory up to the first recorded instant at which the outline is through the floor.

    An integrator looks for that at the ends of its own steps; between them a point may dip and come back.
    """
    allowed = allowed_depth(found.start)
    through = (i for i, q in enumerate(found.q[1:-1], 1) if depth_through(found.start, q) > allowed)
    first = next(through, None) if allowed < math.inf and found.integrated else None
    if first is None:
        return found
    columns = {name: getattr(found, name)[: first + 1] for name in ("t", "q", "u", "r", "branch", "change")}
    counts = {b.label: int((columns["branch"][1:] == b).sum()) for b in ContactMode}
    detail = where_through(found.start, found.t[first], found.q[first])
    statistics = {**found.statistics, **counts}
    return replace(found, **columns, ending=Ending.THROUGH_FLOOR, detail=detail, statistics=statistics)


def _ignore(covered: float) -> None:
    """Progress that nobody watches."""
