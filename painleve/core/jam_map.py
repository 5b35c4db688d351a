"""The last steps of the Contact Dynamics scheme before a Génot-Brogliato point: does a slip jam, or lift off?

Setting. A contact slips towards the edge p = 0 of a paradox, p = a - mu |b|. Let x > 0 be the distance of the angle
from the edge, omega its rate, p = p1 x, and beta the normal acceleration of the tip without contact force. An impulse
lambda moves omega by kappa lambda; with r p1 omega := kappa dbeta/domega and D := -dbeta/dx at fixed omega the slip is

    dx/dt = -omega,  dbeta/dt = -r omega beta/x + D omega,  so that beta = -K x^r - D x/(1 - r):

r is the ratio of the eigenvalues at the point x = beta = 0, and K > 0 tells the trajectories that run into it apart.
For r > 1 (r = 1 too) beta vanishes before x does, at x0 = (D/((r - 1) K))^(1/(r - 1)): the slip lifts off smoothly.

Tip kept on the floor (contact at every step). The law meets v_n = h (beta + D h omega/2) with the compliance p1 x', so

    X' = X - 1,  b' = b (1 - r/X') - d,      X = x/(h omega),  b = -(beta + D h omega/2)/(K (h omega)^r),
                                              d = D (h omega)^(1-r)/K.

b < 0 opens the contact, X < 0 < b jams. The recursion is solved by b = Gamma(X)/Gamma(X - r) + d (X - 1)/(1 - r):
the first term tends to X^r far out, so this is the slip itself. For d = 0 the last X in (0, 1), which is uniform when
h varies, decides: 1/Gamma(X - r) < 0 for X < r, so P(jam) = 1 - r. For r >= 1 the factor 1 - r/X' changes the sign
of b before the edge: P(jam) = 0, for every d >= 0.

Strict test g >= 0. A contact leaves v_n = 0, and then the tip rises, by h v_n + c h^2/2 in a step, c = the curvature
term of beta (omega^2 times the height of the centre, for a rod). After the time T it is at
(c h T + beta T^2 + D omega T^3/3)/2 and v_n = beta T + D omega T^2/2, up to relative errors O(beta/c): it is back at
the least root T, if there is one. With x_* = (h omega c/K)^(1/(1+r)), L = omega T/x_*, X = x/x_* and
B = -beta x_*/(h omega c)

    1 - B L + d L^2/3 = 0,  X' = X - L,  B' = B - d L - r (1 - d L^2/6)/X',      d = D x_*^2/(h omega c),

on the curve B = X^r + d X/(1 - r) far out. No root or B' < 0: lift-off; X' < 0: a jam. For d = 0 put Y = X B: the map
becomes Y' = Y - (1 + r) with a jam from 0 < Y < 1 and lift-off from 1 < Y < 1 + r; the last Y is uniform in
(0, 1 + r) when h varies, so P(jam) = 1/(1 + r).
d is proportional to h^((1-r)/(1+r)). As h -> 0 on one trajectory it vanishes for r < 1, and grows for r > 1: hops are
at most sqrt(3/d) long, X0 = (d/(r - 1))^(1/(r - 1)) grows, and from some h on no hop spans the edge: P(jam) = 0. What
looks like a power of h on the way there is the map's dependence on d, and starts from 1/(1 + r) at d = 0.

Uniformity is exact in the limit: the number of hops (steps) to the edge is a smooth multiple of 1/h. What is
neglected: beta/c at the last contact, O(h^r) with the tip kept and O(h^(r/(1+r))) in the strict test. At finite h hops
last whole numbers of steps, few of them far out, and the phases that arrive from one start bunch as h varies: the
fraction then scatters about the map's by some hundredths. Over starts and step sizes together it is the map's.
Source: docs/theory.md, section 6.6; eigenvalues after F. Génot and B. Brogliato, Eur. J. Mech. A Solids 18 (1999)
653-677.
"""

from __future__ import annotations

import math

import numpy as np

from painleve._jit import jit
from painleve.errors import InputError

