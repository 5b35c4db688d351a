"""The paper's law (7) and Coulomb's law side by side, over the direction of the slip and the friction."""

import math

import numpy as np

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.space.conic_law import disc_impulse
from painleve.core.space.coulomb import COLUMNS, MOST_SOLUTIONS, coulomb_disc
from painleve.core.space.tangent_plane import Delassus

STICK = int(ContactMode.STICK)

TOUCH = 1e-13
"""-v_n/|v_t| at which S stands for its limit u_tilde: S is Lipschitz where v_n < 0, so the error is of this order."""


@jit
def compare_laws(G, Y, v_n, slips, frictions, counts, sticks, apart):
    """For slip velocities (n, 2) and discs of the radii `frictions` (m,), at G (3 x 3) and Y = M^-1 W (d x 3).

    Into `counts` (m, n) how many solutions Coulomb's law has, into `sticks` how many of them stick, and into `apart`
    (m, n, 2): how far the right velocity of law (7) is from the nearest of them, and the farthest of them from those of
    law (7), which are u- and u_tilde where v_n = 0. Distances are Euclidean in R^d.
    """
    found = np.empty((MOST_SOLUTIONS, COLUMNS))
    projected = np.zeros(3)
    for i in range(len(frictions)):
        mu = frictions[i]
        square = mu * mu
        unit = Delassus(G[0, 0], mu * G[0, 1], mu * G[0, 2], square * G[1, 1], square * G[1, 2], square * G[2, 2])
        p = unit.a - math.hypot(unit.b_1, unit.b_2)
        for j in range(len(slips)):
            v_1, v_2 = mu * slips[j, 0], mu * slips[j, 1]
            counts[i, j] = coulomb_disc(unit, p, (v_n, v_1, v_2), found)
            projected[:] = 0.0
            if v_n < 0.0 or (v_n == 0.0 and p < 0.0):
                size = math.hypot(slips[j, 0], slips[j, 1])
                r_n, r_1, r_2, _ = disc_impulse(unit, p, (min(v_n, -TOUCH * size), v_1, v_2))
                projected[0], projected[1], projected[2] = r_n, mu * r_1, mu * r_2
            sticks[i, j], nearest, farthest = 0, np.inf, 0.0
            for row in found[: counts[i, j]]:
                if row[0] == STICK:
                    sticks[i, j] += 1
                row[2] *= mu
                row[3] *= mu
                distance = _length(Y, projected - row[1:4])
                nearest = min(nearest, distance)
                farthest = max(farthest, min(distance, _length(Y, row[1:4])) if v_n == 0.0 else distance)
            apart[i, j, 0], apart[i, j, 1] = nearest, farthest


@jit
def _length(Y, impulse):
    """|Y r|."""
    total = 0.0
    for i in range(Y.shape[0]):
        x = Y[i, 0] * impulse[0] + Y[i, 1] * impulse[1] + Y[i, 2] * impulse[2]
        total += x * x
    return math.sqrt(total)
