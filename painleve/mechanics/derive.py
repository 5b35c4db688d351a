"""Derive the contact quantities of a scene in closed form (the project's notes, sections 1 and 2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import sympy as sp

from painleve.mechanics.scene import Scene

__all__ = ["Derivation", "derive"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Derivation:
    """What follows from a scene, all symbolic and not simplified: simplifying takes seconds, and only a reader of the
    derivation needs it.

    With w_n = -grad g and W = [w_n, H]: the Delassus matrix W^T M^-1 W has the entries a, b, C (b, C are None without
    friction); `responses` is Y = M^-1 W. `edge_plus` = a + mu_plus b and `edge_minus` = a - mu_minus b are the normal
    compliances along the two edges of the friction cone, so gamma = min(edge_plus, edge_minus)/|grad g|^2.
    `shape` are the coordinates on which M, grad g, H or the section depend, `carried` the others on which g depends
    (linearly, with constant coefficients), `idle` the rest, which nothing here depends on.
    """

    scene: Scene
    normal: sp.ImmutableMatrix
    normal_response: sp.ImmutableMatrix
    tangent_response: sp.ImmutableMatrix | None
    a: sp.Expr
    b: sp.Expr | None
    C: sp.Expr | None
    edge_plus: sp.Expr
    edge_minus: sp.Expr
    gradient_squared: sp.Expr
    gamma: sp.Expr
    critical_friction: sp.Expr | None
    shape: tuple[int, ...]
    carried: tuple[int, ...]
    idle: tuple[int, ...]


@lru_cache(maxsize=64)
def derive(scene: Scene) -> Derivation:
    """The contact quantities of a scene; W^T M^-1 W, gamma and mu_c as in the project's notes, section 1."""
    w_n = sp.ImmutableMatrix([-sp.diff(scene.constraint, x) for x in scene.q])
    adjugate, determinant = scene.inertia.adjugate(), scene.inertia.det(method="berkowitz")
    Y_n = adjugate * w_n / determinant
    a = (w_n.T * Y_n)[0, 0]
    squared = (w_n.T * w_n)[0, 0]
    if scene.friction is None:
        Y_t = b = C = critical = None
        plus = minus = a
        gamma = a / squared
    else:
        H = scene.tangents
        Y_t = adjugate * H / determinant
        b, C = (w_n.T * Y_t)[0, 0], (H.T * Y_t)[0, 0]
        plus, minus = a + scene.friction.plus * b, a - scene.friction.minus * b
        symmetric = scene.friction.plus == scene.friction.minus
        gamma = (a - scene.friction.plus * sp.Abs(b) if symmetric else sp.Min(plus, minus)) / squared
        critical = (a / sp.Abs(b) if b != 0 else sp.oo) if symmetric else None
    shape, carried, idle = _coordinate_roles(scene, w_n)
    return Derivation(
        scene=scene, normal=w_n, normal_response=sp.ImmutableMatrix(Y_n),
        tangent_response=None if Y_t is None else sp.ImmutableMatrix(Y_t), a=a, b=b, C=C, edge_plus=plus,
        edge_minus=minus, gradient_squared=squared, gamma=gamma, critical_friction=critical,
        shape=shape, carried=carried, idle=idle,
    )  # fmt: skip


def _coordinate_roles(scene: Scene, w_n: sp.MatrixBase) -> tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]]:
    """Indices of the coordinates on which the law depends, of those that only carry the contact, and of the rest."""
    law = [*scene.inertia, *w_n, *scene.tangents]
    if scene.friction is not None:
        law += [scene.friction.minus, scene.friction.plus]
    used = set().union(*(e.free_symbols for e in law))
    shape = tuple(i for i, x in enumerate(scene.q) if x in used)
    carried = tuple(i for i, x in enumerate(scene.q) if x not in used and w_n[i] != 0)
    idle = tuple(i for i in range(scene.dimension) if i not in shape and i not in carried)
    return shape, carried, idle
