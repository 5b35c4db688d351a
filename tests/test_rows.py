"""The rows that kernels write stand where painleve.core.rows says, and are what they are called."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import sympy as sp
from dynamics_scenes import space_block

from painleve.core.rows import RowLayout, row_layout, row_parts
from painleve.core.sections.polygon import polygon_rows
from painleve.core.sections.segment import segment_rows
from painleve.kernels.rows import Rows, rows_of
from painleve.mechanics.derive import derive
from painleve.mechanics.library import SCENE_NAMES, load_scene
from painleve.mechanics.scene import Scene

SCENES = {name: load_scene(name) for name in SCENE_NAMES} | {"kite": space_block("kite")}
DEFAULTS = {"mu": 0.7, "nu": 0.4, "beta": 0.3, "c": 0.2}  # of the scene whose parameters are 0 by default


@cache
def numbers(name: str) -> dict[sp.Symbol, float]:
    """Some configuration and parameters at which M is positive definite."""
    scene, random = SCENES[name], np.random.default_rng(5)
    values = {p.symbol: DEFAULTS.get(p.name, float(random.uniform(0.5, 1.0))) for p in scene.parameters}
    return values | {x: float(random.uniform(0.3, 0.6)) for x in scene.q}


def evaluated(scene: Scene, expressions: list[sp.Expr], name: str) -> np.ndarray:
    point = numbers(name)
    return np.array([float(sp.sympify(e).evalf(subs=point)) for e in expressions])


@pytest.mark.parametrize("name", list(SCENES))
def test_each_part_of_the_rows_is_what_its_name_says(name: str):
    """Against linear algebra in floats from M, g, H and the section alone."""
    scene = SCENES[name]
    rows: Rows = rows_of(derive(scene))
    table, at, d = evaluated(scene, list(rows.expressions), name), rows.parts, scene.dimension
    M = evaluated(scene, list(scene.inertia), name).reshape(d, d)
    w_n = evaluated(scene, [-sp.diff(scene.contact.constraint, x) for x in scene.q], name)
    H = evaluated(scene, list(scene.contact.tangents), name).reshape(d, -1)
    E = np.eye(H.shape[1])
    if hasattr(scene.contact.section, "map"):
        E = evaluated(scene, list(scene.contact.section.map), name).reshape(2, 2)
    H = H @ E
    G = (W := np.column_stack([w_n, H])).T @ np.linalg.solve(M, W)
    k = H.shape[1]
    found = {
        "g": table[at.g],
        "w_n": table[at.w_n],
        "Y_n": table[at.Y_n],
        "a": table[at.a],
        "H": np.array([table[part] for part in at.H]),
        "Y_t": np.array([table[part] for part in at.Y_t]),
        "b": table[at.b],
        "C": table[at.C],
    }
    wanted = {
        "g": evaluated(scene, [scene.contact.constraint], name)[0],
        "w_n": w_n,
        "Y_n": np.linalg.solve(M, w_n),
        "a": G[0, 0],
        "H": H.T,
        "Y_t": np.linalg.solve(M, H).T,
        "b": G[0, 1:],
        "C": G[1:, 1:][np.triu_indices(k)],
    }
    for part, value in wanted.items():
        assert np.asarray(found[part]).ravel() == pytest.approx(np.asarray(value).ravel(), rel=1e-9, abs=1e-12), part
    a, b = G[0, 0], G[0, 1:]
    edge_plus, section = a, np.zeros(0)
    if k == 1:
        minus, plus = evaluated(scene, [scene.contact.section.minus, scene.contact.section.plus], name)
        edge_plus, section = a + plus * b[0], np.array([a - minus * b[0], plus, minus])
    elif hasattr(scene.contact.section, "vertices"):
        vertices = evaluated(scene, [x for v in scene.contact.section.vertices for x in v], name).reshape(-1, 2)
        section = np.concatenate([a + vertices @ b, vertices.ravel()])
    elif k == 2:
        edge_plus = a - np.linalg.norm(b)
    assert table[at.edge_plus] == pytest.approx(edge_plus)
    assert table[at.section] == pytest.approx(section)
    assert len(table) == at.section.stop


@pytest.mark.parametrize("name", list(SCENES))
def test_the_rows_of_a_section_are_where_compiled_code_looks_for_them(name: str):
    scene = SCENES[name]
    rows, d, k = rows_of(derive(scene)), scene.dimension, scene.contact.section.dimension
    layout = row_layout(d, k)
    if k == 1:
        assert [rows.names[i] for i in segment_rows(layout)] == ["edge_minus", "mu_plus", "mu_minus"]
    vertices = len(getattr(scene.contact.section, "vertices", ()))
    if vertices:
        own = polygon_rows(layout, vertices)
        assert (rows.names[own.p], rows.names[own.s]) == ("p_1", "s_1_1")


@pytest.mark.parametrize("d", [1, 2, 3, 6, 12])
@pytest.mark.parametrize("k", [0, 1, 2])
def test_compiled_offsets_and_parts_agree_and_leave_no_gap(d: int, k: int):
    layout, parts = row_layout(d, k), row_parts(d, k, 7)
    assert isinstance(layout, RowLayout)
    order = [parts.g, parts.w_n, parts.Y_n, parts.a, parts.edge_plus, *parts.H, *parts.Y_t, parts.b, parts.C]
    order.append(parts.section)
    slices = [x if isinstance(x, slice) else slice(x, x + 1) for x in order]
    covered = [i for s in slices for i in range(s.start, s.stop)]
    assert covered == list(range(layout.section + 7))
    for name, offset in layout._asdict().items():
        part = getattr(parts, name)
        for begin in part[:1] if isinstance(part, tuple) else [part]:
            assert offset == (begin.start if isinstance(begin, slice) else begin), name
