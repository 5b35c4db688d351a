"""Sympy expressions as lines of Python for generated kernels."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from painleve.mechanics.scene import Scene

__all__ = ["assignments", "indent", "renamed", "used"]


class _Printer(PythonCodePrinter):
    """Small integer powers become products, which vectorise and round once per factor."""

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        base, exponent = expr.args
        if exponent.is_Integer and 1 < abs(int(exponent)) <= 4:
            factor = self.parenthesize(base, 100)
            product = "*".join([factor] * abs(int(exponent)))
            return f"({product})" if exponent > 0 else f"(1.0/({product}))"
        return super()._print_Pow(expr, rational=rational)

    def _print_Rational(self, expr: sp.Rational) -> str:
        return f"({expr.p}.0/{expr.q}.0)"

    def _print_Integer(self, expr: sp.Integer) -> str:
        return f"{int(expr)}.0"


_PRINTER = _Printer({"fully_qualified_modules": True})


def indent(lines: Iterable[str], depth: int) -> str:
    """The lines, each ended by a newline, `depth` levels in."""
    return "".join(" " * 4 * depth + line + "\n" for line in lines)


def assignments(expressions: Sequence[sp.Expr], targets: Sequence[str]) -> list[str]:
    """`target = expression` for each, common subexpressions first."""
    shared, reduced = sp.cse(list(expressions), symbols=sp.numbered_symbols("c", real=True))
    lines = [f"{symbol} = {_PRINTER.doprint(expression)}" for symbol, expression in shared]
    return lines + [f"{t} = {_PRINTER.doprint(e)}" for t, e in zip(targets, reduced, strict=True)]


def renamed(scene: Scene) -> tuple[dict[sp.Symbol, sp.Symbol], list[str], list[str]]:
    """Coordinates and parameters under names that clash with nothing: q_<name>, p_<name>."""
    q = {c.symbol: sp.Symbol(f"q_{c.name}", real=True) for c in scene.coordinates}
    p = {s.symbol: sp.Symbol(f"p_{s.name}", real=True) for s in scene.parameters}
    return q | p, [str(s) for s in q.values()], [str(s) for s in p.values()]


def used(names: Sequence[str], expressions: Iterable[sp.Expr]) -> list[tuple[int, str]]:
    """Which names occur, with their positions."""
    free = {str(s) for e in expressions for s in e.free_symbols}
    return [(i, n) for i, n in enumerate(names) if n in free]
