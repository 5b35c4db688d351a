"""Moreau's contact law S in space with a disc for the friction section, one point at a time (paper, law (7);
docs/theory.md, section 2).

Where the normal velocity is cancelled, nu = -v_n, the impulses |r_t| <= r_n fill the convex region a|r_t| + b.r_t <= nu
of the tangent plane. Its boundary is a conic with a focus at the origin and the eccentricity |b|/a: an ellipse where
p = a - |b| is positive, a parabola where it is zero, a branch of a hyperbola where it is negative. S projects the
sticking impulse on that region in the metric of the kinetic energy.

With the first axis along b the conic is r_t = nu (c^2 - s^2, 2cs) / (A c^2 + p s^2), A = a + |b|, where s/c = t is the
tangent of half the angle with b; p enters as it is given, and the stationary points of the energy are the roots of a
quartic in t. On the arc that is visible from the sticking impulse there is one only, the projection; the ends of that
arc are the points of contact of the tangents from there.
"""

from math import hypot, inf, sqrt
from typing import NamedTuple

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.space.quartic import bracketed_root
from painleve.core.space.tangent_plane import (
    ROUNDING,
    SMALLEST,
    TangentEnergy,
    is_definite,
    made_definite,
    of_little_friction,
    scales,
    sticking_point,
    tangent_energy,
)

FREE, STICK, SLIP = int(ContactMode.FREE), int(ContactMode.STICK), int(ContactMode.SLIP)


class VisibleArc(NamedTuple):
    """The point t of the conic is visible from the sticking impulse where k_0 + 2 k_1 t + k_2 t^2 > 0."""

    k_0: float
    k_1: float
    k_2: float
    discriminant: float


@jit
def disc_impulse(G, p, v):
    """(r_n, r_1, r_2, branch) of law (7) with the unit disc for a section, at v = (v_n, v_1, v_2) and W^T M^-1 W = G.

    p = a - |b| has the sign of gamma and is taken as given, so that no rounding hides it. Ellipses and discs of any
    radius come as the unit disc: E'b, E'CE and E'v_t stand for b, C and v_t where the section is E times the disc.
    There is no impulse where v_n >= 0.
    """
    v_n, v_1, v_2 = v
    if v_n >= 0.0:
        return 0.0, 0.0, 0.0, FREE
    scale, back = scales(v_n, v_1, v_2)
    nu = -v_n * scale
    energy = tangent_energy(G, nu, v_1 * scale, v_2 * scale)
    if max(energy.Q_11, energy.Q_22) < SMALLEST:
        energy = of_little_friction(energy)
    if not is_definite(energy):
        energy = made_definite(energy, G.C_11, G.C_22)
        if energy.Q_11 == 0.0 and energy.w_1 == 0.0 and energy.w_2 == 0.0:  # the section is a point: no friction
            return -v_n / G.a, 0.0, 0.0, SLIP
    X, Y, W = sticking_point(energy)
    reach, along = G.a * sqrt(X * X + Y * Y), G.b_1 * X + G.b_2 * Y
    if reach + along + ROUNDING * (reach + abs(along)) < nu * W:
        r_1, r_2 = X / W, Y / W
        r_n, branch = (nu - G.b_1 * r_1 - G.b_2 * r_2) / G.a, STICK
    else:
        r_n, r_1, r_2, branch = nearest(G, p, energy, nu, (X, Y, W))
    return r_n * back, r_1 * back, r_2 * back, branch


@jit
def nearest(G, p, energy, nu, point):
    """(r_n, r_1, r_2, branch) of the point of the region nearest to the sticking impulse, in homogeneous coordinates:
    turned into the frame of b and back."""
    Q_11, Q_12, Q_22, w_1, w_2 = energy
    X, Y, W = point
    beta = hypot(G.b_1, G.b_2)
    e_1, e_2 = 1.0, 0.0
    if beta > 0.0:
        e_1, e_2 = G.b_1 / beta, G.b_2 / beta
    turned = TangentEnergy(
        e_1 * (e_1 * Q_11 + e_2 * Q_12) + e_2 * (e_1 * Q_12 + e_2 * Q_22),
        e_1 * (e_1 * Q_12 + e_2 * Q_22) - e_2 * (e_1 * Q_11 + e_2 * Q_12),
        e_1 * (e_1 * Q_22 - e_2 * Q_12) - e_2 * (e_1 * Q_12 - e_2 * Q_11),
        e_1 * w_1 + e_2 * w_2,
        e_1 * w_2 - e_2 * w_1,
    )
    r_n, x, y, branch = aligned(G.a, p, beta, turned, nu, (e_1 * X + e_2 * Y, e_1 * Y - e_2 * X, W))
    return r_n, e_1 * x - e_2 * y, e_1 * y + e_2 * x, branch


