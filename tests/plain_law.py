"""Samples of one ball by the templates of the law: compiled here, and without a compiler where this is a program.

NUMBA_DISABLE_JIT=1 python plain_law.py FILE writes what painleve.kernels.law.lane does as it stands, on the scene of
its sample.
"""

from __future__ import annotations

import sys
from collections.abc import Callable

import numpy as np

from painleve.core.lane import BaseState, Evaluation, LaneTally, SamplePlan
from painleve.core.lattice import kronecker_generators, kronecker_shifts
from painleve.core.reduce import SEGMENT
from painleve.core.sampling import BLOCK, Sampler
from painleve.core.sections.segment import SegmentBase
from painleve.core.taylor import no_polynomials

D, ROWS, EPS = 2, 16, 1e-2
CARRIED = 1.0  # dg/dy = -1
UNIFORMS = {Sampler.UNIFORM: (2, 4), Sampler.KRONECKER: (2, 4), Sampler.BOUNDARY: (2, 4)}


def base_state(rows_at: Callable[..., None]) -> BaseState:
    """Where gamma = 0: x = 1 + sqrt(2), mu = x + 1/x, u- = (-1, -x); the jump ends in u = 0."""
    x = 1.0 + np.sqrt(2.0)
    q, p = np.array([x, x * x / 2.0]), np.array([x + 1.0 / x, 9.81, 0.0, 0.0])
    rows = np.empty(ROWS)
    rows_at(q, p, rows)
    rows[0] = rows[6] = 0.0
    u = np.array([-1.0, -x])
    length = float(np.hypot(*u))
    return BaseState(q, p, rows, u, -u / length, length, SegmentBase(x, 1.0 + x * x), x, 1)


def everything(rows_at: Callable[..., None], sample_lane: Callable[..., None]) -> dict[str, np.ndarray]:
    """The tallies of a few blocks by each sampler, and the law at some points."""
    found = {}
    for sampler in Sampler:
        generators, shifts = kronecker_generators(1 + D), kronecker_shifts(3, 1 + D)
        plan = SamplePlan(int(sampler), 3, generators, shifts, EPS, CARRIED, *UNIFORMS[sampler])
        tally = LaneTally(
            np.zeros(6, np.int64),
            np.array([-1.0, np.inf, np.inf]),
            np.full(3, -1),
            np.full((3, 16), np.inf),
            np.full(16, np.iinfo(np.int64).max),
        )
        sample_lane(
            plan, Evaluation(False, no_polynomials()), 5, 2, 7 * BLOCK - 100, base_state(rows_at), SEGMENT, tally
        )
        found |= {f"{sampler.name} {name}": array for name, array in tally._asdict().items()}
    return found


if __name__ == "__main__":
    from painleve.kernels.law import lane, sample

    np.seterr(over="ignore")  # integers are added modulo 2^64
    np.savez(sys.argv[1], **everything(sample.rows_at, lane.sample_lane))
