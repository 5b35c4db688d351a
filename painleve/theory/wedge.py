"""The two directions s on the boundary of a friction section in space with a + b.s = 0, where gamma < 0."""

from __future__ import annotations

import sympy as sp

from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import Derivation
from painleve.mechanics.friction import Disc, Ellipse, Polygon
from painleve.mechanics.state import State

__all__ = ["wedge"]


def wedge(state: State, d: Derivation) -> tuple[sp.MatrixBase, sp.MatrixBase] | None:
    """(s_1, s_2), s_2 counterclockwise of s_1 by less than a half turn: the impulses that keep the tip's normal
    velocity lie between these rays. None where a sign at a polygon's vertex is undecided."""
    friction = d.scene.contact.section
    if isinstance(friction, Disc | Ellipse):
        return _conic(state, d, friction)
    assert isinstance(friction, Polygon)
    return _polygon(state, d, friction)


def _conic(state: State, d: Derivation, friction: Disc | Ellipse) -> tuple[sp.MatrixBase, sp.MatrixBase]:
    """sigma = (-a c +- sqrt(|c|^2 - a^2) c_perp)/|c|^2 with c = E^T b on the unit circle; E keeps the orientation."""
    a, E = state.exact(d.a), state.exact(friction.map)
    c = E.T * state.exact(d.couplings)
    across = sp.Matrix([-c[1], c[0]])
    squared = (c.T * c)[0, 0]
    half = sp.sqrt(squared - a**2)
    # -c is the wedge's middle; c_perp is clockwise of it
    first, second = (E * (-a * c + sign * half * across) / squared for sign in (1, -1))
    return first, second


def _polygon(state: State, d: Derivation, friction: Polygon) -> tuple[sp.MatrixBase, sp.MatrixBase] | None:
    n, corners = len(friction.vertices), [state.exact(sp.Matrix(v)) for v in friction.vertices]
    compliances = [state.exact(d.edge_compliance[i + 1]) for i in range(n)]
    signs = [exact_sign(p).sign for p in compliances]
    if Sign.UNDECIDED in signs:
        return None
    inside = [sign is Sign.NEGATIVE for sign in signs]
    enters = next(i for i in range(n) if not inside[i] and inside[(i + 1) % n])
    leaves = next(i for i in range(n) if inside[i] and not inside[(i + 1) % n])
    return _crossing(corners, compliances, enters), _crossing(corners, compliances, leaves)


def _crossing(corners: list[sp.MatrixBase], compliances: list[sp.Expr], i: int) -> sp.MatrixBase:
    """Where a + b.s vanishes on the edge from vertex i to the next."""
    j = (i + 1) % len(compliances)
    first, second, p, q = corners[i], corners[j], compliances[i], compliances[j]
    return (first * q - second * p) / (q - p)