@jit
def aligned(a, p, beta, energy, nu, point):
    """`nearest` where b = (beta, 0)."""
    X, Y, W = point
    A, R = a + beta, hypot(X, Y)
    # R + X and R - X without cancellation
    with_b = R + X if X > 0.0 else (Y / (R - X)) * Y if R > 0.0 else 0.0
    against_b = R - X if X < 0.0 else (Y / (R + X)) * Y if R > 0.0 else 0.0
    excess = p * R + beta * with_b - nu * W
    if excess <= 0.0:
        return (nu - beta * (X / W)) / a, X / W, Y / W, STICK
    k_0, k_1, k_2 = A * X - nu * W, a * Y, -(p * X + nu * W)
    discriminant = excess * (p * R + beta * against_b + nu * W)
    f_0, f_4 = A * (nu * energy.Q_12 + A * energy.w_2), p * (nu * energy.Q_12 - p * energy.w_2)
    # Neither t = 0 and t = inf, the points of the axis, are both visible, nor is the projection beyond a visible one.
    if k_0 > 0.0:
        upper = f_0 <= 0.0
    elif p > 0.0 and k_2 > 0.0:
        upper = f_4 >= 0.0
    else:
        upper = Y >= 0.0
    side = 1.0 if upper else -1.0
    mirrored = TangentEnergy(energy.Q_11, side * energy.Q_12, energy.Q_22, energy.w_1, side * energy.w_2)
    c, s, D = half_angle(a, p, A, mirrored, nu, VisibleArc(k_0, side * k_1, k_2, discriminant))
    multiple = nu / D
    return multiple * (c * c + s * s), multiple * ((c - s) * (c + s)), side * (multiple * (2.0 * c * s)), SLIP


@jit
def likely_point(a, p, A, energy, arc):
    """A point (c, s) of the visible arc near the projection, and (0, 0) where no two tangents tell one.

    With h = h_A + z h_B, where h_A and h_B are the points of contact, the vector from the sticking impulse to the
    conic is (d_A + z^2 d_B)/(D_AA + 2 z D_AB + z^2 D_BB): the rational quadratic Bezier curve whose control points are
    the two points and the sticking impulse. This is one Newton step from the z at which both terms are equally long.
    """
    q_11, q_12, q_22, _, _ = energy
    k_0, k_1, k_2, discriminant = arc
    if not discriminant > 0.0:
        return 0.0, 0.0
    sense = 1.0 if k_1 >= 0.0 else -1.0
    sum_ = sense * k_1 + sqrt(discriminant)
    size = sum_ + abs(k_0) + abs(k_2)
    c_A, s_A, c_B, s_B = sum_ / size, -k_0 / size, -k_2 / size, sum_ / size
    A_1, A_2, B_1, B_2 = (
        -2.0 * a * c_A * s_A,
        A * c_A * c_A - p * s_A * s_A,
        -2.0 * a * c_B * s_B,
        A * c_B * c_B - p * s_B * s_B,
    )
    A_1, B_1 = sense * A_1, sense * B_1
    Q_1, Q_2 = q_11 * A_1 + q_12 * A_2, q_12 * A_1 + q_22 * A_2
    AA, AB, BB = (
        A_1 * Q_1 + A_2 * Q_2,
        B_1 * Q_1 + B_2 * Q_2,
        B_1 * (q_11 * B_1 + q_12 * B_2) + B_2 * (q_12 * B_1 + q_22 * B_2),
    )
    root_A, root_B = sqrt(AA), sqrt(BB)
    k = -AB / (root_A * root_B)
    m, n = root_B * (A * c_A * c_A + p * s_A * s_A), root_A * (A * c_B * c_B + p * s_B * s_B)
    omega = sqrt(root_A * root_B) * (A * c_A * c_B + p * s_A * s_B)
    if m < n:
        weight_A, weight_B = 4.0 * omega + 2.0 * (n - k * m), 4.0 * omega + n * (3.0 + k) - m * (1.0 + 3.0 * k)
    else:
        weight_A, weight_B = 4.0 * omega + m * (3.0 + k) - n * (1.0 + 3.0 * k), 4.0 * omega + 2.0 * (m - k * n)
    weight_A, weight_B = weight_A * sqrt(root_B), weight_B * sqrt(root_A)
    return weight_A * c_A + weight_B * c_B, sense * (weight_A * s_A + weight_B * s_B)


