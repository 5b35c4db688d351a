"""The four regimes of a sliding contact over two state keys: slip, lift-off, inconsistent, indeterminate."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import sympy as sp
import xarray as xr

from painleve.dataset_names import IN_REGIMES, hold_to
from painleve.errors import InputError
from painleve.exact.parse import exact_number, parse_expression
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.derive import derive
from painleve.mechanics.norm_units import ACCELERATION, COMPLIANCE
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number, resolve_parameters
from painleve.store import provenance
from painleve.sweep.grid import meaning
from painleve.sweep.variables import coded

__all__ = ["REGIMES", "map_regimes"]

REGIMES = ("slip", "lift_off", "inconsistent", "indeterminate")


def map_regimes(
    scene: Scene,
    *,
    axes: Mapping[str, np.ndarray],
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Regimes by the signs of the normal compliance in the sense of the slip, and of the free normal acceleration.

    `axes` maps two state keys to (n,) values; the other keys and the parameters are exact and fixed. With p the normal
    compliance a + s b at the friction s that opposes the slip, and beta the normal acceleration without contact force,
    `0 <= F, beta + p F >= 0, F (beta + p F) = 0` has the solution F = -beta/p only (slip: p > 0 > beta), F = 0 only
    (lift-off: p, beta > 0), none (inconsistent: p, beta < 0), or both (indeterminate: beta > 0 > p). Plain floats.
    (docs/theory.md, section 6; regimes as in A. R. Champneys and P. L. Várkonyi, arXiv 1601.03545.)

    Raises InputError for a scene without friction, and unless two different state keys are given.
    """
    if scene.contact.section.dimension != 1:
        raise InputError(f"scene {scene.name}: these regimes are those of friction in the plane")
    names, known = tuple(axes), [k.name for k in scene.keys]
    if len(names) != 2 or not set(names) <= set(known):
        raise InputError(f"regimes: give two state keys of {scene.name} as axes: {', '.join(known)}")
    compliance, acceleration = _evaluate(scene, axes, keys or {}, parameters or {})
    regime = 1 + np.where(compliance > 0.0, acceleration > 0.0, 2 + (acceleration > 0.0))

    def number(dims: tuple[str, ...], values: np.ndarray, sentence: str, units: str) -> xr.Variable:
        return xr.Variable(dims, values, {"units": units, "long_name": sentence})

    variables = {
        "slip_compliance": number(names, compliance, "normal compliance a + s b in the sense of the slip", COMPLIANCE),
        "free_acceleration": number(names, acceleration, "normal acceleration without contact force", ACCELERATION),
        "regime": coded(names, regime, REGIMES, "solutions of the contact problem of accelerations"),
    }
    coordinates = {}
    for name, values in axes.items():
        unit, sentence = meaning(scene, name)
        coordinates[name] = number((name,), np.asarray(values, float), sentence, unit)
    title = f"Regimes of the sliding contact of {scene.name}: {scene.sentence}"
    source = provenance(scene=scene, scene_digest=make_kernels(scene).digest, seed=0, command=command)
    dataset = xr.Dataset(variables, coordinates, {"title": title, "kind": "regimes", **source})
    hold_to(IN_REGIMES, [*dataset.variables, *dataset.dims], names)
    return dataset


def _evaluate(
    scene: Scene, axes: Mapping[str, np.ndarray], keys: Mapping[str, Number], parameters: Mapping[str, Number]
) -> tuple[np.ndarray, np.ndarray]:
    """(p, beta) on the grid of the two axes."""
    derivation, velocity = derive(scene), sp.Matrix(scene.u)
    slip = (scene.contact.tangents.T * velocity)[0, 0]
    curvature = (velocity.T * sp.hessian(scene.contact.constraint, scene.q) * velocity)[0, 0]
    beta = (derivation.normal_response.T * scene.force)[0, 0] - curvature
    placed = _placed(scene, axes, keys, parameters)
    symbols = [k.symbol for k in scene.keys if k.name in axes]
    symbols.sort(key=lambda s: list(axes).index(s.name))
    wanted = [derivation.edge_compliance[1], derivation.edge_compliance[-1], slip, beta]
    function = sp.lambdify(symbols, [placed(e) for e in wanted], "numpy", dummify=True)
    mesh = np.meshgrid(*(np.asarray(axes[s.name], float) for s in symbols), indexing="ij")
    plus, minus, sense, acceleration = (np.broadcast_to(value, mesh[0].shape) for value in function(*mesh))
    return np.where(sense < 0.0, plus, minus), np.array(acceleration)


def _placed(
    scene: Scene, axes: Mapping[str, np.ndarray], keys: Mapping[str, Number], parameters: Mapping[str, Number]
) -> Callable[[sp.Expr], sp.Expr]:
    """A function that puts the scene's placement, velocity and exact constants into an expression of q, u and p."""
    table = resolve_parameters(scene, parameters)
    fixed = {p.symbol: table[p.name] for p in scene.parameters if p.name not in scene.contact_parameters}
    for key in scene.keys:
        if key.name in keys:
            fixed[key.symbol] = exact_number(keys[key.name], where=f"state key {key.name}")
        elif key.name not in axes and key.default is not None:
            named = {p.name: fixed[p.symbol] for p in scene.parameters if p.symbol in fixed}
            fixed[key.symbol] = parse_expression(key.default, named, where=f"default of {key.name}")
    rules = {scene.parameter(n).symbol: rule for n, rule in scene.contact_parameters.items() if n not in parameters}
    for c in scene.coordinates:
        rules[c.symbol] = scene.placement.get(c.name, sp.Integer(0))
        rules[c.velocity] = scene.velocity.get(c.name, sp.Integer(0))

    # In two steps: a key may have the name, and so the symbol, of the coordinate that it places.
    return lambda expression: expression.xreplace(rules).xreplace(fixed)
