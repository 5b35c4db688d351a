"""Write a scene's kernels as readable Python source: common subexpressions shared, only what the scene has.

The file holds `rows_at` (every row at a configuration), `varying_block` (the rows that vary, by plain evaluation,
minus their base values: the thing to compare with), `law_block` (S relative to the limit set through a block), `law`
(S from the rows), and what the template painleve.kernels.law.lane makes of them.
"""

from __future__ import annotations

from collections.abc import Sequence

from painleve.kernels.law import lane
from painleve.kernels.law_terms import Names, total, velocity_difference
from painleve.kernels.printing import assignments, indent, renamed, used
from painleve.kernels.rows import Rows
from painleve.kernels.sections.listed import kernels_of
from painleve.kernels.templates import write_out
from painleve.mechanics.scene import Scene

__all__ = ["scene_source"]

PACKAGE = "painleve.kernels.law"


def scene_source(scene: Scene, rows: Rows, shape: Sequence[int]) -> str:
    """The source text of a scene's kernels."""
    functions = [_rows_at(scene, rows), _varying_block(scene, rows, shape), _law_block(scene, rows), _law(scene)]
    numbers = {"D": scene.dimension, "SHAPE": len(shape), "ROWS": len(rows.names), "VARYING": len(rows.varying)}
    varying = ", ".join(rows.names[r] for r in rows.varying) or "none"
    head = f'"""Kernels of the scene {scene.name}, written by painleve from its derivation; edits are lost.\n\n'
    head += f'Rows: {", ".join(rows.names)}\nVarying: {varying}\n"""\n\nimport math\n'
    head += f"{kernels_of(scene.contact).imports}\n"
    return head + write_out(PACKAGE, [lane], numbers, [f.rstrip() for f in functions])


def _rows_at(scene: Scene, rows: Rows) -> str:
    names, q, p = renamed(scene)
    expressions = [e.xreplace(names) for e in rows.expressions]
    lines = [f"{n} = q[{i}]" for i, n in used(q, expressions)] + [f"{n} = p[{i}]" for i, n in used(p, expressions)]
    lines += assignments(expressions, [f"rows[{r}]" for r in range(len(expressions))])
    return "@jit\ndef rows_at(q, p, rows):\n" + indent(lines, 1)


def _varying_block(scene: Scene, rows: Rows, shape: Sequence[int]) -> str:
    names, q, p = renamed(scene)
    expressions = [rows.expressions[r].xreplace(names) for r in rows.varying]
    moving = [q[i] for i in shape]
    before = [f"{n} = q[{i}]" for i, n in used(q, expressions) if n not in moving]
    before += [f"{n} = p[{i}]" for i, n in used(p, expressions)]
    inside = [f"{q[i]} = q[{i}] + dq[{j}, i]" for j, i in enumerate(shape)]
    inside += assignments(expressions, [f"row_{k}" for k in range(len(expressions))])
    inside += [f"values[{k}, i] = row_{k} - base[{r}]" for k, r in enumerate(rows.varying)]
    body = indent(before, 1) + "    for i in range(values.shape[1]):\n" + indent(inside, 2)
    if not rows.varying:
        body = "    return\n"
    return "@jit\ndef varying_block(dq, q, p, base, values):\n" + body


def _law(scene: Scene) -> str:
    call = kernels_of(scene.contact).law_call(scene.dimension)
    return "@jit\ndef law(rows, v, result):\n" + indent([f"return {call}"], 1)


def _law_block(scene: Scene, rows: Rows) -> str:
    axes = [c.name for c in scene.coordinates]
    names = Names(rows)
    before = [
        "u, direction, length, base, impulse = state.u, state.direction, state.length, state.base, state.impulse",
        "multiplier, critical_edge = state.multiplier, state.critical_edge",
        "branch, along, beyond, across2 = result",
        *(f"u_{j} = u[{j}]" for j in range(len(axes))),
        *(f"k_{j} = direction[{j}]" for j in range(len(axes))),
        *names.hoisted(),
    ]
    inside = [f"dv_{j} = dv[{j}, i]" for j in range(len(axes))] + names.loads()
    inside.append(f"v_n = {velocity_difference(names, 'w', axes)}")
    inside.append(f"hit = (v_n < 0.0) & ({names.difference_or_zero('g')} + room[i] >= 0.0)")
    inside += kernels_of(scene.contact).law_lines(names, axes)
    inside.append("dot = " + total(f"z_{j}*k_{j}" for j in range(len(axes))))
    inside += [f"z_{j} -= dot*k_{j}" for j in range(len(axes))]
    inside += [
        "branch[i] = code",
        "along[i] = dot + tau*length",
        "beyond[i] = dot + (tau - 1.0)*length",
        "across2[i] = " + total(f"z_{j}*z_{j}" for j in range(len(axes))),
    ]
    loop = "    for i in range(branch.size):\n" + indent(inside, 2)
    return "@jit\ndef law_block(values, room, dv, state, result):\n" + indent(before, 1) + loop