@jit
def visible_ends(arc):
    """The ends (t, t) of the visible arc among t >= 0, a little outside: rounding must not lose the root."""
    k_0, k_1, k_2, discriminant = arc
    root = sqrt(max(discriminant, 0.0)) * (1.0 + 1e-9)
    low, high = 0.0, inf
    if k_0 <= 0.0:
        low = -k_0 / (k_1 + root)
    if k_0 > 0.0 and k_1 < 0.0:
        if discriminant > 0.0:
            high = k_0 / (root - k_1) * (1.0 + 2e-9)
    elif k_2 < 0.0:
        high = (k_1 + root) / -k_2
    return low * (1.0 - ROUNDING), high * (1.0 + ROUNDING)


@jit
def half_angle(a, p, A, energy, nu, arc):
    """(c, s, A c^2 + p s^2) of the projection, which has t = s/c >= 0, in the chart that represents it best."""
    q_11, q_12, q_22, w_1, w_2 = energy
    low, high = visible_ends(arc)
    f_0 = A * (nu * q_12 + A * w_2)
    f_1 = 2.0 * (A * (nu * q_22 - a * w_1) - a * (nu * q_11))
    f_2 = -6.0 * a * (nu * q_12)
    f_3 = 2.0 * (a * (nu * q_11 - p * w_1) - p * (nu * q_22))
    f_4 = p * (nu * q_12 - p * w_2)
    if arc.k_0 > 0.0 and f_0 == 0.0:
        return 1.0, 0.0, A
    if p > 0.0 and arc.k_2 > 0.0 and f_4 == 0.0:
        return 0.0, 1.0, p
    c, s = likely_point(a, p, A, energy, arc)
    if p < 0.0:
        asymptote = sqrt(A / -p)
        high, third = min(high, asymptote), asymptote / 3.0
        if high > third and (low >= third or f_0 + third * (f_1 + third * (f_2 + third * (f_3 + third * f_4))) < 0.0):
            likely = s / (c * asymptote) if c != 0.0 else 1.0
            return near_asymptote(a, -p, A, energy, nu, low / asymptote, high / asymptote, likely)
        high = min(high, third)
    if high <= 1.0 or (low < 1.0 and f_0 + f_1 + f_2 + f_3 + f_4 >= 0.0):
        t = bracketed_root(f_0, f_1, f_2, f_3, f_4, low, min(high, 1.0), s / c if c != 0.0 else 0.0)
        return 1.0, t, A + p * t * t
    u = bracketed_root(-f_4, -f_3, -f_2, -f_1, -f_0, 1.0 / high, 1.0 / max(low, 1.0), c / s if s != 0.0 else 0.0)
    return u, 1.0, A * u * u + p


@jit
def near_asymptote(a, P, A, energy, nu, low, high, likely):
    """(c, s, A c^2 - P s^2), P = -p > 0, where c = m (1 + x), s = 1 - x and m = sqrt(P/A): the asymptote is x = 0.

    The ends of the bracket and the likely place of the root come as t over that of the asymptote.
    """
    q_11, q_12, q_22, w_1, w_2 = energy
    m = sqrt(P / A)
    g_0, g_1, g_2 = P * m * q_12, 2.0 * P * (q_22 - a * q_11 / A), -6.0 * a * m * q_12
    g_3, g_4 = 2.0 * (a * q_11 + P * q_22), -A * m * q_12
    n_1, n_2 = (m - 1.0) * (m + 1.0), 2.0 * m
    c_0 = nu * A * (n_1 * (n_1 * q_11 + n_2 * q_12) + n_2 * (n_1 * q_12 + n_2 * q_22))
    across, along = A * m * w_2, a * w_1
    c_1 = nu * (4.0 * (g_0 - g_4) + 2.0 * (g_1 - g_3)) + 8.0 * P * (across - along)
    c_2 = nu * (6.0 * (g_0 + g_4) - 2.0 * g_2)
    c_3 = nu * (4.0 * (g_0 - g_4) - 2.0 * (g_1 - g_3)) + 8.0 * P * (across + along)
    c_4 = nu * (g_0 - g_1 + g_2 - g_3 + g_4)
    nearer = max((1.0 - high) / (1.0 + high) - ROUNDING, 0.0)
    farther = min((1.0 - low) / (1.0 + low) + ROUNDING, 0.5)
    guess = (1.0 - likely) / (1.0 + likely) if likely > 0.0 else 0.0
    if c_0 < -0.1 * c_1:  # close to the asymptote the quartic is its first two terms
        guess = c_0 / -c_1
    x = bracketed_root(-c_0, -c_1, -c_2, -c_3, -c_4, nearer, farther, guess)
    return m * (1.0 + x), 1.0 - x, 4.0 * P * x
