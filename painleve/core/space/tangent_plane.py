"""The kinetic energy on the plane of the impulses that cancel the normal velocity (docs/theory.md, section 2).

With nu = -v_n > 0 these are r_n = (nu - b.r_t)/a, and the energy is 1/2 r_t.Q r_t + w.r_t, where Q = C - b b'/a is the
compliance of the tip that is held on the constraint and w = v_t + b nu/a its tangential velocity after a frictionless
impact: Q r_t + w is the tangential velocity that an impulse leaves, and -Q^-1 w the one that stops the tip.
"""

from typing import NamedTuple

from painleve._jit import jit

# Entries of Q are differences: below this many units in the last place a determinant, or an entry, is rounding.
ROUNDING = 2.0**-50
LARGEST, SMALLEST = 2.0**200, 2.0**-200
UP, DOWN = 2.0**450, 2.0**-450


class Delassus(NamedTuple):
    """W^T M^-1 W in space: [[a, b^T], [b, C]]."""

    a: float
    b_1: float
    b_2: float
    C_11: float
    C_12: float
    C_22: float


class TangentEnergy(NamedTuple):
    """Q and w."""

    Q_11: float
    Q_12: float
    Q_22: float
    w_1: float
    w_2: float


@jit
def delassus_at(rows, at):
    """The matrix that the rows hold, at their layout."""
    return Delassus(rows[at.a], rows[at.b], rows[at.b + 1], rows[at.C], rows[at.C + 1], rows[at.C + 2])


@jit
def scales(v_n, v_1, v_2):
    """A power of two for the velocities, so that their squares neither overflow nor vanish, and its inverse."""
    size = max(abs(v_n), abs(v_1), abs(v_2))
    if size > LARGEST:
        return DOWN, UP
    if size < SMALLEST:
        return UP, DOWN
    return 1.0, 1.0


@jit
def tangent_energy(G, nu, v_1, v_2):
    """The energy of the impulses that cancel the normal velocity -nu, where the tip slips at (v_1, v_2)."""
    slope_1, slope_2 = G.b_1 / G.a, G.b_2 / G.a
    return TangentEnergy(
        G.C_11 - G.b_1 * slope_1,
        G.C_12 - G.b_1 * slope_2,
        G.C_22 - G.b_2 * slope_2,
        v_1 + nu * slope_1,
        v_2 + nu * slope_2,
    )


@jit
def of_little_friction(energy):
    """The same energy times a factor, where Q, which goes like mu^2, is very small.

    Beside w, which goes like mu, it is smaller still; where it is below any rounding the energy is linear, and a tiny
    multiple of 1 in its place has the same least point.
    """
    Q_11, Q_12, Q_22, w_1, w_2 = energy
    largest = max(Q_11, Q_22, abs(w_1), abs(w_2))
    if largest == 0.0:
        return TangentEnergy(0.0, 0.0, 0.0, 0.0, 0.0)
    Q_11, Q_12, Q_22 = Q_11 / largest, Q_12 / largest, Q_22 / largest
    if max(Q_11, Q_22) < SMALLEST:
        Q_11, Q_12, Q_22 = SMALLEST, 0.0, SMALLEST
    return TangentEnergy(Q_11, Q_12, Q_22, w_1 / largest, w_2 / largest)


@jit
def sticking_point(energy):
    """-Q^-1 w in homogeneous coordinates (X, Y, W): the point (X, Y)/W, at infinity where W = 0."""
    Q_11, Q_12, Q_22, w_1, w_2 = energy
    return Q_12 * w_2 - Q_22 * w_1, Q_12 * w_1 - Q_11 * w_2, Q_11 * Q_22 - Q_12 * Q_12


@jit
def is_definite(energy):
    """Whether Q is positive definite beyond rounding."""
    Q_11, Q_12, Q_22, _, _ = energy
    return Q_11 > 0.0 and Q_22 > 0.0 and Q_11 * Q_22 - Q_12 * Q_12 > ROUNDING * (Q_11 * Q_22)


@jit
def made_definite(energy, C_11, C_22):
    """The energy with Q changed by its rounding, and multiplied by a positive factor.

    A direction in which nothing happens (a section without width: Q and w vanish there) takes the compliance of the
    other one, so that the least impulse is found; all five are zero where the section is a point.
    """
    Q_11, Q_12, Q_22, w_1, w_2 = energy
    Q_11, Q_22 = max(Q_11, ROUNDING * C_11), max(Q_22, ROUNDING * C_22)
    largest = max(Q_11, Q_22, abs(w_1), abs(w_2))
    if largest == 0.0:
        return TangentEnergy(0.0, 0.0, 0.0, 0.0, 0.0)
    Q_11, Q_12, Q_22, w_1, w_2 = Q_11 / largest, Q_12 / largest, Q_22 / largest, w_1 / largest, w_2 / largest
    if Q_11 == 0.0:
        Q_11 = Q_22
    if Q_22 == 0.0:
        Q_22 = Q_11
    bound = Q_11**0.5 * Q_22**0.5
    Q_12 = min(max(Q_12, -bound), bound)
    return TangentEnergy(Q_11 * (1.0 + ROUNDING), Q_12, Q_22 * (1.0 + ROUNDING), w_1, w_2)
