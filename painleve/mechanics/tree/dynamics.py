"""M(q) and f(t, q, u) of a mechanism on a tape.

M by composite bodies (R. Featherstone, Rigid Body Dynamics Algorithms, Springer 2008, section 6.2), the velocity terms
and gravity by the recursive Newton-Euler equations (section 5.3), both about the joints' anchors in the world's axes
(docs/theory.md, section 1.5).
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from painleve.mechanics.tree.kinematics import Pose
from painleve.mechanics.tree.model import ZERO, Joint, Mechanism, Vector
from painleve.mechanics.tree.vectors import Algebra, Matrix3, rows_of, transposed

__all__ = ["force_of", "inertia_of"]


@dataclass(frozen=True, eq=False)
class _Rigid:
    """Mass, first moment and second moment (the inertia tensor) about a joint's anchor."""

    mass: sp.Expr
    first: Vector
    second: Matrix3


def inertia_of(mechanism: Mechanism, pose: Pose, algebra: Algebra) -> sp.ImmutableMatrix:
    """M(q), armature included: column k is what the joints must give for a unit acceleration of joint k."""
    n = len(pose.hinges)
    composite = _carried(mechanism, pose, algebra)
    for k in range(n - 1, 0, -1):
        hinge, parent = pose.hinges[k], pose.hinges[k].parent
        if parent >= 0:
            composite[parent] = _joined(
                composite[parent], _moved(composite[k], hinge.arm, hinge.place, algebra), algebra
            )
    M = sp.zeros(n, n)
    for k, hinge in enumerate(pose.hinges):
        body = composite[k]
        if hinge.revolute:
            force, moment = algebra.cross(hinge.axis, body.first), algebra.apply(body.second, hinge.axis)
        else:
            force, moment = algebra.scale(body.mass, hinge.axis), algebra.cross(body.first, hinge.axis)
        for j in pose.chain(k):
            along = moment if pose.hinges[j].revolute else force
            M[j, k] = M[k, j] = algebra.dot(pose.hinges[j].axis, along)
            moment = algebra.add(moment, algebra.cross(pose.hinges[j].arm, force))
        M[k, k] = algebra.tape.name(M[k, k] + hinge.joint.armature)
    return sp.ImmutableMatrix(M)


def force_of(mechanism: Mechanism, pose: Pose, algebra: Algebra) -> sp.ImmutableMatrix:
    """f(t, q, u): what acts along the joints, gravity, and the velocity terms of Lagrange's equations."""
    motions = _accelerations(mechanism, pose, algebra)
    wrenches = [
        _wrench(body, motion, algebra) for body, motion in zip(_carried(mechanism, pose, algebra), motions, strict=True)
    ]
    bias: list[sp.Expr] = [sp.Integer(0)] * len(pose.hinges)
    for k in range(len(pose.hinges) - 1, -1, -1):
        hinge, (force, moment) = pose.hinges[k], wrenches[k]
        bias[k] = algebra.dot(hinge.axis, moment if hinge.revolute else force)
        if hinge.parent >= 0:
            below = wrenches[hinge.parent]
            carried = algebra.add(below[1], moment, algebra.cross(hinge.arm, force))
            wrenches[hinge.parent] = (algebra.add(below[0], force), carried)
    return sp.ImmutableMatrix([_applied(hinge.joint) - b for hinge, b in zip(pose.hinges, bias, strict=True)])


def _applied(joint: Joint) -> sp.Expr:
    return joint.force - joint.damping * joint.velocity - joint.stiffness * (joint.symbol - joint.rest)


def _carried(mechanism: Mechanism, pose: Pose, algebra: Algebra) -> list[_Rigid]:
    """What each joint's own bodies weigh, without those behind the next joint: summed in the joint's frame, where they
    are numbers, and turned into the world's axes once."""
    return [
        _turned(own, hinge.axes, algebra)
        for own, hinge in zip(_own(mechanism, pose, algebra), pose.hinges, strict=True)
    ]


def _own(mechanism: Mechanism, pose: Pose, algebra: Algebra) -> list[_Rigid]:
    found = [_Rigid(sp.Integer(0), ZERO, (ZERO, ZERO, ZERO)) for _ in pose.hinges]
    for body in mechanism.bodies:
        frame = pose.frames[body.name]
        if frame.hinge >= 0:
            turned = rows_of(sp.ImmutableMatrix(frame.axes * body.inertia * frame.axes.T))
            centre = frame.point(body.centre)
            placed = _moved(_Rigid(body.mass, ZERO, turned), centre, centre, algebra)
            found[frame.hinge] = _joined(found[frame.hinge], placed, algebra)
    return found


def _turned(body: _Rigid, axes: Matrix3, algebra: Algebra) -> _Rigid:
    second = algebra.product(axes, algebra.product(body.second, transposed(axes)))
    return _Rigid(body.mass, algebra.apply(axes, body.first), second)


def _moved(body: _Rigid, arm: Vector, place: Vector, algebra: Algebra) -> _Rigid:
    """The same body about a point from which its old one is at `arm`; `place` is that arm in a frame in which its
    length is easier to see."""
    h, m = body.first, body.mass
    twice = algebra.tape.name(2 * algebra.dot(arm, h) + m * algebra.dot(place, place))
    shift = [
        [(twice if i == j else 0) - arm[i] * h[j] - h[i] * arm[j] - m * arm[i] * arm[j] for j in range(3)]
        for i in range(3)
    ]
    second = algebra.sum(body.second, algebra.matrix(shift))
    return _Rigid(m, algebra.add(h, algebra.scale(m, arm)), second)


def _joined(left: _Rigid, right: _Rigid, algebra: Algebra) -> _Rigid:
    mass = algebra.tape.name(left.mass + right.mass)
    return _Rigid(mass, algebra.add(left.first, right.first), algebra.sum(left.second, right.second))


@dataclass(frozen=True, eq=False)
class _Motion:
    """Angular velocity, and the accelerations that no acceleration of a joint causes: angular, and of the anchor."""

    turn: Vector
    angular: Vector
    linear: Vector


def _accelerations(mechanism: Mechanism, pose: Pose, algebra: Algebra) -> list[_Motion]:
    rest = _Motion(ZERO, ZERO, algebra.scale(sp.Integer(-1), mechanism.gravity))
    found: list[_Motion] = []
    for hinge in pose.hinges:
        below = found[hinge.parent] if hinge.parent >= 0 else rest
        rate = algebra.scale(hinge.joint.velocity, hinge.axis)
        swing = algebra.add(
            below.linear,
            algebra.cross(below.angular, hinge.arm),
            algebra.cross(below.turn, algebra.cross(below.turn, hinge.arm)),
        )
        gyration = algebra.cross(below.turn, rate)
        if hinge.revolute:
            found.append(_Motion(algebra.add(below.turn, rate), algebra.add(below.angular, gyration), swing))
        else:
            found.append(_Motion(below.turn, below.angular, algebra.add(swing, gyration, gyration)))
    return found


def _wrench(body: _Rigid, motion: _Motion, algebra: Algebra) -> tuple[Vector, Vector]:
    """Force, and moment about the anchor, that the body's motion takes (Newton and Euler)."""
    w = motion.turn
    force = algebra.add(
        algebra.scale(body.mass, motion.linear),
        algebra.cross(motion.angular, body.first),
        algebra.cross(w, algebra.cross(w, body.first)),
    )
    moment = algebra.add(
        algebra.apply(body.second, motion.angular),
        algebra.cross(w, algebra.apply(body.second, w)),
        algebra.cross(body.first, motion.linear),
    )
    return force, moment
