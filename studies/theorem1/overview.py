"""All states of all scenes in one dataset: what a figure of the whole theorem shows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from painleve.mechanics.library import load_scene
from painleve.store import PROVENANCE
from painleve.sweep.variables import BRANCHES, code, coded, text

__all__ = ["overview"]

ISOLATED = code("critical_isolated", BRANCHES)


def overview(distances: Sequence[xr.Dataset]) -> xr.Dataset:
    """Both excesses over (case, eps), a case being a state of a scene; all datasets have the same eps.

    In the isolated branch the first is from the ends of A. The second is the least upper bound that is known.
    """
    parts = [_of_scene(dataset) for dataset in distances]
    units = list(dict.fromkeys(d["excess_Aeps_A_lower"].attrs["units"] for d in distances))
    dataset = xr.concat(parts, "case")
    for name in ("to_limit", "of_limit", "half_jump"):
        dataset[name].attrs["units"] = " or ".join(units)
    dataset["eps"].attrs["units"] = " or ".join(dict.fromkeys(d["eps"].attrs["units"] for d in distances))
    first = distances[0].attrs
    source = {name: first[name] for name in PROVENANCE} | {
        name: ", ".join(d.attrs[name] for d in distances) for name in ("scene", "scene_digest")
    }
    return dataset.assign_attrs({"title": "Theorem 1 at all states of all scenes", "kind": "theorem1", **source})


def _of_scene(dataset: xr.Dataset) -> xr.Dataset:
    isolated = dataset["theorem_branch"].values == ISOLATED
    forward = np.where(
        isolated[:, None], dataset["ends_excess_Aeps_A_lower"].values, dataset["excess_Aeps_A_lower"].values
    )
    backward = np.fmin(dataset["excess_A_Aeps_upper"].values, dataset["witnessed_upper"].values)
    scene, dims = load_scene(dataset.attrs["scene"]), ("case", "eps")
    count = dataset.sizes["state"]

    def number(on: tuple[str, ...], values: np.ndarray, sentence: str, units: str = "1") -> xr.Variable:
        return xr.Variable(on, values, {"long_name": sentence, "units": units})

    return xr.Dataset(
        {
            "to_limit": number(dims, forward, "lower bound on e(A_eps, A); isolated: from the ends of A"),
            "of_limit": number(dims, backward, "least upper bound on e(A, A_eps), sampled or by witnesses"),
            "half_jump": number(("case",), dataset["half_jump"].values, "half the distance between u- and u_tilde"),
            "slope": number(("case",), dataset["slope"].values, "slope of the first excess, in logarithms"),
            "tangents": number(
                ("case",), np.full(count, scene.contact.section.dimension), "number of tangents of the contact"
            ),
            "theorem_branch": coded(
                ["case"], dataset["theorem_branch"].values, BRANCHES, "branch of Theorem 1, by exact arithmetic"
            ),
        },
        {
            "case": text(["case"], [f"{scene.name} {s}" for s in dataset["state"].values], "scene and state"),
            "eps": dataset["eps"].variable.copy(),
        },
    )
