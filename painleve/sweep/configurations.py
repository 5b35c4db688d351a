"""Many configurations of a scene at once, in floats: from values of some of its keys, components and parameters."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

import numpy as np
import sympy as sp

from painleve.errors import InputError, nearest
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number, make_family

__all__ = ["Configurations", "free_names", "make_configurations"]

Configurations = Callable[[Sequence[np.ndarray]], tuple[np.ndarray, np.ndarray, np.ndarray]]


def free_names(scene: Scene) -> list[str]:
    """What may vary: state keys, single components and parameters."""
    names = [*(k.name for k in scene.keys), *map(str, (*scene.q, *scene.u)), *(p.name for p in scene.parameters)]
    return list(dict.fromkeys(names))


def make_configurations(
    scene: Scene,
    free: Collection[str],
    name: str | None = None,
    *,
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
) -> Configurations:
    """A function from one array (n,) for each free name to (q (n, d), u (n, d), parameters (n, number of them)).

    The rest is fixed as for make_state. Raises InputError for unknown names, and for a name that varies and is given.
    """
    known = free_names(scene)
    for word in free:
        if word not in known:
            raise InputError(
                f"scene {scene.name}: nothing is called {word!r}{nearest(word, known)}: {', '.join(known)}"
            )
        if word in (keys or {}) or word in (parameters or {}):
            raise InputError(f"scene {scene.name}: {word} is given, and so cannot vary; leave it out")
    rules = make_family(scene, free, name, keys=keys, parameters=parameters)
    parameters_of = {p.name: p.symbol for p in scene.parameters}
    symbols = [parameters_of.get(word, sp.Symbol(word, real=True)) for word in free]
    wanted = [rules[x] for x in (*scene.q, *scene.u, *scene.p)]
    function = sp.lambdify(symbols, wanted, "numpy", dummify=True)
    d = scene.dimension

    def configurations(values: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        n = len(values[0])
        columns = np.stack([np.broadcast_to(np.asarray(x, dtype=float), n) for x in function(*values)], axis=1)
        return columns[:, :d], columns[:, d : 2 * d], columns[:, 2 * d :]

    return configurations
