"""One formula of a derivation, for whoever reads it."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

__all__ = ["Formula"]


@dataclass(frozen=True, kw_only=True)
class Formula:
    """How its left side is written plainly and in LaTeX, what it is, and the expression."""

    name: str
    plain: str
    latex: str
    sentence: str
    expression: sp.Expr | sp.MatrixBase