__all__ = ["jam_fraction", "limit_law"]

FAR_STEPS = 100.0  # where the map with the tip kept begins; its curve is exact at any X > 1
FAR_HOPS = 200.0  # where the map of the strict test begins: the phase of hops is uniform on its curve to O(1/hops)
NEWTON_STEPS = 4
SURELY_SHORT_HOPS = 300.0  # (X0/longest hop)^2 times 3


@jit
def kept_jams(r, d, X):
    """1 if the slip that is at X > 1 on its curve jams with the tip kept on the floor, else 0."""
    b = math.exp(math.lgamma(X) - math.lgamma(X - r)) + d * (X - 1.0) / (1.0 - r)
    while b >= 0.0:
        X -= 1.0
        if X < 0.0:
            return 1
        b = b * (1.0 - r / X) - d
    return 0


@jit
def strict_jams(r, d, X):
    """1 if the slip that is at X on its curve jams under the strict contact test, else 0."""
    B = X**r + d * X / (1.0 - r)
    while B > 0.0:
        discriminant = B * B - 4.0 * d / 3.0
        if discriminant < 0.0:
            return 0
        L = 2.0 / (B + math.sqrt(discriminant))
        X -= L
        if X < 0.0:
            return 1
        B -= d * L + r * (1.0 - d * L * L / 6.0) / X
    return 0


@jit
def hops_from(r, d, X):
    """The hops from X on the curve to the edge, were they infinitely many: the integral of B."""
    return X ** (1.0 + r) / (1.0 + r) + d * X * X / (2.0 * (1.0 - r))


@jit
def place_after(r, d, X, hops):
    """The place from which there are that many hops more than from X."""
    target = hops_from(r, d, X) + hops
    for _ in range(NEWTON_STEPS):
        X -= (hops_from(r, d, X) - target) / (X**r + d * X / (1.0 - r))
    return X


@jit
def count_jams(strict, r, d, first, phases):
    """Jams among `phases` equidistant phases of one step, or of one hop, from X = first on."""
    jams = 0
    for i in range(phases):
        phase = (i + 0.5) / phases
        jams += strict_jams(r, d, place_after(r, d, first, phase)) if strict else kept_jams(r, d, first + phase)
    return jams


def limit_law(ratio: float, *, strict: bool) -> float:
    """The limit of P(jam) as h -> 0 on a trajectory into a point with this ratio of eigenvalues; 0 for ratio >= 1."""
    _check(ratio, 0.0)
    if ratio >= 1.0:
        return 0.0
    return 1.0 / (1.0 + ratio) if strict else 1.0 - ratio


def jam_fraction(ratio: float, drift: float, *, strict: bool, phases: int = 4000) -> float:
    """P(jam) of the local map at the drift d of the module's text, to about 1/phases.

    For ratio > 1 it is 0 with the tip kept, and 0 by the module's text where d X0^2 is large. Raises InputError for a
    ratio that is not positive or is 1, where the curve has a logarithm instead, and for a negative drift.
    """
    _check(ratio, drift)
    if ratio == 1.0:
        raise InputError("ratio: at 1 the slip has a logarithm that the local map leaves out; take a value beside it")
    if not strict:
        return count_jams(False, ratio, drift, FAR_STEPS, phases) / phases if ratio < 1.0 else 0.0
    lift_off = (drift / (ratio - 1.0)) ** (1.0 / (ratio - 1.0)) if ratio > 1.0 else 0.0
    if drift * lift_off**2 > SURELY_SHORT_HOPS:
        return 0.0
    first = max(1.0, 2.0 * lift_off)
    while hops_from(ratio, drift, first) < FAR_HOPS:
        first *= 1.05
    return count_jams(True, ratio, drift, first, phases) / phases


def _check(ratio: float, drift: float) -> None:
    if not (ratio > 0.0 and np.isfinite(ratio)):
        raise InputError(f"ratio: {ratio} must be a positive number")
    if not (drift >= 0.0 and np.isfinite(drift)):
        raise InputError(f"drift: {drift} must be zero or a positive number")
