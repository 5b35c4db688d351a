"""Derive the contact quantities of a scene in closed form (docs/theory.md, sections 1 and 2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import sympy as sp

from painleve.mechanics.friction import Disc, Ellipse, Polygon, Section, Segment, norm
from painleve.mechanics.scene import Scene

__all__ = ["Derivation", "derive"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Derivation:
    """What follows from a scene, all symbolic and not simplified: simplifying takes seconds, and only a reader of the
    derivation needs it.

    With w_n = -grad g and W = [w_n, H]: the Delassus matrix W^T M^-1 W has the entries a, b (`couplings`, k x 1) and C
    (`compliance`, k x k); the responses are M^-1 w_n and M^-1 H (d x k). For k = 1, b and C are also there as scalars,
    and `edge_plus` = a + mu_plus b and `edge_minus` = a - mu_minus b are the normal compliances along the two edges of
    the friction cone; else b, C and edge_minus are None, and edge_plus is the least compliance over the section.
    gamma = (the least of them)/|grad g|^2. `critical_friction` is the coefficient at which gamma vanishes, for a
    symmetric segment or a disc.
    `shape` are the coordinates on which M, grad g, H or the section depend, `carried` the others on which g depends
    (linearly, with constant coefficients), `idle` the rest, which nothing here depends on.
    """

    scene: Scene
    normal: sp.ImmutableMatrix
    normal_response: sp.ImmutableMatrix
    tangent_response: sp.ImmutableMatrix
    a: sp.Expr
    couplings: sp.ImmutableMatrix
    compliance: sp.ImmutableMatrix
    edge_plus: sp.Expr
    edge_minus: sp.Expr | None
    gradient_squared: sp.Expr
    gamma: sp.Expr
    critical_friction: sp.Expr | None
    shape: tuple[int, ...]
    carried: tuple[int, ...]
    idle: tuple[int, ...]

    def __repr__(self) -> str:
        k = self.scene.friction_dimension
        return f"Derivation({self.scene.name!r}, d = {self.scene.dimension}, k = {k})"

    @property
    def b(self) -> sp.Expr | None:
        return self.couplings[0] if self.scene.friction_dimension == 1 else None

    @property
    def C(self) -> sp.Expr | None:
        return self.compliance[0] if self.scene.friction_dimension == 1 else None

    @property
    def delassus(self) -> sp.ImmutableMatrix:
        """W^T M^-1 W, (1 + k) x (1 + k)."""
        normal = sp.Matrix([[self.a]]).row_join(self.couplings.T)
        return sp.ImmutableMatrix(normal.col_join(self.couplings.row_join(self.compliance)))

    def edge_direction(self, edge: int) -> sp.ImmutableMatrix:
        """s (k x 1) on an edge of the cone: +mu_plus (1) or -mu_minus (-1) of a segment, vertex 1, 2, ... of a polygon,
        or the one that opposes b most on a disc or an ellipse (1; there b must not vanish)."""
        friction = self.scene.friction
        if isinstance(friction, Segment):
            return sp.ImmutableMatrix([friction.plus if edge == 1 else -friction.minus])
        if isinstance(friction, Polygon):
            return sp.ImmutableMatrix(friction.vertices[edge - 1])
        if friction is None:
            raise ValueError("no friction, no edge")
        opposed = friction.map.T * self.couplings
        return sp.ImmutableMatrix(-friction.map * opposed / norm(opposed))

    def edge_compliance(self, edge: int) -> sp.Expr:
        """a + b.s on that edge."""
        if isinstance(self.scene.friction, Disc | Ellipse):
            return self.edge_plus
        return self.a + (self.couplings.T * self.edge_direction(edge))[0, 0]


@lru_cache(maxsize=64)
def derive(scene: Scene) -> Derivation:
    """The contact quantities of a scene; W^T M^-1 W, gamma and mu_c as in docs/theory.md, section 1."""
    w_n = sp.ImmutableMatrix([-sp.diff(scene.constraint, x) for x in scene.q])
    adjugate, determinant = scene.inertia.adjugate(), scene.inertia.det(method="berkowitz")
    Y_n, Y_t = adjugate * w_n / determinant, adjugate * scene.tangents / determinant
    a, squared = (w_n.T * Y_n)[0, 0], (w_n.T * w_n)[0, 0]
    b, C = (w_n.T * Y_t).T, scene.tangents.T * Y_t
    plus, minus, least, critical = _edges(scene.friction, a, b)
    shape, carried, idle = _coordinate_roles(scene, w_n)
    return Derivation(
        scene=scene,
        normal=w_n,
        normal_response=sp.ImmutableMatrix(Y_n),
        tangent_response=sp.ImmutableMatrix(Y_t),
        a=a,
        couplings=sp.ImmutableMatrix(b),
        compliance=sp.ImmutableMatrix(C),
        edge_plus=plus,
        edge_minus=minus,
        gradient_squared=squared,
        gamma=least / squared,
        critical_friction=critical,
        shape=shape,
        carried=carried,
        idle=idle,
    )


def _edges(
    friction: Section | None, a: sp.Expr, b: sp.MatrixBase
) -> tuple[sp.Expr, sp.Expr | None, sp.Expr, sp.Expr | None]:
    """(edge_plus, edge_minus, the least compliance, critical friction)."""
    if friction is None:
        return a, None, a, None
    if isinstance(friction, Segment):
        plus, minus = a + friction.plus * b[0], a - friction.minus * b[0]
        if friction.plus != friction.minus:
            return plus, minus, sp.Min(plus, minus), None
        return plus, minus, a - friction.plus * sp.Abs(b[0]), a / sp.Abs(b[0]) if b[0] != 0 else sp.oo
    least = a - friction.reach(b)
    if not isinstance(friction, Disc):
        return least, None, least, None
    size = norm(b)
    return least, None, least, a / size if size != 0 else sp.oo


def _coordinate_roles(scene: Scene, w_n: sp.MatrixBase) -> tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]]:
    """Indices of the coordinates on which the law depends, of those that only carry the contact, and of the rest."""
    law = [*scene.inertia, *w_n, *scene.tangents]
    if scene.friction is not None:
        law += scene.friction.expressions
    used = set().union(*(e.free_symbols for e in law))
    shape = tuple(i for i, x in enumerate(scene.q) if x in used)
    carried = tuple(i for i, x in enumerate(scene.q) if x not in used and w_n[i] != 0)
    idle = tuple(i for i in range(scene.dimension) if i not in shape and i not in carried)
    return shape, carried, idle
