"""Which states of a map share a picture, and what tells one picture from another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from painleve.mechanics.derive import derive
from painleve.mechanics.state import State

__all__ = ["MappedState", "panel_titles", "panels_of"]

SAME = 1e-9  # relative: curves that differ by less differ by rounding


@dataclass(frozen=True, kw_only=True, eq=False)
class MappedState:
    """A state with mu_c and its own friction along the path, (n,) each, where it lies, and its branch."""

    state: State
    critical: np.ndarray
    friction: np.ndarray
    place: tuple[float, float]
    branch: str


def panels_of(states: Sequence[MappedState]) -> np.ndarray:
    """Numbers without gaps: states share a panel if mu_c is the same and no two marks in one place would differ."""
    panels: list[list[MappedState]] = []
    numbers = []
    for one in states:
        fitting = [i for i, panel in enumerate(panels) if _fits(one, panel)]
        if not fitting:
            panels.append([])
        numbers.append(fitting[0] if fitting else len(panels) - 1)
        panels[numbers[-1]].append(one)
    return np.array(numbers, dtype=np.int64)


def _fits(one: MappedState, panel: list[MappedState]) -> bool:
    """In the same picture, and nowhere under another mark."""
    return _same(one.critical, panel[0].critical) and not any(
        one.place == other.place and (one.branch != other.branch or not _same(one.friction, other.friction))
        for other in panel
    )


def _same(one: np.ndarray, other: np.ndarray) -> bool:
    return np.allclose(one, other, rtol=SAME, atol=0.0, equal_nan=True)


def panel_titles(states: Sequence[MappedState], panels: np.ndarray) -> list[str]:
    """For each state the parameters of mu_c and of g that differ from panel to panel, else those of gamma too.

    Panels that still say the same differ off the path.
    """
    derivation = derive(states[0].state.scene)
    curve = [derivation.critical_friction, derivation.scene.contact.constraint]
    count, titles = len(np.unique(panels)), [""]
    for expressions in (curve, [*curve, derivation.gamma]):
        names = _telling(states, panels, [e for e in expressions if e is not None])
        titles = [", ".join(_said(one.state, name) for name in names) for one in states]
        if len(set(titles)) == count:
            return titles
    first = {title: int(panel) for panel, title in reversed(list(zip(panels, titles, strict=True)))}
    return [
        title if first[title] == panel else f"{title}; other parameters off the path".removeprefix("; ")
        for panel, title in zip(panels, titles, strict=True)
    ]


def _telling(states: Sequence[MappedState], panels: np.ndarray, expressions: list[sp.Expr]) -> list[str]:
    """Parameters of the expressions that have one value in each panel, and not the same in all."""
    symbols: set[sp.Basic] = set().union(*(e.free_symbols for e in expressions))
    found = []
    for parameter in states[0].state.scene.parameters:
        values = np.array([one.state.number(parameter.symbol) for one in states])
        alike = all(len(set(values[panels == panel])) == 1 for panel in np.unique(panels))
        if parameter.symbol in symbols and alike and len(set(values)) > 1:
            found.append(parameter.name)
    return found


def _said(state: State, name: str) -> str:
    """A parameter with its value and its unit."""
    unit, value = state.scene.parameter(name).unit, state.number(state.scene.parameter(name).symbol)
    if value == 0.0 or unit == "1":
        return f"{name} = {value:.4g}"
    return f"{name} = {value:.4g}{unit[1:] if unit.startswith('1/') else f' {unit}'}"
