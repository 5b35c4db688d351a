"""What a friction section knows as mechanics, and what several of them need.

All sections lie in R^k, k = 1 in the plane and 2 in space, hold 0 and may depend on q. Where the impulse is
lambda (1, s), the normal compliance along it is a + b.s; its least value over B decides the sign of gamma.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Protocol

import sympy as sp

from painleve.mechanics.formula import Formula

if TYPE_CHECKING:
    from painleve.mechanics.scene_file.fields import Field

__all__ = ["Condition", "Read", "Section", "coefficients", "made_symbolic", "norm"]

LONG = 400  # operations beyond which an expression is not simplified: it would take minutes

Read = Callable[["Field"], sp.Expr]  # the formula of a coefficient, which may depend on q
Simplify = Callable[[sp.Expr], sp.Expr]


@dataclass(frozen=True, kw_only=True)
class Condition:
    """An expression that must be zero or positive for a section to be one, and what it is."""

    expression: sp.Expr
    sentence: str


class Section(Protocol):
    """A friction section. Its cone has edges, which are numbered: those on which the compliance may be least."""

    kind: ClassVar[str]
    """What files and messages call it."""
    dimension: ClassVar[int]
    """k."""
    fields: ClassVar[tuple[str, ...]]
    """What a scene file may give."""

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """All that the section consists of."""

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """What must hold for it to be a section."""

    @property
    def flaw(self) -> str:
        """Why it is none, whatever the numbers are; "" if it is one."""

    @property
    def edges(self) -> Sequence[int]:
        """The numbers of its cone's edges."""

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        """Zero or positive, all of them, where s (k x 1) is in the section."""

    def direction(self, edge: int, b: sp.MatrixBase) -> sp.ImmutableMatrix:
        """s (k x 1) on that edge, at the coupling b (k x 1)."""

    def compliance(self, edge: int, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        """a + b.s on that edge."""

    def least_compliance(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr:
        """The least a + b.s over the section."""

    def shown_compliance(self, a: sp.Expr, b: sp.MatrixBase, short: Simplify) -> sp.Expr:
        """The same as a person would write it, simplified by `short`."""

    def critical_friction(self, a: sp.Expr, b: sp.MatrixBase) -> sp.Expr | None:
        """The coefficient of friction at which the least compliance vanishes, where there is one coefficient."""

    def formulas(self, H: sp.MatrixBase, size: sp.Expr) -> Iterator[Formula]:
        """What D_1 is, for a reader; H simplified, size = |grad g|."""

    @classmethod
    def read(cls, field: Field, given: Collection[str], read: Read) -> Section:
        """The section that the table `friction` of a scene file describes, in which these names are given."""


def coefficients(field: Field, read: Read, *names: str) -> list[sp.Expr]:
    """Those of a table that gives exactly these."""
    fields = field.table(("kind", *names))
    return [read(fields[name]) for name in names]


def made_symbolic(section: object, *names: str) -> None:
    """Plain numbers are welcome; text is not, for sympify would run it."""
    for name in names:
        object.__setattr__(section, name, sp.sympify(getattr(section, name), strict=True))


def norm(b: sp.MatrixBase) -> sp.Expr:
    """|b|, without the coordinates that cancel in it where simplifying is cheap (an azimuth, say)."""
    squared = sum((x**2 for x in b), sp.Integer(0))
    if squared.count_ops() <= LONG:
        factors = sp.Mul.make_args(sp.factor(squared))
        squared = sp.Mul(*(sp.trigsimp(f) if f.is_Add else f for f in factors))
    return sp.sqrt(squared)
