"""The kernels of a contact with planar friction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType

import sympy as sp

from painleve.core.rows import RowParts
from painleve.kernels.law_terms import Names, offset_lines, velocity_difference
from painleve.kernels.motion.schemes.listed import IN_PLANE
from painleve.kernels.motion.sections import segment
from painleve.kernels.sections.section import Entries, by_axis, common_parts
from painleve.mechanics.contact import Contact
from painleve.mechanics.derive import Derivation
from painleve.mechanics.sections.segment import Segment

__all__ = ["SegmentKernels"]

IMPORTS = "from painleve.core.sections.segment import SegmentChange, SegmentContact, law_from_rows, split"


@dataclass(frozen=True)
class SegmentKernels:
    """See painleve.kernels.sections.section."""

    section: Segment
    imports: str = IMPORTS
    motion_template: ModuleType = segment
    scheme_templates: Sequence[ModuleType] = IN_PLANE

    def parts(self, derivation: Derivation, axes: Sequence[str]) -> Mapping[str, Entries]:
        d, section = derivation, self.section
        return common_parts(d, axes, d.edge_compliance[1]) | {
            "H": by_axis("H", axes, d.scene.contact.tangents),
            "Y_t": by_axis("Yt", axes, d.tangent_response),
            "b": [("b", d.couplings[0])],
            "C": [("C", d.compliance[0])],
            "section": [
                ("edge_minus", d.edge_compliance[-1]),
                ("mu_plus", section.plus),
                ("mu_minus", section.minus),
            ],
        }

    def edge_rows(self, at: RowParts) -> Mapping[int, int]:
        return {1: at.edge_plus, -1: at.section.start}

    def law_call(self, dimension: int) -> str:
        return f"law_from_rows(rows, {dimension}, v, result)"

    def law_lines(self, names: Names, axes: Sequence[str]) -> list[str]:
        differences = ", ".join(names.difference_or_zero(n) for n in ("a", "b", "C", "mu_plus", "mu_minus"))
        return [
            f"dv_t = {velocity_difference(names, 'H', axes)}",
            "contact = SegmentContact(a, b, C, edge_plus, edge_minus, mu_plus, mu_minus)",
            f"change = SegmentChange({differences})",
            "code, tau, e_n, e_t = split(hit, contact, change, v_n, dv_t, impulse, multiplier, critical_edge)",
            *offset_lines(names, axes, {"Yn": "n", "Yt": "t"}, "impulse.stick"),
        ]

    def motion_constants(self, rows: Mapping[str, int]) -> dict[str, int]:
        return {}

    def own_tangents(self, derivation: Derivation) -> None:
        return None

    def drifting(self, contact: Contact) -> sp.MatrixBase:
        return contact.tangents
