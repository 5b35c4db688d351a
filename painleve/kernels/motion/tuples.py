"""Template: arithmetic of vectors, tuples of D numbers."""

from painleve._jit import jit
from painleve.kernels.motion.sample import D

ACCURACY = 1e-12  # change, relative to the velocities, at which an implicit step is solved


@jit
def add(x, s, y):
    """x + s y."""
    return tuple(x[j] + s * y[j] for j in range(D))


@jit
def mix(s, x, y):
    """(1 - s) x + s y."""
    return tuple((1.0 - s) * x[j] + s * y[j] for j in range(D))


@jit
def size_of(x):
    """The sum of |x_j|."""
    size = 0.0
    for j in range(D):
        size += abs(x[j])
    return size


@jit
def close(x, y, v, noise):
    """Whether x and y are the same velocity but for rounding and for `noise`.

    Against the free velocity v too: x is v plus an impulse, and rounding in v is all that is left of x at rest.
    """
    bound = ACCURACY * (size_of(x) + size_of(v)) + noise
    same = True
    for j in range(D):
        same &= abs(x[j] - y[j]) <= bound
    return same


@jit
def load(x, i):
    """Row i of an array."""
    return tuple(x[i, j] for j in range(D))


@jit
def store(x, i, y):
    """y into row i of an array."""
    for j in range(D):
        x[i, j] = y[j]
