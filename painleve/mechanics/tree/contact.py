"""Height over a plane, its gradient and the tangential Jacobian of a mechanism's touching point, on a tape.

(docs/theory.md, section 1.5.)
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from painleve.mechanics.tree.kinematics import Pose
from painleve.mechanics.tree.model import Plane, TouchingPoint, Vector
from painleve.mechanics.tree.vectors import Algebra

__all__ = ["PlaneContact", "contact_of", "position_of"]


@dataclass(frozen=True, eq=False)
class PlaneContact:
    """The height over the plane, its gradient w_n (d,) and H (d, k): the Jacobians of the body's material point that
    touches, which for a sphere is another one at each configuration."""

    height: sp.Expr
    normal: sp.ImmutableMatrix
    tangents: sp.ImmutableMatrix


def contact_of(point: TouchingPoint, plane: Plane, pose: Pose, algebra: Algebra) -> PlaneContact:
    arms, centre = _arms(point.body, point.point, pose, algebra)
    height = algebra.dot(plane.normal, algebra.add(centre, algebra.scale(sp.Integer(-1), plane.point)))
    sunk = algebra.scale(-point.radius, plane.normal)
    columns: list[list[sp.Expr]] = []
    for k, hinge in enumerate(pose.hinges):
        moved = arms.get(k)
        if moved is None:
            columns.append([sp.Integer(0)] * (1 + len(plane.tangents)))
            continue
        velocity = algebra.cross(hinge.axis, algebra.add(moved, sunk)) if hinge.revolute else hinge.axis
        columns.append([algebra.dot(direction, velocity) for direction in (plane.normal, *plane.tangents)])
    W = sp.ImmutableMatrix(columns)
    return PlaneContact(algebra.tape.name(height - point.radius), W[:, 0], W[:, 1:])


def position_of(body: str, point: Vector, pose: Pose, algebra: Algebra) -> Vector:
    """A body's point in the world."""
    return _arms(body, point, pose, algebra)[1]


def _arms(body: str, point: Vector, pose: Pose, algebra: Algebra) -> tuple[dict[int, Vector], Vector]:
    """The vector from the anchor of each joint below the point to it, and the point itself in the world."""
    frame = pose.frames[body]
    arm = algebra.apply(pose.axes(frame.hinge), algebra.vector(frame.point(point)))
    arms: dict[int, Vector] = {}
    for k in pose.chain(frame.hinge):
        arms[k] = arm
        arm = algebra.add(pose.hinges[k].arm, arm)
    return arms, arm
