"""Write a scene's motion kernels as Python source: acceleration, inertia, one step of each scheme, the time loops.

The file holds `motion_at` (rows and M^-1 f), `inertia_at`, `force_at`, `drift_at` (what the curvature of g and, in the
plane, of the tangential displacement add to the contact accelerations), `step`, `run`, `run_members`, and `tabulate`.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from painleve.kernels import planar_motion_text, space_motion_text
from painleve.kernels.motion_text import HEADER, SCHEMES
from painleve.kernels.printing import assignments, indent, renamed, used
from painleve.kernels.rows import Rows
from painleve.mechanics.friction import Polygon
from painleve.mechanics.scene import Scene

__all__ = ["motion_source"]


def motion_source(scene: Scene, rows: Rows) -> str:
    """The source text of a scene's motion kernels; `rows` as painleve.kernels.motion_rows gives them."""
    imports, constants, schemes = _space_text(scene, rows) if scene.friction_dimension > 1 else _planar_text(scene)
    header = HEADER.format(
        name=scene.name,
        rows=", ".join(rows.names),
        dimension=scene.dimension,
        row_count=len(rows.names),
        imports=imports,
        constants=constants,
    )
    M, f = scene.inertia, scene.force
    acceleration = M.adjugate() * f / M.det(method="berkowitz")
    parts = [
        _function(scene, "motion_at", "t, q, u, p", [rows.expressions, list(acceleration)]),
        _function(scene, "rows_at", "q, p", [rows.expressions]),
        _function(scene, "inertia_at", "q, p", [list(M)]),
        _function(scene, "force_at", "t, q, u, p", [list(f)]),
        _function(scene, "drift_at", "q, u, p", [_drifts(scene)]),
        *_vectors(scene),
        _respond(scene),
        _store_impulse(scene),
        schemes,
        SCHEMES,
    ]
    return header + "\n\n".join(parts)


def _planar_text(scene: Scene) -> tuple[str, str, str]:
    """Imports, constants and schemes in the plane."""
    text = planar_motion_text
    return text.IMPORTS, text.CONSTANTS.format(planar=scene.friction is not None), text.PLANAR_SCHEMES


def _space_text(scene: Scene, rows: Rows) -> tuple[str, str, str]:
    """Imports, constants and schemes in space."""
    text, section = space_motion_text, scene.friction
    polygon = isinstance(section, Polygon)
    law = text.POLYGON if polygon else text.CONIC
    vertices = f"VERTICES = {len(section.vertices)}\n" if isinstance(section, Polygon) else ""
    constants = text.CONSTANTS.format(vertices=vertices, section=rows.index("E_11"))
    return text.IMPORTS.format(**law), constants, text.SPACE_SCHEMES.format(**law)


def _drifts(scene: Scene) -> list[sp.Expr]:
    """(dW/dt)^T u, in space of the normal alone: the contact accelerations are W^T du/dt and these."""
    u = sp.Matrix(scene.u)
    columns = [sp.Matrix([-sp.diff(scene.constraint, x) for x in scene.q])]
    if scene.friction_dimension < 2:
        columns.append(scene.tangents if scene.friction is not None else sp.zeros(scene.dimension, 1))
    return [(u.T * column.jacobian(scene.q) * u)[0, 0] for column in columns]


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
    return f"@jit\ndef {name}({arguments}):\n" + indent([*lines, f"return {', '.join(results)}"], 1)


def _each(scene: Scene, component: str) -> str:
    """A d-tuple, written out: a loop cannot build one. {j} is the component, {n} and {t} are its rows in M^-1 W."""
    d, first = scene.dimension, 3 + (3 if scene.friction_dimension < 2 else 4) * scene.dimension
    filled = (component.format(j=j, n=1 + d + j, t=first + j, t2=first + d + j) for j in range(d))
    return "(" + "".join(f"{x}, " for x in filled) + ")"


def _define(head: str, lines: Sequence[str]) -> str:
    return f"@jit\ndef {head}:\n" + indent(lines, 1)


def _vectors(scene: Scene) -> list[str]:
    """Arithmetic of d-tuples."""
    d = range(scene.dimension)
    near = " and ".join(f"abs(x[{j}] - y[{j}]) <= bound" for j in d)
    bodies = {
        "add(x, s, y)": [f"return {_each(scene, 'x[{j}] + s*y[{j}]')}"],
        "mix(s, x, y)": [f"return {_each(scene, '(1.0 - s)*x[{j}] + s*y[{j}]')}"],
        "size_of(x)": [f"return {' + '.join(f'abs(x[{j}])' for j in d)}"],
        # Against the free velocity v too: x is v plus an impulse, and rounding in v is all that is left of x at rest.
        "close(x, y, v, noise)": ["bound = ACCURACY*(size_of(x) + size_of(v)) + noise", f"return {near}"],
        "load(x, i)": [f"return {_each(scene, 'x[i, {j}]')}"],
        "store(x, i, y)": [f"x[i, {j}] = y[{j}]" for j in d],
    }
    return [_define(head, lines) for head, lines in bodies.items()]


def _respond(scene: Scene) -> str:
    """v + M^-1 W r."""
    frictionless = "v[{j}] + rows[{n}]*r_n"
    if scene.friction_dimension > 1:
        moved = _each(scene, frictionless + " + rows[{t}]*r_1 + rows[{t2}]*r_2")
        return _define("respond(rows, r_n, r_1, r_2, v)", [f"return {moved}"])
    moved = _each(scene, frictionless + (" + rows[{t}]*r_t" if scene.friction is not None else ""))
    return _define("respond(rows, r_n, r_t, v)", [f"return {moved}"])


def _store_impulse(scene: Scene) -> str:
    """The impulse of a step into the array of the trajectory, in physical tangents."""
    if scene.friction_dimension < 2:
        lines = [f"x[i, {k}] = r[{k}]" for k in range(2)]
    else:
        rows = [f"rows[SECTION + {2 * k}]*r[1] + rows[SECTION + {2 * k + 1}]*r[2]" for k in range(2)]
        lines = ["x[i, 0] = r[0]", *(f"x[i, {k + 1}] = {row}" for k, row in enumerate(rows))]
    return _define("store_impulse(x, i, rows, r)", lines)
