"""Which point of a robot touches which plane, and with which friction, as MuJoCo would have it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import sympy as sp

from painleve.errors import InputError, nearest
from painleve.exact.parse import exact_number
from painleve.mechanics.robot_file.read import Robot, exact, exact_vector, rotation_of
from painleve.mechanics.tree.model import ALONG_X, ALONG_Y, ALONG_Z, ZERO, Plane, TouchingPoint, Tree, Vector

__all__ = ["ChosenContact", "choose_contact"]

PLANE, SPHERE, CAPSULE = 0, 2, 3  # of mjtGeom
FRICTION = 1.0  # MuJoCo's default, of a floor that the file does not have


@dataclass(frozen=True, eq=False)
class ChosenContact:
    """A mechanism's touching point in words and as data, its plane with two tangents, and the friction of the pair."""

    what: str
    tree: Tree
    friction: sp.Rational
    notes: tuple[str, ...]


def choose_contact(
    robot: Robot,
    path: Path,
    *,
    body: str,
    geom: str | None,
    end: int | None,
    point: Sequence[str] | None,
    plane: str | None,
) -> ChosenContact:
    """The contact of a body's geom or point with a plane of the world.

    A geom that is a sphere touches as one, a capsule by the sphere at its end 0 or 1. Friction is the larger of the two
    geoms' unless their priorities differ. Raises InputError, one line, for what is not in the file.
    """
    model, index = robot.model, _body_index(robot, path, body)
    notes: list[str] = []
    floor = _plane_index(model, path, plane, notes)
    own = _geom_index(model, path, index, geom) if geom is not None else None
    what = f"the point ({', '.join(point or ())}) of {robot.bodies[index]}"
    if own is not None:
        touching = _of_geom(model, path, robot.bodies[index], own, end)
        what = f"geom {geom}{f', end {end},' if end is not None else ''} of {robot.bodies[index]}"
    elif point is not None:
        x, y, z = (exact_number(text, where="--point") for text in point)
        touching = TouchingPoint(body=robot.bodies[index], point=(x, y, z))
        notes.append("friction: the plane's own, for a point has none")
    else:
        raise InputError(f"{path}: say where body {body} touches: --geom NAME or --point X Y Z")
    others = tuple(_others(robot, own, end, floor, notes))
    tree = Tree(mechanism=robot.mechanism, point=touching, plane=_plane(model, floor), others=others)
    return ChosenContact(what, tree, _friction(model, own, floor), tuple(notes))


def _body_index(robot: Robot, path: Path, body: str) -> int:
    for i, name in robot.bodies.items():
        if body in (name, robot.model.body(i).name):
            return i
    known = list(robot.bodies.values())
    raise InputError(f"{path}: no body {body!r}{nearest(body, known)}; bodies: {', '.join(known)}")


def _geom_names(model: Any, geoms: Sequence[int]) -> dict[str, int]:
    return {model.geom(i).name or f"geom_{i}": i for i in geoms}


def _geom_index(model: Any, path: Path, body: int, geom: str) -> int:
    first, count = int(model.body_geomadr[body]), int(model.body_geomnum[body])
    known = _geom_names(model, range(first, first + count))
    if geom not in known:
        raise InputError(
            f"{path}: body {model.body(body).name} has no geom {geom!r}{nearest(geom, known)}; "
            f"it has: {', '.join(known) or 'none'}"
        )
    return known[geom]


def _plane_index(model: Any, path: Path, plane: str | None, notes: list[str]) -> int | None:
    planes = [i for i in range(model.ngeom) if int(model.geom_type[i]) == PLANE]
    known = _geom_names(model, planes)
    if plane is not None and plane not in known:
        raise InputError(f"{path}: no plane {plane!r}{nearest(plane, known)}; planes: {', '.join(known) or 'none'}")
    if plane is None and len(planes) > 1:
        raise InputError(f"{path}: there are several planes, {', '.join(known)}; choose one with --plane NAME")
    if plane is None and not planes:
        notes.append(f"the file has no plane: the floor is z = 0, with friction {FRICTION:g}")
        return None
    chosen = known[plane] if plane is not None else planes[0]
    if int(model.body_weldid[model.geom_bodyid[chosen]]) != 0:
        raise InputError(f"{path}: the plane {model.geom(chosen).name} moves; only a plane at rest is read")
    return chosen


