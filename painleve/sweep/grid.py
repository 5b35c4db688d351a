"""The exact states of a sweep: every state asked for, at every combination of the swept parameters and keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from types import MappingProxyType

import numpy as np
import sympy as sp
import xarray as xr

from painleve.dataset_names import EXACT, IN_SWEEPS
from painleve.errors import InputError, nearest
from painleve.exact.parse import exact_number
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number, State, make_state
from painleve.sweep.variables import text

__all__ = ["SweepGrid", "make_grid", "meaning"]


@dataclass(frozen=True, kw_only=True, eq=False)
class SweepGrid:
    """States x swept values. `labels`: of the states; `names`: their names in the library (None: given by keys alone);
    `over`: exact values by parameter or state key, in the order of the dataset's dimensions."""

    scene: Scene
    labels: tuple[str, ...]
    names: tuple[str | None, ...]
    keys: Mapping[str, Number]
    parameters: Mapping[str, Number]
    over: Mapping[str, tuple[sp.Expr, ...]]
    spelled: Mapping[str, tuple[str, ...]]

    @property
    def dims(self) -> tuple[str, ...]:
        return ("state", *self.over)

    @property
    def shape(self) -> tuple[int, ...]:
        return (len(self.labels), *(len(values) for values in self.over.values()))

    def points(self) -> Iterator[tuple[int, ...]]:
        """Indices of all points, the last swept quantity fastest."""
        return product(*(range(size) for size in self.shape))

    def state(self, index: tuple[int, ...]) -> State:
        """The exact state of a point. Raises InputError where there is none."""
        keys, parameters = dict(self.keys), dict(self.parameters)
        for place, (name, values) in zip(index[1:], self.over.items(), strict=True):
            (keys if _is_key(self.scene, name) else parameters)[name] = values[place]
        return make_state(self.scene, self.names[index[0]], keys=keys, parameters=parameters)

    @property
    def own_names(self) -> tuple[str, ...]:
        """The names in the dataset that are the scene's: those of what is swept."""
        return (*self.over, *(f"{name}{EXACT}" for name in self.over))

    def coordinates(self) -> dict[str, xr.Variable]:
        """Labels of the states, and the swept values: rounded, and exactly as text."""
        found = {"state": text(["state"], list(self.labels), "label of the exact state (q, u-, parameters)")}
        for name, values in self.over.items():
            unit, sentence = meaning(self.scene, name)
            numbers = np.array([float(sp.N(value, 30)) for value in values])
            found[name] = xr.Variable((name,), numbers, {"units": unit, "long_name": f"{sentence} (swept)"})
            found[f"{name}{EXACT}"] = text([name], list(self.spelled[name]), f"exact value of {name} as an expression")
        return found


def make_grid(
    scene: Scene,
    *,
    states: Sequence[str] = (),
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
    over: Mapping[str, Sequence[Number]] | None = None,
) -> SweepGrid:
    """A grid over named states (none: the state that the keys give) and over exact values of parameters or keys.

    Raises InputError for unknown names, an empty list of values, and values that are not exact numbers.
    """
    exact: dict[str, tuple[sp.Expr, ...]] = {}
    spelled: dict[str, tuple[str, ...]] = {}
    for name, values in (over or {}).items():
        meaning(scene, name)
        if name in IN_SWEEPS or name in {*(keys or {}), *(parameters or {})}:
            raise InputError(f"sweep over {name}: this name is taken; it cannot be swept here")
        if not values:
            raise InputError(f"sweep over {name}: no values; give at least one")
        exact[name] = tuple(exact_number(value, where=f"sweep over {name}") for value in values)
        spelled[name] = tuple(str(value) for value in values)
    for state in states:
        scene.state(state)
    given = " ".join(f"{k}={v}" for k, v in {**(keys or {}), **(parameters or {})}.items())
    labels = tuple(f"{state} {given}".strip() for state in states) or (given or "given",)
    if len(set(labels)) < len(labels):
        raise InputError(f"sweep: a state is named twice in {', '.join(states)}; name each once")
    return SweepGrid(
        scene=scene,
        labels=labels,
        names=tuple(states) or (None,),
        keys=MappingProxyType(dict(keys or {})),
        parameters=MappingProxyType(dict(parameters or {})),
        over=MappingProxyType(exact),
        spelled=MappingProxyType(spelled),
    )


def _is_key(scene: Scene, name: str) -> bool:
    components = {c.name for c in scene.coordinates} | {f"u_{c.name}" for c in scene.coordinates}
    return name in components or name in {k.name for k in scene.keys}


def meaning(scene: Scene, name: str) -> tuple[str, str]:
    """Unit and sentence of a state key, a component of q or u, or a parameter. Raises InputError for another name."""
    for key in scene.keys:
        if key.name == name:
            return key.unit, f"state key {name}: {key.sentence}"
    for coordinate in scene.coordinates:
        if coordinate.name == name:
            return coordinate.unit, f"coordinate {name}: {coordinate.sentence}"
        if f"u_{coordinate.name}" == name:
            return f"{coordinate.unit}/s", f"velocity of {coordinate.name}: {coordinate.sentence}"
    if name not in {p.name for p in scene.parameters}:
        known = [*(k.name for k in scene.keys), *(p.name for p in scene.parameters)]
        hint = nearest(name, known)
        raise InputError(f"scene {scene.name}: no parameter and no state key {name!r}{hint}; it has {', '.join(known)}")
    parameter = scene.parameter(name)
    return parameter.unit, f"parameter {name}: {parameter.sentence}"
