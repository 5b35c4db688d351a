"""From a MuJoCo model to a mechanism as data: bodies and joints with the numbers that MuJoCo computes with."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import sympy as sp

from painleve.errors import InputError, nearest
from painleve.exact.parse import exact_number
from painleve.mechanics.robot_file.xml_text import root_of_file
from painleve.mechanics.tree.model import ALONG_X, ALONG_Y, ALONG_Z, ZERO, Body, Joint, JointKind, Mechanism, Vector
from painleve.mechanics.tree.vectors import quaternion_rotation

__all__ = ["Robot", "exact", "exact_vector", "read_robot", "rotation_of"]

FREE, BALL, SLIDE, HINGE = range(4)  # MuJoCo's mjtJoint
CONNECT, WELD = 0, 1  # of mjtEq: what closes a loop
MOST_BODIES, MOST_JOINTS = 200, 64
ROUNDING = 1e-14


@dataclass(frozen=True, eq=False)
class Robot:
    """A robot as it was read: the model of the package, its mechanism, names by MuJoCo's numbers, what was left out."""

    model: Any
    mechanism: Mechanism
    bodies: Mapping[int, str]
    notes: tuple[str, ...]


def read_robot(path: Path, locked: Mapping[str, str]) -> Robot:
    """The mechanism of an MJCF or URDF file. `locked` fixes joints at exact values.

    Raises InputError, one line, for what is not such a file, for the package missing, for closed loops, for locked
    joints that do not exist or are out of their range.
    """
    model = _load(path)
    if model.nbody > MOST_BODIES or model.njnt > MOST_JOINTS:
        raise InputError(
            f"{path}: the robot has {model.nbody - 1} bodies and {model.njnt} joints; "
            f"{MOST_BODIES} and {MOST_JOINTS} are the most that are read"
        )
    loops = [i for i in range(model.neq) if int(model.eq_type[i]) in (CONNECT, WELD)]
    if loops:
        raise InputError(
            f"{path}: {len(loops)} equality constraint(s) join bodies into closed loops, which a tree of joints "
            "does not have; remove them, or lock the joints of the loop"
        )
    names = _Names()
    bodies = {i: names.of(model.body(i).name or f"body_{i}") for i in range(1, model.nbody)}
    joints = {i: names.of(model.joint(i).name or f"joint_{i}") for i in range(model.njnt)}
    values = _locked(path, model, joints, locked)
    tree = [_body(model, i, bodies, joints, values) for i in range(1, model.nbody)]
    mechanism = Mechanism(bodies=tuple(tree), gravity=exact_vector(model.opt.gravity))
    return Robot(model, mechanism, bodies, tuple(_left_out(model)))


def exact(value: float) -> sp.Rational:
    """The decimal number that a float prints."""
    return sp.Rational(Fraction(repr(float(value))))


def exact_vector(values: Any) -> Vector:
    """Three decimals; what is rounding beside a metre is zero."""
    x, y, z = (exact(v) if abs(float(v)) > ROUNDING else sp.Integer(0) for v in values)
    return x, y, z


def _load(path: Path) -> Any:
    root = root_of_file(path)
    if root not in ("mujoco", "robot"):
        raise InputError(f"{path}: the root element is <{root[:40]}>; <mujoco> (MJCF) and <robot> (URDF) are read")
    try:
        import mujoco
    except ImportError:
        raise InputError(
            "reading a robot's file needs the package mujoco; install it with: pip install 'painleve[robots]'"
        ) from None
    try:
        return mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise InputError(f"{path}: {' '.join(str(error).split())[:200]}") from None


class _Names:
    """Names that scene files allow, each once."""

    def __init__(self) -> None:
        self.taken: set[str] = set()

    def of(self, name: str) -> str:
        clean = re.sub(r"[^A-Za-z0-9_]", "_", name)[:28]
        clean = clean if clean[:1].isalpha() and not clean.startswith("u_") else f"j_{clean}"
        while clean in self.taken:
            clean += "_"
        self.taken.add(clean)
        return clean


def _locked(path: Path, model: Any, joints: Mapping[int, str], locked: Mapping[str, str]) -> dict[int, sp.Expr]:
    found = {}
    for name, text in locked.items():
        matches = [i for i, clean in joints.items() if name in (clean, model.joint(i).name)]
        if not matches:
            known = list(joints.values())
            raise InputError(f"{path}: no joint {name!r} to lock{nearest(name, known)}; joints: {', '.join(known)}")
        (i,) = matches
        if int(model.jnt_type[i]) not in (SLIDE, HINGE):
            raise InputError(f"{path}: joint {name} is no hinge and no slide, and cannot be locked at one value")
        value = exact_number(text, where=f"--lock {name}")
        low, high = (float(x) for x in model.jnt_range[i])
        if model.jnt_limited[i] and not low <= float(value) <= high:
            raise InputError(f"{path}: joint {name} locked at {text} is out of its range, {low:g} to {high:g}")
        found[i] = value
    return found


