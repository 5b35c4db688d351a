"""Steps of small scenes by every scheme: compiled here, and without a compiler where this file is run as a program.

NUMBA_DISABLE_JIT=1 python plain_motion.py FILE writes what the templates do as they stand, on the scene of their
sample, and what they do written out for scenes with friction in space and without friction.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from functools import cache

import numpy as np
import sympy as sp
from dynamics_scenes import U_X, T, X, Y, block, space_block

from painleve.core.motion_codes import FixedStep
from painleve.core.stepping import Fates, Rounding, SteppingMethod, Track
from painleve.kernels.motion.compiled import make_motion
from painleve.mechanics.friction import Segment
from painleve.mechanics.scene import Coordinate, Outline, Parameter, Scene, make_scene

STEP, STEPS, MEMBERS = 6e-3, 120, 8
IN_SPACE = (FixedStep.CONTACT_DYNAMICS, FixedStep.MOREAU_JEAN)


@cache
def parabola() -> Scene:
    """The scene of painleve.kernels.motion.sample."""
    parameters = [Parameter(name=n, unit="1", sentence=n, default="0") for n in ("mu", "weight", "drag", "beat")]
    mu, weight, drag, beat = (p.symbol for p in parameters)
    return make_scene(
        name="parabola",
        sentence="a point on a parabola",
        source="docs/theory.md, section 6, minimal scene",
        coordinates=[Coordinate(name=n, unit="m", sentence=n) for n in ("x", "y")],
        parameters=parameters,
        inertia=sp.eye(2),
        force=sp.Matrix([-drag * U_X + beat * T, -weight]),
        constraint=X**2 / 2 - Y,
        tangential_displacements=[X],
        friction=Segment(minus=mu, plus=mu),
        outline=Outline(points=((X, X + Y + sp.Rational(1, 4)),), floor=sp.Integer(0)),
    )


def cases(scene: Scene, seed: int) -> tuple[np.ndarray, np.ndarray, tuple[float, ...]]:
    """q, u (members, d) near contact, and the parameters."""
    random = np.random.default_rng(seed)
    d = scene.dimension
    q, u = random.normal(0.0, 1.0, (MEMBERS, d)), random.normal(0.0, 2.0, (MEMBERS, d))
    q[:, -1] = random.choice([0.0, 0.1, 10.0], MEMBERS) + (q[:, 0] ** 2 / 2.0 if scene is parabola() else 0.0)
    u[:, -1] = random.normal(0.0, 0.3, MEMBERS)
    ranges = {"mu": (1.0, 4.0), "nu": (0.2, 1.0), "weight": (5.0, 20.0), "drag": (0.0, 2.0), "beat": (-5.0, 5.0)}
    p = tuple(float(random.uniform(*ranges.get(s.name, (-0.4, 0.4)))) for s in scene.parameters)
    return q, u, p


def stepped(scene: Scene, run: Callable, run_members: Callable, method: SteppingMethod) -> dict[str, np.ndarray]:
    """Every column of the tracks of the members, one after the other, and of their fates."""
    (q, u, p), d, n = cases(scene, method.scheme), scene.dimension, STEPS + 1
    tracks = []
    for i in range(MEMBERS):
        room = (np.zeros((n, width)) for width in (d, d, 1 + max(1, scene.contact.section.dimension)))
        tracks.append(Track(*room, *(np.zeros(n, np.int8) for _ in range(3))))
        tracks[-1].q[0], tracks[-1].u[0] = q[i], u[i]
        run(method, 0, math.inf, STEP * np.arange(n), *[np.full(STEPS, STEP)] * 2, p, tracks[-1])
    fates = Fates(np.zeros(MEMBERS, np.int8), np.zeros(MEMBERS), np.zeros(MEMBERS, np.int64))
    run_members(method, Rounding(0.0, 0.0), 0.0, 1.0, STEP * np.linspace(0.3, 2.0, MEMBERS), q, u, p, fates)
    columns = zip(Track._fields, zip(*tracks, strict=True), strict=True)
    return {name: np.concatenate(parts) for name, parts in columns} | fates._asdict()


def everything(plain: bool) -> dict[str, np.ndarray]:
    """What each scheme does on each scene, by "scene scheme column"."""
    found = {}
    for scene in (parabola(), block(frictional=False), space_block("ellipse"), space_block("kite")):
        run, run_members = functions(scene, plain)
        for scheme in IN_SPACE if scene.contact.section.dimension > 1 else FixedStep:
            columns = stepped(scene, run, run_members, SteppingMethod(int(scheme), 0.5, 1e-3))
            found |= {f"{scene.name} {scheme.name} {name}": column for name, column in columns.items()}
    return found


def functions(scene: Scene, plain: bool) -> tuple[Callable, Callable]:
    if plain and scene is parabola():
        from painleve.kernels.motion import loops

        return loops.run, loops.run_members
    motion = make_motion(scene)
    return motion.run, motion.run_members


if __name__ == "__main__":
    np.savez(sys.argv[1], **everything(plain=True))
