"""All solutions of Coulomb's one-step problem in space, in contact coordinates (docs/theory.md, section 2).

The section is the unit disc; a disc of another radius or an ellipse is brought to it by a linear change of the
tangents, which leaves maximal dissipation as it is. Given G = [[a, b], [b, C]] and (v_n, v_t), a solution is an
impulse r = lambda (1, s), |s| <= 1, with the contact velocity u = (v_n, v_t) + G r, for which u_n >= 0, lambda u_n =
0 and, where lambda > 0, u_t = 0 or s = -u_t/|u_t|. So r = 0 (open), u = 0 (stick), or s = d with |d| = 1 and u_t =
-kappa d, kappa > 0 (slip). With nu = -v_n not 0 a slip has lambda = nu/(a + b.d), and d is parallel to
    w(d) = v_t (a + b.d) + nu (b + C d),
a trigonometric equation of degree 2: at most four candidates. With nu = 0 it has a + b.d = 0: at most two. Of all these
no more than three are solutions, families apart: a proposition (docs/theory.md, section 2.6), which polygons break.

The first axis of the frame used here is -b/|b|, so that a + b.d = p + |b| (1 - d_1), p = a - |b|, is formed without
cancellation where gamma is near zero. Counts are those of nearby data where two slips are about to merge: deciding that
needs exact arithmetic, which is not done here.
"""

import math

import numpy as np

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.space.quartic import roots_of_quartic

FREE, STICK, SLIP = int(ContactMode.FREE), int(ContactMode.STICK), int(ContactMode.SLIP)

MOST_SOLUTIONS = 6
"""Open, stick and four slips: the rows that `found` needs if rounding lets more pass than there are."""
COLUMNS = 7
"""Of `found`: the branch, the impulse (r_n, r_1, r_2) and the contact velocity (u_n, u_1, u_2)."""


@jit
def coulomb_disc(G, p, v, found):
    """Write the solutions at v = (v_n, v_1, v_2) and W^T M^-1 W = G into `found` (MOST_SOLUTIONS x COLUMNS), and return
    how many there are.

    p = a - |b| is a number of its own because its sign decides. Where v_n = 0 = p a whole interval of impulses may
    solve the problem; of such a family only the ends are listed.
    """
    a, b_1, b_2, C_11, C_12, C_22 = G
    v_n, v_1, v_2 = v
    count = 0
    if v_n >= 0.0:
        found[count] = np.array((FREE, 0.0, 0.0, 0.0, v_n, v_1, v_2))
        count += 1
    beta = math.hypot(b_1, b_2)
    e_1, e_2 = (-b_1 / beta, -b_2 / beta) if beta > 0.0 else (1.0, 0.0)
    first, second = e_1 * v_1 + e_2 * v_2, e_1 * v_2 - e_2 * v_1
    mixed = C_11 * e_1 + C_12 * e_2, C_12 * e_1 + C_22 * e_2
    A_11 = mixed[0] * e_1 + mixed[1] * e_2
    A_12 = mixed[1] * e_1 - mixed[0] * e_2
    A_22 = C_11 + C_22 - A_11
    slips = np.empty((4, 5))
    if v_n != 0.0:
        number = _slips(p, beta, A_11, A_12, A_22, -v_n, first, second, slips)
    else:
        number = _tangential_slips(p, beta, A_11, A_12, A_22, first, second, slips)
    sticking = _stick(a, beta, A_11, A_12, A_22, v_n, first, second, slips[number]) if number < 4 else False
    if sticking:
        number += 1
    for i in range(number):
        impulse, d_1, d_2, speed_1, speed_2 = slips[i]
        found[count, 0] = STICK if sticking and i == number - 1 else SLIP
        found[count, 1] = impulse
        found[count, 2] = impulse * (e_1 * d_1 - e_2 * d_2)
        found[count, 3] = impulse * (e_2 * d_1 + e_1 * d_2)
        found[count, 4] = 0.0
        found[count, 5] = e_1 * speed_1 - e_2 * speed_2
        found[count, 6] = e_2 * speed_1 + e_1 * speed_2
        count += 1
    return count