def _others(robot: Robot, own: int | None, end: int | None, floor: int | None, notes: list[str]) -> list[TouchingPoint]:
    """The other spheres and ends of capsules that the plane stops: a configuration in which one of them is below the
    plane is not one of the contact asked for."""
    model = robot.model
    found: list[TouchingPoint] = []
    shapeless: list[str] = []
    for i in range(model.ngeom):
        body = int(model.geom_bodyid[i])
        if body not in robot.bodies or floor is None or not _collide(model, i, floor):
            continue
        kind = int(model.geom_type[i])
        if kind == SPHERE and i != own:
            found.append(_end(model, robot.bodies[body], i, 0))
        elif kind == CAPSULE:
            found += [_end(model, robot.bodies[body], i, sign) for sign in (-1, 1) if (i, sign) != (own, _sign(end))]
        elif kind not in (SPHERE, CAPSULE):
            shapeless.append(model.geom(i).name or f"geom_{i}")
    if shapeless:
        notes.append(f"where the plane stops {', '.join(shapeless)}, which are no spheres and no capsules")
    return found


def _sign(end: int | None) -> int:
    return 1 if end == 1 else -1


def _collide(model: Any, first: int, second: int) -> bool:
    types, affinities = model.geom_contype, model.geom_conaffinity
    return bool((types[first] & affinities[second]) | (types[second] & affinities[first]))


def _end(model: Any, body: str, geom: int, sign: int) -> TouchingPoint:
    """The sphere in the middle of a geom (sign 0), or at an end of a capsule."""
    centre = sp.Matrix(exact_vector(model.geom_pos[geom]))
    if sign:
        centre += sign * rotation_of(model.geom_quat[geom])[:, 2] * exact(model.geom_size[geom][1])
    return TouchingPoint(body=body, point=exact_vector(centre), radius=exact(model.geom_size[geom][0]))


def _of_geom(model: Any, path: Path, body: str, geom: int, end: int | None) -> TouchingPoint:
    name, kind = model.geom(geom).name or f"geom_{geom}", int(model.geom_type[geom])
    if kind not in (SPHERE, CAPSULE):
        raise InputError(f"{path}: geom {name} is no sphere and no capsule; say where it touches with --point X Y Z")
    if kind == CAPSULE and end not in (0, 1):
        raise InputError(f"{path}: geom {name} is a capsule; say which end touches with --end 0 or --end 1")
    return _end(model, body, geom, _sign(end) if kind == CAPSULE else 0)


def _plane(model: Any, geom: int | None) -> Plane:
    if geom is None:
        return Plane(point=ZERO, normal=ALONG_Z, tangents=(ALONG_X, ALONG_Y))
    # the geom's own place in its body, which is at rest in the world: mj_kinematics at the reference
    import mujoco

    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    turn = np.reshape(data.geom_xmat[geom], (3, 3))
    point: Vector = exact_vector(data.geom_xpos[geom])
    first, second, normal = (exact_vector(turn[:, j]) for j in range(3))
    return Plane(point=point, normal=normal, tangents=(first, second))


def _friction(model: Any, own: int | None, floor: int | None) -> sp.Rational:
    values = [float(model.geom_friction[i][0]) for i in (own, floor) if i is not None]
    if own is not None and floor is not None:
        first, second = int(model.geom_priority[own]), int(model.geom_priority[floor])
        if first != second:
            return exact(values[0 if first > second else 1])
    return exact(max(values)) if values else exact(FRICTION)
