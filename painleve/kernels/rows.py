"""The functions of q that the law needs, in one fixed order: the rows of every table and block.

    g, w_n (d), Y_n (d), a, edge_plus                                  without friction, and in the plane also
    H (d), Y_t (d), b, C, edge_minus, mu_plus, mu_minus                (edge_plus is a without friction)
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from painleve.mechanics.derive import Derivation
from painleve.mechanics.friction import Segment

__all__ = ["Rows", "rows_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Rows:
    """Names and expressions of a scene's rows; `varying` are those that depend on a shape coordinate."""

    names: tuple[str, ...]
    expressions: tuple[sp.Expr, ...]
    varying: tuple[int, ...]

    def index(self, name: str) -> int:
        return self.names.index(name)


def rows_of(derivation: Derivation) -> Rows:
    """The rows of a scene in their fixed order."""
    d, scene = derivation, derivation.scene
    axes = [c.name for c in scene.coordinates]
    table: list[tuple[str, sp.Expr]] = [("g", scene.constraint)]
    table += [(f"w_{x}", e) for x, e in zip(axes, d.normal, strict=True)]
    table += [(f"Yn_{x}", e) for x, e in zip(axes, d.normal_response, strict=True)]
    table += [("a", d.a), ("edge_plus", d.edge_plus)]
    if isinstance(scene.friction, Segment):
        table += [(f"H_{x}", e) for x, e in zip(axes, scene.tangents, strict=True)]
        table += [(f"Yt_{x}", e) for x, e in zip(axes, d.tangent_response, strict=True)]
        table += [("b", d.b), ("C", d.C), ("edge_minus", d.edge_minus)]
        table += [("mu_plus", scene.friction.plus), ("mu_minus", scene.friction.minus)]
    shape = {scene.q[i] for i in d.shape}
    varying = tuple(i for i, (_, e) in enumerate(table) if e.free_symbols & shape)
    return Rows(names=tuple(n for n, _ in table), expressions=tuple(e for _, e in table), varying=varying)
