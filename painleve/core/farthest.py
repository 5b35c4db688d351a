"""The largest value of |A y + c| over a ball cut by a few half-spaces, in dimension at most three or so, globally.

A convex function attains its maximum where as many constraints hold with equality as can: on the sphere, or at a
vertex of the half-spaces inside it. So every set of active half-spaces is tried; on the sphere of what is left free
this is a trust-region problem, whose maxima are the global one, nu > sigma_1 in the secular equation, and at most one
more, sigma_2 < nu < sigma_1 (J. M. Martinez, SIAM J. Optim. 4 (1994) 159-176).

Loops are written out: for such small arrays that runs, and compiles, many times faster than array expressions.
(docs/theory.md, section 4.4.)
"""

import math

import numpy as np

from painleve._jit import jit

SLACK = 1e-11  # by which a candidate may leave a half-space, in the units of y
SWEEPS = 10
BISECTIONS = 64


@jit
def farthest(A, c, normals, offsets, count, size, radius, best):
    """max |A y + c|^2 over the y of length `size` with |y| <= radius and normals[i] . y <= offsets[i], i < count.

    normals: rows of unit length; columns of A, rows of normals and `best` beyond `size` are not used. The place goes
    into `best`. -1 where no y is admissible.
    """
    value = -1.0
    frame, start = np.zeros((size, size)), np.zeros(size)
    form, vectors = np.empty((size, size)), np.empty((size, size))
    sigma, beta, z, y = np.empty(size), np.empty(size), np.empty(size), np.empty(size)
    for active in range(1 << count):
        used, left = _face(normals, offsets, count, active, size, radius, frame, start)
        if used < 0:
            continue
        free = size - used
        if free > 0:
            _reduce(A, c, frame, start, used, free, form, beta, sigma, vectors)
        for sense in (1.0, -1.0):
            if free > 0 and not _on_sphere(sigma, beta, free, left, sense, z):
                continue
            for j in range(size):
                y[j] = start[j]
                for i in range(free):
                    for k in range(free):
                        y[j] += z[i] * vectors[k, i] * frame[used + k, j]
            squared = _squared(A, c, y)
            if squared <= value:
                break  # the first candidate bounds the whole face
            if _admissible(normals, offsets, count, y):
                value = squared
                for j in range(size):
                    best[j] = y[j]
                if active == 0 and sense > 0.0:
                    return value  # the maximum over the whole ball is admissible
                break
            if free == 0:
                break
    return value


@jit
def dot(x, y):
    total = 0.0
    for i in range(x.size):
        total += x[i] * y[i]
    return total


@jit
def _squared(A, c, y):
    total = 0.0
    for i in range(c.size):
        x = c[i]
        for j in range(y.size):
            x += A[i, j] * y[j]
        total += x * x
    return total


@jit
def _admissible(normals, offsets, count, y):
    for i in range(count):
        x = 0.0
        for j in range(y.size):
            x += normals[i, j] * y[j]
        if x > offsets[i] + SLACK:
            return False
    return True


@jit
def _face(normals, offsets, count, active, size, radius, frame, start):
    """Where the active half-spaces hold with equality: its point nearest to the origin into `start`, and an orthonormal
    frame whose rows from the `used`-th on span it. Returns (used, radius of the ball in it); used < 0: no such face."""
    used = 0
    start[:] = 0.0
    for i in range(count):
        if active >> i & 1:
            if used == size:
                return -1, 0.0
            for j in range(size):
                frame[used, j] = normals[i, j]
            length = _orthogonalise(frame, used)
            if length < 1e-9:
                return -1, 0.0
            shift = offsets[i]
            for j in range(size):
                shift -= normals[i, j] * start[j]
            for j in range(size):
                start[j] += shift / length * frame[used, j]
            used += 1
    left = radius * radius - dot(start, start)
    if left < 0.0:
        return -1, 0.0
    complete_frame(frame, used)
    return used, math.sqrt(left)


@jit
def _orthogonalise(frame, k):
    """Make row k a unit vector orthogonal to the rows before it; returns its length before that."""
    size, length = frame.shape[1], 0.0
    for _ in range(2):  # twice is enough for orthogonality to rounding
        for i in range(k):
            x = 0.0
            for j in range(size):
                x += frame[i, j] * frame[k, j]
            for j in range(size):
                frame[k, j] -= x * frame[i, j]
    for j in range(size):
        length += frame[k, j] ** 2
    length = math.sqrt(length)
    if length > 0.0:
        for j in range(size):
            frame[k, j] /= length
    return length


@jit
def complete_frame(frame, used):
    """Extend the first `used` orthonormal rows to an orthonormal basis, from the axes that are left over most."""
    size = frame.shape[1]
    for k in range(used, size):
        longest, chosen = -1.0, 0
        for axis in range(size):
            left = 1.0
            for i in range(k):
                left -= frame[i, axis] ** 2
            if left > longest:
                longest, chosen = left, axis
        for j in range(size):
            frame[k, j] = 1.0 if j == chosen else 0.0
        _orthogonalise(frame, k)


