"""Write a scene's kernels as readable Python source: common subexpressions shared, only what the scene has.

The file holds `rows_at` (every row at a configuration), `varying_block` (the rows that vary, by plain evaluation,
minus their base values: the thing to compare with), `law_block` (S relative to the limit set through a block), and
`offset_block` and `sample_lane`, which drive the stages.
"""

from __future__ import annotations

from collections.abc import Sequence

from painleve.kernels.law_terms import Names, total, velocity_difference
from painleve.kernels.printing import assignments, indent, renamed, used
from painleve.kernels.rows import Rows
from painleve.kernels.space_source import law_call, space_imports, space_lines
from painleve.mechanics.scene import Scene

__all__ = ["scene_source"]

HEADER = '''"""Kernels of the scene {name}, written by painleve from its derivation; edits are lost.

Rows: {rows}
Varying: {varying}
"""

import math

import numpy as np

from painleve._jit import jit
{law}
from painleve.core.reduce import reduce_block
from painleve.core.sampling import BLOCK, UNIFORM, sample_block
from painleve.core.taylor import monomial_block, polynomial_block

'''

PLANAR_IMPORTS = """from painleve.core.law import FREE, FRICTIONLESS, law_from_rows
from painleve.core.offset import planar_split"""

# The same for every scene, but compiled with it: a compiled function that is passed as an argument is compiled anew
# in every process.
LANE = '''@jit
def offset_block(sampler, seed, start, alphas, shifts, eps, carried, q_uniforms, taylor, polynomials,
                 q, p, base, u, direction, length, impulse, multiplier, critical_edge,
                 x, dv, room, uniforms, monomials, values, branch, along, beyond, across2):
    """Samples start ... start + BLOCK - 1 through all stages."""
    dimension, q_rows = {dimension}, {shape}
    sample_block(sampler, seed, start, alphas, shifts, eps, carried, dimension, q_uniforms, uniforms, q_rows,
                 x, dv, room)
    if taylor:
        monomial_block(polynomials, x, monomials)
        polynomial_block(polynomials, monomials, values)
    else:
        varying_block(x, q, p, base, values)
    law_block(values, room, dv, base, u, direction, length, impulse, multiplier, critical_edge,
              branch, along, beyond, across2)


@jit
def sample_lane(first, blocks, samples, sampler, seed, alphas, shifts, eps, carried, q_uniforms, taylor, polynomials,
                q, p, base, u, direction, length, impulse, multiplier, critical_edge, kind,
                uniform_rows, counts, best, best_index, bins, bin_index):
    """Run `blocks` blocks from block `first` and fold them into this lane's state."""
    dimension, q_rows = {dimension}, {shape}
    rows = q_rows + (1 if sampler == UNIFORM else dimension)
    x = np.empty((rows, BLOCK))
    dv = np.empty((dimension, BLOCK)) if sampler == UNIFORM else x[q_rows:]
    room, uniforms = np.empty(BLOCK), np.empty((uniform_rows, BLOCK))
    monomials, values = np.empty((polynomials.parents.size, BLOCK)), np.empty(({varying_count}, BLOCK))
    branch = np.empty(BLOCK, np.int64)
    along, beyond, across2 = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
    for block in range(first, first + blocks):
        start = block * BLOCK
        offset_block(sampler, seed, start, alphas, shifts, eps, carried, q_uniforms, taylor, polynomials,
                     q, p, base, u, direction, length, impulse, multiplier, critical_edge,
                     x, dv, room, uniforms, monomials, values, branch, along, beyond, across2)
        reduce_block(kind, length, start, min(BLOCK, samples - start), branch, along, beyond, across2,
                     counts, best, best_index, bins, bin_index)


@jit
def law_at(q, p, v, result):
    """S(q, v) by plain evaluation; returns the branch."""
    rows = np.empty({row_count})
    rows_at(q, p, rows)
    return {law}
'''


