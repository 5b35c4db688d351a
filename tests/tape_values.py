"""Values of a scene's expressions in floats, through its definitions: by plain substitution, one step at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from painleve.mechanics.scene import Scene


def values_at(scene: Scene, expressions: Sequence[sp.Expr], point: Mapping[sp.Symbol, float]) -> list[float]:
    known = dict(point)
    for symbol, expression in scene.definitions.needed(expressions).steps:
        known[symbol] = evaluated(expression, known)
    return [evaluated(e, known) for e in expressions]


def evaluated(expression: sp.Expr, known: Mapping[sp.Symbol, float]) -> float:
    symbols = sorted(expression.free_symbols, key=str)
    return float(sp.lambdify(symbols, expression, "math")(*(known[s] for s in symbols)))
