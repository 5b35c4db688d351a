"""The impulse of law (7) with friction in space, in ball arithmetic and independently of the compiled law.

With nu = -v_n > 0 the impulses that cancel v_n are those with r_n = (nu - b.r_t)/a, and what is minimised over them is
the convex function r_t.Q r_t/2 + w.r_t. Its minimum over a convex set is known by the conditions of Karush, Kuhn and
Tucker alone: a point of the boundary where the tip's velocity Q r_t + w is the inward normal, times some factor. On the
boundary of a conic the points where it is parallel to the normal are the roots of a quartic: one of them, enclosed by
an interval Newton step and with the right sense, is the optimum, and no other need be looked at. On a polygon it is
a vertex from which the energy grows along both edges, or the least point of an edge that has the sticking impulse
beyond it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

import flint

from painleve.core.codes import ContactMode

__all__ = ["ContactBalls", "conic_impulse", "polygon_impulse"]

WIDENINGS = (4, 2**10, 2**30)  # of the first Newton correction, to a ball that holds the root
Balls = Sequence[flint.arb]
Impulse = tuple[flint.arb, flint.arb, flint.arb, ContactMode]


@dataclass(frozen=True, kw_only=True)
class ContactBalls:
    """The Delassus matrix [[a, b], [b, C]] and the contact velocity (v_n, v_t) with v_n < 0: balls.

    b: (b_1, b_2), C: (C_11, C_12, C_22), v: (v_n, v_1, v_2).
    """

    a: flint.arb
    b: Balls
    C: Balls
    v: Balls

    @property
    def energy(self) -> tuple[Balls, Balls]:
        """Q = C - b b^T/a as (Q_11, Q_12, Q_22), and w = v_t - b v_n/a."""
        a, (b_1, b_2), (C_11, C_12, C_22), (v_n, v_1, v_2) = self.a, self.b, self.C, self.v
        Q = (C_11 - b_1 * b_1 / a, C_12 - b_1 * b_2 / a, C_22 - b_2 * b_2 / a)
        return Q, (v_1 - b_1 * v_n / a, v_2 - b_2 * v_n / a)

    def sticking(self) -> tuple[flint.arb, flint.arb]:
        """-Q^-1 w."""
        (Q_11, Q_12, Q_22), (w_1, w_2) = self.energy
        determinant = Q_11 * Q_22 - Q_12 * Q_12
        return (Q_12 * w_2 - Q_22 * w_1) / determinant, (Q_12 * w_1 - Q_11 * w_2) / determinant

    def normal(self, r_1: flint.arb, r_2: flint.arb) -> flint.arb:
        """r_n of r_t."""
        return (-self.v[0] - self.b[0] * r_1 - self.b[1] * r_2) / self.a

    def after(self, r_1: flint.arb, r_2: flint.arb) -> tuple[flint.arb, flint.arb]:
        """The tip's velocity afterwards, Q r_t + w."""
        (Q_11, Q_12, Q_22), (w_1, w_2) = self.energy
        return Q_11 * r_1 + Q_12 * r_2 + w_1, Q_12 * r_1 + Q_22 * r_2 + w_2

    def turned(self, e_1: flint.arb, e_2: flint.arb) -> ContactBalls:
        """The same in tangential axes of which (e_1, e_2) is the first."""
        (b_1, b_2), (C_11, C_12, C_22), (v_n, v_1, v_2) = self.b, self.C, self.v
        x_1, x_2 = C_11 * e_1 + C_12 * e_2, C_12 * e_1 + C_22 * e_2
        y_1, y_2 = C_12 * e_1 - C_11 * e_2, C_22 * e_1 - C_12 * e_2
        return ContactBalls(
            a=self.a,
            b=(b_1 * e_1 + b_2 * e_2, b_2 * e_1 - b_1 * e_2),
            C=(x_1 * e_1 + x_2 * e_2, x_2 * e_1 - x_1 * e_2, y_2 * e_1 - y_1 * e_2),
            v=(v_n, v_1 * e_1 + v_2 * e_2, v_2 * e_1 - v_1 * e_2),
        )


