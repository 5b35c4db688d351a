"""The functions of q that the law needs, in one fixed order: the rows of every table and block.

    g, w_n (d), Y_n (d), a, edge_plus                                  without friction, and in the plane also
    H (d), Y_t (d), b, C, edge_minus, mu_plus, mu_minus                (edge_plus is a without friction);
    in space g, w_n (d), Y_n (d), a, edge_plus, and
    H_1 (d), H_2 (d), Y_1 (d), Y_2 (d), b_1, b_2, C_11, C_12, C_22     and for a polygon of n vertices
    p_1 ... p_n, s_1_1, s_2_1 ... s_1_n, s_2_n                         (p_i = a + b.s_i; edge_plus is a).

In space a disc and an ellipse are handed over as the unit disc: with their section E times that disc (E is
painleve.mechanics.friction's `map`) H stands for H E, Y for Y E, b for E^T b and C for E^T C E. edge_plus is then
a - |b|, an expression of its own: its expansion has no cancellation where it vanishes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from painleve.mechanics.derive import Derivation
from painleve.mechanics.friction import Polygon, Segment

__all__ = ["Rows", "rows_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Rows:
    """Names and expressions of a scene's rows; `varying` are those that depend on a shape coordinate."""

    names: tuple[str, ...]
    expressions: tuple[sp.Expr, ...]
    varying: tuple[int, ...]

    def index(self, name: str) -> int:
        return self.names.index(name)

    def edge(self, edge: int) -> int:
        """The row of a + b.s on that edge of the cone (painleve.mechanics.derive.Derivation.edge_direction)."""
        if f"p_{edge}" in self.names:
            return self.index(f"p_{edge}")
        return self.index("edge_minus" if edge == -1 else "edge_plus")


def rows_of(derivation: Derivation) -> Rows:
    """The rows of a scene in their fixed order."""
    d, scene = derivation, derivation.scene
    axes = [c.name for c in scene.coordinates]
    table: list[tuple[str, sp.Expr]] = [("g", scene.constraint)]
    table += [(f"w_{x}", e) for x, e in zip(axes, d.normal, strict=True)]
    table += [(f"Yn_{x}", e) for x, e in zip(axes, d.normal_response, strict=True)]
    table += [("a", d.a), ("edge_plus", d.a if isinstance(scene.friction, Polygon) else d.edge_plus)]
    if isinstance(scene.friction, Segment):
        table += [(f"H_{x}", e) for x, e in zip(axes, scene.tangents, strict=True)]
        table += [(f"Yt_{x}", e) for x, e in zip(axes, d.tangent_response, strict=True)]
        table += [("b", d.b), ("C", d.C), ("edge_minus", d.edge_minus)]
        table += [("mu_plus", scene.friction.plus), ("mu_minus", scene.friction.minus)]
    elif scene.friction is not None:
        table += _space(d, axes)
    shape = {scene.q[i] for i in d.shape}
    varying = tuple(i for i, (_, e) in enumerate(table) if e.free_symbols & shape)
    return Rows(names=tuple(n for n, _ in table), expressions=tuple(e for _, e in table), varying=varying)


def _space(d: Derivation, axes: Sequence[str]) -> Iterator[tuple[str, sp.Expr]]:
    friction = d.scene.friction
    E = sp.eye(2) if isinstance(friction, Polygon) else friction.map  # type: ignore[union-attr]
    for letter, columns in (("H", d.scene.tangents * E), ("Y", d.tangent_response * E)):
        for k in range(2):
            yield from ((f"{letter}{k + 1}_{x}", e) for x, e in zip(axes, columns[:, k], strict=True))
    b, C = E.T * d.couplings, E.T * d.compliance * E
    yield from (("b_1", b[0]), ("b_2", b[1]), ("C_11", C[0, 0]), ("C_12", C[0, 1]), ("C_22", C[1, 1]))
    if isinstance(friction, Polygon):
        yield from ((f"p_{i + 1}", d.edge_compliance(i + 1)) for i in range(len(friction.vertices)))
        for i, vertex in enumerate(friction.vertices):
            yield from ((f"s_{k + 1}_{i + 1}", s) for k, s in enumerate(vertex))
