"""The farthest member of one branch of S over one configuration: all velocities of a ball at once.

For fixed q the law is piecewise linear in v, so on each of its branches dist(S, A) is to be maximised over a ball cut
by half-spaces (painleve.core.farthest). Velocity offsets are measured in units of the ball's radius, and S relative
to the limit set as in painleve.core.offset: S = u- + tau (u_tilde - u-) + eps z.

On a slipping branch S = u- + dv + lam Y(1, s) and v_n = -lam p, where p = a + s b may be as small as one likes; lam is
therefore given, and dv runs over the section of the ball on which v_n = -lam p. Where p -> 0+ this is the closure.
"""

import math

import numpy as np

from painleve._jit import jit
from painleve.core.farthest import complete_frame, dot, farthest
from painleve.core.law import FRICTIONLESS, SLIP_PLUS, STICK
from painleve.core.reduce import PAIR, POINT
from painleve.core.rows import row_layout, segment_rows

REACH = 3  # instead of a distance: how far S comes back from u_tilde towards u-
EDGES = 3  # half-spaces at most: v_n <= 0 and the two edges of the cone
PIECES = EDGES + 1


@jit
def branch_excesses(
    branch,
    kind,
    base,
    differences,
    share,
    eps,
    u,
    direction,
    length,
    impulse,
    multiplier,
    critical_edge,
    values,
    places,
    impulses,
):
    """For each column of `differences` (rows minus their base values) the largest distance/eps, -1 where the branch
    has no member; dv/eps into `places` (d, n) and the normal impulse of the slip into `impulses`.

    share: which impulse a slip has, from 0 to the largest that the ball allows. For REACH the value is
    -(S - u_tilde).direction/eps, which may have any sign; -inf where there is none.
    """
    d = u.size
    A, c = np.empty((d, d)), np.empty(d)
    normals, offsets = np.empty((PIECES, d)), np.empty(PIECES)
    for i in range(values.size):
        row, change = base + differences[:, i], differences[:, i] / eps
        values[i], impulses[i] = -1.0 if kind != REACH else -math.inf, 0.0
        if branch in (STICK, FRICTIONLESS):
            if branch == STICK:
                count = _stick(row, change, eps, u, impulse, multiplier, A, c, normals, offsets)
            else:
                count = _frictionless(row, change, u, A, c, normals, offsets)
            if count >= 0:
                after = length / eps if multiplier > 0.0 else 0.0
                y = np.zeros(d)
                values[i] = _excess(
                    kind, A, c, after, after - length / eps, direction, normals, offsets, count, d, 1.0, y
                )
                places[:, i] = y
            continue
        sense = 1 if branch == SLIP_PLUS else -1
        start, basis, lam, more, count = _slip(
            sense, row, change, share[i], eps, u, impulse, multiplier, critical_edge == sense, c, normals, offsets
        )
        left = 1.0 - dot(start, start)
        if count < 0 or left < 0.0:
            continue
        y = np.zeros(d - 1)
        after, beyond = 0.0, -length / eps
        if critical_edge == sense:
            after, beyond = lam / multiplier * (length / eps), more * (length / multiplier)
        values[i] = _excess(
            kind, basis, c, after, beyond, direction, normals, offsets, count, d - 1, math.sqrt(left), y
        )
        for j in range(d):
            places[j, i] = start[j] + dot(basis[j], y)
        impulses[i] = lam


@jit
def _columns(row, at, d):
    """w_n, M^-1 w_n, H and M^-1 H, (d,) each."""
    return row[at.w_n : at.w_n + d], row[at.Y_n : at.Y_n + d], row[at.H : at.H + d], row[at.Y_t : at.Y_t + d]


