"""Moreau's contact law S in contact coordinates, one point at a time (docs/theory.md, section 2).

With G = [[a, b], [b, C]] and the contact velocity (v_n, v_t), v_n < 0, the feasible impulses (1, s) lambda that
cancel the normal velocity form an interval of the line a r_n + b r_t = -v_n. The kinetic energy restricted to that
line is a parabola with its least value at the sticking impulse, so S is a clamp: this holds for every sign of gamma.
"""

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.rows import row_layout, segment_rows

FREE, STICK, SLIP_PLUS, SLIP_MINUS = (
    int(b) for b in (ContactMode.FREE, ContactMode.STICK, ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS)
)
FRICTIONLESS = int(ContactMode.FRICTIONLESS)


@jit
def stick_impulse(a, b, C, v_n, v_t):
    """The impulse -G^-1 v_c that stops the tip."""
    determinant = a * C - b * b
    return (b * v_t - C * v_n) / determinant, (b * v_n - a * v_t) / determinant


@jit
def planar_branch(edge_plus, edge_minus, mu_plus, mu_minus, v_n, stick_t):
    """Which branch S takes at a contact with v_n < 0: the sticking impulse is clamped to the cone."""
    # Written without 0 * inf: an edge that cannot lift never binds.
    if edge_plus > 0.0 and stick_t * edge_plus > -mu_plus * v_n:
        return SLIP_PLUS
    if edge_minus > 0.0 and -stick_t * edge_minus > -mu_minus * v_n:
        return SLIP_MINUS
    return STICK


@jit
def planar_impulse(a, b, C, edge_plus, edge_minus, mu_plus, mu_minus, v_n, v_t):
    """(r_n, r_t, branch) of the planar law with the section [-mu_minus, mu_plus]; no impulse where v_n >= 0."""
    if v_n >= 0.0:
        return 0.0, 0.0, FREE
    stick_n, stick_t = stick_impulse(a, b, C, v_n, v_t)
    branch = planar_branch(edge_plus, edge_minus, mu_plus, mu_minus, v_n, stick_t)
    if branch == SLIP_PLUS:
        r_n = -v_n / edge_plus
        return r_n, mu_plus * r_n, branch
    if branch == SLIP_MINUS:
        r_n = -v_n / edge_minus
        return r_n, -mu_minus * r_n, branch
    return stick_n, stick_t, branch


@jit
def law_from_rows(rows, dimension, planar, v, result):
    """S(q, v) into `result` from the scene's rows at q (painleve.core.rows); returns the branch."""
    at = row_layout(dimension, 1 if planar else 0)
    v_n = 0.0
    for j in range(dimension):
        v_n += rows[at.w_n + j] * v[j]
        result[j] = v[j]
    if rows[at.g] < 0.0 or v_n >= 0.0:
        return FREE
    a = rows[at.a]
    if not planar:
        for j in range(dimension):
            result[j] -= rows[at.Y_n + j] * v_n / a
        return FRICTIONLESS
    v_t = 0.0
    for j in range(dimension):
        v_t += rows[at.H + j] * v[j]
    own = segment_rows(at)
    r_n, r_t, branch = planar_impulse(
        a,
        rows[at.b],
        rows[at.C],
        rows[at.edge_plus],
        rows[own.edge_minus],
        rows[own.mu_plus],
        rows[own.mu_minus],
        v_n,
        v_t,
    )
    for j in range(dimension):
        result[j] += rows[at.Y_n + j] * r_n + rows[at.Y_t + j] * r_t
    return branch
