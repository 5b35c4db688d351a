"""The units of a mechanism's formulas: each field of a body, a joint or a point of contact has a unit of its own.

Metres, kilograms, seconds and radians. A number is in the unit of its field, so only formulas are looked at. What
follows from the fields (M, f, g and H) has the right units if they have.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from painleve.mechanics.tree.model import Body, Joint, Tree

__all__ = ["fields_of"]


def fields_of(tree: Tree) -> Iterator[tuple[str, sp.Expr, str]]:
    """(what it is, the formula, the unit that its field has) of every formula with a name in it."""
    for what, entries, unit in _fields(tree):
        for entry in dict.fromkeys(e for e in entries if e.free_symbols):
            yield what, entry, unit


def _fields(tree: Tree) -> Iterator[tuple[str, tuple[sp.Expr, ...], str]]:
    yield "gravity", tree.mechanism.gravity, "m/s^2"
    for body in tree.mechanism.bodies:
        yield from _of_body(body)
        for joint in body.joints:
            yield from _of_joint(joint)
    for point in (tree.point, *tree.others):
        yield f"touching point of {point.body}", point.point, "m"
        yield f"radius of the sphere on {point.body}", (point.radius,), "m"
    yield "point of the plane", tree.plane.point, "m"
    yield "directions of the plane", (*tree.plane.normal, *(x for t in tree.plane.tangents for x in t)), "1"


def _of_body(body: Body) -> Iterator[tuple[str, tuple[sp.Expr, ...], str]]:
    yield f"mass of {body.name}", (body.mass,), "kg"
    yield f"centre of {body.name}", body.centre, "m"
    yield f"inertia of {body.name}", tuple(body.inertia), "kg m^2"
    yield f"position of {body.name}", body.position, "m"
    yield f"rotation of {body.name}", tuple(body.rotation), "1"


def _of_joint(joint: Joint) -> Iterator[tuple[str, tuple[sp.Expr, ...], str]]:
    turns = joint.kind == "revolute"
    place, force, inertia = ("rad", "N m", "kg m^2") if turns else ("m", "N", "kg")
    yield f"anchor of {joint.name}", joint.anchor, "m"
    places = (joint.reference, joint.rest, *(joint.limits or ()), *(() if joint.locked is None else (joint.locked,)))
    yield f"place of {joint.name}", places, place
    yield f"force of {joint.name}", (joint.force,), force
    yield f"damping of {joint.name}", (joint.damping,), f"{force} s" if turns else "N s/m"
    yield f"stiffness of {joint.name}", (joint.stiffness,), force if turns else "N/m"
    yield f"armature of {joint.name}", (joint.armature,), inertia