@jit
def _reduce(A, c, frame, start, used, free, form, beta, sigma, vectors):
    """|A y + c|^2 on the face, in the axes of its quadratic form: curvatures sigma, falling, and linear part beta."""
    rows, size = c.size, start.size
    linear = np.zeros(free)
    images = np.zeros((rows, free))
    for i in range(rows):
        x = c[i]
        for j in range(size):
            x += A[i, j] * start[j]
            for k in range(free):
                images[i, k] += A[i, j] * frame[used + k, j]
        for k in range(free):
            linear[k] += images[i, k] * x
    for k in range(free):
        for m in range(free):
            form[k, m] = 0.0
            for i in range(rows):
                form[k, m] += images[i, k] * images[i, m]
    _diagonalise(form, vectors, free)
    for k in range(free):
        sigma[k], beta[k] = form[k, k], 0.0
        for m in range(free):
            beta[k] += vectors[m, k] * linear[m]
    for k in range(1, free):  # the largest curvature first
        if sigma[k] > sigma[0]:
            sigma[0], sigma[k] = sigma[k], sigma[0]
            beta[0], beta[k] = beta[k], beta[0]
            for m in range(free):
                vectors[m, 0], vectors[m, k] = vectors[m, k], vectors[m, 0]


@jit
def _diagonalise(form, vectors, size):
    """Jacobi rotations: the leading block of `form` becomes diagonal, its eigenvectors the columns of `vectors`."""
    for i in range(size):
        for j in range(size):
            vectors[i, j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        off, scale = 0.0, 0.0
        for i in range(size):
            scale += abs(form[i, i])
            for j in range(i + 1, size):
                off += abs(form[i, j])
        if off <= 1e-18 * scale:
            return
        for i in range(size):
            for j in range(i + 1, size):
                if form[i, j] != 0.0:
                    angle = 0.5 * math.atan2(2.0 * form[i, j], form[i, i] - form[j, j])
                    cos, sin = math.cos(angle), math.sin(angle)
                    for k in range(size):
                        x, y = form[k, i], form[k, j]
                        form[k, i], form[k, j] = cos * x + sin * y, cos * y - sin * x
                    for k in range(size):
                        x, y = form[i, k], form[j, k]
                        form[i, k], form[j, k] = cos * x + sin * y, cos * y - sin * x
                        x, y = vectors[k, i], vectors[k, j]
                        vectors[k, i], vectors[k, j] = cos * x + sin * y, cos * y - sin * x
                    form[i, j] = form[j, i] = 0.0


@jit
def _on_sphere(sigma, beta, size, radius, sense, z):
    """z_i = beta_i/(nu - sigma_i) with |z| = radius and nu = sigma_1 + sense * gap: the global maximum for sense = +1,
    the other local one for sense = -1. Returns whether there is one."""
    total = 0.0
    for i in range(size):
        total += beta[i] ** 2
    total = math.sqrt(total)
    if size == 1 or radius == 0.0:
        z[:] = 0.0
        z[0] = sense * math.copysign(radius, beta[0])
        return sense > 0.0 or radius > 0.0
    # Where beta_1 vanishes both signs of z_1 are as good; a beta_1 below rounding chooses one and changes nothing.
    floor = 1e-15 * (sigma[0] * radius + total) + 1e-300
    first = beta[0] if abs(beta[0]) > floor else math.copysign(floor, beta[0])
    low, high = abs(first) / radius, (total + floor) / radius
    if sense < 0.0:
        high = _shortest(sigma, beta, first, size, low)
        if not high > low or _length2(sigma, beta, first, size, -high) > radius * radius:
            return False
    for _ in range(BISECTIONS):
        gap = math.sqrt(low * high)
        if _length2(sigma, beta, first, size, sense * gap) > radius * radius:
            low = gap
        else:
            high = gap
    z[0] = sense * first / high
    length = z[0] ** 2
    for i in range(1, size):
        z[i] = beta[i] / (sigma[0] - sigma[i] + sense * high)
        length += z[i] ** 2
    for i in range(size):
        z[i] *= radius / math.sqrt(length)
    return True


@jit
def _length2(sigma, beta, first, size, shift):
    total = (first / shift) ** 2
    for i in range(1, size):
        total += (beta[i] / (sigma[0] - sigma[i] + shift)) ** 2
    return total


@jit
def _shortest(sigma, beta, first, size, low):
    """The gap above `low` at which |z| is least on sigma_2 < nu < sigma_1; `low` if there is none."""
    high = math.inf
    for i in range(1, size):
        high = min(high, sigma[0] - sigma[i])
    for _ in range(BISECTIONS):
        if not high > low:
            return low
        gap = math.sqrt(low * high)
        slope = -(first**2) / gap**3
        for i in range(1, size):
            if beta[i] != 0.0:
                slope += beta[i] ** 2 / (sigma[0] - sigma[i] - gap) ** 3
        if slope < 0.0:
            low = gap
        else:
            high = gap
    return low