def conic_impulse(contact: ContactBalls, p: flint.arb) -> Impulse:
    """(r_n, r_1, r_2, branch) with the unit disc for a section; p = a - |b|, exactly zero where it is known to be.

    Raises ArithmeticError where the balls do not decide between sticking and slip, or do not isolate the optimum.
    """
    size = _norm(*contact.b)
    if not size > 0 and not size == 0:
        raise ArithmeticError("the direction of the coupling b cannot be decided at these offsets")
    e_1, e_2 = (contact.b[0] / size, contact.b[1] / size) if size > 0 else (flint.arb(1), flint.arb(0))
    aligned, nu = contact.turned(e_1, e_2), -contact.v[0]
    x, y = aligned.sticking()
    reach = _norm(x, y)
    excess = p * reach + size * (reach + x) - nu
    if excess <= 0:
        r_n, branch = aligned.normal(x, y), ContactMode.STICK
    elif excess > 0:
        (r_n, x, y), branch = _slip(aligned, size, p), ContactMode.SLIP
    else:
        raise ArithmeticError("stick or slip cannot be decided at these offsets")
    return r_n, x * e_1 - y * e_2, x * e_2 + y * e_1, branch


def _norm(x: flint.arb, y: flint.arb) -> flint.arb:
    return (x * x + y * y).nonnegative_part().sqrt()


def _slip(contact: ContactBalls, size: flint.arb, p: flint.arb) -> tuple[flint.arb, flint.arb, flint.arb]:
    """(r_n, x, y) of the optimum on the boundary, in the frame of b; |b| = size."""
    for cotangent in (False, True):
        for t, quartic in _stationary(contact, size, p, cotangent):
            found = _enclosed(quartic, t)
            if found is None:
                continue
            x, y, D = _point(found, cotangent, size, contact.a, p)
            if not D > 0:
                continue
            multiple = -contact.v[0] / D
            r_n, r_1, r_2 = multiple * (1 + found * found), multiple * x, multiple * y
            c_1, c_2 = contact.after(r_1, r_2)
            n_1, n_2 = contact.a * r_1 / r_n + size, contact.a * r_2 / r_n
            if c_1 * n_1 + c_2 * n_2 < 0:
                return r_n, r_1, r_2
    raise ArithmeticError("the least impulse cannot be enclosed at these offsets")


# Where t is the tangent of half the angle of r_t with b, r_t = nu (1 - t^2, 2t)/(a + |b| + p t^2); where it is the
# cotangent, nu (t^2 - 1, 2t)/((a + |b|) t^2 + p). The derivative of either is a multiple of (-2at, a + |b| - p t^2),
# or of (2at, p - (a + |b|) t^2).
Number = TypeVar("Number", flint.arb, flint.arb_poly)


def _point(t: Number, cotangent: bool, size: flint.arb, a: flint.arb, p: flint.arb) -> tuple[Number, Number, Number]:
    """(x, y, D) with r_t = nu (x, y)/D."""
    if cotangent:
        return t * t - 1, 2 * t, (a + size) * (t * t) + p
    return 1 - t * t, 2 * t, (a + size) + p * (t * t)


