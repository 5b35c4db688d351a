"""The text of a scene file for a robot's contact."""

from __future__ import annotations

import re
from pathlib import Path

import sympy as sp

from painleve.errors import InputError
from painleve.mechanics.robot_file.contact import ChosenContact
from painleve.mechanics.robot_file.read import Robot
from painleve.mechanics.tree.model import Body, Mechanism, Tree
from painleve.mechanics.tree.write import mechanism_text, number_text, touching_text

__all__ = ["robot_scene_text"]


def robot_scene_text(robot: Robot, path: Path, chosen: ChosenContact, planar: bool) -> str:
    """A scene file that a person can read and change; what was left out stands at its head.

    Bodies that hang on other roots than the touching one are left out: they do not move with it. Raises InputError for
    a planar scene of a mechanism that does not move in one plane with the normal.
    """
    mechanism, aside = _connected(robot.mechanism, chosen.tree.point.body)
    kept = tuple(other for other in chosen.tree.others if other.body in mechanism.by_name)
    tree = Tree(mechanism=mechanism, point=chosen.tree.point, plane=chosen.tree.plane, others=kept)
    notes = [*robot.notes, *chosen.notes]
    if aside:
        notes.append(f"bodies that are not joined to {tree.point.body}: {', '.join(aside)}")
    if planar:
        tree = _planar(path, tree)
    kind = "segment" if planar else "disc"
    name = re.sub(r"[^A-Za-z0-9_]", "_", f"{path.stem}_{tree.point.body}")[:32]
    sentence = f"{path.stem}, touching with {chosen.what}"
    head = [f"# Written from {path.name}. Left out: {note}." for note in notes]
    tables = [
        *head,
        f'name = "{name}"\nsentence = "{sentence}"\n',
        "[parameters]\n"
        f'mu = {{ unit = "1", sentence = "coefficient of friction", default = {number_text(chosen.friction)}, '
        'range = "nonnegative" }\n',
        mechanism_text(tree.mechanism),
        touching_text(tree),
        f'[friction]\nkind = "{kind}"\nmu = "mu"\n',
    ]
    return "\n".join(tables)


def _connected(mechanism: Mechanism, body: str) -> tuple[Mechanism, list[str]]:
    """The bodies that share a root with the body, and the names of the others that move."""
    by_name = mechanism.by_name

    def root(one: Body) -> str:
        """The first joint's body on the way from the base."""
        while one.parent and not (one.joints and not _moving_below(one, mechanism)):
            one = by_name[one.parent]
        return one.name

    own = root(by_name[body])
    kept = tuple(one for one in mechanism.bodies if root(one) == own)
    aside = [one.name for one in mechanism.bodies if one not in kept and one.joints]
    return Mechanism(bodies=kept, gravity=mechanism.gravity), aside


def _moving_below(body: Body, mechanism: Mechanism) -> bool:
    """Whether a joint moves the body's parent."""
    by_name = mechanism.by_name
    while body.parent:
        body = by_name[body.parent]
        if any(joint.locked is None for joint in body.joints):
            return True
    return False


def _planar(path: Path, tree: Tree) -> Tree:
    """The same with the one tangent along which the mechanism moves: across the hinges' axes."""
    axes = [joint.axis for joint in tree.mechanism.joints if joint.kind == "revolute"]
    if any(not body.rotation.is_Identity for body in tree.mechanism.bodies):
        raise InputError(f"{path}: --planar reads mechanisms whose bodies are not turned against each other")
    if not axes:
        raise InputError(f"{path}: --planar needs a hinge, whose axis is across the plane of the motion")
    across = sp.Matrix(axes[0])
    flat = all(sp.Matrix(axis).cross(across).is_zero_matrix for axis in axes)
    shifts = [joint.axis for joint in tree.mechanism.joints if joint.kind == "prismatic"]
    flat = flat and all(sp.Matrix(axis).dot(across) == 0 for axis in shifts)
    normal = sp.Matrix(tree.plane.normal)
    if not flat or normal.dot(across) != 0:
        raise InputError(f"{path}: the joints do not move the robot in one plane with the normal; leave out --planar")
    x, y, z = across.cross(normal) / across.norm()
    plane = type(tree.plane)(point=tree.plane.point, normal=tree.plane.normal, tangents=((x, y, z),))
    return Tree(mechanism=tree.mechanism, point=tree.point, plane=plane, others=tree.others)
