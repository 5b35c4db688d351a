"""A trajectory as a dataset: units, sentences and codes, and the body's outline over time for pictures."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import sympy as sp
import xarray as xr

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change
from painleve.dataset_names import IN_TRAJECTORIES, hold_to
from painleve.dynamics.contact_rows import tangential_names
from painleve.dynamics.start import Start
from painleve.mechanics.norm_units import gamma_unit

__all__ = ["record"]

TANGENTIAL = {"t": "tangential", "t1": "first tangential", "t2": "second tangential"}


def record(start: Start, columns: Mapping[str, np.ndarray], facts: Mapping[str, str | float]) -> xr.Dataset:
    """Variables over `time`, one a coordinate since their units differ; codes count from 1, and 0 is `not_run`.

    columns: t (n,), q, u (n, d), r (n, 1 + k), and over the instants branch, change, contact_force, contact_work,
    splitting_loss, g, gamma, v_n, v_t (in space v_t1, v_t2) and kinetic_energy. facts: attributes, among them the
    scheme, and how it ended.
    No step ends at the first instant, so its codes are 0. Lengths of the contact point are in metres where the scene
    says so by having an outline, in the scene's own units ("SI") otherwise.
    """
    scene = start.scene
    motion = _motion(start, columns)
    variables = {**motion, **_contact(start, columns), **_outline(start, columns["q"])}
    time = ("time", columns["t"], {"units": "s", "long_name": "time along the trajectory"})
    attributes = {
        "title": f"Trajectory of {scene.name} by {facts['scheme']}: {scene.sentence}",
        "kind": "trajectory",
        "scene": scene.name,
        "start": start.label,
        **facts,
        "coordinates_of_scene": " ".join(c.name for c in scene.coordinates),
        "parameters": ", ".join(f"{s.name} = {x:.17g}" for s, x in zip(scene.parameters, start.p, strict=True)),
    }
    dataset = xr.Dataset(variables, {"time": time}, attributes)
    hold_to(IN_TRAJECTORIES, [*dataset.variables, *dataset.dims], motion)
    return dataset


def _number(values: np.ndarray, sentence: str, unit: str, dims: tuple[str, ...] = ("time",)) -> xr.Variable:
    return xr.Variable(dims, values, {"units": unit, "long_name": sentence})


def _code(values: np.ndarray, sentence: str, codes: type[ContactMode] | type[Change]) -> xr.Variable:
    """CF flags, with 0 for the start, where no step ends."""
    known = np.arange(len(codes) + 1, dtype=np.int8)
    meanings = " ".join(["not_run", *(c.label for c in codes)])
    shifted = np.where(np.arange(len(values)) > 0, values + 1, 0).astype(np.int8)
    attributes = {"long_name": sentence, "units": "1", "flag_values": known, "flag_meanings": meanings}
    return xr.Variable(("time",), shifted, attributes)


def _motion(start: Start, columns: Mapping[str, np.ndarray]) -> dict[str, xr.Variable]:
    variables = {}
    for j, c in enumerate(start.scene.coordinates):
        rate = "1/s" if c.unit == "1" else f"{c.unit}/s"
        variables[c.name] = _number(columns["q"][:, j], f"coordinate {c.name}: {c.sentence}", c.unit)
        variables[f"u_{c.name}"] = _number(columns["u"][:, j], f"velocity of {c.name}: {c.sentence}", rate)
    return variables


def _contact(start: Start, columns: Mapping[str, np.ndarray]) -> dict[str, xr.Variable]:
    scene, sentence = start.scene, "gamma, the least normal compliance: below 0 the law is discontinuous"
    length, speed, impulse = ("m", "m/s", "N s") if scene.outline else ("SI", "SI", "SI")
    tangential = {side: TANGENTIAL[side] for side in tangential_names(start.motion)}
    sentences = {
        "g": ("constraint g(q), admissible where it is not positive", length),
        "gamma": (sentence, gamma_unit(scene)),
        "v_n": ("normal velocity of the contact point, positive away from the obstacle", speed),
        **{f"v_{side}": (f"{words} velocity of the contact point", speed) for side, words in tangential.items()},
        "kinetic_energy": ("kinetic energy of the scene", "J"),
    }
    variables = {name: _number(columns[name], *meaning) for name, meaning in sentences.items()}
    for j, (side, words) in enumerate({"n": "normal", **tangential}.items()):
        sentence = f"{words} contact impulse of the step that ends here"
        variables[f"r_{side}"] = _number(columns["r"][:, j], sentence, impulse)
    force = "normal contact force: the impulse over the time since the contact before; NaN at jumps"
    work = "work of the contact since the start: the law's own dissipation"
    loss = "what the scheme loses at the contact since the start: its error, O(h)"
    variables["contact_force"] = _number(columns["contact_force"], force, "N" if start.scene.outline else "SI")
    variables["contact_work"] = _number(columns["contact_work"], work, "J")
    variables["splitting_loss"] = _number(columns["splitting_loss"], loss, "J")
    sentence = "branch of the contact law in the step that ends here"
    variables["branch"] = _code(columns["branch"], sentence, ContactMode)
    variables["change"] = _code(columns["change"], "change of the velocity at the contact in that step", Change)
    return variables


def _outline(start: Start, q: np.ndarray) -> dict[str, xr.Variable]:
    outline = start.scene.outline
    if outline is None:
        return {}
    x, y = (_evaluate(start, [point[k] for point in outline.points], q) for k in (0, 1))
    floor = _evaluate(start, [outline.floor], q)[0, 0]
    sentence = "coordinate of the points that outline the body"
    return {
        "outline_x": _number(x, f"horizontal {sentence}", "m", ("time", "point")),
        "outline_y": _number(y, f"vertical {sentence}", "m", ("time", "point")),
        "floor": _number(floor, "height of the floor below the body", "m", ()),
    }


def _evaluate(start: Start, expressions: list[sp.Expr], q: np.ndarray) -> np.ndarray:
    """Expressions in q (n, d) and the parameters (n, number of expressions)."""
    function = sp.lambdify((*start.scene.q, *start.scene.p), expressions, "numpy", dummify=True)
    values = function(*q.T, *start.p)
    return np.stack([np.broadcast_to(value, len(q)) for value in values], axis=1).astype(float)
