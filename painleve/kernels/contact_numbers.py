"""The contact quantities of many configurations at once, in floats, for scenes of any size.

M^-1 W is solved for at each configuration with the zeros of M that the mechanism has, so no closed form is needed. One
straight-line function is written out for the scene and compiled; its columns have names.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp

from painleve.exact.program import make_program
from painleve.exact.tape import Tape, TapeBuilder
from painleve.kernels.factor_text import FactorText
from painleve.kernels.files import load_generated
from painleve.kernels.program_text import program_lines
from painleve.mechanics.scene import Scene
from painleve.mechanics.tree.contact import contact_of
from painleve.mechanics.tree.kinematics import place
from painleve.mechanics.tree.vectors import Algebra

__all__ = ["ContactNumbers", "make_contact_numbers"]

HEADER = '''"""Contact quantities of the scene {name}, written by painleve; edits are lost.

Columns: {columns}
"""

import math

from painleve._jit import jit


@jit
def contact_numbers(q, p, out):
    for i in range(q.shape[0]):
'''


@dataclass(frozen=True, eq=False)
class ContactNumbers:
    """A scene's compiled function and the columns that it fills.

    height: -g; squared: |grad g|^2; a; b_1 ... b_k; pivot: the least pivot of M, positive exactly where M is positive
    definite; edge_<number>: a + b.s on that edge of the friction cone; least: the least a + b.s over the section;
    other_1 ...: heights of a mechanism's other points over the plane.
    """

    scene: Scene
    columns: tuple[str, ...]
    function: Any
    digest: str

    def at(self, q: np.ndarray, p: np.ndarray) -> dict[str, np.ndarray]:
        """The columns (n,) at configurations q (n, d) and parameters p (n, number of parameters)."""
        q, p = np.ascontiguousarray(q, dtype=float), np.ascontiguousarray(p, dtype=float)
        out = np.empty((len(q), len(self.columns)))
        self.function(q, p, out)
        return dict(zip(self.columns, out.T, strict=True))


@lru_cache(maxsize=32)
def make_contact_numbers(scene: Scene) -> ContactNumbers:
    """Write the function for a scene, and compile it at its first call or find it in the cache."""
    contact, section, d = scene.contact, scene.contact.section, scene.dimension
    w_n = contact.normal if contact.normal is not None else _gradient(scene)
    lower = [scene.inertia[i, j] for i in range(d) for j in range(i + 1)]
    others, steps = _other_heights(scene)
    wanted = [*lower, *w_n, *contact.tangents.T, -contact.constraint, *others]
    program = make_program(wanted, Tape((*scene.definitions.steps, *steps)))
    inputs = {x: f"q_{i}" for i, x in enumerate(scene.q)} | {x: f"p_{i}" for i, x in enumerate(scene.p)}
    lines, names = program_lines(program, inputs, "s_")
    M, rest = _lower(names, d), [_blank(name) for name in names[len(lower) :]]
    k = section.dimension
    columns = [rest[j * d : (j + 1) * d] for j in range(1 + k)]
    height, *heights = names[len(lower) + (1 + k) * d :]
    factor = FactorText(M, "f_")
    lines += factor.lines
    responses = []
    for j, column in enumerate(columns):
        more, response = factor.solve(column, f"y_{j}")
        lines += more
        responses.append(response)
    table = {"height": height, "squared": _dot(columns[0], columns[0]), "a": _dot(columns[0], responses[0])}
    table |= {f"b_{j}": _dot(columns[j], responses[0]) for j in range(1, 1 + k)}
    table["pivot"] = f"min({', '.join(factor.pivots)})" if d > 1 else factor.pivots[0]
    more, compliances = _compliances(scene, inputs, table)
    table |= compliances | {f"other_{j + 1}": name for j, name in enumerate(heights)}
    return _load(scene, [*lines, *more], table)


def _load(scene: Scene, lines: Sequence[str], table: dict[str, str]) -> ContactNumbers:
    used = "\n".join([*lines, *table.values()])
    before = [f"q_{i} = q[i, {i}]" for i in range(scene.dimension) if f"q_{i}" in used]
    before += [f"p_{i} = p[i, {i}]" for i in range(len(scene.p)) if f"p_{i}" in used]
    after = [f"out[i, {c}] = {text or '0.0'}" for c, text in enumerate(table.values())]
    body = "".join(f"        {line}\n" for line in (*before, *lines, *after))
    text = HEADER.format(name=scene.name, columns=", ".join(table)) + body
    module, digest, _ = load_generated(f"contact_{scene.name}", text)
    return ContactNumbers(scene, tuple(table), module.contact_numbers, digest)


def _gradient(scene: Scene) -> sp.ImmutableMatrix:
    return sp.ImmutableMatrix([-sp.diff(scene.contact.constraint, x) for x in scene.q])


def _other_heights(scene: Scene) -> tuple[list[sp.Expr], tuple[tuple[sp.Symbol, sp.Expr], ...]]:
    """Heights of a mechanism's other points, and the steps of a tape for them."""
    if scene.tree is None or not scene.tree.others:
        return [], ()
    builder = TapeBuilder("_o")
    algebra = Algebra(builder)
    pose = place(scene.tree.mechanism, algebra)
    heights = [contact_of(point, scene.tree.plane, pose, algebra).height for point in scene.tree.others]
    return heights, builder.tape.steps


def _compliances(scene: Scene, inputs: dict[sp.Symbol, str], table: dict[str, str]) -> tuple[list[str], dict[str, str]]:
    """a + b.s on each edge of the cone and the least of all, from the values of a and b."""
    section = scene.contact.section
    a = sp.Symbol("_a", real=True)
    b = sp.Matrix([sp.Symbol(f"_b_{j}", real=True) for j in range(1, 1 + section.dimension)])
    wanted = {f"edge_{edge}".replace("-", "m"): section.compliance(edge, a, b) for edge in section.edges}
    wanted["least"] = section.least_compliance(a, b)
    program = make_program(list(wanted.values()), scene.definitions)
    known = inputs | {a: "a_0"} | {x: f"b_{j + 1}" for j, x in enumerate(b)}
    lines, names = program_lines(program, known, "e_")
    first = [f"a_0 = {table['a']}", *(f"b_{j} = {table[f'b_{j}'] or '0.0'}" for j in range(1, 1 + section.dimension))]
    return [*first, *lines], dict(zip(wanted, names, strict=True))


def _lower(names: Sequence[str], d: int) -> list[list[str]]:
    entries = iter(names)
    return [[_blank(next(entries)) for _ in range(i + 1)] for i in range(d)]


def _blank(name: str) -> str:
    return "" if name == "0.0" else name


def _dot(left: Sequence[str], right: Sequence[str]) -> str:
    return " + ".join(f"{x}*{y}" for x, y in zip(left, right, strict=True) if x and y)
