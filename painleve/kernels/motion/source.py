"""Write a scene's motion kernels as Python source: its own functions, and the templates of this package.

The file holds what painleve.kernels.motion.sample defines for one scene, from the formulas of this one, and what the
templates define: `step`, `run`, `run_members`, `tabulate`.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from painleve.kernels.motion import contact, loops, tuples
from painleve.kernels.motion.rows import MotionRows
from painleve.kernels.printing import assignments, indent, renamed, used
from painleve.kernels.sections.listed import kernels_of
from painleve.kernels.templates import write_out
from painleve.mechanics.scene import Scene

__all__ = ["motion_source"]

PACKAGE = "painleve.kernels.motion"


def motion_source(scene: Scene, rows: MotionRows) -> str:
    """The source text of a scene's motion kernels; `rows` as painleve.kernels.motion.rows gives them."""
    M, f = scene.inertia, scene.force
    acceleration = M.adjugate() * f / M.det(method="berkowitz")
    functions = [
        _function(scene, "motion_at", "t, q, u, p", [rows.expressions, list(acceleration)]),
        _function(scene, "rows_at", "q, p", [rows.expressions]),
        _function(scene, "inertia_at", "q, p", [list(M)]),
        _function(scene, "force_at", "t, q, u, p", [list(f)]),
        _function(scene, "drift_at", "q, u, p", [_drifts(scene)]),
        _function(scene, "depths_at", "q, p", [_depths(scene)]),
    ]
    section = kernels_of(scene.contact)
    constants = section.motion_constants({name: i for i, name in enumerate(rows.names)})
    constants |= {"D": scene.dimension, "ROWS": len(rows.names)}
    templates = [tuples, section.motion_template, contact, *section.scheme_templates, loops]
    head = f'"""Motion of the scene {scene.name}, written by painleve from its derivation; edits are lost.\n\n'
    head += f'Rows: {", ".join(rows.names)}\n"""\n\nimport math\n\n'
    return head + write_out(PACKAGE, templates, constants, functions)


def _drifts(scene: Scene) -> list[sp.Expr]:
    """(dW/dt)^T u, in space of the normal alone: the contact accelerations are W^T du/dt and these."""
    u, turning = sp.Matrix(scene.u), kernels_of(scene.contact).drifting(scene.contact)
    columns = [sp.Matrix([-sp.diff(scene.contact.constraint, x) for x in scene.q])]
    columns += [turning[:, j] for j in range(turning.cols)]
    return [(u.T * column.jacobian(scene.q) * u)[0, 0] for column in columns]


def _depths(scene: Scene) -> list[sp.Expr]:
    """How far below the floor the points of the outline are that the contact does not hold up; -inf without any."""
    depths = scene.outline.depths(scene.contact.constraint) if scene.outline else {}
    return list(depths.values()) or [-sp.oo]


def _function(scene: Scene, name: str, arguments: str, tuples: Sequence[Sequence[sp.Expr]]) -> str:
    """A function that returns a tuple of numbers, or several."""
    names, q, p = renamed(scene)
    velocities = [f"u_{c.name}" for c in scene.coordinates]
    names |= {c.velocity: sp.Symbol(f"u_{c.name}", real=True) for c in scene.coordinates}
    expressions = [sp.sympify(e).xreplace(names) for group in tuples for e in group]
    lines = [f"{n} = q[{i}]" for i, n in used(q, expressions)]
    lines += [f"{n} = u[{i}]" for i, n in used(velocities, expressions)]
    lines += [f"{n} = p[{i}]" for i, n in used(p, expressions)]
    targets = [f"value_{k}" for k in range(len(expressions))]
    lines += assignments(expressions, targets)
    left = iter(targets)
    results = ["(" + "".join(f"{next(left)}, " for _ in group) + ")" for group in tuples]
    return f"@jit\ndef {name}({arguments}):\n" + indent([*lines, f"return {', '.join(results)}"], 1).rstrip()
