"""The one time loop of all fixed-step schemes, in compiled chunks, so that Ctrl-C comes through."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Ending
from painleve.dynamics.grid import TimeGrid
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory

__all__ = ["run_fixed_step"]

CHUNK = 100_000  # steps: some ten milliseconds


def run_fixed_step(
    name: str,
    code: int,
    theta: float,
    lag: float,
    start: Start,
    grid: TimeGrid,
    tolerance: float,
    progress: Callable[[float], None],
) -> Trajectory:
    """Step through the grid with the compiled scheme of that code, to its end or to the first step that fails.

    `progress` hears of the time covered after each chunk; the steps do not depend on how they are cut into chunks.
    """
    n, d, k = len(grid.h), start.scene.dimension, start.scene.friction_dimension
    q, u, r = np.zeros((n + 1, d)), np.zeros((n + 1, d)), np.zeros((n + 1, 1 + max(1, k)))
    branch, change, several = (np.zeros(n + 1, np.int8) for _ in range(3))
    q[0], u[0] = start.q, start.u
    done, since, ending = 0, 0, Ending.REACHED_END
    try:
        while done < n and ending is Ending.REACHED_END:
            rest = slice(done, min(done + CHUNK, n) + 1)
            steps = grid.h[done : done + CHUNK]
            taken, status, since = start.motion.run(
                code,
                theta,
                tolerance,
                since,
                grid.t[rest],
                steps,
                start.p,
                q[rest],
                u[rest],
                r[rest],
                branch[rest],
                change[rest],
                several[rest],
            )
            done, ending = done + taken, Ending(status)
            progress(float(grid.t[done] - grid.t[done - taken]))
    except KeyboardInterrupt:
        ending = Ending.INTERRUPTED
    kept = slice(0, done + 1)
    statistics = {b.label: int((branch[1 : done + 1] == b).sum()) for b in ContactMode}
    if k < 2:  # in space other solutions of Coulomb's law are not counted
        statistics["steps_with_several_solutions"] = int((several[kept] > 1).sum())
    return Trajectory(
        scheme=name,
        start=start,
        settings={"contact_tolerance": tolerance, "theta": theta},
        t=grid.t[kept],
        q=q[kept],
        u=u[kept],
        r=r[kept],
        branch=branch[kept],
        change=change[kept],
        lag=lag,
        ending=ending,
        statistics=statistics,
    )