@jit
def _stick(row, change, eps, u, impulse, multiplier, A, c, normals, offsets):
    """S - (u- or, after a jump, u_tilde) = eps (A y + c) where the tip sticks; returns how many half-spaces."""
    d = u.size
    at = row_layout(d, 1)
    own = segment_rows(at)
    w, Y_n, H, Y_t = _columns(row, at, d)
    a, b, C, plus, minus = row[at.a], row[at.b], row[at.C], row[at.edge_plus], row[own.edge_minus]
    det, (base_n, base_t) = a * C - b * b, (impulse[0], impulse[1])
    dw, dY_n, dH, dY_t = _columns(change, at, d)
    k_n = dot(dw, u)
    lack_n = k_n + change[at.a] * base_n + change[at.b] * base_t
    lack_t = dot(dH, u) + change[at.b] * base_n + change[at.C] * base_t
    e_n, e_t = (b * lack_t - C * lack_n) / det, (b * lack_n - a * lack_t) / det
    E_n, E_t = (b * H - C * w) / det, (b * w - a * H) / det
    jumps = multiplier > 0.0
    for j in range(d):
        c[j] = Y_n[j] * e_n + Y_t[j] * e_t
        if jumps:
            c[j] += dY_n[j] * base_n + dY_t[j] * base_t
        else:
            c[j] += (Y_n[j] * base_n + Y_t[j] * base_t) / eps
        for k in range(d):
            A[j, k] = Y_n[j] * E_n[k] + Y_t[j] * E_t[k] + (1.0 if j == k else 0.0)
    count = _half_space(w, -k_n, normals, offsets, 0)
    for sense, edge, s in ((1.0, plus, row[own.mu_plus]), (-1.0, minus, -row[own.mu_minus])):
        if edge > 0.0 and count >= 0:
            least = sense * (base_t * (edge / eps) + edge * e_t + s * k_n)
            count = _half_space(sense * (edge * E_t + s * w), -least, normals, offsets, count)
    return count


@jit
def _frictionless(row, change, u, A, c, normals, offsets):
    d = u.size
    at = row_layout(d, 0)
    w, Y_n, a, k_n = row[at.w_n : at.Y_n], row[at.Y_n : at.a], row[at.a], dot(change[at.w_n : at.Y_n], u)
    for j in range(d):
        c[j] = -Y_n[j] * k_n / a
        for k in range(d):
            A[j, k] = (1.0 if j == k else 0.0) - Y_n[j] * w[k] / a
    return _half_space(w, -k_n, normals, offsets, 0)


@jit
def _slip(sense, row, change, share, eps, u, impulse, multiplier, critical, c, normals, offsets):
    """dv/eps = start + basis y on the section, and S - u- (less tau jump on the critical edge) = eps (basis y + c).

    Returns start, basis, the impulse lam, more = (lam - multiplier)/eps, formed without cancellation on the critical
    edge, and how many half-spaces; -1 where the edge cannot lift the tip or always sticks.
    """
    d = u.size
    at = row_layout(d, 1)
    own = segment_rows(at)
    w, Y_n, H, Y_t = _columns(row, at, d)
    dw, dY_n, dH, dY_t = _columns(change, at, d)
    a, b, C = row[at.a], row[at.b], row[at.C]
    edge = row[at.edge_plus] if sense == 1 else row[own.edge_minus]
    s, ds = (row[own.mu_plus], change[own.mu_plus]) if sense == 1 else (-row[own.mu_minus], -change[own.mu_minus])
    det, size = a * C - b * b, math.sqrt(dot(w, w))
    frame = np.zeros((d, d))
    frame[0] = w / size
    start, basis = np.zeros(d), np.zeros((d, d - 1))
    k_n = dot(dw, u)
    lack_n = k_n + change[at.a] * impulse[0] + change[at.b] * impulse[1]
    lack_t = dot(dH, u) + change[at.b] * impulse[0] + change[at.C] * impulse[1]
    e_t, E_t = (b * lack_n - a * lack_t) / det, (b * w - a * H) / det
    # It slips while |s| lam < sense * (the sticking impulse's friction). On the critical edge both are |s| multiplier
    # at the base, and `drive` is what is left of the difference; elsewhere lam itself is compared.
    drive = sense * (e_t - ds * multiplier) if critical else sense * (impulse[1] / eps + e_t)
    most, least = drive + math.sqrt(dot(E_t, E_t)), -multiplier / eps if critical else 0.0
    if edge < 0.0 or most < abs(s) * least or size < k_n:
        return start, basis, 0.0, 0.0, -1
    highest = math.inf if s == 0.0 else most / abs(s)
    if edge > 0.0:
        highest = min(highest, (size - k_n) / (edge / eps) / eps + least)
    if highest == math.inf:
        return start, basis, 0.0, 0.0, -1
    above = (1.0 - share) * least + share * highest
    lam, more = (eps * (above - least), above) if critical else (eps * above, above - multiplier / eps)
    start[:] = -(k_n + lam * (edge / eps)) / size * frame[0]
    complete_frame(frame, 1)
    basis[:] = frame[1:].T
    for j in range(d):
        c[j] = start[j]
        if critical:  # Y (1, s) at the base points along the jump
            c[j] += lam * (dY_n[j] + s * dY_t[j] + ds * (Y_t[j] - eps * dY_t[j]))
        else:
            c[j] += lam / eps * (Y_n[j] + s * Y_t[j])
    normal = np.empty(d - 1)
    for k in range(d - 1):
        normal[k] = -sense * dot(E_t, frame[k + 1])
    count = _half_space(normal, drive - abs(s) * above + sense * dot(E_t, start), normals, offsets, 0)
    return start, basis, lam, more, count


