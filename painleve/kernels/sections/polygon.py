"""The kernels of a contact in space with a polygon."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType

import sympy as sp

from painleve.core.rows import RowParts
from painleve.kernels.law_terms import Names, offset_lines
from painleve.kernels.motion.schemes.listed import IN_SPACE
from painleve.kernels.motion.sections import polygon
from painleve.kernels.sections.section import Entries, common_parts
from painleve.kernels.sections.space import IMPULSES, delassus_text, slip_lines, space_parts, values_text
from painleve.mechanics.contact import Contact
from painleve.mechanics.derive import Derivation
from painleve.mechanics.sections.polygon import Polygon

__all__ = ["PolygonKernels"]

IMPORTS = """from painleve.core.sections.polygon import PolygonCorners, law_from_rows, split
from painleve.core.space.tangent_plane import Delassus"""


@dataclass(frozen=True)
class PolygonKernels:
    """See painleve.kernels.sections.section."""

    section: Polygon
    imports: str = IMPORTS
    motion_template: ModuleType = polygon
    scheme_templates: Sequence[ModuleType] = IN_SPACE

    @property
    def count(self) -> int:
        return len(self.section.vertices)

    def parts(self, derivation: Derivation, axes: Sequence[str]) -> Mapping[str, Entries]:
        common = common_parts(derivation, axes, derivation.a) | space_parts(derivation, axes, sp.eye(2))
        return common | {"section": list(self._entries(derivation))}

    def _entries(self, derivation: Derivation) -> Iterator[tuple[str, sp.Expr]]:
        yield from ((f"p_{edge}", p) for edge, p in derivation.edge_compliance.items())
        for i, vertex in enumerate(self.section.vertices):
            yield from ((f"s_{k + 1}_{i + 1}", s) for k, s in enumerate(vertex))

    def edge_rows(self, at: RowParts) -> Mapping[int, int]:
        return {edge: at.section.start + edge - 1 for edge in self.section.edges}

    def law_call(self, dimension: int) -> str:
        return f"law_from_rows(rows, {dimension}, {self.count}, v, result)"

    def law_lines(self, names: Names, axes: Sequence[str]) -> list[str]:
        """The vertices and their compliances as tuples, which cost no allocation."""
        each = range(1, self.count + 1)
        groups = [[f"p_{i}" for i in each], [f"s_1_{i}" for i in each], [f"s_2_{i}" for i in each]]
        value, change = delassus_text(names)
        texts = zip(*(values_text(names, group) for group in groups), strict=True)
        corners, moved = (", ".join(f"({text})" for text in column) for column in texts)
        return [
            *slip_lines(names, axes),
            f"corners, moved = PolygonCorners({corners}), PolygonCorners({moved})",
            f"code, tau, e_n, e_1, e_2 = split(hit, {value}, {change}, corners, moved, dt, impulse, critical_edge)",
            *offset_lines(names, axes, IMPULSES, "impulse.jump"),
        ]

    def motion_constants(self, rows: Mapping[str, int]) -> dict[str, int]:
        return {"VERTICES": self.count}

    def own_tangents(self, derivation: Derivation) -> None:
        return None

    def drifting(self, contact: Contact) -> sp.MatrixBase:
        return sp.zeros(contact.tangents.rows, 0)
