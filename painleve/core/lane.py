"""What goes into compiled samples and comes out of them: named tuples, which cost compiled code nothing."""

from typing import NamedTuple

import numpy as np

from painleve.core.sections.conic import ConicBase
from painleve.core.sections.none import NoFrictionBase
from painleve.core.sections.polygon import PolygonBase
from painleve.core.sections.segment import SegmentBase
from painleve.core.taylor import Polynomials

__all__ = ["BaseImpulse", "BaseState", "BlockOffsets", "BlockResult", "Evaluation", "LaneTally", "SamplePlan"]

BaseImpulse = NoFrictionBase | SegmentBase | ConicBase | PolygonBase


class BaseState(NamedTuple):
    """The state that the samples are around, and its limit set."""

    q: np.ndarray  # (d,)
    p: np.ndarray  # the parameters
    base: np.ndarray  # the rows at q
    u: np.ndarray  # (d,) u-
    direction: np.ndarray  # (d,) unit vector from u- to u_tilde; 0 without a jump
    length: float  # |u_tilde - u-|
    impulse: BaseImpulse  # the sticking impulse and what else the section's split needs
    multiplier: float  # the normal impulse of the jump, 0 if there is none
    critical_edge: int  # the edge of the cone on which gamma = 0, if there is a jump too; else 0


class SamplePlan(NamedTuple):
    """Which points of the two balls of radius eps are taken."""

    sampler: int  # painleve.core.sampling.Sampler
    seed: int
    alphas: np.ndarray  # painleve.core.lattice
    shifts: np.ndarray
    eps: float
    carried: float  # norm of dg with respect to the carried coordinates
    q_uniforms: int  # uniform numbers a sample for q, and for q and v
    uniforms: int


class Evaluation(NamedTuple):
    """How the rows are evaluated: by their polynomials, or plainly."""

    taylor: bool
    polynomials: Polynomials


class BlockOffsets(NamedTuple):
    """Arrays for the samples of one block, one column a sample."""

    x: np.ndarray  # the shape offsets, and below them what the sampler needs
    dv: np.ndarray  # (d, n), a view of x for the low-discrepancy samplers
    room: np.ndarray  # (n,) what the carried coordinates add to g
    uniforms: np.ndarray  # (uniforms, n)
    monomials: np.ndarray
    values: np.ndarray  # the varying rows minus their base values


class BlockResult(NamedTuple):
    """S at the samples of one block, relative to the limit set (painleve.core.reduce), (n,) each."""

    branch: np.ndarray
    along: np.ndarray
    beyond: np.ndarray
    across2: np.ndarray


class LaneTally(NamedTuple):
    """What a lane keeps of its samples (painleve.core.reduce.reduce_block)."""

    counts: np.ndarray
    best: np.ndarray
    best_index: np.ndarray
    bins: np.ndarray
    bin_index: np.ndarray
