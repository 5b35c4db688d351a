"""A scene's rows as expressions, in the order of painleve.core.rows, and the name of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from painleve.core.rows import RowLayout, RowParts, row_parts
from painleve.kernels.sections.listed import kernels_of
from painleve.mechanics.derive import Derivation

__all__ = ["Rows", "rows_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Rows:
    """Names and expressions of a scene's rows, and which are which part.

    edges: where a + b.s is on each edge of the cone (painleve.mechanics.sections.section); varying: the rows that
    depend on a shape coordinate.
    """

    names: tuple[str, ...]
    expressions: tuple[sp.Expr, ...]
    parts: RowParts
    edges: Mapping[int, int]
    varying: tuple[int, ...]

    def index(self, name: str) -> int:
        return self.names.index(name)


def rows_of(derivation: Derivation) -> Rows:
    """The rows of a scene in their fixed order."""
    scene = derivation.scene
    section = kernels_of(scene.contact)
    parts = section.parts(derivation, [c.name for c in scene.coordinates])
    table = [entry for part in RowLayout._fields for entry in parts.get(part, [])]
    shape = {scene.q[i] for i in derivation.shape}
    at = row_parts(scene.dimension, scene.contact.tangents.cols, len(parts.get("section", [])))
    return Rows(
        names=tuple(name for name, _ in table),
        expressions=tuple(expression for _, expression in table),
        parts=at,
        edges=section.edge_rows(at),
        varying=tuple(i for i, (_, expression) in enumerate(table) if expression.free_symbols & shape),
    )