def _body(
    model: Any, i: int, bodies: Mapping[int, str], joints: Mapping[int, str], locked: Mapping[int, sp.Expr]
) -> Body:
    first, count = int(model.body_jntadr[i]), int(model.body_jntnum[i])
    own: list[Joint] = []
    for j in range(first, first + count):
        own += _JOINTS[int(model.jnt_type[j])](model, j, joints[j], locked.get(j))
    return Body(
        name=bodies[i],
        parent=bodies.get(int(model.body_parentid[i]), ""),
        position=ZERO if own and _is_free(model, first) else exact_vector(model.body_pos[i]),
        rotation=rotation_of(model.body_quat[i]),
        joints=tuple(own),
        mass=exact(model.body_mass[i]),
        centre=exact_vector(model.body_ipos[i]),
        inertia=_inertia(model.body_inertia[i], model.body_iquat[i]),
    )


def _is_free(model: Any, j: int) -> bool:
    return int(model.jnt_type[j]) == FREE


def rotation_of(quaternion: Any) -> sp.ImmutableMatrix:
    """The exact rotation of a quaternion of decimals, whatever its length."""
    w, x, y, z = (exact(c) for c in quaternion)
    return quaternion_rotation(w, (x, y, z))


def _inertia(principal: Any, quaternion: Any) -> sp.ImmutableMatrix:
    """In the body's axes; products of inertia that are rounding beside the principal values are zero."""
    turn = np.array(rotation_of(quaternion).tolist(), dtype=float)
    full = turn @ np.diag(principal) @ turn.T
    full[np.abs(full) <= ROUNDING * np.max(np.abs(full))] = 0.0
    return sp.ImmutableMatrix(3, 3, lambda i, j: exact(full[min(i, j), max(i, j)]))


def _moving(model: Any, j: int, name: str, locked: sp.Expr | None, kind: JointKind) -> list[Joint]:
    d, at = int(model.jnt_dofadr[j]), int(model.jnt_qposadr[j])
    low, high = (exact(x) for x in model.jnt_range[j])
    return [
        Joint(
            name=name,
            kind=kind,
            axis=exact_vector(model.jnt_axis[j]),
            anchor=exact_vector(model.jnt_pos[j]),
            reference=exact(model.qpos0[at]),
            damping=exact(model.dof_damping[d]),
            armature=exact(model.dof_armature[d]),
            stiffness=exact(model.jnt_stiffness[j]),
            rest=exact(model.qpos_spring[at]),
            limits=(low, high) if model.jnt_limited[j] else None,
            locked=locked,
        )
    ]


def _turning(model: Any, j: int, name: str, locked: sp.Expr | None) -> list[Joint]:
    """Three turns about z, y and x, a chart about the reference orientation (singular where the second is pi/2)."""
    d, anchor = int(model.jnt_dofadr[j]), exact_vector(model.jnt_pos[j])
    return [
        Joint(name=f"{name}_{letter}", kind="revolute", axis=axis, anchor=anchor, damping=exact(model.dof_damping[d]))
        for letter, axis in (("yaw", ALONG_Z), ("pitch", ALONG_Y), ("roll", ALONG_X))
    ]


def _free(model: Any, j: int, name: str, locked: sp.Expr | None) -> list[Joint]:
    shifts = [
        Joint(name=f"{name}_{letter}", kind="prismatic", axis=axis)
        for letter, axis in (("x", ALONG_X), ("y", ALONG_Y), ("z", ALONG_Z))
    ]
    return shifts + [
        Joint(name=f"{name}_{letter}", kind="revolute", axis=axis)
        for letter, axis in (("yaw", ALONG_Z), ("pitch", ALONG_Y), ("roll", ALONG_X))
    ]


_JOINTS: Mapping[int, Callable[[Any, int, str, sp.Expr | None], list[Joint]]] = {
    FREE: _free,
    BALL: _turning,
    SLIDE: lambda model, j, name, locked: _moving(model, j, name, locked, "prismatic"),
    HINGE: lambda model, j, name, locked: _moving(model, j, name, locked, "revolute"),
}


def _left_out(model: Any) -> list[str]:
    """What the model has and a scene has not, in words."""
    counts = {
        "actuators (motors give no force here)": model.nu,
        "tendons": model.ntendon,
        "equality constraints of joints": model.neq,
        "joints with dry friction": int(np.count_nonzero(model.dof_frictionloss)),
        "bodies with gravity compensation": int(np.count_nonzero(model.body_gravcomp)),
    }
    notes = [f"{number} {what}" for what, number in counts.items() if number]
    if model.opt.density or model.opt.viscosity:
        notes.append("the drag of the medium")
    return notes
