"""Friction in space that is a convex polygon. Its cone has an edge for each vertex: 1, 2, ..."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from painleve.mechanics.formula import Formula
from painleve.mechanics.sections.section import Condition, Read, Simplify

if TYPE_CHECKING:
    from painleve.mechanics.scene_file.fields import Field

__all__ = ["Polygon"]

MOST_VERTICES = 16  # that a scene file may give
FEW = 8  # vertices whose reaches sympy is let compare, all with all, before they are numbers


@dataclass(frozen=True, kw_only=True)
class Polygon:
    """A convex polygon in space, its vertices (s_1, s_2) counterclockwise."""

    kind: ClassVar[str] = "polygon"
    dimension: ClassVar[int] = 2
    fields: ClassVar[tuple[str, ...]] = ("vertices",)
    vertices: tuple[tuple[sp.Expr, sp.Expr], ...]

    def __post_init__(self) -> None:
        vertices = tuple((sp.sympify(x, strict=True), sp.sympify(y, strict=True)) for x, y in self.vertices)
        object.__setattr__(self, "vertices", vertices)

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        return tuple(x for vertex in self.vertices for x in vertex)

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """0 and every vertex are on the left of every edge (left turns alone would admit a star)."""
        v, n = self.vertices, len(self.vertices)
        points = [(sp.Integer(0), sp.Integer(0)), *v]
        return tuple(
            Condition(
                expression=_cross(_minus(v[(i + 1) % n], v[i]), _minus(points[j], v[i])),
                sentence=(
                    f"the side of edge {i + 1} of the friction polygon on which {f'vertex {j}' if j else '0'} lies"
                ),
            )
            for i in range(n)
            for j in range(n + 1)
            if j not in (i + 1, (i + 1) % n + 1)
        )

    @property
    def flaw(self) -> str:
        return "" if len(self.vertices) >= 3 else "a friction polygon needs three vertices at least"

    @property
    def edges(self) -> Sequence[int]:
        return range(1, 1 + len(self.vertices))

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        v, n = self.vertices, len(self.vertices)
        return tuple(_cross(_minus(v[(i + 1) % n], v[i]), _minus(s, v[i])) for i in range(n))

    def reach(self, b: sp.MatrixBase) -> sp.Expr:
        """The largest -b.s over the section."""
        reaches = [-(b[0] * x + b[1] * y) for x, y in self.vertices]
        return sp.Max(*reaches, evaluate=len(reaches) <= FEW)

    def direction(self, edge: int, b: sp.MatrixBase) -> sp.ImmutableMatrix:
        return sp.ImmutableMatrix(self.vertices[edge - 1])

    def compliance(self, edge: int, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        return a + (b.T * self.direction(edge, b))[0, 0]

    def least_compliance(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        return a - self.reach(b)

    def shown_compliance(self, a: sp.Expr, b: sp.MatrixBase, short: Simplify) -> sp.Expr:
        return short(a) - short(self.reach(b))

    def critical_friction(self, a: sp.Expr, b: sp.MatrixBase) -> None:
        return None

    def formulas(self, H: sp.MatrixBase, size: sp.Expr) -> Iterator[Formula]:
        yield Formula(
            name="vertices",
            plain="vertices",
            latex=r"\mathrm{vertices}",
            expression=sp.Matrix(self.vertices),
            sentence="the friction section is {H s/|∇g|}, s in the polygon of these vertices",
        )

    @classmethod
    def read(cls, field: Field, given: Collection[str], read: Read) -> Polygon:
        listed = field.table(("kind", "vertices"))["vertices"].array(MOST_VERTICES, what="vertices")
        if len(listed) < 3:
            raise listed[0].refuse("a polygon needs at least three vertices")
        pairs = [vertex.array(2, length=2, what="components") for vertex in listed]
        return cls(vertices=tuple((read(x), read(y)) for x, y in pairs))


def _minus(x: Iterable[sp.Expr], y: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
    return tuple(a - b for a, b in zip(x, y, strict=True))


def _cross(x: tuple[sp.Expr, ...], y: tuple[sp.Expr, ...]) -> sp.Expr:
    return x[0] * y[1] - x[1] * y[0]
