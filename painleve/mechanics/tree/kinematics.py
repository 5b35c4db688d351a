"""Where joints and bodies are: relative vectors in the world's axes, as names on a tape.

Every vector runs from one joint to the next and so depends on what lies between them alone: a base that slides along
the floor does not enter M, and coordinates that the law does not depend on drop out by themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from painleve.mechanics.tree.model import UPRIGHT, ZERO, Body, Joint, Mechanism, Vector
from painleve.mechanics.tree.vectors import Algebra, Matrix3

__all__ = ["Frame", "Hinge", "Orientation", "Pose", "place"]


@dataclass(frozen=True, eq=False)
class Orientation:
    """The rotation `start` followed by a turn about `axis`, an axis of numbers in the frame of `start`, by `angle`.

    Turns about one axis one after the other add their angles: a planar chain needs one sine and cosine a link.
    """

    start: Matrix3
    axis: Vector | None
    angle: sp.Expr


@dataclass(frozen=True, eq=False)
class Hinge:
    """A joint in place: its parent's index (-1: the world), the vector from that one's anchor to its own, its axis."""

    joint: Joint
    parent: int
    arm: Vector
    axis: Vector

    @property
    def revolute(self) -> bool:
        return self.joint.kind == "revolute"


@dataclass(frozen=True, eq=False)
class Frame:
    """A body's frame: the joint that carries it, the vector from that joint's anchor to its origin, its axes."""

    hinge: int
    origin: Vector
    axes: Matrix3


@dataclass(frozen=True, eq=False)
class Pose:
    """All joints and bodies of a mechanism, joints in the order of their coordinates."""

    hinges: tuple[Hinge, ...]
    frames: dict[str, Frame]

    def chain(self, hinge: int) -> list[int]:
        """From that joint down to the base."""
        found = []
        while hinge >= 0:
            found.append(hinge)
            hinge = self.hinges[hinge].parent
        return found


def place(mechanism: Mechanism, algebra: Algebra) -> Pose:
    """The pose as a function of the joints' coordinates."""
    hinges: list[Hinge] = []
    frames: dict[str, Frame] = {}
    turned: dict[str, Orientation] = {"": Orientation(_constant(UPRIGHT), None, sp.Integer(0))}
    for body in mechanism.bodies:
        frames[body.name], turned[body.name] = _place_body(body, frames, turned[body.parent], hinges, algebra)
    return Pose(tuple(hinges), frames)


def _place_body(
    body: Body, frames: dict[str, Frame], orientation: Orientation, hinges: list[Hinge], algebra: Algebra
) -> tuple[Frame, Orientation]:
    hinge, origin, axes = -1, ZERO, _axes(orientation, algebra)
    if body.parent:
        parent = frames[body.parent]
        hinge, origin, axes = parent.hinge, parent.origin, parent.axes
    origin = algebra.add(origin, algebra.apply(axes, body.position))
    if body.rotation != UPRIGHT:
        orientation = Orientation(algebra.product(axes, _constant(body.rotation)), None, sp.Integer(0))
        axes = orientation.start
    for joint in body.joints:
        anchor = algebra.add(origin, algebra.apply(axes, joint.anchor))
        unit = _unit(joint.axis)
        direction = algebra.apply(axes, unit)
        travel = joint.symbol - joint.reference
        if joint.kind == "prismatic":
            anchor = algebra.add(anchor, algebra.scale(algebra.tape.name(travel), direction))
        else:
            orientation = _turn(orientation, unit, travel, axes)
            axes = _axes(orientation, algebra)
        hinges.append(Hinge(joint, hinge, anchor, direction))
        hinge = len(hinges) - 1
        origin = algebra.scale(sp.Integer(-1), algebra.apply(axes, joint.anchor))
    return Frame(hinge, origin, axes), orientation


def _turn(orientation: Orientation, axis: Vector, angle: sp.Expr, axes: Matrix3) -> Orientation:
    if orientation.axis is None:
        return Orientation(orientation.start, axis, angle)
    for sign in (1, -1):
        if all(x == sign * y for x, y in zip(axis, orientation.axis, strict=True)):
            return Orientation(orientation.start, orientation.axis, orientation.angle + sign * angle)
    return Orientation(axes, axis, angle)


def _axes(orientation: Orientation, algebra: Algebra) -> Matrix3:
    if orientation.axis is None:
        return orientation.start
    turn = algebra.rotation(orientation.axis, orientation.angle)
    return algebra.product(orientation.start, turn)


def _unit(axis: Vector) -> Vector:
    length = sp.sqrt(sp.Add(*(x**2 for x in axis)))
    x, y, z = (e / length for e in axis)
    return x, y, z


def _constant(matrix: sp.ImmutableMatrix) -> Matrix3:
    x, y, z = (tuple(matrix.row(i)) for i in range(3))
    return x, y, z
