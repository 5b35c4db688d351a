"""Blocks of samples of the two balls, addressed by index: offsets of the shape coordinates and of the velocity.

Only the shape coordinates are sampled, those on which the law depends. The coordinates that merely carry the contact
enter through `room`, what they add to g at the sample. A sample of A_eps may choose them: the low-discrepancy points
take the greatest room that the ball leaves, so that each is in contact wherever some q of the ball with this shape is;
uniform points draw the one combination of them that matters. (docs/theory.md, section 4.2.)
"""

import math
from enum import IntEnum

from painleve._jit import jit
from painleve.core.ball_maps import cube_to_ball, uniform_ball
from painleve.core.lattice import kronecker_block
from painleve.core.streams import uniform_block

__all__ = ["BLOCK", "Sampler", "sample_block"]

BLOCK = 768  # samples; some thirty arrays of this length stay in the second-level cache. Not a power of two: their rows
# would all fall on the same lines of the first-level cache


class Sampler(IntEnum):
    """How the two balls are covered."""

    UNIFORM = 0  # independent and uniform in both balls
    KRONECKER = 1  # low discrepancy, from the centres outwards
    BOUNDARY = 2  # low discrepancy, weighted towards both spheres


UNIFORM = int(Sampler.UNIFORM)
BOUNDARY = int(Sampler.BOUNDARY)
ROOM_MARGIN = 2.0**-48  # more than all roundings on the way to a point of the ball, so that it is in the ball exactly
BOUNDARY_WEIGHT = 2  # 1 - r becomes (1 - r)^4: half of the samples are within 7% of the sphere


@jit
def sample_block(plan, start, dimension, q_rows, offsets):
    """Fill one block of the painleve.core.lane.SamplePlan: dq in the first rows of `x`, dv, and `room`.

    `x` has the q_rows shape offsets and below them, for the low-discrepancy samplers, the d rows that `dv` views; for
    the uniform one, a row for the carried combination if there is one. The first `q_uniforms` rows of `uniforms` serve
    q, the rest v.
    """
    x, dv, room, uniforms = offsets.x, offsets.dv, offsets.room, offsets.uniforms
    eps, carried = plan.eps, plan.carried
    if plan.sampler == UNIFORM:
        uniform_block(plan.seed, start, uniforms)
        in_q = q_rows + (1 if carried > 0.0 else 0)
        if in_q > 0:
            uniform_ball(uniforms[: plan.q_uniforms], x[:in_q], eps, dimension)
        uniform_ball(uniforms[plan.q_uniforms :], dv, eps, dimension)
        share = carried * (1.0 - ROOM_MARGIN) if carried > 0.0 else 0.0
        for i in range(room.size):
            room[i] = share * x[in_q - 1, i] if carried > 0.0 else 0.0
        return
    kronecker_block(start, plan.alphas, plan.shifts, x)
    weight = BOUNDARY_WEIGHT if plan.sampler == BOUNDARY else 0
    if q_rows > 0:
        cube_to_ball(x[:q_rows], eps, weight)
    cube_to_ball(dv, eps, weight)
    _greatest_room(x, q_rows, eps, carried, room)


@jit
def _greatest_room(x, q_rows, eps, carried, room):
    """What the ball leaves to the carried coordinates beside the q_rows shape offsets, as a change of g."""
    inverse, size = 1.0 / eps, carried * eps
    for i in range(room.size):
        room[i] = 1.0 - (q_rows + 1) * ROOM_MARGIN
    for j in range(q_rows):
        for i in range(room.size):
            y = x[j, i] * inverse
            room[i] -= y * y
    for i in range(room.size):
        room[i] = size * math.sqrt(room[i] if room[i] > 0.0 else 0.0)
