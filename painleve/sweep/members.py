"""Members of A_eps beside A in the space of velocities, projected on a plane: the dataset of a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from painleve.asymptotics.sample import SampleOptions, check_radii, sample_members
from painleve.asymptotics.witness import find_family
from painleve.errors import InputError
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.norm_units import ball_unit, velocity_unit
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number
from painleve.store import provenance
from painleve.sweep.grid import make_grid
from painleve.sweep.variables import BRANCHES, LAW_BRANCHES, LIMIT_SETS, code, coded, text
from painleve.theory.classification import classify
from painleve.theory.limit_set import LimitSet

__all__ = ["sweep_members"]

SHADOW = 1e-3  # how near to A, in units of eps, the witnesses are asked to come
MOST_MEMBERS = 100_000  # a picture shows no more, and the file stays small


def sweep_members(
    scene: Scene,
    *,
    eps: Sequence[float],
    states: Sequence[str] = (),
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
    options: SampleOptions | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Sampled members of A_eps as offsets S - u-, their projection on a plane, the ends of A, and witnesses.

    The plane is spanned by the jump u_tilde - u- and, orthogonal to it, the direction in which the members of the first
    eps spread most (without a jump: the two directions of largest spread). Velocities are rounded; `along` and
    `across` are coordinates in that plane. Witnesses are the two ends of an affine family of members.

    Raises InputError for bad eps, names and values, more than 100000 samples, and a limit set that is undecided.
    """
    radii = check_radii(eps)
    options = options or SampleOptions(samples=4096, sampler="uniform")
    if options.samples > MOST_MEMBERS:
        raise InputError(f"samples: {options.samples} are more than a picture shows; at most {MOST_MEMBERS}")
    grid = make_grid(scene, states=states, keys=keys, parameters=parameters)
    pictures = [_picture(classify(grid.state(index)).limit, radii, options) for index in grid.points()]
    branches = [code(classify(grid.state(index)).branch.value, BRANCHES) for index in grid.points()]
    variables = {name: xr.concat([p[name] for p in pictures], "state").variable for name in pictures[0].data_vars}
    variables["theorem_branch"] = coded(
        ["state"], np.array(branches), BRANCHES, "branch of Theorem 1, by exact arithmetic"
    )
    unit = {"units": ball_unit(scene), "long_name": "radius of the two closed balls about q and about u-"}
    coordinates = grid.coordinates() | {
        "eps": xr.Variable(("eps",), np.array(radii), unit),
        "coordinate": text(["coordinate"], [c.name for c in scene.coordinates], "coordinate of the configuration"),
    }
    source = provenance(scene=scene, scene_digest=make_kernels(scene).digest, seed=options.seed, command=command)
    title = f"A and sampled members of A_eps of {scene.name}: {scene.sentence}"
    return xr.Dataset(variables, coordinates, {"title": title, "kind": "members", **source})


def _picture(limit: LimitSet, radii: list[float], options: SampleOptions) -> xr.Dataset:
    """One state at every eps."""
    if limit.kind == "undecided":
        raise InputError(f"state {limit.state.label}: no picture of a limit set that is undecided: {limit.reason}")
    samples = [sample_members(limit, eps, replace(options, progress=None)) for eps in radii]
    offsets = np.array([s["offset"] for s in samples])
    axes = _axes(limit.jump, offsets[0])
    projected = offsets @ axes.T
    witnesses = np.array([_witnesses(limit, eps) for eps in radii]) @ axes.T
    unit, cloud = velocity_unit(limit.state.scene), ("eps", "member")
    codes = np.array([s["branch"] for s in samples]) + 1

    def number(dims: tuple[str, ...], values: np.ndarray, sentence: str, units: str = unit) -> xr.Variable:
        return xr.Variable(dims, values, {"units": units, "long_name": sentence})

    return xr.Dataset(
        {
            "offset": number((*cloud, "coordinate"), offsets, "sampled member S(q_eps, v_eps) of A_eps, minus u-"),
            "law_branch": coded(cloud, codes, LAW_BRANCHES, "branch of the law at the sampled member"),
            "along": number(cloud, projected[..., 0], "component of the member's offset along the first axis"),
            "across": number(cloud, projected[..., 1], "component of the member's offset along the second axis"),
            "witness_along": number(("eps", "end"), witnesses[..., 0], "witness at an end of A, along the first axis"),
            "witness_across": number(
                ("eps", "end"), witnesses[..., 1], "witness at an end of A, along the second axis"
            ),
            "axis_along": number(("coordinate",), axes[0], "first axis, a unit vector: the jump u_tilde - u-", "1"),
            "axis_across": number(("coordinate",), axes[1], "second axis, a unit vector: the largest spread", "1"),
            "jump_length": number((), np.array(np.linalg.norm(limit.jump)), "distance between u- and u_tilde"),
            "limit_set": coded((), np.array(code(limit.kind, LIMIT_SETS)), LIMIT_SETS, "what kind of set A is"),
        }
    )


def _axes(jump: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """(2, d) orthonormal rows: the jump, if there is one, then directions of largest spread about the mean."""
    length = np.linalg.norm(jump)
    first = [jump / length] if length > 0.0 else []
    rest = offsets - offsets.mean(axis=0)
    for axis in first:
        rest = rest - np.outer(rest @ axis, axis)
    spread = np.linalg.svd(rest, full_matrices=False)[2]
    directions = [v * np.sign(v[np.argmax(np.abs(v))]) for v in spread]
    return np.array([*first, *directions][:2])


def _witnesses(limit: LimitSet, eps: float) -> np.ndarray:
    """(2, d) offsets of the two ends of the family that shadows A; NaN where there is none."""
    family = find_family(limit, eps, within=SHADOW * eps)
    if family is None:
        return np.full((2, len(limit.state.u)), np.nan)
    return np.array([family.first.offset, family.last.offset])
