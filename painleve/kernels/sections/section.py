"""What the kernels ask of a friction section."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Protocol, TypeAlias

import sympy as sp

from painleve.core.rows import RowParts
from painleve.kernels.law_terms import Names
from painleve.mechanics.contact import Contact
from painleve.mechanics.derive import Derivation

__all__ = ["Entries", "OwnTangents", "SectionKernels", "by_axis", "common_parts"]

Entries: TypeAlias = list[tuple[str, sp.Expr]]
OwnTangents: TypeAlias = tuple[sp.MatrixBase, sp.MatrixBase, sp.MatrixBase]


class SectionKernels(Protocol):
    """The kernels of a contact with this section."""

    def parts(self, derivation: Derivation, axes: Sequence[str]) -> Mapping[str, Entries]:
        """The rows, with their names, by the parts of painleve.core.rows.RowLayout; axes: names of the coordinates."""

    def edge_rows(self, at: RowParts) -> Mapping[int, int]:
        """Where a + b.s is on each edge of the cone (painleve.mechanics.sections.section)."""

    @property
    def imports(self) -> str:
        """What the lines of the law call."""

    def law_call(self, dimension: int) -> str:
        """S(q, v) from `rows` at q, into `result`; its value is the branch."""

    def law_lines(self, names: Names, axes: Sequence[str]) -> list[str]:
        """In the loop over samples: from v_n and `hit` to `code`, `tau` and the z of a sample."""

    @property
    def motion_template(self) -> ModuleType:
        """Of painleve.kernels.motion.sections."""

    @property
    def scheme_templates(self) -> Sequence[ModuleType]:
        """Of painleve.kernels.motion.schemes: those that step such a contact."""

    def motion_constants(self, rows: Mapping[str, int]) -> dict[str, int]:
        """Of its template; rows: where the rows of the motion are, by their names."""

    def own_tangents(self, derivation: Derivation) -> OwnTangents | None:
        """H and M^-1 H (d x k) in the scene's own tangents, and E of the section in them, where those of the rows are
        others; None where they are the same."""

    def drifting(self, contact: Contact) -> sp.MatrixBase:
        """The tangents (d x n) whose turning counts in the accelerations of the contact point."""


def by_axis(letter: str, axes: Sequence[str], column: sp.MatrixBase) -> Entries:
    """The components of a vector as rows."""
    return [(f"{letter}_{x}", e) for x, e in zip(axes, column, strict=True)]


def common_parts(d: Derivation, axes: Sequence[str], edge_plus: sp.Expr) -> dict[str, Entries]:
    """What every contact has."""
    return {
        "g": [("g", d.scene.contact.constraint)],
        "w_n": by_axis("w", axes, d.normal),
        "Y_n": by_axis("Yn", axes, d.normal_response),
        "a": [("a", d.a)],
        "edge_plus": [("edge_plus", edge_plus)],
    }
