"""The tables of a scene file that describe a mechanism: [mechanism], [[body]] with its joints, and where it touches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

import sympy as sp

from painleve.mechanics.scene_file.fields import Field
from painleve.mechanics.scene_file.names import why_no_name, why_no_symbol
from painleve.mechanics.tree.model import (
    ALONG_X,
    ALONG_Z,
    UPRIGHT,
    ZERO,
    Body,
    Joint,
    JointKind,
    Mechanism,
    Plane,
    TouchingPoint,
    Tree,
    Vector,
)
from painleve.mechanics.tree.vectors import quaternion_rotation, rotation_about

__all__ = ["read_mechanism", "read_tree"]

MOST_BODIES, MOST_JOINTS, MOST_OTHERS = 64, 32, 64

Symbols = Mapping[str, sp.Expr]
_VALUES = ("reference", "damping", "armature", "stiffness", "rest")


def read_mechanism(mechanism: Field | None, bodies: Field, p: Symbols) -> Mechanism:
    """Bodies and joints; joints that are not locked are the scene's coordinates."""
    listed = bodies.array(MOST_BODIES, what="bodies")
    known = _known_to_forces(listed, p)
    found: list[Body] = []
    for field in listed:
        body = _body(field, [b.name for b in found], p, known)
        if body.name in {b.name for b in found}:
            raise field.refuse(f"there are two bodies {body.name}; each needs a name of its own")
        found.append(body)
    gravity = ZERO
    if mechanism is not None:
        parts = mechanism.table((), ("gravity",))
        gravity = _vector(parts["gravity"], p) if "gravity" in parts else ZERO
    tree = Mechanism(bodies=tuple(found), gravity=gravity)
    if not 0 < len(tree.joints) <= MOST_JOINTS:
        raise bodies.refuse(f"the bodies have {len(tree.joints)} joints that move; there may be 1 to {MOST_JOINTS}")
    return tree


def _known_to_forces(listed: list[Field], p: Symbols) -> dict[str, sp.Expr]:
    """What a joint's force may depend on: parameters, t, every coordinate and its velocity."""
    known: dict[str, sp.Expr] = {**p, "t": sp.Symbol("t", real=True)}
    for joint in (j for body in listed for j in _joints(body)):
        fields = joint.some(("name", "locked"))
        if "name" in fields and "locked" not in fields:
            name = fields["name"].string()
            why = why_no_symbol(name, coordinate=True)
            if why is None and name in known:
                why = f"the name {name} is taken already; choose another one"
            if why is not None:
                raise fields["name"].refuse(why)
            known |= {name: sp.Symbol(name, real=True), f"u_{name}": sp.Symbol(f"u_{name}", real=True)}
    return known


def _joints(body: Field) -> list[Field]:
    fields = body.some(("joint",))
    return fields["joint"].array(MOST_JOINTS, what="joints") if "joint" in fields else []


def _body(field: Field, before: list[str], p: Symbols, known: Symbols) -> Body:
    parts = field.table(("name",), ("parent", "position", "rotation", "mass", "centre", "inertia", "joint"))
    name = parts["name"].string()
    why = why_no_name(name)
    if why is not None:
        raise parts["name"].refuse(why)
    parent = parts["parent"].choice(("world", *before)) if "parent" in parts else "world"
    return Body(
        name=name,
        parent="" if parent == "world" else parent,
        position=_vector(parts["position"], p) if "position" in parts else ZERO,
        rotation=_rotation(parts["rotation"], p) if "rotation" in parts else UPRIGHT,
        joints=tuple(_joint(joint, p, known) for joint in _joints(field)),
        mass=parts["mass"].formula(p) if "mass" in parts else sp.Integer(0),
        centre=_vector(parts["centre"], p) if "centre" in parts else ZERO,
        inertia=_inertia(parts["inertia"], p) if "inertia" in parts else sp.ImmutableMatrix.zeros(3),
    )