def _stationary(
    contact: ContactBalls, size: flint.arb, p: flint.arb, cotangent: bool
) -> Iterator[tuple[flint.arb, flint.arb_poly]]:
    """Approximate roots in [-1, 1] of the quartic that vanishes where the tip's velocity is normal to the conic."""
    t = flint.arb_poly([0, 1])
    x, y, D = _point(t, cotangent, size, contact.a, p)
    nu, (Q_11, Q_12, Q_22), (w_1, w_2) = -contact.v[0], *contact.energy
    after_1, after_2 = nu * (Q_11 * x + Q_12 * y) + w_1 * D, nu * (Q_12 * x + Q_22 * y) + w_2 * D
    if cotangent:
        quartic = (p - (contact.a + size) * (t * t)) * after_2 + 2 * contact.a * t * after_1
    else:
        quartic = (contact.a + size - p * (t * t)) * after_2 - 2 * contact.a * t * after_1
    tiny = flint.arb(2) ** (-flint.ctx.prec // 2)
    try:
        roots = flint.acb_poly([c.mid() for c in quartic.coeffs()]).roots(tol=tiny)
    except ValueError:  # two roots that cannot be told apart; the other chart may part them
        return
    for root in roots:
        if abs(root.real.mid()) <= 1.01 and abs(root.imag.mid()) <= tiny:
            yield root.real.mid(), quartic


def _enclosed(quartic: flint.arb_poly, t: flint.arb) -> flint.arb | None:
    """A ball about t with exactly one root: the slope has one sign on it, and the interval Newton step stays inside."""
    slope = quartic.derivative()
    first = abs(quartic(t) / slope(t)).upper()
    if not first.is_finite():
        return None
    for widening in WIDENINGS:
        wide = t + flint.arb(0, 1) * (first * widening + abs(t) * flint.arb(2) ** (4 - flint.ctx.prec))
        step = t - quartic(t) / slope(wide)
        if wide.contains(step):
            return step
    return None


def polygon_impulse(contact: ContactBalls, vertices: Sequence[Balls], p: Balls) -> Impulse:
    """(r_n, r_1, r_2, branch) with a polygon for a section; p: a + b.s of its vertices, zero where it is known to be.

    Raises ArithmeticError where the balls decide nothing.
    """
    n, stick = len(vertices), contact.sticking()
    depths = [_depth(contact, vertices, p, i, (i + 1) % n, *stick) for i in range(n)]
    if all(depth >= 0 for depth in depths):
        return contact.normal(*stick), *stick, ContactMode.STICK
    if not any(depth < 0 for depth in depths):
        raise ArithmeticError("stick or slip cannot be decided at these offsets")
    for i in range(n):
        found = _on_vertex(contact, vertices, p, i) or (_on_edge(contact, vertices, p, i) if depths[i] < 0 else None)
        if found is not None:
            return *found, ContactMode.SLIP
    raise ArithmeticError("the least impulse cannot be enclosed at these offsets")


def _depth(
    contact: ContactBalls, vertices: Sequence[Balls], p: Balls, i: int, j: int, r_1: flint.arb, r_2: flint.arb
) -> flint.arb:
    """The determinant of (p_i, s_i), (p_j, s_j), (nu, r): positive inside the edge from s_i to s_j."""
    (s_1, s_2), (z_1, z_2) = vertices[i], vertices[j]
    return -contact.v[0] * (s_1 * z_2 - s_2 * z_1) + p[i] * (z_1 * r_2 - z_2 * r_1) - p[j] * (s_1 * r_2 - s_2 * r_1)


def _on_vertex(
    contact: ContactBalls, vertices: Sequence[Balls], p: Balls, i: int
) -> tuple[flint.arb, flint.arb, flint.arb] | None:
    """The impulse on vertex i, if it is the optimum."""
    if not p[i] > 0:
        return None
    r_n = -contact.v[0] / p[i]
    r_1, r_2 = r_n * vertices[i][0], r_n * vertices[i][1]
    c_1, c_2 = contact.after(r_1, r_2)
    for j in ((i + 1) % len(vertices), i - 1):
        T_1, T_2 = (p[i] * vertices[j][k] - p[j] * vertices[i][k] for k in range(2))
        if not T_1 * c_1 + T_2 * c_2 >= 0:
            return None
    return r_n, r_1, r_2


def _on_edge(
    contact: ContactBalls, vertices: Sequence[Balls], p: Balls, k: int
) -> tuple[flint.arb, flint.arb, flint.arb] | None:
    """The least point of the edge from vertex k to the next, if it is between them."""
    i, j = k, (k + 1) % len(vertices)
    if p[j].mid() > p[i].mid():
        i, j = j, i
    if not p[i] > 0:
        return None
    T_1, T_2 = (vertices[j][m] - vertices[i][m] * p[j] / p[i] for m in range(2))
    start = -contact.v[0] / p[i]
    c_1, c_2 = contact.after(start * vertices[i][0], start * vertices[i][1])
    Q_11, Q_12, Q_22 = contact.energy[0]
    x_j = -(T_1 * c_1 + T_2 * c_2) / (T_1 * (Q_11 * T_1 + Q_12 * T_2) + T_2 * (Q_12 * T_1 + Q_22 * T_2))
    x_i = (-contact.v[0] - x_j * p[j]) / p[i]
    if not (x_i >= 0 and x_j >= 0):
        return None
    r_1, r_2 = (x_i * vertices[i][m] + x_j * vertices[j][m] for m in range(2))
    return x_i + x_j, r_1, r_2
