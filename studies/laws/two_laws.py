"""Law (7) of the paper against Coulomb's law with maximal dissipation, over the slip's direction and the friction."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np
import xarray as xr

from painleve.core.space.two_laws import compare_laws
from painleve.errors import InputError
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Disc
from painleve.mechanics.norm_units import velocity_unit
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import State
from painleve.store import provenance
from painleve.sweep.variables import text
from painleve.theory.coulomb.problem import problem_at
from studies.laws.bands import NUMBERS, bands

__all__ = ["map_laws"]


def map_laws(
    states: Sequence[State],
    *,
    approaches: Sequence[float],
    frictions: Sequence[float],
    directions: int = 181,
    command: str | None = None,
) -> xr.Dataset:
    """How many solutions Coulomb's law has, and how far they are from law (7), at the configurations of the states.

    The slip has the speed 1 and turns about, `directions` angles against b from -pi to pi; the contact velocity has the
    normal part v_n of `approaches` (<= 0; at 0 the tangential problem, law (7) standing for {u-, u_tilde}), and the
    friction is a disc of each radius of `frictions`. The states' own slips and coefficients are not used. Double
    precision: a map shows, `coulomb_solutions` decides.

    Raises InputError for states that are not of one scene with a disc of friction, or where b = 0, and for bad numbers.
    """
    scenes = {state.scene for state in states}
    if len(scenes) != 1 or not all(isinstance(scene.contact.section, Disc) for scene in scenes):
        raise InputError("two laws: give states of one scene whose section of friction is a disc")
    if not (len(approaches) and len(frictions)) or max(approaches) > 0.0 or min(frictions) <= 0.0 or directions < 3:
        raise InputError("two laws: give approaches v_n <= 0, coefficients of friction > 0 and 3 directions or more")
    (scene,) = scenes
    angles, mu = np.linspace(-np.pi, np.pi, directions), np.array(frictions, dtype=float)
    shape = (len(states), len(approaches), len(mu), directions)
    counts, sticks, apart = np.zeros(shape, dtype=np.int64), np.zeros(shape, dtype=np.int64), np.zeros((*shape, 2))
    critical = np.empty(len(states))
    several = np.empty((len(states), len(approaches), len(NUMBERS), 2, len(mu)))
    for i, state in enumerate(states):
        G, Y, critical[i] = _local(state)
        b = G[0, 1:] / np.linalg.norm(G[0, 1:])
        slips = np.outer(np.cos(angles), b) + np.outer(np.sin(angles), [-b[1], b[0]])
        for j, v_n in enumerate(approaches):
            compare_laws(G, Y, float(v_n), slips, mu, counts[i, j], sticks[i, j], apart[i, j])
            several[i, j] = bands(G, Y, float(v_n), mu)
    unit = velocity_unit(scene)

    def variable(dims: tuple[str, ...], values: np.ndarray, sentence: str, units: str = "1") -> xr.Variable:
        return xr.Variable(dims, values, {"units": units, "long_name": sentence})

    # arccos(mu_c/mu): the half angle of the slips that friction would drive; none where mu < mu_c
    with np.errstate(invalid="ignore"):
        half_angle = np.arccos(critical[:, None] / mu)
    dims, over = ("state", "approach", "friction", "direction"), ("state", "friction")
    return xr.Dataset(
        {
            "solutions": variable(dims, counts, "number of solutions of Coulomb's law"),
            "sticking": variable(dims, sticks, "number of those that stick"),
            "nearest": variable(dims, apart[..., 0], "distance of law (7) from Coulomb's nearest solution", unit),
            "farthest": variable(dims, apart[..., 1], "distance of Coulomb's farthest solution from law (7)", unit),
            "several": variable(
                ("state", "approach", "number", "edge", "friction"),
                several,
                "least and largest angle against b with that number of solutions; NaN for none",
                "rad",
            ),
            "critical_friction": variable(("state",), critical, "critical coefficient of friction mu_c = a/|b|"),
            "driven": variable(over, half_angle, "friction would drive slips up to this angle from b", "rad"),
            "projected": variable(over, half_angle + np.pi / 2.0, "law (7) has a jump up to this angle from b", "rad"),
        },
        {
            "state": text(["state"], [state.label for state in states], "label of the configuration"),
            "approach": variable(("approach",), np.array(approaches, dtype=float), "normal velocity v_n over the slip"),
            "friction": variable(("friction",), mu, "coefficient of friction"),
            "number": variable(("number",), np.array(NUMBERS), "number of solutions of Coulomb's law"),
            "direction": variable(("direction",), angles, "angle of the slip against b", "rad"),
        },
        {
            "title": "The paper's law (7) and Coulomb's law with maximal dissipation",
            "kind": "laws",
            **provenance(scene=scene, scene_digest=_digest(scene), seed=0, command=command),
        },
    )


def _local(state: State) -> tuple[np.ndarray, np.ndarray, float]:
    """G, Y and mu_c, rounded."""
    problem = problem_at(state)
    G = np.array([[state.number(x) for x in problem.delassus.row(i)] for i in range(3)])
    Y = np.array([[state.number(x) for x in problem.responses.row(i)] for i in range(problem.responses.rows)])
    reach = float(np.linalg.norm(G[0, 1:]))
    if reach == 0.0:
        raise InputError(f"two laws: b = 0 at the state {state.label}: no direction to count angles from")
    return G, Y, G[0, 0] / reach


def _digest(scene: Scene) -> str:
    """Of the matrices that the map is made from: nothing is compiled for it."""
    d = derive(scene)
    return hashlib.sha256(str((d.delassus, d.normal_response, d.tangent_response)).encode()).hexdigest()[:16]