def scene_source(scene: Scene, rows: Rows, shape: Sequence[int]) -> str:
    """The source text of a scene's kernels."""
    varying = ", ".join(rows.names[r] for r in rows.varying) or "none"
    imports = space_imports(scene) or PLANAR_IMPORTS
    header = HEADER.format(name=scene.name, rows=", ".join(rows.names), varying=varying, law=imports)
    planar = f"law_from_rows(rows, {scene.dimension}, {scene.contact.section.dimension > 0}, v, result)"
    lane = LANE.format(
        dimension=scene.dimension,
        shape=len(shape),
        varying_count=len(rows.varying),
        row_count=len(rows.names),
        law=law_call(scene) or planar,
    )
    parts = [_rows_at(scene, rows), _varying_block(scene, rows, shape), _law_block(scene, rows), lane]
    return header + "\n\n".join(parts)


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


def _law_block(scene: Scene, rows: Rows) -> str:
    axes = [c.name for c in scene.coordinates]
    names = Names(rows)
    before = [f"u_{j} = u[{j}]" for j in range(len(axes))] + [f"k_{j} = direction[{j}]" for j in range(len(axes))]
    before += names.hoisted()
    inside = [f"dv_{j} = dv[{j}, i]" for j in range(len(axes))] + names.loads()
    inside.append(f"v_n = {velocity_difference(names, 'w', axes)}")
    inside.append(f"hit = (v_n < 0.0) & ({names.difference_or_zero('g')} + room[i] >= 0.0)")
    inside += _contact_lines(scene, names, axes)
    inside.append("dot = " + total(f"z_{j}*k_{j}" for j in range(len(axes))))
    inside += [f"z_{j} -= dot*k_{j}" for j in range(len(axes))]
    inside += [
        "branch[i] = code",
        "along[i] = dot + tau*length",
        "beyond[i] = dot + (tau - 1.0)*length",
        "across2[i] = " + total(f"z_{j}*z_{j}" for j in range(len(axes))),
    ]
    signature = (
        "@jit\ndef law_block(values, room, dv, base, u, direction, length, impulse, multiplier, critical_edge,\n"
        "              branch, along, beyond, across2):\n"
    )
    loop = "    for i in range(branch.size):\n" + indent(inside, 2)
    impulse = "" if scene.contact.section.dimension == 2 else "    base_n, base_t = impulse[0], impulse[1]\n"
    return signature + impulse + indent(before, 1) + loop


def _contact_lines(scene: Scene, names: Names, axes: Sequence[str]) -> list[str]:
    if not scene.contact.section.dimension:
        return _frictionless_lines(names, axes)
    return _planar_lines(names, axes) if scene.contact.section.dimension == 1 else space_lines(scene, names, axes)


def _planar_lines(names: Names, axes: Sequence[str]) -> list[str]:
    differences = ", ".join(names.difference_or_zero(n) for n in ("a", "b", "C", "mu_plus", "mu_minus"))
    lines = [
        f"dv_t = {velocity_difference(names, 'H', axes)}",
        "code, tau, e_n, e_t = planar_split(",
        f"    hit, a, b, C, edge_plus, edge_minus, mu_plus, mu_minus, {differences},",
        "    v_n, dv_t, base_n, base_t, multiplier, critical_edge)",
    ]
    for j, x in enumerate(axes):
        terms = [f"dv_{j}"]
        moved = [f"d_{y}_{x}*base_{i}" for y, i in (("Yn", "n"), ("Yt", "t")) if names.difference(f"{y}_{x}")]
        if moved:
            terms.append(f"tau*({total(moved)})")
        terms += [f"{y}_{x}*e_{i}" for y, i in (("Yn", "n"), ("Yt", "t")) if not names.is_zero(f"{y}_{x}")]
        lines.append(f"z_{j} = {total(terms)}")
    return lines


def _frictionless_lines(names: Names, axes: Sequence[str]) -> list[str]:
    lines = ["code = FRICTIONLESS if hit else FREE", "tau = 0.0", "e_n = -v_n/a if hit else 0.0"]
    for j, x in enumerate(axes):
        lines.append(f"z_{j} = dv_{j}" + ("" if names.is_zero(f"Yn_{x}") else f" + Yn_{x}*e_n"))
    return lines
