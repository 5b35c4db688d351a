"""What a scene defines for its motion, for one small scene: the templates run on it where nothing is compiled.

A point of mass 1 in the plane slides with friction on the parabola y = x^2/2: g = x^2/2 - y, w_n = (-x, 1), H = (1, 0).
Its parameters p are mu, the weight, a drag on u_x, and a force `beat` t along x. A point of its outline is at
the height y + x + 1/4 over the floor 0.

Tuples hold the rows (painleve.core.rows), vectors of D components, and matrices row by row.
"""

from painleve._jit import jit

D, ROWS = 2, 16


@jit
def rows_at(q, p):
    """The rows at the configuration q."""
    x, mu = q[0], p[0]
    a = x * x + 1.0
    edge_plus, edge_minus = -mu * x + a, mu * x + a
    return (x * x / 2.0 - q[1], -x, 1.0, -x, 1.0, a, edge_plus, 1.0, 0.0, 1.0, 0.0, -x, 1.0, edge_minus, mu, mu)


@jit
def force_at(t, q, u, p):
    """The force f."""
    return (-p[2] * u[0] + p[3] * t, -p[1])


@jit
def motion_at(t, q, u, p):
    """(rows, M^-1 f)."""
    return rows_at(q, p), force_at(t, q, u, p)


@jit
def inertia_at(q, p):
    """M."""
    return (1.0, 0.0, 0.0, 1.0)


@jit
def drift_at(q, u, p):
    """What curvature adds to the contact accelerations W^T du/dt: u . (dW/dq) u, of the normal and of the tangent."""
    return (-u[0] * u[0], 0.0)


@jit
def depths_at(q, p):
    """How far below the floor the points of the outline are that the contact does not hold up; -inf without any."""
    return (-q[0] - q[1] - 1.0 / 4.0,)