def _joint(field: Field, p: Symbols, known: Symbols) -> Joint:
    parts = field.table(("name", "kind", "axis"), ("anchor", "limits", "locked", "sentence", "force", *_VALUES))
    axis = _vector(parts["axis"], p)
    if all(x == 0 for x in axis):
        raise parts["axis"].refuse("the axis has no direction")
    limits = [x.formula(p) for x in parts["limits"].array(2, length=2, what="limits")] if "limits" in parts else None
    values = {value: parts[value].formula(p) for value in _VALUES if value in parts}
    return Joint(
        name=parts["name"].string(),
        kind=cast(JointKind, parts["kind"].choice(("revolute", "prismatic"))),
        axis=axis,
        anchor=_vector(parts["anchor"], p) if "anchor" in parts else ZERO,
        limits=(limits[0], limits[1]) if limits else None,
        locked=parts["locked"].formula(p) if "locked" in parts else None,
        force=parts["force"].formula(known) if "force" in parts else sp.Integer(0),
        sentence=parts["sentence"].sentence() if "sentence" in parts else "",
        **values,
    )


def read_tree(field: Field, mechanism: Mechanism, p: Symbols, directions: int) -> Tree:
    """`body`, `point`, `radius` of a sphere about it; the plane, the floor z = 0 unless it is given; `other` points of
    the mechanism that the plane stops too."""
    parts = field.table(("body", "point"), ("radius", "plane", "other"))
    others = parts["other"].array(MOST_OTHERS, what="points") if "other" in parts else []
    given = parts["plane"].table((), ("point", "normal", "tangent")) if "plane" in parts else {}
    normal = _unit(given["normal"], p) if "normal" in given else ALONG_Z
    tangent = _unit(given["tangent"], p) if "tangent" in given else ALONG_X
    if sp.expand(sum(x * y for x, y in zip(normal, tangent, strict=True))) != 0:
        raise field.refuse("the plane's tangent is not orthogonal to its normal")
    across = sp.Matrix(normal).cross(sp.Matrix(tangent))
    tangents: tuple[Vector, ...] = (tangent, (across[0], across[1], across[2]))
    place = _vector(given["point"], p) if "point" in given else ZERO
    return Tree(
        mechanism=mechanism,
        point=_point(parts, mechanism, p),
        plane=Plane(point=place, normal=normal, tangents=tangents[:directions]),
        others=tuple(_point(other.table(("body", "point"), ("radius",)), mechanism, p) for other in others),
    )


def _point(parts: Mapping[str, Field], mechanism: Mechanism, p: Symbols) -> TouchingPoint:
    return TouchingPoint(
        body=parts["body"].choice([body.name for body in mechanism.bodies]),
        point=_vector(parts["point"], p),
        radius=parts["radius"].formula(p) if "radius" in parts else sp.Integer(0),
    )


def _unit(field: Field, p: Symbols) -> Vector:
    v = _vector(field, p)
    length = sp.sqrt(sp.Add(*(x**2 for x in v)))
    if length == 0:
        raise field.refuse("the vector has no direction")
    x, y, z = (e / length for e in v)
    return x, y, z


def _vector(field: Field, p: Symbols) -> Vector:
    x, y, z = (part.formula(p) for part in field.array(3, length=3, what="components"))
    return x, y, z


def _rotation(field: Field, p: Symbols) -> sp.ImmutableMatrix:
    """`{ axis = [...], angle = ... }`, or a quaternion of any length, `{ quaternion = [w, x, y, z] }`."""
    parts = field.table((), ("axis", "angle", "quaternion"))
    if "quaternion" in parts:
        w, x, y, z = (part.formula(p) for part in parts["quaternion"].array(4, length=4, what="components"))
        if w**2 + x**2 + y**2 + z**2 == 0:
            raise parts["quaternion"].refuse("the quaternion is zero, which is no rotation")
        return quaternion_rotation(w, (x, y, z))
    if set(parts) != {"axis", "angle"}:
        raise field.refuse("give either axis and angle, or a quaternion")
    return rotation_about(_unit(parts["axis"], p), parts["angle"].formula(p))


def _inertia(field: Field, p: Symbols) -> sp.ImmutableMatrix:
    """Three principal values along the body's axes, or six entries: xx, yy, zz, xy, xz, yz."""
    entries = [part.formula(p) for part in field.array(6, what="entries")]
    if len(entries) not in (3, 6):
        raise field.refuse(f"there are {len(entries)} entries; give 3 (xx, yy, zz) or 6 (xx, yy, zz, xy, xz, yz)")
    xx, yy, zz, xy, xz, yz = (*entries, *([sp.Integer(0)] * (6 - len(entries))))
    return sp.ImmutableMatrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
