"""Where in a workspace a contact is paradoxical, and from which friction on: mu_c and the sign of gamma over one or two
axes, in floats."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from painleve.dataset_names import IN_FRICTION_MAPS, hold_to
from painleve.errors import InputError
from painleve.kernels.contact_numbers import ContactNumbers, make_contact_numbers
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number
from painleve.store import provenance
from painleve.sweep.configurations import make_configurations
from painleve.sweep.grid import meaning
from painleve.sweep.variables import coded

__all__ = ["SENSES", "Frictions", "frictions", "map_friction"]

SENSES = ("plus", "minus")  # of the slip along the tangent
CHUNK = 65536  # configurations evaluated at a time
MOST_POINTS = 100_000_000


@dataclass(frozen=True, eq=False)
class Frictions:
    """Of n configurations: the critical friction for slip in each sense (in space the least one of all directions, in
    both), whether gamma < 0 there in that sense at the scene's own friction, and whether the configuration is admitted.

    critical: inf where no friction is critical; NaN, and not negative, where M is not positive definite, grad g
    vanishes, or another point of the mechanism lies below the plane while the touching one is on it.
    """

    critical: dict[str, np.ndarray]
    negative: dict[str, np.ndarray]
    admitted: np.ndarray


def frictions(numbers: ContactNumbers, q: np.ndarray, p: np.ndarray, *, others_above: bool = True) -> Frictions:
    """Critical friction and the sign of gamma by the sense of the slip at configurations q (n, d), parameters p (n, m).

    A slip v_t > 0 takes the friction impulse s = -mu, so it is paradoxical where a - mu b < 0, and mu_c = a/b if b > 0;
    for v_t < 0 the sign of b is the other one (docs/theory.md, section 1.6).
    """
    k = numbers.scene.contact.section.dimension
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        table = numbers.at(q, p)
        admitted = (table["pivot"] > 0.0) & (table["squared"] > 0.0) & np.isfinite(table["least"])
        if others_above:
            for name in (c for c in numbers.columns if c.startswith("other_")):
                admitted &= table[name] >= table["height"]
        if k == 1:
            b = table["b_1"]
            by_sense = {"plus": (b, table["edge_m1"]), "minus": (-b, table["edge_1"])}
        else:
            size = np.sqrt(sum(table[f"b_{j}"] ** 2 for j in range(1, 1 + k)))
            by_sense = dict.fromkeys(SENSES, (size, table["least"]))
        critical = {
            sense: np.where(admitted, np.where(drive > 0.0, table["a"] / drive, np.inf), np.nan)
            for sense, (drive, _) in by_sense.items()
        }
    negative = {sense: admitted & (compliance < 0.0) for sense, (_, compliance) in by_sense.items()}
    return Frictions(critical, negative, admitted)


def map_friction(
    scene: Scene,
    axes: Mapping[str, np.ndarray],
    *,
    state: str | None = None,
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
    others_above: bool = True,
    command: str | None = None,
) -> xr.Dataset:
    """The critical friction by the sense of the slip, and where gamma < 0 at the scene's friction, over the axes.

    `axes` maps one or two state keys, single components or parameters to (n,) values; the rest is fixed as for
    make_state. Plain floats: a map shows; what holds exactly at a state, `classify` says. Raises InputError for a scene
    without friction, for unknown names, and for no or more than two axes.
    """
    if not scene.contact.section.dimension:
        raise InputError(f"scene {scene.name}: a map of friction needs a scene with friction")
    if len(axes) not in (1, 2):
        raise InputError(f"map: give one or two axes, such as theta=0:1; {len(axes)} are given")
    shape = tuple(len(values) for values in axes.values())
    if np.prod(shape) > MOST_POINTS:
        raise InputError(f"map: {np.prod(shape)} points are more than {MOST_POINTS}; take fewer on an axis")
    numbers = make_contact_numbers(scene)
    configurations = make_configurations(scene, list(axes), state, keys=keys, parameters=parameters)
    parts = []
    for point in _chunks(axes):
        q, _, p = configurations(point)
        parts.append(frictions(numbers, q, p, others_above=others_above))
    names = tuple(axes)
    variables = {"admitted": _answers(names, _joined([x.admitted for x in parts], shape), _ADMITTED)}
    for sense in SENSES:
        critical = _joined([x.critical[sense] for x in parts], shape)
        negative = _joined([x.negative[sense] for x in parts], shape)
        slip = f"for slip in the sense {'v_t > 0' if sense == 'plus' else 'v_t < 0'}"
        variables[f"critical_friction_{sense}"] = _variable(names, critical, f"critical friction mu_c = a/|b| {slip}")
        variables[f"gamma_negative_{sense}"] = _answers(names, negative, f"whether gamma < 0 {slip}")
    coordinates = {}
    for name, values in axes.items():
        unit, sentence = meaning(scene, name)
        coordinates[name] = xr.Variable((name,), np.asarray(values, float), {"units": unit, "long_name": sentence})
    attributes = {
        "title": f"Critical friction of {scene.name}: {scene.sentence}",
        "kind": "friction_map",
        "friction_dimension": scene.contact.section.dimension,
        **provenance(scene=scene, scene_digest=numbers.digest, seed=0, command=command),
    }
    dataset = xr.Dataset(variables, coordinates, attributes)
    hold_to(IN_FRICTION_MAPS, dataset.variables, axes)
    return dataset


ANSWERS = ("no", "yes")
_ADMITTED = "whether M is positive definite and no other point of the mechanism lies below the plane"


def _chunks(axes: Mapping[str, np.ndarray]) -> Iterator[list[np.ndarray]]:
    """The points of the grid, the last axis fastest, some at a time."""
    arrays = [np.asarray(values, dtype=float) for values in axes.values()]
    sizes = [len(a) for a in arrays]
    total = int(np.prod(sizes))
    for start in range(0, total, CHUNK):
        index = np.unravel_index(np.arange(start, min(total, start + CHUNK)), sizes)
        yield [a[i] for a, i in zip(arrays, index, strict=True)]


def _joined(parts: list[np.ndarray], shape: tuple[int, ...]) -> np.ndarray:
    return np.concatenate(parts).reshape(shape)


def _answers(names: tuple[str, ...], values: np.ndarray, sentence: str) -> xr.Variable:
    return coded(list(names), 1 + values, ANSWERS, sentence)


def _variable(names: tuple[str, ...], values: np.ndarray, sentence: str) -> xr.Variable:
    return xr.Variable(names, values, {"units": "1", "long_name": sentence})
