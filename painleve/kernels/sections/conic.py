"""The kernels of a contact in space with a disc or an ellipse, which come as the unit disc: H stands for H E.

edge_plus is a - |b|, an expression of its own: its expansion has no cancellation where it vanishes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType

import sympy as sp

from painleve.core.rows import RowParts
from painleve.kernels.law_terms import Names, offset_lines
from painleve.kernels.motion.schemes.listed import IN_SPACE
from painleve.kernels.motion.sections import conic
from painleve.kernels.sections.section import Entries, OwnTangents, common_parts
from painleve.kernels.sections.space import IMPULSES, delassus_text, slip_lines, space_parts
from painleve.mechanics.contact import Contact
from painleve.mechanics.derive import Derivation
from painleve.mechanics.sections.conic import Disc, Ellipse

__all__ = ["ConicKernels"]

IMPORTS = """from painleve.core.sections.conic import law_from_rows, split
from painleve.core.space.tangent_plane import Delassus"""


@dataclass(frozen=True)
class ConicKernels:
    """See painleve.kernels.sections.section."""

    section: Disc | Ellipse
    imports: str = IMPORTS
    motion_template: ModuleType = conic
    scheme_templates: Sequence[ModuleType] = IN_SPACE

    def parts(self, derivation: Derivation, axes: Sequence[str]) -> Mapping[str, Entries]:
        common = common_parts(derivation, axes, derivation.edge_compliance[1])
        return common | space_parts(derivation, axes, self.section.map)

    def edge_rows(self, at: RowParts) -> Mapping[int, int]:
        return {1: at.edge_plus}

    def law_call(self, dimension: int) -> str:
        return f"law_from_rows(rows, {dimension}, v, result)"

    def law_lines(self, names: Names, axes: Sequence[str]) -> list[str]:
        value, change = delassus_text(names)
        return [
            *slip_lines(names, axes),
            f"code, tau, e_n, e_1, e_2 = split(hit, {value}, edge_plus, {change}, dt, impulse, critical_edge)",
            *offset_lines(names, axes, IMPULSES, "impulse.jump"),
        ]

    def motion_constants(self, rows: Mapping[str, int]) -> dict[str, int]:
        return {"SECTION": rows["E_11"]}

    def own_tangents(self, derivation: Derivation) -> OwnTangents:
        """They cannot be found from H E where a coefficient of friction vanishes."""
        return derivation.scene.contact.tangents, derivation.tangent_response, self.section.map

    def drifting(self, contact: Contact) -> sp.MatrixBase:
        return sp.zeros(contact.tangents.rows, 0)
