"""How rows, and sums of them over the coordinates, are written in the loop of a generated law."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from painleve.kernels.rows import Rows

__all__ = ["Names", "total", "velocity_difference"]


class Names:
    """How a row's value and its difference from the base are written in the law's loop."""

    def __init__(self, rows: Rows) -> None:
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
