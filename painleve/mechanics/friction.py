"""Friction sections B(q): what friction impulses s a unit normal impulse admits (docs/theory.md, section 1).

All lie in R^k, k = 1 in the plane and 2 in space, hold 0 and may depend on q. Where the impulse is lambda (1, s), the
normal compliance along it is a + b.s; its least value over B decides the sign of gamma.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, TypeAlias

import sympy as sp

__all__ = ["Condition", "Disc", "Ellipse", "Polygon", "Section", "Segment"]

LONG = 400  # operations beyond which an expression is not simplified: it would take minutes


@dataclass(frozen=True, kw_only=True)
class Condition:
    """An expression that must be zero or positive for a section to be one, and what it is."""

    expression: sp.Expr
    sentence: str


@dataclass(frozen=True, kw_only=True)
class Segment:
    """Planar section [-minus, plus]; both ends are >= 0."""

    dimension: ClassVar[int] = 1
    minus: sp.Expr
    plus: sp.Expr

    def __post_init__(self) -> None:
        _make_symbolic(self, "minus", "plus")

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        return self.minus, self.plus

    @property
    def conditions(self) -> tuple[Condition, ...]:
        return tuple(Condition(expression=end, sentence="the coefficient of friction") for end in self.expressions)

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        """Zero or positive, all of them, where s (k x 1) is in the section."""
        return self.plus - s[0], s[0] + self.minus


@dataclass(frozen=True, kw_only=True)
class Disc:
    """Isotropic friction in space: |s| <= mu."""

    dimension: ClassVar[int] = 2
    mu: sp.Expr

    def __post_init__(self) -> None:
        _make_symbolic(self, "mu")

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        return (self.mu,)

    @property
    def conditions(self) -> tuple[Condition, ...]:
        return (Condition(expression=self.mu, sentence="the coefficient of friction"),)

    @property
    def map(self) -> sp.ImmutableMatrix:
        """E of s = E sigma, |sigma| <= 1."""
        return sp.ImmutableMatrix([[self.mu, 0], [0, self.mu]])

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        """Zero or positive where s (k x 1) is in the section."""
        return (self.mu**2 - s[0] ** 2 - s[1] ** 2,)

    def reach(self, b: sp.MatrixBase) -> sp.Expr:
        """The largest -b.s over the section."""
        return self.mu * norm(b)


@dataclass(frozen=True, kw_only=True)
class Ellipse:
    """Orthotropic friction in space: semi-axes mu_1 at `angle` (rad) from the first tangent and mu_2 across it."""

    dimension: ClassVar[int] = 2
    mu_1: sp.Expr
    mu_2: sp.Expr
    angle: sp.Expr

    def __post_init__(self) -> None:
        _make_symbolic(self, "mu_1", "mu_2", "angle")

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        return self.mu_1, self.mu_2, self.angle

    @property
    def conditions(self) -> tuple[Condition, ...]:
        return tuple(Condition(expression=mu, sentence="the coefficient of friction") for mu in (self.mu_1, self.mu_2))

    @property
    def map(self) -> sp.ImmutableMatrix:
        """E of s = E sigma, |sigma| <= 1."""
        c, s = sp.cos(self.angle), sp.sin(self.angle)
        return sp.ImmutableMatrix([[c * self.mu_1, -s * self.mu_2], [s * self.mu_1, c * self.mu_2]])

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        """Zero or positive, all of them, where s (k x 1) is in the section."""
        c, d = sp.cos(self.angle), sp.sin(self.angle)
        along, across = c * s[0] + d * s[1], c * s[1] - d * s[0]
        inside = (self.mu_1 * self.mu_2) ** 2 - (self.mu_2 * along) ** 2 - (self.mu_1 * across) ** 2
        # the last two decide where a semi-axis vanishes
        return inside, self.mu_1**2 - along**2, self.mu_2**2 - across**2

    def reach(self, b: sp.MatrixBase) -> sp.Expr:
        """The largest -b.s over the section."""
        return norm(self.map.T * b)


@dataclass(frozen=True, kw_only=True)
class Polygon:
    """A convex polygon in space, its vertices (s_1, s_2) counterclockwise."""

    dimension: ClassVar[int] = 2
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

    def membership(self, s: sp.MatrixBase) -> tuple[sp.Expr, ...]:
        """Zero or positive, all of them, where s (k x 1) is in the section."""
        v, n = self.vertices, len(self.vertices)
        return tuple(_cross(_minus(v[(i + 1) % n], v[i]), _minus(s, v[i])) for i in range(n))

    def reach(self, b: sp.MatrixBase) -> sp.Expr:
        """The largest -b.s over the section."""
        return sp.Max(*(-(b[0] * x + b[1] * y) for x, y in self.vertices))


Section: TypeAlias = Segment | Disc | Ellipse | Polygon


def norm(b: sp.MatrixBase) -> sp.Expr:
    """|b|, without the coordinates that cancel in it where simplifying is cheap (an azimuth, say)."""
    squared = sum((x**2 for x in b), sp.Integer(0))
    if squared.count_ops() <= LONG:
        factors = sp.Mul.make_args(sp.factor(squared))
        squared = sp.Mul(*(sp.trigsimp(f) if f.is_Add else f for f in factors))
    return sp.sqrt(squared)


def _make_symbolic(section: object, *names: str) -> None:
    """Plain numbers are welcome; text is not, for sympify would run it."""
    for name in names:
        object.__setattr__(section, name, sp.sympify(getattr(section, name), strict=True))


def _minus(x: Iterable[sp.Expr], y: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
    return tuple(a - b for a, b in zip(x, y, strict=True))


def _cross(x: tuple[sp.Expr, ...], y: tuple[sp.Expr, ...]) -> sp.Expr:
    return x[0] * y[1] - x[1] * y[0]
