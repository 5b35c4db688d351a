"""Friction in space that is a disc or an ellipse: s = E sigma, |sigma| <= 1. Its cone has one edge, 1: the direction
that opposes b most."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from painleve.mechanics.formula import Formula
from painleve.mechanics.sections.section import Condition, Read, Simplify, coefficients, made_symbolic, norm

if TYPE_CHECKING:
    from painleve.mechanics.scene_file.fields import Field

__all__ = ["Conic", "Disc", "Ellipse"]


class Conic:
    """What a disc and an ellipse share."""

    dimension: ClassVar[int] = 2
    flaw: ClassVar[str] = ""
    edges: ClassVar[Sequence[int]] = (1,)

    @property
    def map(self) -> sp.ImmutableMatrix:
        """E of s = E sigma, |sigma| <= 1."""
        raise NotImplementedError

    def reach(self, b: sp.MatrixBase) -> sp.Expr:
        """The largest -b.s over the section."""
        return norm(self.map.T * b)

    def direction(self, edge: int, b: sp.MatrixBase) -> sp.ImmutableMatrix:
        """There b must not vanish."""
        opposed = self.map.T * b
        return sp.ImmutableMatrix(-self.map * opposed / norm(opposed))

    def compliance(self, edge: int, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        return self.least_compliance(a, b)

    def least_compliance(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        return a - self.reach(b)

    def shown_compliance(self, a: sp.Expr, b: sp.MatrixBase, short: Simplify) -> sp.Expr:
        return short(a) - short(self.reach(b))

    def critical_friction(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr | None:
        return None

    def formulas(self, H: sp.MatrixBase, size: sp.Expr) -> Iterator[Formula]:
        yield Formula(
            name="E",
            plain="E(q)",
            latex="E(q)",
            expression=self.map,
            sentence="the friction section is {H E σ/|∇g| : |σ| ≤ 1}",
        )


@dataclass(frozen=True, kw_only=True)
class Disc(Conic):
    """Isotropic friction in space: |s| <= mu."""

    kind: ClassVar[str] = "disc"
    fields: ClassVar[tuple[str, ...]] = ("mu",)
    mu: sp.Expr

    def __post_init__(self) -> None:
        made_symbolic(self, "mu")

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        return (self.mu,)

    @property
    def conditions(self) -> tuple[Condition, ...]:
        return (Condition(expression=self.mu, sentence="the coefficient of friction"),)

    @property
    def map(self) -> sp.ImmutableMatrix:
        return sp.ImmutableMatrix([[self.mu, 0], [0, self.mu]])

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        return (self.mu**2 - s[0] ** 2 - s[1] ** 2,)

    def reach(self, b: sp.MatrixBase) -> sp.Expr:
        return self.mu * norm(b)

    def critical_friction(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        size = norm(b)
        return a / size if size != 0 else sp.oo

    @classmethod
    def read(cls, field: Field, given: Collection[str], read: Read) -> Disc:
        (mu,) = coefficients(field, read, "mu")
        return cls(mu=mu)


@dataclass(frozen=True, kw_only=True)
class Ellipse(Conic):
    """Orthotropic friction in space: semi-axes mu_1 at `angle` (rad) from the first tangent and mu_2 across it."""

    kind: ClassVar[str] = "ellipse"
    fields: ClassVar[tuple[str, ...]] = ("mu_1", "mu_2", "angle")
    mu_1: sp.Expr
    mu_2: sp.Expr
    angle: sp.Expr

    def __post_init__(self) -> None:
        made_symbolic(self, "mu_1", "mu_2", "angle")

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        return self.mu_1, self.mu_2, self.angle

    @property
    def conditions(self) -> tuple[Condition, ...]:
        return tuple(Condition(expression=mu, sentence="the coefficient of friction") for mu in (self.mu_1, self.mu_2))

    @property
    def map(self) -> sp.ImmutableMatrix:
        c, s = sp.cos(self.angle), sp.sin(self.angle)
        return sp.ImmutableMatrix([[c * self.mu_1, -s * self.mu_2], [s * self.mu_1, c * self.mu_2]])

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        c, d = sp.cos(self.angle), sp.sin(self.angle)
        along, across = c * s[0] + d * s[1], c * s[1] - d * s[0]
        inside = (self.mu_1 * self.mu_2) ** 2 - (self.mu_2 * along) ** 2 - (self.mu_1 * across) ** 2
        # the last two decide where a semi-axis vanishes
        return inside, self.mu_1**2 - along**2, self.mu_2**2 - across**2

    @classmethod
    def read(cls, field: Field, given: Collection[str], read: Read) -> Ellipse:
        mu_1, mu_2, angle = coefficients(field, read, "mu_1", "mu_2", "angle")
        return cls(mu_1=mu_1, mu_2=mu_2, angle=angle)
