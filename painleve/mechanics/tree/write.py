"""A mechanism as the text of a scene file that a person can read and change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import sympy as sp

from painleve.mechanics.tree.model import UPRIGHT, ZERO, Body, Joint, Mechanism, TouchingPoint, Tree, Vector

__all__ = ["mechanism_text", "number_text", "touching_text"]


def number_text(value: sp.Expr) -> str:
    """A TOML value: a whole number, the decimal that a number is, or its formula in quotes."""
    if value.is_Integer:
        return str(value)
    if value.is_Rational and set(sp.factorint(value.q)) <= {2, 5}:
        return _decimal(value)
    return f'"{value}"'


def _decimal(value: sp.Rational) -> str:
    """Exactly, with as many places as it takes."""
    places = 0
    while (value * 10**places).q != 1:
        places += 1
    digits = str(abs(int(value * 10**places))).rjust(places + 1, "0")
    sign = "-" if value < 0 else ""
    exponent = len(digits.rstrip("0")) - places
    if places > 18 and exponent < -3:  # a small number reads better with its power of ten
        lead = digits.strip("0")
        return f"{sign}{lead[0]}.{lead[1:] or '0'}e-{places - len(digits.lstrip('0')) + 1}"
    return f"{sign}{digits[:-places]}.{digits[-places:]}"


def _array(values: Iterable[sp.Expr]) -> str:
    return f"[{', '.join(number_text(v) for v in values)}]"


def mechanism_text(mechanism: Mechanism) -> str:
    """The tables [mechanism] and [[body]]."""
    parts = [f"[mechanism]\ngravity = {_array(mechanism.gravity)}\n"] if mechanism.gravity != ZERO else []
    return "\n".join([*parts, *(_body_text(body) for body in mechanism.bodies)])


def _body_text(body: Body) -> str:
    lines = ["[[body]]", f'name = "{body.name}"', f'parent = "{body.parent or "world"}"']
    lines += _vector_line("position", body.position)
    if body.rotation != UPRIGHT:
        lines.append(f"rotation = {_rotation_text(body.rotation)}")
    if body.mass != 0:
        lines.append(f"mass = {number_text(body.mass)}")
    lines += _vector_line("centre", body.centre)
    if not body.inertia.is_zero_matrix:
        lines.append(f"inertia = {_array(_inertia_entries(body.inertia))}")
    return "\n".join([*lines, *(_joint_text(joint) for joint in body.joints)]) + "\n"


def _vector_line(name: str, v: Vector) -> list[str]:
    return [] if v == ZERO else [f"{name} = {_array(v)}"]


def _inertia_entries(J: sp.ImmutableMatrix) -> Sequence[sp.Expr]:
    principal = [J[0, 0], J[1, 1], J[2, 2]]
    return principal if J.is_diagonal() else [*principal, J[0, 1], J[0, 2], J[1, 2]]


def _rotation_text(rotation: sp.ImmutableMatrix) -> str:
    """By a quaternion: its components are proportional to these whole expressions of the matrix."""
    R = rotation
    w = 1 + R.trace()
    quaternion = [w, R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]
    if w == 0:  # half a turn: a column of R + 1 is along the axis
        axis = next(column for column in (R + sp.eye(3)).columnspace())
        quaternion = [sp.Integer(0), *axis]
    return f"{{ quaternion = {_array(sp.nsimplify(x) for x in quaternion)} }}"


def _joint_text(joint: Joint) -> str:
    lines = ["", "[[body.joint]]", f'name = "{joint.name}"', f'kind = "{joint.kind}"', f"axis = {_array(joint.axis)}"]
    lines += _vector_line("anchor", joint.anchor)
    for name in ("reference", "damping", "armature", "stiffness", "rest"):
        value = getattr(joint, name)
        if value != 0:
            lines.append(f"{name} = {number_text(value)}")
    if joint.force != 0:
        lines.append(f'force = "{joint.force}"')
    if joint.limits is not None:
        lines.append(f"limits = {_array(joint.limits)}")
    if joint.locked is not None:
        lines.append(f"locked = {number_text(joint.locked)}")
    return "\n".join(lines)


def touching_text(tree: Tree) -> str:
    """The table [contact]."""
    point, plane = tree.point, tree.plane
    lines = ["[contact]", *_point_lines(point)]
    entries = [f"{name} = {_array(v)}" for name, v in (("point", plane.point), ("normal", plane.normal)) if v != ZERO]
    entries.append(f"tangent = {_array(plane.tangents[0])}")
    lines.append(f"plane = {{ {', '.join(entries)} }}")
    others = ["\n".join(["", "[[contact.other]]", *_point_lines(other)]) for other in tree.others]
    return "\n".join([*lines, *others]) + "\n"


def _point_lines(point: TouchingPoint) -> list[str]:
    lines = [f'body = "{point.body}"', f"point = {_array(point.point)}"]
    return lines if point.radius == 0 else [*lines, f"radius = {number_text(point.radius)}"]
