"""Whether a symmetric matrix of exact numbers is positive definite, without forming determinants where balls decide."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp
from flint import arb

from painleve.exact.balls import ball
from painleve.exact.signs import Sign, exact_sign

__all__ = ["least_minor_sign"]

PRECISIONS = (128, 512)  # bits; what those leave open is most often exactly zero


def least_minor_sign(matrix: sp.MatrixBase) -> Sign:
    """POSITIVE where all leading minors are, which makes the matrix positive definite (Sylvester); else the sign of the
    first one that is not. UNDECIDED where exact arithmetic does not tell.

    Elimination in ball arithmetic proves a sign as soon as its pivots are balls away from zero. Otherwise the minors
    are formed and their exact signs are asked for, which can take long for involved entries.
    """
    for bits in PRECISIONS:
        found = _by_pivots([[ball(x, bits=bits) for x in matrix.row(i)] for i in range(matrix.rows)])
        if found is not Sign.UNDECIDED:
            return found
    for size in range(1, matrix.rows + 1):
        sign = exact_sign(matrix[:size, :size].det(method="berkowitz")).sign
        if sign is not Sign.POSITIVE:
            return sign
    return Sign.POSITIVE


def _by_pivots(rows: list[list[arb]]) -> Sign:
    """Each leading minor is the one before it times the next pivot of Gaussian elimination."""
    for k, row in enumerate(rows):
        pivot = row[k]
        if not pivot > 0:
            return Sign.NEGATIVE if pivot < 0 else Sign.UNDECIDED
        for below in rows[k + 1 :]:
            _eliminate(below, row, k)
    return Sign.POSITIVE


def _eliminate(below: list[arb], row: Sequence[arb], k: int) -> None:
    ratio = below[k] / row[k]
    for j in range(k, len(row)):
        below[j] = below[j] - ratio * row[j]
