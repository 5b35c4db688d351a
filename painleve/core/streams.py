"""Pseudo-random uniform numbers addressed by seed, coordinate and sample index.

The generator is SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014) read
as a counter-based one: its state moves by a constant, so the output at any position is a hash of that position. Nothing
is carried from block to block, any split of the work over threads gives the same bits, and loops over it vectorise.
"""

from __future__ import annotations

import numpy as np

from painleve._jit import jit

__all__ = ["splitmix64", "uniform_block", "unit_float"]

_WEYL = np.uint64(0x9E3779B97F4A7C15)  # odd integer nearest to 2^64 / golden ratio
_ONE = np.uint64(0x3FF0000000000000)  # the bits of the double 1.0


@jit
def _mix64(z: np.uint64) -> np.uint64:
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


@jit
def splitmix64(seed: int, position: int) -> np.uint64:
    """Output number `position` (from 0) of SplitMix64 started at `seed`; both are taken modulo 2^64."""
    return _mix64(np.uint64(seed) + (np.uint64(position) + np.uint64(1)) * _WEYL)


@jit
def unit_float(bits: np.uint64) -> float:
    """1 + f with f = the leading 52 bits of `bits` as a fraction, exact.

    Written into the mantissa of a number in [1, 2): a conversion from 64-bit integers vectorises only with AVX-512.
    """
    return np.uint64((bits >> np.uint64(12)) | _ONE).view(np.float64)


@jit
def uniform_block(seed: int, start: int, x: np.ndarray) -> None:
    """Fill x[j, i] with the uniform number in [0, 1) of coordinate j and sample `start + i`.

    x: (coordinates, samples), C order. Row j is SplitMix64 started at output j of SplitMix64(seed), from position
    `start` on; the numbers are multiples of 2^-52. `start` counts samples, not blocks.
    """
    for j in range(x.shape[0]):
        row = x[j]
        state = splitmix64(seed, j) + (np.uint64(start) + np.uint64(1)) * _WEYL
        for i in range(row.size):
            row[i] = unit_float(_mix64(state)) - 1.0
            state += _WEYL
