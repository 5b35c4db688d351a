"""The kernels of a contact without friction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType

import sympy as sp

from painleve.core.rows import RowParts
from painleve.kernels.law_terms import Names
from painleve.kernels.motion.schemes.listed import IN_PLANE
from painleve.kernels.motion.sections import none
from painleve.kernels.sections.section import Entries, common_parts
from painleve.mechanics.contact import Contact
from painleve.mechanics.derive import Derivation
from painleve.mechanics.sections.none import NoFriction

__all__ = ["NoFrictionKernels"]


@dataclass(frozen=True)
class NoFrictionKernels:
    """See painleve.kernels.sections.section."""

    section: NoFriction
    imports: str = "from painleve.core.sections.none import law_from_rows, split"
    motion_template: ModuleType = none
    scheme_templates: Sequence[ModuleType] = IN_PLANE

    def parts(self, derivation: Derivation, axes: Sequence[str]) -> Mapping[str, Entries]:
        return common_parts(derivation, axes, derivation.a)

    def edge_rows(self, at: RowParts) -> Mapping[int, int]:
        return {}

    def law_call(self, dimension: int) -> str:
        return f"law_from_rows(rows, {dimension}, v, result)"

    def law_lines(self, names: Names, axes: Sequence[str]) -> list[str]:
        lines = ["code, e_n = split(hit, a, v_n)", "tau = 0.0"]
        for j, x in enumerate(axes):
            lines.append(f"z_{j} = dv_{j}" + ("" if names.is_zero(f"Yn_{x}") else f" + Yn_{x}*e_n"))
        return lines

    def motion_constants(self, rows: Mapping[str, int]) -> dict[str, int]:
        return {}

    def own_tangents(self, derivation: Derivation) -> None:
        return None

    def drifting(self, contact: Contact) -> sp.MatrixBase:
        """Zeros stand for a tangent."""
        return sp.zeros(contact.tangents.rows, 1)
