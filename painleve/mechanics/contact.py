"""A contact as data: one unilateral constraint and its friction."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from painleve.mechanics.friction import Section

__all__ = ["Contact"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Contact:
    """`constraint` is g(q), admissible where g <= 0; `tangents` is H(q) (d x k), whose columns are the gradients of the
    contact point's tangential displacements; `section` is the friction section B(q), of dimension k. `normal` is
    w_n = -grad g (d x 1), where it is known without differentiating g."""

    constraint: sp.Expr
    tangents: sp.ImmutableMatrix
    section: Section
    normal: sp.ImmutableMatrix | None = None
