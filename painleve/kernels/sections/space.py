"""What the kernels of every section in space share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import sympy as sp

from painleve.kernels.law_terms import Names, velocity_difference
from painleve.kernels.sections.section import Entries, by_axis
from painleve.mechanics.derive import Derivation

__all__ = ["IMPULSES", "delassus_text", "slip_lines", "space_parts", "values_text"]

IMPULSES: Mapping[str, str] = MappingProxyType({"Yn": "n", "Y1": "1", "Y2": "2"})
DELASSUS = ("a", "b_1", "b_2", "C_11", "C_12", "C_22")


def space_parts(d: Derivation, axes: Sequence[str], E: sp.MatrixBase) -> dict[str, Entries]:
    """The parts of friction in space, in the tangents H E."""
    H, Y = d.scene.contact.tangents * E, d.tangent_response * E
    b, C = E.T * d.couplings, E.T * d.compliance * E
    return {
        "H": [*by_axis("H1", axes, H[:, 0]), *by_axis("H2", axes, H[:, 1])],
        "Y_t": [*by_axis("Y1", axes, Y[:, 0]), *by_axis("Y2", axes, Y[:, 1])],
        "b": [("b_1", b[0]), ("b_2", b[1])],
        "C": [("C_11", C[0, 0]), ("C_12", C[0, 1]), ("C_22", C[1, 1])],
    }


def values_text(names: Names, rows: Sequence[str]) -> tuple[str, str]:
    """The values of rows, and their differences from the base state."""
    values = ", ".join("0.0" if names.is_zero(row) else row for row in rows)
    return values, ", ".join(names.difference_or_zero(row) for row in rows)


def delassus_text(names: Names) -> tuple[str, str]:
    """W^T M^-1 W of a sample, and its difference."""
    values, differences = values_text(names, DELASSUS)
    return f"Delassus({values})", f"Delassus({differences})"


def slip_lines(names: Names, axes: Sequence[str]) -> list[str]:
    """v_n, and how the tip's velocity differs."""
    along = (velocity_difference(names, f"H{k}", axes) for k in (1, 2))
    return [f"dt = (v_n, {', '.join(along)})"]
