"""A mechanism as data: bodies, the joints by which each hangs on its parent, and points of contact.

Lengths in metres, masses in kilograms, angles in radians; a body's frame is placed in its parent's frame by `position`
and `rotation` where all its joints stand at their reference. Several joints of one body act one after the other, each
in the frame that those before it have moved.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import sympy as sp

__all__ = ["Body", "Joint", "JointKind", "Mechanism", "Plane", "TouchingPoint", "Tree", "Vector"]

Vector = tuple[sp.Expr, sp.Expr, sp.Expr]
JointKind = Literal["revolute", "prismatic"]

ZERO: Vector = (sp.Integer(0), sp.Integer(0), sp.Integer(0))
ALONG_X: Vector = (sp.Integer(1), sp.Integer(0), sp.Integer(0))
ALONG_Y: Vector = (sp.Integer(0), sp.Integer(1), sp.Integer(0))
ALONG_Z: Vector = (sp.Integer(0), sp.Integer(0), sp.Integer(1))
UPRIGHT = sp.ImmutableMatrix.eye(3)


@dataclass(frozen=True, kw_only=True, eq=False)
class Joint:
    """One coordinate: a rotation about an axis through an anchor, or a shift along an axis.

    `anchor` and `axis` are in the body's frame; the axis need not be of unit length. `reference` is the value of the
    coordinate at which the joint does nothing. `force` is what acts along the coordinate (N m or N) besides damping,
    -damping * velocity, and the spring, -stiffness * (q - rest): an expression of t, coordinates and velocities.
    `armature` is added to the diagonal of M. `limits` are for scans and pictures: no contact of the joint is modelled.
    A joint that is `locked` at a value is no coordinate.
    """

    name: str
    kind: JointKind
    axis: Vector
    anchor: Vector = ZERO
    reference: sp.Expr = sp.S.Zero
    damping: sp.Expr = sp.S.Zero
    armature: sp.Expr = sp.S.Zero
    stiffness: sp.Expr = sp.S.Zero
    rest: sp.Expr = sp.S.Zero
    force: sp.Expr = sp.S.Zero
    limits: tuple[sp.Expr, sp.Expr] | None = None
    locked: sp.Expr | None = None
    sentence: str = ""

    @property
    def symbol(self) -> sp.Symbol:
        return sp.Symbol(self.name, real=True)

    @property
    def velocity(self) -> sp.Symbol:
        return sp.Symbol(f"u_{self.name}", real=True)


@dataclass(frozen=True, kw_only=True, eq=False)
class Body:
    """A rigid body: mass, centre of mass and inertia about it (3 x 3), in its own frame; parent "" is the world."""

    name: str
    parent: str = ""
    position: Vector = ZERO
    rotation: sp.ImmutableMatrix = UPRIGHT
    joints: tuple[Joint, ...] = ()
    mass: sp.Expr = sp.S.Zero
    centre: Vector = ZERO
    inertia: sp.ImmutableMatrix = field(default_factory=lambda: sp.ImmutableMatrix.zeros(3))


@dataclass(frozen=True, kw_only=True, eq=False)
class TouchingPoint:
    """Where a body touches: a point of it, or a sphere about that point, which rolls."""

    body: str
    point: Vector
    radius: sp.Expr = sp.S.Zero


@dataclass(frozen=True, kw_only=True, eq=False)
class Plane:
    """A fixed plane: a point of it, its unit normal, and one or two unit tangents (one in a planar mechanism)."""

    point: Vector
    normal: Vector
    tangents: tuple[Vector, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Mechanism:
    """Bodies, parents before children, and gravity (m/s^2) in the world's frame."""

    bodies: tuple[Body, ...]
    gravity: Vector = ZERO

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Those that are coordinates, in their order."""
        return tuple(joint for body in self.bodies for joint in body.joints if joint.locked is None)

    @property
    def by_name(self) -> Mapping[str, Body]:
        return {body.name: body for body in self.bodies}


@dataclass(frozen=True, kw_only=True, eq=False)
class Tree:
    """A mechanism and where it touches; `others` are further points of it that the plane stops too."""

    mechanism: Mechanism
    point: TouchingPoint
    plane: Plane
    others: tuple[TouchingPoint, ...] = ()
