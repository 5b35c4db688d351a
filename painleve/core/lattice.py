"""Kronecker sequences: low-discrepancy points of the cube that are functions of their index.

Point number n has the coordinates frac(shift_j + n alpha_j). Shifts and generators are 64-bit fractions (a uint64 k
stands for k / 2^64), so that addition modulo 1 is the wrapping addition of integers and loses nothing at any index.
(docs/theory.md, section 4.2.)
"""

from __future__ import annotations

import numpy as np

from painleve._jit import jit
from painleve.core.streams import splitmix64, unit_float

__all__ = ["kronecker_block", "kronecker_generators", "kronecker_shifts"]


def kronecker_generators(dimension: int) -> np.ndarray:
    """alpha_j = phi^-j, j = 1..dimension, phi the positive root of phi^(dimension + 1) = phi + 1, as 64-bit fractions.

    Roberts' generalised golden ratio ("The unreasonable effectiveness of quasirandom sequences", 2018). Exact integer
    bisection for y = 1/phi, which solves y^(dimension + 1) + y^dimension = 1.
    """
    bits = 128
    one = 1 << bits
    y = 0
    for place in reversed(range(bits)):
        trial = y | (1 << place)
        if trial**dimension * (trial + one) <= one ** (dimension + 1):
            y = trial
    return np.array([y**j >> (bits * j - 64) for j in range(1, dimension + 1)], dtype=np.uint64)


def kronecker_shifts(seed: int, dimension: int) -> np.ndarray:
    """A random shift of the whole sequence (Cranley-Patterson rotation): the outputs of SplitMix64(seed), seed >= 0."""
    return np.array([splitmix64(seed, j) for j in range(dimension)], dtype=np.uint64)


@jit
def kronecker_block(start: int, alphas: np.ndarray, shifts: np.ndarray, x: np.ndarray) -> None:
    """Fill x[j, i] with 2 frac(shift_j + (start + i) alpha_j) - 1, in [-1, 1).

    x: (coordinates, samples), C order; alphas, shifts: uint64 fractions, one per coordinate. The fraction is exact for
    every index below 2^64, then cut to 52 bits.
    """
    for j in range(x.shape[0]):
        row = x[j]
        alpha = alphas[j]
        fraction = shifts[j] + np.uint64(start) * alpha
        for i in range(row.size):
            row[i] = 2.0 * unit_float(fraction) - 3.0
            fraction += alpha
