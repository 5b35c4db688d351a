"""M = L^T D L and M^-1 w as straight-line text that uses the zeros of M.

From the last coordinate to the first, as a tree of joints is walked from its leaves: then no zero of M fills up, for a
joint couples only with those between it and the base (R. Featherstone, Rigid Body Dynamics Algorithms, Springer 2008,
section 6.5). For other matrices the entries that fill up are worked out here, before there are numbers
(docs/theory.md, section 1.6).
"""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["FactorText"]


class FactorText:
    """Lines that factor a symmetric matrix whose lower entries have the names M[i][j] ("" for zero).

    `pivots` are the names of D's entries: M is positive definite exactly where all are positive.
    """

    def __init__(self, M: Sequence[Sequence[str]], prefix: str) -> None:
        self.size, self.prefix = len(M), prefix
        self.lines: list[str] = []
        self._entries = [[M[i][j] for j in range(i + 1)] for i in range(self.size)]
        self._ratios = [["" for _ in range(i)] for i in range(self.size)]
        for k in range(self.size - 1, -1, -1):
            self._eliminate(k)
        self.pivots = [self._entries[k][k] for k in range(self.size)]

    def _eliminate(self, k: int) -> None:
        row = self._entries[k]
        coupled = [i for i in range(k) if row[i]]
        for i in coupled:
            self._ratios[k][i] = f"{self.prefix}l_{k}_{i}"
            self.lines.append(f"{self._ratios[k][i]} = {row[i]}/{row[k]}")
        for i in coupled:
            for j in (j for j in coupled if j <= i):
                name, old = f"{self.prefix}m_{i}_{j}_{k}", self._entries[i][j]
                self.lines.append(f"{name} = {old or '0.0'} - {self._ratios[k][i]}*{row[j]}")
                self._entries[i][j] = name

    def solve(self, right: Sequence[str], name: str) -> tuple[list[str], list[str]]:
        """(lines, names of the entries) of M^-1 right; "" for entries that are zero."""
        lines: list[str] = []
        x = list(right)
        for i in range(self.size - 1, -1, -1):
            for j in range(i):
                if self._ratios[i][j] and x[i]:
                    x[j] = _assign(lines, f"{name}_f_{i}_{j}", f"{x[j] or '0.0'} - {self._ratios[i][j]}*{x[i]}")
        for i in range(self.size):
            if x[i]:
                x[i] = _assign(lines, f"{name}_d_{i}", f"{x[i]}/{self.pivots[i]}")
        for i in range(self.size):
            for j in range(i):
                if self._ratios[i][j] and x[j]:
                    x[i] = _assign(lines, f"{name}_b_{i}_{j}", f"{x[i] or '0.0'} - {self._ratios[i][j]}*{x[j]}")
        return lines, x


def _assign(lines: list[str], name: str, text: str) -> str:
    lines.append(f"{name} = {text}")
    return name
