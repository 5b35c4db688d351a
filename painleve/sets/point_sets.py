"""The sets whose distances are measured: finite sets, segments, and samples of sets that are larger.

All of them live in R^d with the Euclidean norm; coordinates are in the units of whoever made them. Arrays are copied
to float64 and made read-only, so that a set cannot change after a distance was measured from it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from painleve.errors import InputError

__all__ = ["LARGEST_COORDINATE", "Cloud", "FloatArray", "LineSegment", "PointSet", "Points"]

FloatArray = NDArray[np.float64]

LARGEST_COORDINATE = 1e150
"""Distances square differences of coordinates; beyond this the squares overflow."""


@dataclass(frozen=True, eq=False)
class Points:
    """A finite set, given by all its members, shape (n, d) with n, d >= 1. Raises InputError."""

    members: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "members", _members(self.members, "Points"))

    @property
    def dimension(self) -> int:
        return int(self.members.shape[1])


@dataclass(frozen=True, eq=False)
class Cloud:
    """Members, shape (n, d) with n, d >= 1, of a larger closed set that is known by this sample alone.

    Whatever is measured from a cloud is a statement about the larger set, and therefore one-sided. Raises InputError.
    """

    members: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "members", _members(self.members, "Cloud"))

    @property
    def dimension(self) -> int:
        return int(self.members.shape[1])


@dataclass(frozen=True, eq=False)
class LineSegment:
    """The closed segment from start to end, shape (d,) each; start = end is allowed. Raises InputError."""

    start: FloatArray
    end: FloatArray

    def __post_init__(self) -> None:
        start, end = (_frozen_floats(p, f"Segment: {name}") for p, name in ((self.start, "start"), (self.end, "end")))
        if start.ndim != 1 or start.shape != end.shape or start.size == 0:
            raise InputError(
                f"Segment: start, end have shapes {start.shape}, {end.shape}; give two vectors of one length d >= 1"
            )
        object.__setattr__(self, "start", start)
        object.__setattr__(self, "end", end)

    @property
    def dimension(self) -> int:
        return int(self.start.shape[0])

    @property
    def length(self) -> float:
        return float(np.linalg.norm(self.end - self.start))

    @property
    def direction(self) -> FloatArray:
        """The unit vector from start to end; zero where the segment is a single point."""
        length = self.length
        return (self.end - self.start) / length if length > 0.0 else np.zeros_like(self.start)


PointSet = Points | LineSegment | Cloud


def _members(values: ArrayLike, what: str) -> FloatArray:
    members = _frozen_floats(values, what)
    if members.ndim != 2 or members.size == 0:
        raise InputError(f"{what}: members have shape {members.shape}; give an array (n, d) with n >= 1 and d >= 1")
    return members


def _frozen_floats(values: ArrayLike, what: str) -> FloatArray:
    try:
        given = np.asarray(values)
    except ValueError:
        raise InputError(f"{what}: coordinates form no array; give rows of equal length") from None
    if given.dtype.kind not in "iuf":
        raise InputError(f"{what}: coordinates are of type {given.dtype}; give real numbers")
    floats = np.array(given, dtype=np.float64, order="C")
    if not np.all(np.abs(floats) <= LARGEST_COORDINATE):  # NaN fails the comparison too
        raise InputError(f"{what}: a coordinate is NaN, infinite or beyond {LARGEST_COORDINATE:g}; remove or rescale")
    floats.setflags(write=False)
    return floats
