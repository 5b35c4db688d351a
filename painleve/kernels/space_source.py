"""The part of a scene's kernels that knows friction in space."""

from __future__ import annotations

from collections.abc import Sequence

from painleve.kernels.law_terms import Names, total, velocity_difference
from painleve.mechanics.friction import Polygon
from painleve.mechanics.scene import Scene

__all__ = ["law_call", "space_imports", "space_lines"]

CONIC_IMPORTS = """from painleve.core.space.law import conic_law_from_rows
from painleve.core.space.offset import conic_split"""
POLYGON_IMPORTS = """from painleve.core.space.polygon_offset import polygon_split
from painleve.core.space.law import polygon_law_from_rows"""
IMPULSES = (("Yn", "n"), ("Y1", "1"), ("Y2", "2"))


def space_imports(scene: Scene) -> str | None:
    """What the law's lines call; None unless friction is in space."""
    if scene.contact.section.dimension != 2:
        return None
    return POLYGON_IMPORTS if isinstance(scene.contact.section, Polygon) else CONIC_IMPORTS


def law_call(scene: Scene) -> str | None:
    """The call of S from a row table; None unless friction is in space."""
    if scene.contact.section.dimension != 2:
        return None
    if isinstance(scene.contact.section, Polygon):
        return f"polygon_law_from_rows(rows, {scene.dimension}, {len(scene.contact.section.vertices)}, v, result)"
    return f"conic_law_from_rows(rows, {scene.dimension}, v, result)"


def space_lines(scene: Scene, names: Names, axes: Sequence[str]) -> list[str]:
    """From v_n and `hit` to the code, tau and z of a sample (painleve.core.space.offset)."""
    lines = [f"dt_{k} = {velocity_difference(names, f'H{k}', axes)}" for k in (1, 2)]
    section = scene.contact.section
    lines += _polygon_call(section, names) if isinstance(section, Polygon) else _conic_call(names)
    for j, x in enumerate(axes):
        moved = [f"d_{y}_{x}*impulse.jump_{i}" for y, i in IMPULSES if names.difference(f"{y}_{x}")]
        terms = [f"dv_{j}"] + ([f"tau*({total(moved)})"] if moved else [])
        terms += [f"{y}_{x}*e_{i}" for y, i in IMPULSES if not names.is_zero(f"{y}_{x}")]
        lines.append(f"z_{j} = {total(terms)}")
    return lines


def _values(names: Names, *rows: str) -> str:
    return ", ".join("0.0" if names.is_zero(row) else row for row in rows)


def _differences(names: Names, *rows: str) -> str:
    return ", ".join(names.difference_or_zero(row) for row in rows)


def _conic_call(names: Names) -> list[str]:
    rows = ("a", "b_1", "b_2", "C_11", "C_12", "C_22")
    return [
        "code, tau, e_n, e_1, e_2 = conic_split(",
        f"    hit, a, edge_plus, {_values(names, *rows[1:])}, {_differences(names, *rows)},",
        "    v_n, dt_1, dt_2, impulse, critical_edge)",
    ]


def _polygon_call(polygon: Polygon, names: Names) -> list[str]:
    """The polygon's vertices and their compliances as tuples, which cost no allocation."""
    rows, n = ("a", "b_1", "b_2", "C_11", "C_12", "C_22"), len(polygon.vertices)
    groups = [[f"p_{i + 1}" for i in range(n)]] + [[f"s_{k}_{i + 1}" for i in range(n)] for k in (1, 2)]
    values = ", ".join(f"({_values(names, *group)})" for group in groups)
    changes = ", ".join(f"({_differences(names, *group)})" for group in groups)
    return [
        "code, tau, e_n, e_1, e_2 = polygon_split(",
        f"    hit, a, {_values(names, *rows[1:])}, {_differences(names, *rows)},",
        f"    {values}, {changes},",
        "    v_n, dt_1, dt_2, impulse, critical_edge)",
    ]
