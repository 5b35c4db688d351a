"""What goes into a compiled step and comes out of it: named tuples, which live in registers as plain ones do."""

from typing import NamedTuple

import numpy as np

__all__ = ["ITERATIONS", "NOT_SOLVED", "Fates", "Rounding", "Step", "SteppingMethod", "Track"]

NOT_SOLVED = -1  # in place of a branch, where the iteration of an implicit step does not converge
ITERATIONS = 50  # at most, of an implicit step

Vector = tuple[float, ...]


class SteppingMethod(NamedTuple):
    """A scheme and its numbers."""

    scheme: int  # painleve.core.motion_codes.FixedStep
    theta: float  # of the theta-method
    tolerance: float  # contact is where g(q) >= -tolerance


class Rounding(NamedTuple):
    """What rounding may do at the start of a motion."""

    g: float  # to g at a contact
    depth: float  # to how far a point of the outline is below the floor


class Step(NamedTuple):
    """The end (q, u) of a step, and what the law did: `impulse` took the free velocity v to u.

    `rows`, the free acceleration M^-1 f and the contact velocity W^T v are those from which the law started.
    """

    q: Vector
    u: Vector
    contact: Vector  # W^T v
    impulse: Vector  # r, in the tangents of the rows
    branch: int  # painleve.core.codes.ContactMode, or NOT_SOLVED
    rows: Vector
    acceleration: Vector
    free: Vector  # v


class Track(NamedTuple):
    """Arrays for n steps: row 0 is where they start, row i + 1 is for the step that ends at t[i + 1]."""

    q: np.ndarray  # (n + 1, d)
    u: np.ndarray  # (n + 1, d)
    r: np.ndarray  # (n + 1, 1 + k), at least two columns: impulses in the scene's own tangents
    branch: np.ndarray  # (n + 1,) painleve.core.codes.ContactMode
    change: np.ndarray  # (n + 1,) painleve.core.motion_codes.Change
    several: np.ndarray  # (n + 1,) how many impulses solve the step


class Fates(NamedTuple):
    """Arrays for the members of an ensemble, (members,) each."""

    outcome: np.ndarray  # painleve.core.motion_codes.MemberOutcome
    time: np.ndarray
    steps: np.ndarray