@jit
def _half_space(normal, offset, normals, offsets, count):
    """Add normal . y <= offset, scaled; a vanishing normal leaves all (the same count) or nothing (-1)."""
    size, length = normal.size, math.sqrt(dot(normal, normal))
    if length < 1e-14:
        return count if offset >= 0.0 else -1
    for j in range(size):
        normals[count, j] = normal[j] / length
    offsets[count] = offset / length
    return count + 1


@jit
def _excess(kind, A, c, after, beyond, direction, normals, offsets, count, size, radius, best):
    """Largest distance from the limit set over the admissible y, all in units of eps, of A y + c taken from the point
    of its line that is `after` u- and `beyond` u_tilde."""
    rows = c.size
    slope, level = np.zeros(size), dot(direction, c)
    for i in range(rows):
        for j in range(size):
            slope[j] += direction[i] * A[i, j]
    reach = math.sqrt(dot(slope, slope)) * radius
    if kind == REACH:
        return _back(slope, level + beyond, reach, normals, offsets, count, radius, best)
    start, end = np.empty(rows), np.empty(rows)
    for i in range(rows):
        start[i] = c[i] + after * direction[i]
        end[i] = c[i] + beyond * direction[i]
    if kind == POINT:
        return _root(farthest(A, start, normals, offsets, count, size, radius, best))
    # Nearest to u- where level + slope . y <= first, to u_tilde where it is >= second, else to a point between them.
    half = 0.5 * (after - beyond) if kind == PAIR else 0.0
    first, second = half - after, -half - beyond
    value, y, opposite = -1.0, np.zeros(size), np.empty(size)
    if level - reach <= first:
        more = _half_space(slope, first - level, normals, offsets, count)
        if more >= 0:
            value = _better(farthest(A, start, normals, offsets, more, size, radius, y), value, y, best)
    if level + reach >= second:
        for j in range(size):
            opposite[j] = -slope[j]
        more = _half_space(opposite, level - second, normals, offsets, count)
        if more >= 0:
            value = _better(farthest(A, end, normals, offsets, more, size, radius, y), value, y, best)
    if kind != PAIR:
        across = np.empty((rows, size))
        for i in range(rows):
            end[i] = c[i] - level * direction[i]
            for j in range(size):
                across[i, j] = A[i, j] - direction[i] * slope[j]
        value = _better(farthest(across, end, normals, offsets, count, size, radius, y), value, y, best)
    return _root(value)


@jit
def _back(slope, level, reach, normals, offsets, count, radius, best):
    """max -(level + slope . y): squared after a shift that makes it positive."""
    shift, form = 2.0 * reach + abs(level) + 1.0, np.empty((1, slope.size))
    for j in range(slope.size):
        form[0, j] = -slope[j]
    value = farthest(form, np.array([shift - level]), normals, offsets, count, slope.size, radius, best)
    return math.sqrt(value) - shift if value >= 0.0 else -math.inf


@jit
def _better(value, known, y, best):
    if value > known:
        best[:] = y
        return value
    return known


@jit
def _root(squared):
    return math.sqrt(squared) if squared >= 0.0 else -1.0
