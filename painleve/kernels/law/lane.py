"""Template: samples of the two balls through all stages, block by block, and the law at one point."""

import numpy as np

from painleve._jit import jit
from painleve.core.lane import BlockOffsets, BlockResult
from painleve.core.reduce import reduce_block
from painleve.core.sampling import BLOCK, UNIFORM, sample_block
from painleve.core.taylor import monomial_block, polynomial_block
from painleve.kernels.law.sample import ROWS, SHAPE, VARYING, D, law, law_block, rows_at, varying_block


@jit
def offset_block(plan, evaluation, start, state, offsets, result):
    """Samples start ... start + BLOCK - 1 through all stages (painleve.core.lane)."""
    sample_block(plan, start, D, SHAPE, offsets)
    if evaluation.taylor:
        monomial_block(evaluation.polynomials, offsets.x, offsets.monomials)
        polynomial_block(evaluation.polynomials, offsets.monomials, offsets.values)
    else:
        varying_block(offsets.x, state.q, state.p, state.base, offsets.values)
    law_block(offsets.values, offsets.room, offsets.dv, state, result)


@jit
def empty_block(plan, evaluation):
    """Room for the samples of one block."""
    rows = SHAPE + (1 if plan.sampler == UNIFORM else D)
    x = np.empty((rows, BLOCK))
    dv = np.empty((D, BLOCK)) if plan.sampler == UNIFORM else x[SHAPE:]
    monomials = np.empty((evaluation.polynomials.parents.size, BLOCK))
    values, uniforms = np.empty((VARYING, BLOCK)), np.empty((plan.uniforms, BLOCK))
    offsets = BlockOffsets(x, dv, np.empty(BLOCK), uniforms, monomials, values)
    return offsets, BlockResult(np.empty(BLOCK, np.int64), np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK))


@jit
def sample_lane(plan, evaluation, first, blocks, samples, state, kind, tally):
    """Run `blocks` blocks from block `first` and fold them into a painleve.core.lane.LaneTally.

    samples: how many there are in all; kind: of the limit set (painleve.core.reduce).
    """
    offsets, result = empty_block(plan, evaluation)
    for block in range(first, first + blocks):
        start = block * BLOCK
        offset_block(plan, evaluation, start, state, offsets, result)
        reduce_block(kind, state.length, start, min(BLOCK, samples - start), result, tally)


@jit
def law_at(q, p, v, result):
    """S(q, v) by plain evaluation; returns the branch."""
    rows = np.empty(ROWS)
    rows_at(q, p, rows)
    return law(rows, v, result)
