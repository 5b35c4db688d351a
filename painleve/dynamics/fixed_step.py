"""The one time loop of all fixed-step schemes, in compiled chunks, so that Ctrl-C comes through."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Ending
from painleve.core.stepping import SteppingMethod, Track
from painleve.dynamics.grid import TimeGrid
from painleve.dynamics.outline import allowed_depth, where_through
from painleve.dynamics.sections.listed import dynamics_of
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory

__all__ = ["empty_track", "run_fixed_step"]

CHUNK = 100_000  # steps: some ten milliseconds


def empty_track(start: Start, steps: int) -> Track:
    """Room for that many steps from the start, which is in its first row."""
    n, d, k = steps + 1, start.scene.dimension, len(dynamics_of(start.scene.contact).tangential)
    codes = {name: np.zeros(n, np.int8) for name in ("branch", "change", "several")}
    track = Track(q=np.zeros((n, d)), u=np.zeros((n, d)), r=np.zeros((n, 1 + k)), **codes)
    track.q[0], track.u[0] = start.q, start.u
    return track


def run_fixed_step(
    name: str,
    method: SteppingMethod,
    lag: float,
    start: Start,
    grid: TimeGrid,
    progress: Callable[[float], None],
) -> Trajectory:
    """Step through the grid with a compiled scheme, to its end or to the first step that fails.

    `progress` hears of the time covered after each chunk; the steps do not depend on how they are cut into chunks.
    """
    n, track, allowed = len(grid.h), empty_track(start, len(grid.h)), allowed_depth(start)
    done, since, ending, lengths = 0, 0, Ending.REACHED_END, (grid.h, grid.given)
    try:
        while done < n and ending is Ending.REACHED_END:
            rest = slice(done, min(done + CHUNK, n) + 1)
            part, h, given = Track(*(column[rest] for column in track)), *(x[done : done + CHUNK] for x in lengths)
            taken, status, since = start.motion.run(method, since, allowed, grid.t[rest], h, given, start.p, part)
            done, ending = done + taken, Ending(status)
            progress(float(grid.t[done] - grid.t[done - taken]))
    except KeyboardInterrupt:
        ending = Ending.INTERRUPTED
    detail = where_through(start, grid.t[done], track.q[done]) if ending is Ending.THROUGH_FLOOR else ""
    kept = Track(*(column[: done + 1] for column in track))
    statistics = {b.label: int((kept.branch[1:] == b).sum()) for b in ContactMode}
    if dynamics_of(start.scene.contact).counts_solutions:
        statistics["steps_with_several_solutions"] = int((kept.several > 1).sum())
    return Trajectory(
        scheme=name,
        start=start,
        settings={"contact_tolerance": method.tolerance, "theta": method.theta},
        t=grid.t[: done + 1],
        q=kept.q,
        u=kept.u,
        r=kept.r,
        branch=kept.branch,
        change=kept.change,
        lag=lag,
        ending=ending,
        detail=detail,
        statistics=statistics,
    )
