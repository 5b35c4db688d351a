"""The rows of a contact: the functions of q that its law needs, in the one order that all tables and kernels share.

    g, w_n (d), Y_n (d), a, edge_plus                      every contact; edge_plus: the least normal compliance,
                                                           in the plane that on the edge s = +mu_plus of the cone
    H (k d), Y_t (k d), b (k), C (k (k + 1)/2)             with friction in k directions, one tangent after the other
    section                                                what the friction section adds, see below

for d coordinates: w_n = -grad g, Y_n = M^-1 w_n, Y_t = M^-1 H, and W^T M^-1 W = [[a, b^T], [b, C]], the upper half of
C. Discs and ellipses come as the unit disc: with the section E times that disc, H stands for H E, and so on.

What a section adds has its order in painleve.core.sections: SegmentRows, PolygonRows.

Offsets are numbers of compiled code too: there `row_layout` costs nothing, for it is inlined and its sums are folded.
"""

from __future__ import annotations

from typing import NamedTuple

from painleve._jit import jit

__all__ = ["RowLayout", "RowParts", "row_layout", "row_parts"]


class RowLayout(NamedTuple):
    """Where each part begins; C is followed by what the section adds."""

    g: int
    w_n: int
    Y_n: int
    a: int
    edge_plus: int
    H: int
    Y_t: int
    b: int
    C: int
    section: int


def _row_layout(d, k):
    w_n = 1
    Y_n = w_n + d
    a = Y_n + d
    edge_plus = a + 1
    H = edge_plus + 1
    Y_t = H + k * d
    b = Y_t + k * d
    C = b + k
    return RowLayout(0, w_n, Y_n, a, edge_plus, H, Y_t, b, C, C + k * (k + 1) // 2)


row_layout = jit(_row_layout)
"""The layout for d coordinates and k tangents."""


class RowParts(NamedTuple):
    """The same for tables with the rows along their first axis, and for lists: one part each, H and Y_t by tangent."""

    g: int
    w_n: slice
    Y_n: slice
    a: int
    edge_plus: int
    H: tuple[slice, ...]
    Y_t: tuple[slice, ...]
    b: slice
    C: slice
    section: slice


def row_parts(d: int, k: int, section: int) -> RowParts:
    """The parts for d coordinates, k tangents and that many rows of the section."""
    r = _row_layout(d, k)
    H, Y_t = (tuple(slice(first + j * d, first + (j + 1) * d) for j in range(k)) for first in (r.H, r.Y_t))
    return RowParts(
        g=r.g,
        w_n=slice(r.w_n, r.w_n + d),
        Y_n=slice(r.Y_n, r.Y_n + d),
        a=r.a,
        edge_plus=r.edge_plus,
        H=H,
        Y_t=Y_t,
        b=slice(r.b, r.C),
        C=slice(r.C, r.section),
        section=slice(r.section, r.section + section),
    )
