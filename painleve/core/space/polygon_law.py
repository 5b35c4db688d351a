"""Moreau's contact law S in space with a convex polygon for the friction section, one point at a time (paper, law (7);
docs/theory.md, section 2).

The impulses are sums of x_i (1, s_i) with x_i >= 0 over the vertices s_i; those that cancel the normal velocity have
sum x_i p_i = nu = -v_n, where p_i = a + b.s_i. In the plane of r_t they fill a convex polygon, unbounded where some p_i
is not positive: two neighbours span a segment of its boundary if both p are positive, a ray if one is, else nothing.
"""

from math import inf

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.space.tangent_plane import is_definite, made_definite, scales, sticking_point, tangent_energy

FREE, STICK, SLIP = int(ContactMode.FREE), int(ContactMode.STICK), int(ContactMode.SLIP)


@jit
def polygon_impulse(G, vertices, p, v):
    """(r_n, r_1, r_2, branch) of law (7) with a polygon for a section, at v = (v_n, v_1, v_2) and W^T M^-1 W = G; no
    impulse where v_n >= 0.

    `vertices` (n, 2), counterclockwise with 0 inside or on the edge; a segment and a point are polygons too. `p` (n,):
    a + b.s_i, taken as given, so that no rounding hides a sign.
    """
    v_n, v_1, v_2 = v
    if v_n >= 0.0:
        return 0.0, 0.0, 0.0, FREE
    scale, back = scales(v_n, v_1, v_2)
    nu = -v_n * scale
    energy = tangent_energy(G, nu, v_1 * scale, v_2 * scale)
    if not is_definite(energy):
        energy = made_definite(energy, G.C_11, G.C_22)
    point = sticking_point(energy)
    if sticks(vertices, p, nu, point):
        X, Y, W = point
        r_1, r_2 = X / W, Y / W
        r_n, branch = (nu - G.b_1 * r_1 - G.b_2 * r_2) / G.a, STICK
    else:
        r_n, r_1, r_2, branch = nearest_on_boundary(vertices, p, energy, nu, point)
    return r_n * back, r_1 * back, r_2 * back, branch


@jit
def depth(vertices, p, i, j, nu, point):
    """W times the determinant of (p_i, s_i), (p_j, s_j), (nu, r): positive inside the edge from s_i to s_j.

    r = (X, Y)/W, `point` = (X, Y, W).
    """
    X, Y, W = point
    s_1, s_2, z_1, z_2 = vertices[i, 0], vertices[i, 1], vertices[j, 0], vertices[j, 1]
    return nu * W * (s_1 * z_2 - s_2 * z_1) + p[i] * (z_1 * Y - z_2 * X) - p[j] * (s_1 * Y - s_2 * X)


@jit
def sticks(vertices, p, nu, point):
    """Whether the sticking impulse is in the cone; a section without area is left to the search on its edges."""
    n, inner = len(p), 0
    for i in range(n):
        inside = depth(vertices, p, i, (i + 1) % n, nu, point)
        if inside < 0.0:
            return False
        if inside > 0.0:
            inner += 1
    return inner > 0


@jit
def nearest_on_boundary(vertices, p, energy, nu, point):
    """(r_n, r_1, r_2, branch) of the point of least energy on the visible edges, or where there are none on all."""
    i, j, x_i, x_j, branch = nearest_edge(vertices, p, energy, nu, point)
    r_1 = x_i * vertices[i, 0] + x_j * vertices[j, 0]
    return x_i + x_j, r_1, x_i * vertices[i, 1] + x_j * vertices[j, 1], branch


@jit
def nearest_edge(vertices, p, energy, nu, point):
    """(i, j, x_i, x_j, branch): the same point as x_i (1, s_i) + x_j (1, s_j)."""
    Q_11, Q_12, Q_22, w_1, w_2 = energy
    n = len(p)
    best_1, best_2, found, branch = 0.0, 0.0, False, SLIP
    best_i, best_j, best_x_i, best_x_j = 0, 0, 0.0, 0.0
    for k in range(n):
        i, j = k, (k + 1) % n
        outside = depth(vertices, p, i, j, nu, point)
        if p[j] > p[i]:
            i, j = j, i
        if outside > 0.0 or p[i] <= 0.0:
            continue
        s_1, s_2, z_1, z_2 = vertices[i, 0], vertices[i, 1], vertices[j, 0], vertices[j, 1]
        start_1, start_2 = s_1 * (nu / p[i]), s_2 * (nu / p[i])
        along_1, along_2 = z_1 - s_1 * (p[j] / p[i]), z_2 - s_2 * (p[j] / p[i])
        slope = along_1 * (Q_11 * start_1 + Q_12 * start_2 + w_1) + along_2 * (Q_12 * start_1 + Q_22 * start_2 + w_2)
        curvature = along_1 * (Q_11 * along_1 + Q_12 * along_2) + along_2 * (Q_12 * along_1 + Q_22 * along_2)
        farthest = nu / p[j] if p[j] > 0.0 else inf
        x_j = -slope / curvature if slope < 0.0 and curvature > 0.0 else 0.0
        x_i = (nu - x_j * p[j]) / p[i]
        if x_j >= farthest:
            x_i, x_j = 0.0, farthest
        r_1, r_2 = x_i * s_1 + x_j * z_1, x_i * s_2 + x_j * z_2
        # the difference of the two energies, from their mean velocity
        step_1, step_2, mean_1, mean_2 = r_1 - best_1, r_2 - best_2, 0.5 * (r_1 + best_1), 0.5 * (r_2 + best_2)
        change = step_1 * (Q_11 * mean_1 + Q_12 * mean_2 + w_1) + step_2 * (Q_12 * mean_1 + Q_22 * mean_2 + w_2)
        if not found or change < 0.0:
            found, best_1, best_2 = True, r_1, r_2
            best_i, best_j, best_x_i, best_x_j = i, j, x_i, x_j
            branch = STICK if outside == 0.0 and 0.0 < x_j < farthest else SLIP
    return best_i, best_j, best_x_i, best_x_j, branch
