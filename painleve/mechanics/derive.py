"""Derive the contact quantities of a scene in closed form (docs/theory.md, sections 1 and 2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import sympy as sp

from painleve.errors import InputError
from painleve.mechanics.scene import Scene

__all__ = ["Derivation", "derive"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Derivation:
    """What follows from a scene, all symbolic and not simplified: simplifying takes seconds, and only a reader of the
    derivation needs it.

    With w_n = -grad g and W = [w_n, H]: the Delassus matrix W^T M^-1 W has the entries a, b (`couplings`, k x 1) and C
    (`compliance`, k x k); the responses are M^-1 w_n and M^-1 H (d x k). `edge_compliance` holds the normal
    compliances a + b.s along the edges of the friction cone, by the section's numbers of them; gamma = (the least over
    the section)/|grad g|^2. `critical_friction` is the coefficient at which gamma vanishes, for a symmetric segment or
    a disc.
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
    edge_compliance: Mapping[int, sp.Expr]
    gradient_squared: sp.Expr
    gamma: sp.Expr
    critical_friction: sp.Expr | None
    shape: tuple[int, ...]
    carried: tuple[int, ...]
    idle: tuple[int, ...]

    def __repr__(self) -> str:
        k = self.scene.contact.section.dimension
        return f"Derivation({self.scene.name!r}, d = {self.scene.dimension}, k = {k})"

    @property
    def delassus(self) -> sp.ImmutableMatrix:
        """W^T M^-1 W, (1 + k) x (1 + k)."""
        normal = sp.Matrix([[self.a]]).row_join(self.couplings.T)
        return sp.ImmutableMatrix(normal.col_join(self.couplings.row_join(self.compliance)))

    def edge_direction(self, edge: int) -> sp.ImmutableMatrix:
        """s (k x 1) on an edge of the cone."""
        return self.scene.contact.section.direction(edge, self.couplings)


@lru_cache(maxsize=64)
def derive(scene: Scene) -> Derivation:
    """The contact quantities of a scene; W^T M^-1 W, gamma and mu_c as in docs/theory.md, section 1.

    Raises InputError for a scene that is written in intermediate results: its closed forms would fill pages.
    """
    if scene.definitions.steps:
        raise InputError(
            f"scene {scene.name}: the closed forms of its {scene.dimension} coordinates would fill pages, and this "
            "needs them; `painleve map` and `painleve scan` do without"
        )
    contact, section = scene.contact, scene.contact.section
    w_n = sp.ImmutableMatrix([-sp.diff(contact.constraint, x) for x in scene.q])
    adjugate, determinant = scene.inertia.adjugate(), scene.inertia.det(method="berkowitz")
    Y_n, Y_t = adjugate * w_n / determinant, adjugate * contact.tangents / determinant
    a, squared = (w_n.T * Y_n)[0, 0], (w_n.T * w_n)[0, 0]
    b, C = sp.ImmutableMatrix((w_n.T * Y_t).T), contact.tangents.T * Y_t
    shape, carried, idle = _coordinate_roles(scene, w_n)
    return Derivation(
        scene=scene,
        normal=w_n,
        normal_response=sp.ImmutableMatrix(Y_n),
        tangent_response=sp.ImmutableMatrix(Y_t),
        a=a,
        couplings=b,
        compliance=sp.ImmutableMatrix(C),
        edge_compliance=MappingProxyType({edge: section.compliance(edge, a, b) for edge in section.edges}),
        gradient_squared=squared,
        gamma=section.least_compliance(a, b) / squared,
        critical_friction=section.critical_friction(a, b),
        shape=shape,
        carried=carried,
        idle=idle,
    )


def _coordinate_roles(scene: Scene, w_n: sp.MatrixBase) -> tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]]:
    """Indices of the coordinates on which the law depends, of those that only carry the contact, and of the rest."""
    law = [*scene.inertia, *w_n, *scene.contact.tangents, *scene.contact.section.expressions]
    used = set().union(*(e.free_symbols for e in law))
    shape = tuple(i for i, x in enumerate(scene.q) if x in used)
    carried = tuple(i for i, x in enumerate(scene.q) if x not in used and w_n[i] != 0)
    idle = tuple(i for i in range(scene.dimension) if i not in shape and i not in carried)
    return shape, carried, idle
