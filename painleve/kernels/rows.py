"""A scene's rows as expressions, in the order of painleve.core.rows, and the name of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import sympy as sp

from painleve.core.rows import RowLayout, RowParts, row_parts
from painleve.mechanics.derive import Derivation
from painleve.mechanics.friction import Polygon, Segment

__all__ = ["Rows", "rows_of"]

Entries: TypeAlias = list[tuple[str, sp.Expr]]


@dataclass(frozen=True, kw_only=True, eq=False)
class Rows:
    """Names and expressions of a scene's rows, and which are which part; `varying` are those that depend on a shape
    coordinate."""

    names: tuple[str, ...]
    expressions: tuple[sp.Expr, ...]
    parts: RowParts
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
    friction, k = scene.contact.section, scene.contact.section.dimension
    parts = _common(d, axes)
    if isinstance(friction, Segment):
        parts |= _segment(d, axes, friction)
    elif friction.dimension:
        parts |= _space(d, axes)
    table = [entry for part in RowLayout._fields for entry in parts.get(part, [])]
    shape = {scene.q[i] for i in d.shape}
    return Rows(
        names=tuple(name for name, _ in table),
        expressions=tuple(expression for _, expression in table),
        parts=row_parts(scene.dimension, k, len(parts.get("section", []))),
        varying=tuple(i for i, (_, expression) in enumerate(table) if expression.free_symbols & shape),
    )


def _common(d: Derivation, axes: Sequence[str]) -> dict[str, Entries]:
    polygon = isinstance(d.scene.contact.section, Polygon)
    edge_plus = d.a if polygon or not d.edge_compliance else d.edge_compliance[1]
    return {
        "g": [("g", d.scene.contact.constraint)],
        "w_n": _by_axis("w", axes, d.normal),
        "Y_n": _by_axis("Yn", axes, d.normal_response),
        "a": [("a", d.a)],
        "edge_plus": [("edge_plus", edge_plus)],
    }


def _segment(d: Derivation, axes: Sequence[str], friction: Segment) -> dict[str, Entries]:
    return {
        "H": _by_axis("H", axes, d.scene.contact.tangents),
        "Y_t": _by_axis("Yt", axes, d.tangent_response),
        "b": [("b", d.couplings[0])],
        "C": [("C", d.compliance[0])],
        "section": [("edge_minus", d.edge_compliance[-1]), ("mu_plus", friction.plus), ("mu_minus", friction.minus)],
    }


def _space(d: Derivation, axes: Sequence[str]) -> dict[str, Entries]:
    friction = d.scene.contact.section
    E = sp.eye(2) if isinstance(friction, Polygon) else friction.map  # type: ignore[attr-defined]
    H, Y = d.scene.contact.tangents * E, d.tangent_response * E
    b, C = E.T * d.couplings, E.T * d.compliance * E
    return {
        "H": [*_by_axis("H1", axes, H[:, 0]), *_by_axis("H2", axes, H[:, 1])],
        "Y_t": [*_by_axis("Y1", axes, Y[:, 0]), *_by_axis("Y2", axes, Y[:, 1])],
        "b": [("b_1", b[0]), ("b_2", b[1])],
        "C": [("C_11", C[0, 0]), ("C_12", C[0, 1]), ("C_22", C[1, 1])],
        "section": list(_polygon(d, friction)) if isinstance(friction, Polygon) else [],
    }


def _polygon(d: Derivation, friction: Polygon) -> Iterator[tuple[str, sp.Expr]]:
    yield from ((f"p_{i + 1}", d.edge_compliance[i + 1]) for i in range(len(friction.vertices)))
    for i, vertex in enumerate(friction.vertices):
        yield from ((f"s_{k + 1}_{i + 1}", s) for k, s in enumerate(vertex))


def _by_axis(letter: str, axes: Sequence[str], column: sp.MatrixBase) -> Entries:
    return [(f"{letter}_{x}", e) for x, e in zip(axes, column, strict=True)]
