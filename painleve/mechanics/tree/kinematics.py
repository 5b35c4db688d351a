"""Where joints and bodies are: frames that move with the joints, and relative vectors in the world's axes.

Every joint carries a frame that stands parallel to the world's where all joints are at their reference. In it its own
bodies, and the anchors of the joints that it carries, are at rest: numbers. Only what runs from one anchor to the next
is turned into the world's axes, so M does not depend on where a base that slides along the floor has got to, and
coordinates on which the law does not depend drop out by themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from painleve.mechanics.tree.model import UPRIGHT, ZERO, Joint, Mechanism, Vector
from painleve.mechanics.tree.vectors import Algebra, Matrix3, rotation_about, rows_of

__all__ = ["Frame", "Hinge", "Pose", "place"]

WORLD = rows_of(UPRIGHT)


@dataclass(frozen=True, eq=False)
class Hinge:
    """A joint in place: its parent's index (-1: the world), where its anchor is in its parent's frame, and in the
    world's axes that arm, the axis of the joint and the axes of the frame that moves with it."""

    joint: Joint
    parent: int
    place: Vector
    arm: Vector
    axis: Vector
    axes: Matrix3

    @property
    def revolute(self) -> bool:
        return self.joint.kind == "revolute"


@dataclass(frozen=True, eq=False)
class Frame:
    """A body at rest in the frame of the joint that carries it (-1: the world): its origin and its axes there."""

    hinge: int
    origin: Vector
    axes: sp.ImmutableMatrix

    def point(self, local: Vector) -> Vector:
        """A body's point in the joint's frame."""
        return _plus(self.origin, _turned(self.axes, local))


@dataclass(frozen=True, eq=False)
class Pose:
    """All joints and bodies of a mechanism, joints in the order of their coordinates."""

    hinges: tuple[Hinge, ...]
    frames: dict[str, Frame]

    def axes(self, hinge: int) -> Matrix3:
        return self.hinges[hinge].axes if hinge >= 0 else WORLD

    def chain(self, hinge: int) -> list[int]:
        """From that joint down to the base."""
        found = []
        while hinge >= 0:
            found.append(hinge)
            hinge = self.hinges[hinge].parent
        return found


@dataclass(frozen=True, eq=False)
class _Turn:
    """The axes `start`, turned about the axis `about` of that frame by `angle`.

    Turns about one axis one after the other add their angles: a planar chain needs one sine and cosine a link.
    """

    start: Matrix3
    about: Vector | None
    angle: sp.Expr


def place(mechanism: Mechanism, algebra: Algebra) -> Pose:
    """The pose as a function of the joints' coordinates."""
    hinges: list[Hinge] = []
    turns: list[_Turn] = []
    frames: dict[str, Frame] = {}
    for body in mechanism.bodies:
        parent = frames[body.parent] if body.parent else Frame(-1, ZERO, UPRIGHT)
        frame = Frame(parent.hinge, parent.point(body.position), sp.ImmutableMatrix(parent.axes * body.rotation))
        for joint in body.joints:
            if joint.locked is not None:
                frame = _locked(joint, frame, joint.locked)
            else:
                frame = _add_joint(joint, frame, hinges, turns, algebra)
        frames[body.name] = frame
    return Pose(tuple(hinges), frames)


def _add_joint(joint: Joint, frame: Frame, hinges: list[Hinge], turns: list[_Turn], algebra: Algebra) -> Frame:
    """The joint's hinge is added, and the body's frame in the frame of that joint given back."""
    below = turns[frame.hinge] if frame.hinge >= 0 else _Turn(WORLD, None, sp.Integer(0))
    axes = hinges[frame.hinge].axes if frame.hinge >= 0 else WORLD
    lever, axis = _turned(frame.axes, joint.anchor), _unit(_turned(frame.axes, joint.axis))
    anchor, travel = _plus(frame.origin, lever), joint.symbol - joint.reference
    direction = algebra.apply(axes, axis)
    if joint.kind == "prismatic":
        anchor = _plus(anchor, tuple(travel * x for x in axis))
        turn = below
    else:
        turn = _turned_further(below, axis, travel, axes)
        axes = (
            turn.start if turn.about is None else algebra.product(turn.start, algebra.rotation(turn.about, turn.angle))
        )
    arm = algebra.apply(hinges[frame.hinge].axes if frame.hinge >= 0 else WORLD, algebra.vector(anchor))
    hinges.append(Hinge(joint, frame.hinge, anchor, arm, direction, axes))
    turns.append(turn)
    return Frame(len(hinges) - 1, tuple(-x for x in lever), frame.axes)


def _locked(joint: Joint, frame: Frame, value: sp.Expr) -> Frame:
    """The body's frame, moved as far as the joint is locked."""
    travel, axis = value - joint.reference, _unit(joint.axis)
    if joint.kind == "prismatic":
        return Frame(frame.hinge, frame.point(tuple(travel * x for x in axis)), frame.axes)
    turn = rotation_about(axis, travel)
    anchor = frame.point(joint.anchor)
    axes = sp.ImmutableMatrix(frame.axes * turn)
    return Frame(frame.hinge, _plus(anchor, tuple(-x for x in _turned(axes, joint.anchor))), axes)


def _turned_further(turn: _Turn, axis: Vector, angle: sp.Expr, axes: Matrix3) -> _Turn:
    if turn.about is None:
        return _Turn(turn.start, axis, angle)
    for sign in (1, -1):
        if all(x == sign * y for x, y in zip(axis, turn.about, strict=True)):
            return _Turn(turn.start, turn.about, turn.angle + sign * angle)
    return _Turn(axes, axis, angle)


def _turned(matrix: sp.ImmutableMatrix, v: Vector) -> Vector:
    x, y, z = matrix * sp.Matrix(v)
    return x, y, z


def _plus(v: Vector, w: Vector) -> Vector:
    x, y, z = (a + b for a, b in zip(v, w, strict=True))
    return x, y, z


def _unit(axis: Vector) -> Vector:
    length = sp.sqrt(sp.Add(*(x**2 for x in axis)))
    x, y, z = (e / length for e in axis)
    return x, y, z
