"""No friction: the section {0} of a space without dimensions."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from painleve.mechanics.formula import Formula
from painleve.mechanics.sections.section import Condition, Read, Simplify

if TYPE_CHECKING:
    from painleve.mechanics.scene_file.fields import Field

__all__ = ["NoFriction"]


@dataclass(frozen=True, kw_only=True)
class NoFriction:
    """An impulse is normal."""

    kind: ClassVar[str] = "none"
    dimension: ClassVar[int] = 0
    fields: ClassVar[tuple[str, ...]] = ()
    expressions: ClassVar[tuple[sp.Expr, ...]] = ()
    conditions: ClassVar[tuple[Condition, ...]] = ()
    flaw: ClassVar[str] = ""
    edges: ClassVar[Sequence[int]] = ()

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        return ()

    def direction(self, edge: int, b: sp.MatrixBase) -> sp.ImmutableMatrix:
        raise ValueError("no friction, no edge")

    def compliance(self, edge: int, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        raise ValueError("no friction, no edge")

    def least_compliance(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        return a

    def shown_compliance(self, a: sp.Expr, b: sp.MatrixBase, short: Simplify) -> sp.Expr:
        return short(a)

    def critical_friction(self, a: sp.Expr, b: sp.MatrixBase) -> None:
        return None

    def formulas(self, H: sp.MatrixBase, size: sp.Expr) -> Iterator[Formula]:
        return iter(())

    @classmethod
    def read(cls, field: Field, given: Collection[str], read: Read) -> NoFriction:
        field.table(("kind",))
        return cls()