@jit
def _stick(a, beta, A_11, A_12, A_22, v_n, v_1, v_2, row):
    """Whether the impulse -G^-1 v_c that stops the tip lies in the cone; it goes into `row`, with b = (-beta, 0)."""
    determinant = a * (A_11 * A_22 - A_12 * A_12) - beta * beta * A_22
    r_n = -((A_11 * A_22 - A_12 * A_12) * v_n + beta * (A_22 * v_1 - A_12 * v_2)) / determinant
    r_1 = -(beta * A_22 * v_n + a * (A_22 * v_1 - A_12 * v_2)) / determinant
    r_2 = -(A_12 * r_1 + v_2) / A_22
    if not (r_n > 0.0 and math.hypot(r_1, r_2) <= r_n):
        return False
    row[0], row[1], row[2], row[3], row[4] = r_n, r_1 / r_n, r_2 / r_n, 0.0, 0.0
    return True


@jit
def _tangential_slips(p, beta, A_11, A_12, A_22, v_1, v_2, slips):
    """Slips at v_n = 0: a + b.d = 0 fixes d, and d x (v_t + lambda (b + C d)) = 0 then fixes lambda."""
    count = 0
    if p > 0.0 or beta == 0.0:
        return count
    t = math.sqrt(-p / (p + 2.0 * beta))
    for sense in (1.0, -1.0):
        d_1, d_2 = (1.0 - t * t) / (1.0 + t * t), sense * 2.0 * t / (1.0 + t * t)
        lift_1, lift_2 = A_11 * d_1 + A_12 * d_2 - beta, A_12 * d_1 + A_22 * d_2
        turning = d_1 * lift_2 - d_2 * lift_1
        impulse = -(d_1 * v_2 - d_2 * v_1) / turning if turning != 0.0 else 0.0
        speed = -(d_1 * (v_1 + impulse * lift_1) + d_2 * (v_2 + impulse * lift_2))
        if impulse > 0.0 and speed > 0.0:
            _write(impulse, d_1, d_2, speed, slips[count])
            count += 1
        if p == 0.0:
            break
    return count


@jit
def _slips(p, beta, A_11, A_12, A_22, nu, v_1, v_2, slips):
    """Slips at nu = -v_n not 0: the roots d = (1 - t^2, 2 t)/(1 + t^2) of d x w(d) = 0 with lambda > 0, kappa > 0."""
    far = p + 2.0 * beta
    w_1 = np.array((v_1 * p + nu * (A_11 - beta), 2.0 * nu * A_12, v_1 * far - nu * (A_11 + beta)))
    w_2 = np.array((v_2 * p + nu * A_12, 2.0 * nu * A_22, v_2 * far - nu * A_12))
    quartic = np.array((w_2[0], w_2[1] - 2.0 * w_1[0], w_2[2] - w_2[0] - 2.0 * w_1[1], -w_2[1] - 2.0 * w_1[2], -w_2[2]))
    # Two halves of the circle: -1 <= t < 1, and the same of -1/t, by which the quartic is turned by a half circle.
    turned = np.array((quartic[4], -quartic[3], quartic[2], -quartic[1], quartic[0]))
    roots = np.empty(4)
    count = 0
    for half, polynomial in enumerate((quartic, turned)):
        for i in range(roots_of_quartic(polynomial, roots)):
            t = roots[i]
            square = 1.0 + t * t
            d_1, d_2 = (1.0 - t * t) / square, 2.0 * t / square
            lever = (p + far * t * t) / square
            if half == 1:
                d_1, d_2, lever = -d_1, -d_2, (far + p * t * t) / square
            if not nu * lever > 0.0:
                continue
            impulse = nu / lever
            speed_1 = v_1 + impulse * (A_11 * d_1 + A_12 * d_2 - beta)
            speed_2 = v_2 + impulse * (A_12 * d_1 + A_22 * d_2)
            speed = -(d_1 * speed_1 + d_2 * speed_2)
            if speed > 0.0 and count < 4:
                _write(impulse, d_1, d_2, speed, slips[count])
                count += 1
    return count


@jit
def _write(impulse, d_1, d_2, speed, row):
    """One slip: lambda, d and u_t = -kappa d, which is parallel to d whatever the rounding of the root."""
    row[0], row[1], row[2], row[3], row[4] = impulse, d_1, d_2, -speed * d_1, -speed * d_2
