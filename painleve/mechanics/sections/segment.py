"""Planar friction: a segment. Its cone has two edges: 1 for s = +plus, -1 for s = -minus."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from painleve.mechanics.formula import Formula
from painleve.mechanics.sections.section import Condition, Read, Simplify, coefficients, made_symbolic

if TYPE_CHECKING:
    from painleve.mechanics.scene_file.fields import Field

__all__ = ["Segment"]


@dataclass(frozen=True, kw_only=True)
class Segment:
    """Planar section [-minus, plus]; both ends are >= 0."""

    kind: ClassVar[str] = "segment"
    dimension: ClassVar[int] = 1
    fields: ClassVar[tuple[str, ...]] = ("mu", "minus", "plus")
    flaw: ClassVar[str] = ""
    edges: ClassVar[Sequence[int]] = (1, -1)
    minus: sp.Expr
    plus: sp.Expr

    def __post_init__(self) -> None:
        made_symbolic(self, "minus", "plus")

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        return self.minus, self.plus

    @property
    def conditions(self) -> tuple[Condition, ...]:
        return tuple(Condition(expression=end, sentence="the coefficient of friction") for end in self.expressions)

    @property
    def symmetric(self) -> bool:
        """Whether one coefficient serves both senses."""
        return bool(self.plus == self.minus)

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        return self.plus - s[0], s[0] + self.minus

    def direction(self, edge: int, b: sp.MatrixBase) -> sp.ImmutableMatrix:
        return sp.ImmutableMatrix([self.plus if edge == 1 else -self.minus])

    def compliance(self, edge: int, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        return a + self.plus * b[0] if edge == 1 else a - self.minus * b[0]

    def least_compliance(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        if self.symmetric:
            return a - self.plus * sp.Abs(b[0])
        return sp.Min(*(self.compliance(edge, a, b) for edge in self.edges))

    def shown_compliance(self, a: sp.Expr, b: sp.MatrixBase, short: Simplify) -> sp.Expr:
        if self.symmetric:
            return short(a) - short(self.plus) * sp.Abs(sp.factor_terms(short(b[0])))
        return sp.Min(*(short(self.compliance(edge, a, b)) for edge in self.edges))

    def critical_friction(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr | None:
        if not self.symmetric:
            return None
        return a / sp.Abs(b[0]) if b[0] != 0 else sp.oo

    def formulas(self, H: sp.MatrixBase, size: sp.Expr) -> Iterator[Formula]:
        ends = [H * s / size for s in (-self.minus, self.plus)]
        yield Formula(
            name="D_1_minus",
            plain="D₁(q) from",
            latex=r"D_1^-(q)",
            expression=ends[0],
            sentence="the friction section is the segment H s/|∇g|, from its end s = -μ",
        )
        yield Formula(
            name="D_1_plus", plain="D₁(q) to", latex=r"D_1^+(q)", expression=ends[1], sentence="to its end s = +μ"
        )

    @classmethod
    def read(cls, field: Field, given: Collection[str], read: Read) -> Segment:
        """`mu`, or `minus` and `plus`."""
        if "mu" in given:
            (mu,) = coefficients(field, read, "mu")
            return cls(minus=mu, plus=mu)
        if "minus" not in given and "plus" not in given:
            raise field.refuse("mu, or minus and plus, are missing")
        minus, plus = coefficients(field, read, "minus", "plus")
        return cls(minus=minus, plus=plus)
