"""Streaming reductions of a block of samples: counts, extremal samples, and the profile along the segment.

A sample is described by `along` and `beyond`, its coordinate on the line through u- and u_tilde measured from either
end (so that both are accurate near their end), and `across2`, its squared distance from that line. Ties go to the
smaller index, so that the result does not depend on the order in which lanes are merged.

Records fall seldom. So a first pass, which vectorises, counts the samples that beat the records of the blocks before;
only where there are any does a second one go sample by sample. (docs/theory.md, section 4.1.)
"""

import math

import numpy as np

from painleve._jit import jit

POINT, PAIR, SEGMENT = 0, 1, 2


@jit
def distance_squared(kind, along, beyond, across2):
    """Squared distance to the point u-, the pair {u-, u_tilde} or the segment between them."""
    to_start, to_end = along * along, beyond * beyond
    if kind == POINT:
        return across2 + to_start
    if kind == PAIR:
        return across2 + (to_end if to_end < to_start else to_start)
    before = along if along < 0.0 else 0.0
    outside = beyond if beyond > 0.0 else before
    return across2 + outside * outside


@jit
def reduce_block(kind, length, start, size, result, tally):
    """Fold the first `size` samples of a painleve.core.lane.BlockResult into a LaneTally.

    best: [farthest from the limit set, nearest to u-, nearest to u_tilde], squared; best_index: where.
    bins: (3, K) of along, beyond and across2 of the sample nearest to the line in each K-th of the segment.
    """
    branch, along = result.branch[:size], result.along[:size]
    beyond, across2 = result.beyond[:size], result.across2[:size]
    counts, best, best_index, bins, bin_index = tally
    for code in range(counts.size):
        counts[code] += _count(branch, code)
    if _records(kind, along, beyond, across2, best[0], best[1], best[2]) > 0:
        _fold_records(kind, start, along, beyond, across2, best, best_index)
    if kind == SEGMENT:
        _fold_bins(length, start, along, beyond, across2, bins, bin_index)


@jit
def _count(branch, code):
    found = 0
    for i in range(branch.size):
        found += 1 if branch[i] == code else 0
    return found


@jit
def _records(kind, along, beyond, across2, farthest, near_start, near_end):
    """How many samples beat a record; a NaN always does, so that it cannot hide."""
    found = 0
    for i in range(along.size):
        t, gap, rho2 = along[i], beyond[i], across2[i]
        far = not (distance_squared(kind, t, gap, rho2) <= farthest)
        near = (rho2 + t * t < near_start) | (rho2 + gap * gap < near_end)
        found += 1 if far | near else 0
    return found


@jit
def _fold_records(kind, start, along, beyond, across2, best, best_index):
    for i in range(along.size):
        index = start + i
        t, gap, rho2 = along[i], beyond[i], across2[i]
        far = distance_squared(kind, t, gap, rho2)
        if far > best[0] or math.isnan(far):
            best[0], best_index[0] = far, index
        near = rho2 + t * t
        if near < best[1]:
            best[1], best_index[1] = near, index
        near = rho2 + gap * gap
        if near < best[2]:
            best[2], best_index[2] = near, index


@jit
def _fold_bins(length, start, along, beyond, across2, bins, bin_index):
    """Most samples lie near the ends, in the first and the last bin: those that beat neither are passed over."""
    last = bins.shape[1] - 1
    scale = (last + 1) / length
    in_first, in_last = bins[2, 0], bins[2, last]
    chosen, found = np.empty(along.size, np.int64), 0
    for i in range(along.size):
        place = along[i] * scale
        bound = in_last if place >= last else math.inf
        bound = in_first if place < 1.0 else bound
        chosen[found] = i
        found += 1 if across2[i] < bound else 0
    for i in chosen[:found]:
        k = min(max(int(along[i] * scale), 0), last)
        if across2[i] < bins[2, k]:
            bins[0, k], bins[1, k], bins[2, k] = along[i], beyond[i], across2[i]
            bin_index[k] = start + i
