"""How rows, and sums of them over the coordinates, are written in the loop of a generated law."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

import sympy as sp

__all__ = ["Names", "offset_lines", "total", "velocity_difference"]


class TableOfRows(Protocol):
    """What is used of painleve.kernels.rows.Rows."""

    @property
    def names(self) -> tuple[str, ...]: ...
    @property
    def expressions(self) -> tuple[sp.Expr, ...]: ...
    @property
    def varying(self) -> tuple[int, ...]: ...
    def index(self, name: str) -> int: ...


class Names:
    """How a row's value and its difference from the base are written in the law's loop."""

    def __init__(self, rows: TableOfRows) -> None:
        self.rows = rows
        self.slot = {r: k for k, r in enumerate(rows.varying)}

    def is_zero(self, name: str) -> bool:
        return self.rows.expressions[self.rows.index(name)] == 0

    def difference(self, name: str) -> str | None:
        r = self.rows.index(name)
        return f"d_{name}" if r in self.slot else None

    def difference_or_zero(self, name: str) -> str:
        return self.difference(name) or "0.0"

    def loads(self) -> list[str]:
        lines = []
        for r, k in self.slot.items():
            name = self.rows.names[r]
            lines += [f"d_{name} = values[{k}, i]", f"{name} = base_{name} + d_{name}"]
        return lines

    def hoisted(self) -> list[str]:
        return [
            f"base_{n} = base[{r}]" if r in self.slot else f"{n} = base[{r}]"
            for r, n in enumerate(self.rows.names)
            if self.rows.expressions[r] != 0
        ]


def total(terms: Iterable[str]) -> str:
    return " + ".join(terms) or "0.0"


def velocity_difference(names: Names, prefix: str, axes: Sequence[str]) -> str:
    """w . v - w_base . u- as sum of dw u- and w dv: no difference of large numbers."""
    terms = []
    for j, x in enumerate(axes):
        name = f"{prefix}_{x}"
        if names.difference(name):
            terms.append(f"d_{name}*u_{j}")
        if not names.is_zero(name):
            terms.append(f"{name}*dv_{j}")
    return total(terms)


def offset_lines(names: Names, axes: Sequence[str], responses: Mapping[str, str], base: str) -> list[str]:
    """z = dv + tau dY r + Y e, component by component: `responses` are the prefixes of the rows of Y with the names of
    their impulses, r = base_<name>, e = e_<name>."""
    lines = []
    for j, x in enumerate(axes):
        moved = [f"d_{y}_{x}*{base}_{i}" for y, i in responses.items() if names.difference(f"{y}_{x}")]
        terms = [f"dv_{j}"] + ([f"tau*({total(moved)})"] if moved else [])
        terms += [f"{y}_{x}*e_{i}" for y, i in responses.items() if not names.is_zero(f"{y}_{x}")]
        lines.append(f"z_{j} = {total(terms)}")
    return lines
