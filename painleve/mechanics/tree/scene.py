"""The scene of a mechanism that touches a plane."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

import sympy as sp

from painleve.errors import InputError
from painleve.exact.tape import Tape, TapeBuilder
from painleve.mechanics.contact import Contact
from painleve.mechanics.friction import NoFriction, Section
from painleve.mechanics.scene import Coordinate, NamedState, Parameter, Scene, StateKey
from painleve.mechanics.tree.contact import PlaneContact, contact_of
from painleve.mechanics.tree.dynamics import force_of, inertia_of
from painleve.mechanics.tree.kinematics import place
from painleve.mechanics.tree.model import Joint, Tree
from painleve.mechanics.tree.vectors import Algebra

__all__ = ["make_tree_scene"]

PREFIX = "_z"  # of intermediate results: no name of a user begins with _
MOST_CLOSED = 3  # coordinates of a mechanism whose closed forms are formed at once ...
MOST_OPERATIONS = 150  # ... if its tape is no longer


def make_tree_scene(
    *,
    name: str,
    sentence: str,
    source: str,
    tree: Tree,
    parameters: Iterable[Parameter] = (),
    friction: Section | None = None,
    states: Iterable[NamedState] = (),
    contact_parameters: Mapping[str, sp.Expr] | None = None,
) -> Scene:
    """M, f, g and H of a tree of bodies that touches a plane; joints that are not locked are its coordinates.

    A short mechanism is given in closed form, and is a scene like any other. A longer one keeps its intermediate
    results. The coordinates are the state keys; where the height of a free base carries the contact, it follows from
    the others. Raises InputError where the contact does not depend on any joint, or where friction in space meets a
    mechanism that moves in a plane.
    """
    section = friction if friction is not None else NoFriction()
    builder = TapeBuilder(PREFIX)
    algebra = Algebra(builder)
    pose = place(tree.mechanism, algebra)
    M, f = inertia_of(tree.mechanism, pose, algebra), force_of(tree.mechanism, pose, algebra)
    contact = contact_of(tree.point, tree.plane, pose, algebra)
    if contact.normal.is_zero_matrix:
        raise InputError(f"scene {name}: no joint moves the touching point against the plane")
    if any(contact.tangents[:, j].is_zero_matrix for j in range(contact.tangents.shape[1])):
        raise InputError(
            f"scene {name}: no joint moves the touching point along one of the plane's tangents: the mechanism moves "
            "in a plane, so its friction is a segment along the other one"
        )
    tape = builder.tape
    closed = len(pose.hinges) <= MOST_CLOSED and tape.needed([*M, *contact.tangents]).operations() <= MOST_OPERATIONS
    if closed:
        M, f, contact = _expanded(tape, M, f, contact)
        tape = Tape()
    carrier = carrying_joint(contact)
    joints = tree.mechanism.joints
    given = [joint for i, joint in enumerate(joints) if not (closed and i == carrier)]
    rules = {joint.name: joint.symbol for joint in given}
    if closed and carrier is not None:
        rest = contact.height.subs(joints[carrier].symbol, 0)
        rules[joints[carrier].name] = sp.expand(-rest / contact.normal[carrier])
    return Scene(
        name=name,
        sentence=sentence,
        source=source,
        coordinates=tuple(_coordinate(joint) for joint in joints),
        parameters=tuple(parameters),
        inertia=M,
        force=f,
        contact=Contact(
            constraint=-contact.height,
            tangents=contact.tangents,
            section=section,
            normal=None if closed else contact.normal,
        ),
        keys=tuple(_key(joint) for joint in given),
        placement=MappingProxyType(rules),
        velocity=MappingProxyType({}),
        contact_parameters=MappingProxyType(dict(contact_parameters or {})),
        states=tuple(states),
        definitions=tape.needed([*M, *f, contact.height, *contact.normal, *contact.tangents]),
        tree=tree,
    )


def carrying_joint(contact: PlaneContact) -> int | None:
    """The first coordinate along which the height has a constant slope: a free base's."""
    return next((i for i, w in enumerate(contact.normal) if w != 0 and not w.free_symbols), None)


def _expanded(
    tape: Tape, M: sp.MatrixBase, f: sp.MatrixBase, contact: PlaneContact
) -> tuple[sp.ImmutableMatrix, sp.ImmutableMatrix, PlaneContact]:
    def matrix(entries: sp.MatrixBase) -> sp.ImmutableMatrix:
        return sp.ImmutableMatrix(*entries.shape, [sp.expand(e) for e in tape.expand(list(entries))])

    (height,) = (sp.expand(e) for e in tape.expand([contact.height]))
    return matrix(M), matrix(f), PlaneContact(height, matrix(contact.normal), matrix(contact.tangents))


def _coordinate(joint: Joint) -> Coordinate:
    unit, kind = ("rad", "angle") if joint.kind == "revolute" else ("m", "shift")
    return Coordinate(name=joint.name, unit=unit, sentence=joint.sentence or f"{kind} of the joint {joint.name}")


def _key(joint: Joint) -> StateKey:
    of_joint = _coordinate(joint)
    return StateKey(
        name=joint.name,
        unit=of_joint.unit,
        sentence=of_joint.sentence,
        default=str(joint.reference),
        interval=(str(joint.limits[0]), str(joint.limits[1])) if joint.limits else None,
    )
