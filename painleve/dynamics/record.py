"""A trajectory as a dataset: units, sentences and codes, and the body's outline over time for pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import sympy as sp
import xarray as xr

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change
from painleve.dataset_names import IN_TRAJECTORIES, hold_to
from painleve.dynamics.contact_rows import tangential_names
from painleve.dynamics.proposition1 import MARGIN_SCALE
from painleve.mechanics.scene import Scene

if TYPE_CHECKING:
    from painleve.dynamics.trajectory import Trajectory

__all__ = ["record"]

TANGENTIAL = {"t": "tangential", "t1": "first tangential", "t2": "second tangential"}


def record(trajectory: Trajectory) -> xr.Dataset:
    """Variables over `time`, one a coordinate since their units differ; codes count from 1, and 0 is `not_run`.

    No step ends at the first instant, so its codes are 0. Lengths of the contact point are in metres where the scene
    says so by having an outline, in the scene's own units ("SI") otherwise.
    """
    scene = trajectory.start.scene
    with np.errstate(over="ignore", invalid="ignore"):  # energies of a motion that all but leaves the numbers
        motion = _motion(trajectory)
        variables = {**motion, **_contact(trajectory), **_outline(trajectory)}
    time = ("time", trajectory.t, {"units": "s", "long_name": "time along the trajectory"})
    attributes = {
        "title": f"Trajectory of {scene.name} by {trajectory.scheme}: {scene.sentence}",
        "kind": "trajectory",
        "scene": scene.name,
        "start": trajectory.start.label,
        "scheme": trajectory.scheme,
        "status": trajectory.ending.label,
        "ending": trajectory.sentence,
        "coordinates_of_scene": " ".join(c.name for c in scene.coordinates),
        "parameters": ", ".join(
            f"{s.name} = {x:.17g}" for s, x in zip(scene.parameters, trajectory.start.p, strict=True)
        ),
    }
    dataset = xr.Dataset(variables, {"time": time}, attributes | _margins(trajectory))
    hold_to(IN_TRAJECTORIES, [*dataset.variables, *dataset.dims], motion)
    return dataset


def _margins(trajectory: Trajectory) -> dict[str, str | float]:
    """The worst margins of Proposition 1 as attributes, where they were asked for, and what they are relative to."""
    margins = trajectory.proposition1
    if margins is None:
        return {}
    worst: dict[str, str | float] = {f"proposition1_{name}": margin for name, margin in margins.as_dict().items()}
    return worst | {"proposition1_margins": f"the worst of all steps, positive where a statement fails; {MARGIN_SCALE}"}


def _number(values: np.ndarray, sentence: str, unit: str, dims: tuple[str, ...] = ("time",)) -> xr.Variable:
    return xr.Variable(dims, values, {"units": unit, "long_name": sentence})


def _code(values: np.ndarray, sentence: str, codes: type[ContactMode] | type[Change]) -> xr.Variable:
    """CF flags, with 0 for the start, where no step ends."""
    known = np.arange(len(codes) + 1, dtype=np.int8)
    meanings = " ".join(["not_run", *(c.label for c in codes)])
    shifted = np.where(np.arange(len(values)) > 0, values + 1, 0).astype(np.int8)
    attributes = {"long_name": sentence, "units": "1", "flag_values": known, "flag_meanings": meanings}
    return xr.Variable(("time",), shifted, attributes)


def _motion(trajectory: Trajectory) -> dict[str, xr.Variable]:
    variables = {}
    for j, c in enumerate(trajectory.start.scene.coordinates):
        rate = "1/s" if c.unit == "1" else f"{c.unit}/s"
        variables[c.name] = _number(trajectory.q[:, j], f"coordinate {c.name}: {c.sentence}", c.unit)
        variables[f"u_{c.name}"] = _number(trajectory.u[:, j], f"velocity of {c.name}: {c.sentence}", rate)
    return variables


def _contact(trajectory: Trajectory) -> dict[str, xr.Variable]:
    length, speed, impulse = ("m", "m/s", "N s") if trajectory.start.scene.outline else ("SI", "SI", "SI")
    tangential = {side: TANGENTIAL[side] for side in tangential_names(trajectory.start.motion)}
    sentences = {
        "g": ("constraint g(q), admissible where it is not positive", length),
        "gamma": ("gamma, the least normal compliance: the law is discontinuous where it is negative", "SI"),
        "v_n": ("normal velocity of the contact point, positive away from the obstacle", speed),
        **{f"v_{side}": (f"{words} velocity of the contact point", speed) for side, words in tangential.items()},
        "kinetic_energy": ("kinetic energy of the scene", "J"),
    }
    values = trajectory.contact_quantities()
    variables = {name: _number(values[name], *meaning) for name, meaning in sentences.items()}
    for j, (side, words) in enumerate({"n": "normal", **tangential}.items()):
        sentence = f"{words} contact impulse of the step that ends here"
        variables[f"r_{side}"] = _number(trajectory.r[:, j], sentence, impulse)
    variables["contact_work"] = _number(trajectory.contact_work(), "work of the contact impulses since the start", "J")
    variables["branch"] = _code(trajectory.branch, "branch of the contact law in the step that ends here", ContactMode)
    variables["change"] = _code(trajectory.change, "change of the velocity at the contact in that step", Change)
    return variables


def _outline(trajectory: Trajectory) -> dict[str, xr.Variable]:
    scene = trajectory.start.scene
    if scene.outline is None:
        return {}
    x, y = (_evaluate(scene, [point[k] for point in scene.outline.points], trajectory) for k in (0, 1))
    floor = _evaluate(scene, [scene.outline.floor], trajectory)[0, 0]
    sentence = "coordinate of the points that outline the body"
    return {
        "outline_x": _number(x, f"horizontal {sentence}", "m", ("time", "point")),
        "outline_y": _number(y, f"vertical {sentence}", "m", ("time", "point")),
        "floor": _number(floor, "height of the floor below the body", "m", ()),
    }


def _evaluate(scene: Scene, expressions: list[sp.Expr], trajectory: Trajectory) -> np.ndarray:
    """Expressions in q and the parameters at every instant (n, number of expressions)."""
    function = sp.lambdify((*scene.q, *scene.p), expressions, "numpy", dummify=True)
    columns = function(*trajectory.q.T, *trajectory.start.p)
    return np.stack([np.broadcast_to(column, len(trajectory.t)) for column in columns], axis=1).astype(float)
