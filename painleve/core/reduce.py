"""Streaming reductions of a block of samples: counts, extremal samples, and the profile along the segment.

A sample is described by `along` and `beyond`, its coordinate on the line through u- and u_tilde measured from either
end (so that both are accurate near their end), and `across2`, its squared distance from that line. Ties go to the
smaller index, so that the result does not depend on the order in which lanes are merged.
"""

import math

from painleve._jit import jit

POINT, PAIR, SEGMENT = 0, 1, 2


@jit
def distance_squared(kind, along, beyond, across2):
    """Squared distance to the point u-, the pair {u-, u_tilde} or the segment between them."""
    if kind == POINT:
        return across2 + along * along
    if kind == PAIR:
        return across2 + min(along * along, beyond * beyond)
    outside = min(along, 0.0) if beyond <= 0.0 else beyond
    return across2 + outside * outside


@jit
def reduce_block(
    kind, length, start, size, branch, along, beyond, across2, counts, best, best_index, bins, bin_index
):
    """Fold the first `size` samples of a block into a lane's state.

    best: [farthest from the limit set, nearest to u-, nearest to u_tilde], squared; best_index: where.
    bins: (3, K) of along, beyond and across2 of the sample nearest to the line in each K-th of the segment.
    """
    count = bins.shape[1]
    scale = count / length if length > 0.0 else 0.0
    for i in range(size):
        index = start + i
        counts[branch[i]] += 1
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
        if kind == SEGMENT:
            k = min(max(int(t * scale), 0), count - 1)
            if rho2 < bins[2, k]:
                bins[0, k], bins[1, k], bins[2, k] = t, gap, rho2
                bin_index[k] = index
