"""Law (7) with the unit disc for a section, at many digits: the oracle of the tests, without brackets or charts.

Every stationary point of the energy on the conic is a root of one quartic, found all at once; the projection is the one
whose multiplier has the right sign, and the sticking impulse where that is feasible.
"""

from __future__ import annotations

import mpmath

DIGITS = 60


def exact_disc_impulse(a, p, b, C, v) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf, str]:
    """(r_n, r_1, r_2, "free" | "stick" | "slip") for the floats as they are; |b| is a - p, b gives its direction."""
    with mpmath.workdps(DIGITS):
        a, p, b, C = mpmath.mpf(float(a)), mpmath.mpf(float(p)), to_vector(b), to_matrix(C)
        nu, v_t = -mpmath.mpf(float(v[0])), to_vector(v[1:])
        if nu <= 0:
            return mpmath.mpf(0), mpmath.mpf(0), mpmath.mpf(0), "free"
        beta = a - p
        e = b / mpmath.norm(b) if mpmath.norm(b) > 0 else mpmath.matrix([1, 0])
        turn = mpmath.matrix([[e[0], e[1]], [-e[1], e[0]]])
        Q, w = turn * C * turn.T, turn * v_t
        Q[0, 0] -= beta * beta / a
        w[0] += beta * nu / a
        stick = mpmath.lu_solve(Q, -w)
        if a * mpmath.norm(stick) + beta * stick[0] <= nu:
            r_n, r_t, branch = (nu - beta * stick[0]) / a, stick, "stick"
        else:
            r_n, r_t = projection(a, p, beta, Q, w, nu)
            branch = "slip"
        r_t = turn.T * r_t
        return r_n, r_t[0], r_t[1], branch


def projection(a, p, beta, Q, w, nu) -> tuple[mpmath.mpf, mpmath.matrix]:
    candidates = []
    for c, s in stationary_points(a, p, beta, Q, w, nu):
        D = (a + beta) * c * c + p * s * s
        if D <= 0:
            continue
        r_n, r_t = nu * (c * c + s * s) / D, nu / D * mpmath.matrix([c * c - s * s, 2 * c * s])
        velocity, normal = Q * r_t + w, mpmath.matrix([a * r_t[0] + beta * r_n, a * r_t[1]])
        if mpmath.fdot(velocity, normal) < 0:
            candidates.append((r_n, r_t, mpmath.fdot(r_t, Q * r_t) / 2 + mpmath.fdot(w, r_t)))
    best = min(candidates, key=lambda candidate: candidate[2])
    return best[0], best[1]


def stationary_points(a, p, beta, Q, w, nu):
    """The half-angles (c, s) at which the energy is stationary on the conic.

    With t = sigma tau the scale sigma balances the ends of the quartic, whose roots may be powers of p apart.
    """
    N = [[nu, 0, -nu], [0, 2 * nu, 0]]
    D, T = [a + beta, 0, p], [[0, -2 * a, 0], [a + beta, 0, -p]]
    quartic = [mpmath.mpf(0)] * 5
    for i in range(2):
        along = [mpmath.fdot([Q[i, 0], Q[i, 1]], [N[0][k], N[1][k]]) + D[k] * w[i] for k in range(3)]
        for j in range(3):
            for k in range(3):
                quartic[j + k] += T[i][j] * along[k]
    if quartic[0] == 0:
        yield mpmath.mpf(1), mpmath.mpf(0)
    if quartic[4] == 0:
        yield mpmath.mpf(0), mpmath.mpf(1)
    degrees = [k for k in range(5) if quartic[k] != 0]
    low, high = degrees[0], degrees[-1]
    if low == high:
        return
    sigma = abs(quartic[low] / quartic[high]) ** (mpmath.mpf(1) / (high - low))
    scaled = [quartic[k] * sigma ** (k - low) for k in range(low, high + 1)]
    with mpmath.workdps(2 * DIGITS):
        roots = mpmath.polyroots(scaled[::-1], maxsteps=1000, extraprec=800)
    for root in roots:
        if abs(mpmath.im(root)) <= mpmath.mpf(10) ** (-DIGITS) * abs(root):
            yield mpmath.mpf(1), sigma * mpmath.re(root)


def to_vector(x) -> mpmath.matrix:
    return mpmath.matrix([mpmath.mpf(float(y)) for y in x])


def to_matrix(x) -> mpmath.matrix:
    return mpmath.matrix([[mpmath.mpf(float(y)) for y in row] for row in x])
