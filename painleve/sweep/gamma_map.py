"""gamma and the critical friction along a path of touching configurations through each state: the dataset of a map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp
import xarray as xr

from painleve.errors import InputError
from painleve.kernels.compiled import Kernels, make_kernels
from painleve.mechanics.derive import derive
from painleve.mechanics.norm_units import gamma_unit
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number, State
from painleve.store import provenance
from painleve.sweep.grid import make_grid
from painleve.sweep.map_panels import MappedState, panel_titles, panels_of
from painleve.sweep.variables import BRANCHES, code, coded, text
from painleve.theory.classification import Classification, classify

__all__ = ["has_gamma_map", "map_gamma"]

REACH = 0.4  # of the path on both sides of the states, in the unit of its coordinate
HEADROOM = 1.5  # the friction axis goes beyond the largest coefficient at a state by this factor
NEWTON_STEPS = 12
TOUCHING = 1e-12  # |g|, in the unit of g, at which Newton's iteration has arrived
LARGEST_STEP = 0.2  # of the following coordinate between neighbours: beyond it another branch of g = 0 was reached


@dataclass(frozen=True, kw_only=True, eq=False)
class _Path:
    """Along one path: a, |b|, |grad g|^2 and the coefficient of friction, (n,) each, NaN where there is no contact."""

    a: np.ndarray
    b: np.ndarray
    squared: np.ndarray
    friction: np.ndarray

    @property
    def critical(self) -> np.ndarray:
        """mu_c = a/|b|; NaN where b = 0 and no friction is critical."""
        return self.a / np.where(self.b > 0.0, self.b, np.nan)


def has_gamma_map(scene: Scene) -> bool:
    """Whether a scene has symmetric friction, and one path along the contact on which gamma depends."""
    derivation = derive(scene)
    return derivation.critical_friction is not None and len(derivation.shape) in (1, 2)


def map_gamma(
    scene: Scene,
    *,
    states: Sequence[str] = (),
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
    points: tuple[int, int] = (241, 121),
    command: str | None = None,
) -> xr.Dataset:
    """gamma over (path, coefficient of friction), mu_c and the scene's own friction along the path, and the states.

    The path varies the first coordinate on which the law depends; where it depends on a second one, that one follows
    the constraint g = 0. Plain floating-point values: a map shows, and the branch of each state is the exact one.
    States with the same curve mu_c share a panel, unless their marks would coincide and differ.

    Raises InputError for unknown names, and for a scene without symmetric friction or with more than one path.
    """
    if not has_gamma_map(scene):
        raise InputError(f"scene {scene.name}: no map: it needs symmetric friction and one path along the contact")
    kernels = make_kernels(scene)
    shape = kernels.derivation.shape
    grid = make_grid(scene, states=states, keys=keys, parameters=parameters)
    classified = [classify(grid.state(index)) for index in grid.points()]
    coordinate = scene.coordinates[shape[0]]
    path, friction, variables = _evaluate(kernels, classified, points)
    variables["theorem_branch"] = coded(
        ["state"],
        np.array([code(c.branch.value, BRANCHES) for c in classified]),
        BRANCHES,
        "branch of Theorem 1, by exact arithmetic",
    )
    attributes = {
        "title": f"gamma and the critical friction of {scene.name}: {scene.sentence}",
        "kind": "gamma_map",
        "path_symbol": f"${coordinate.latex or coordinate.name}$",
        **provenance(scene=scene, scene_digest=kernels.digest, seed=0, command=command),
    }
    return xr.Dataset(variables, grid.coordinates() | {"path": path, "friction": friction}, attributes)


def _evaluate(
    kernels: Kernels, classified: list[Classification], points: tuple[int, int]
) -> tuple[xr.Variable, xr.Variable, dict[str, xr.Variable]]:
    """The two axes, and what is drawn over them."""
    index, states = kernels.derivation.shape[0], [c.limit.state for c in classified]
    coordinate = kernels.scene.coordinates[index]
    places = np.array([state.number(state.q[index]) for state in states])
    values = np.linspace(places.min() - REACH, places.max() + REACH, points[0])
    paths = [_follow(kernels, state, values) for state in states]
    own = np.array([_follow(kernels, s, places[i : i + 1]).friction[0] for i, s in enumerate(states)])
    friction = np.linspace(0.0, HEADROOM * own.max(), points[1])

    def number(dims: tuple[str, ...], data: np.ndarray, sentence: str, units: str = "1") -> xr.Variable:
        return xr.Variable(dims, data, {"units": units, "long_name": sentence})

    along, critical = ("state", "path"), np.array([p.critical for p in paths])
    mapped = [
        MappedState(state=s, critical=p.critical, friction=p.friction, place=(x, y), branch=c.branch.value)
        for s, p, x, y, c in zip(states, paths, places, own, classified, strict=True)
    ]
    panel = panels_of(mapped)
    gamma = np.array([_gamma(path, friction) for path in paths])
    variables = {
        "gamma": number(
            (*along, "friction"),
            gamma,
            "gamma, the least normal compliance, in plain floats",
            gamma_unit(kernels.scene),
        ),
        "critical_friction": number(along, critical, "critical coefficient of friction mu_c = a/|b|"),
        "own_friction": number(along, np.array([p.friction for p in paths]), "coefficient of friction of the scene"),
        "state_path": number(("state",), places, f"where the state lies: {coordinate.sentence}", coordinate.unit),
        "state_friction": number(("state",), own, "coefficient of friction of the scene at the state"),
        "panel": number(("state",), panel, "number of the picture; states with one mu_c share it"),
        "panel_title": text(["state"], panel_titles(mapped, panel), "what tells the state's picture from the others"),
    }
    axis = number(("path",), values, f"coordinate along the contact: {coordinate.sentence}", coordinate.unit)
    return axis, number(("friction",), friction, "coefficient of friction as an independent variable"), variables


def _gamma(path: _Path, friction: np.ndarray) -> np.ndarray:
    """(path, friction): (a - mu |b|)/|grad g|^2."""
    return (path.a[:, None] - path.b[:, None] * friction) / path.squared[:, None]


def _follow(kernels: Kernels, state: State, values: np.ndarray) -> _Path:
    """Evaluate the rows along the path, outwards from the state in both senses."""
    at = kernels.rows.parts
    table = np.full((len(values), len(kernels.rows.names)), np.nan)
    start = int(np.searchsorted(values, state.number(state.q[kernels.derivation.shape[0]])))
    for order in (range(start, len(values)), range(start - 1, -1, -1)):
        q = np.array([state.number(x) for x in state.q])
        for i in order:
            rows = _touch(kernels, state, q, values[i])
            if rows is None:
                break
            table[i] = rows
    a, squared = table[:, at.a], np.sum(table[:, at.w_n] ** 2, axis=1)
    if len(at.H) > 1:  # the rows have a disc as the unit disc
        friction = _coefficients(kernels, state, values)
        return _Path(a=a, b=(a - table[:, at.edge_plus]) / friction, squared=squared, friction=friction)
    _, mu_plus, _ = table[:, at.section].T
    return _Path(a=a, b=np.abs(table[:, at.b])[:, 0], squared=squared, friction=mu_plus)


def _coefficients(kernels: Kernels, state: State, values: np.ndarray) -> np.ndarray:
    """The disc's coefficient of friction along the path."""
    scene, index = kernels.scene, kernels.derivation.shape[0]
    own = scene.contact.section.expressions[0]
    mu = own.xreplace({s: x for s, x in state.substitution.items() if s != scene.q[index]})
    return np.array([float(mu.xreplace({scene.q[index]: sp.Float(x)})) for x in values])


def _touch(kernels: Kernels, state: State, q: np.ndarray, value: float) -> np.ndarray | None:
    """Move q, in place, to that value of the path's coordinate, with g = 0 again; its rows, or None if it cannot."""
    p = np.array([state.number(state.parameters[s.name]) for s in state.scene.parameters])
    rows, at = np.empty(len(kernels.rows.names)), kernels.rows.parts
    shape = kernels.derivation.shape
    q[shape[0]] = value
    kernels.rows_at(q, p, rows)
    if len(shape) == 1 or kernels.derivation.carried:
        return rows
    follower, before = shape[1], q[shape[1]]
    for _ in range(NEWTON_STEPS):
        if abs(rows[at.g]) <= TOUCHING:
            return rows
        slope = rows[at.w_n][follower]  # -dg/dq_i
        if slope == 0.0 or abs(q[follower] + rows[at.g] / slope - before) > LARGEST_STEP:
            return None
        q[follower] += rows[at.g] / slope
        kernels.rows_at(q, p, rows)
    return None
