"""What samples of growing size bound at one state as eps falls, beside witnesses: the dataset of a warning."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

from painleve.asymptotics.sample import SampleOptions, check_radii, sample_distance
from painleve.asymptotics.theorem import SHADOW
from painleve.asymptotics.witness import find_family
from painleve.core.codes import ContactMode
from painleve.errors import InputError
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.norm_units import ball_unit, velocity_unit
from painleve.mechanics.state import State
from painleve.store import provenance
from painleve.theory.classification import classify

__all__ = ["sweep_sampled_bound"]

SLIPS = (ContactMode.SLIP_PLUS.label, ContactMode.SLIP_MINUS.label)


def sweep_sampled_bound(
    state: State,
    *,
    eps: Sequence[float],
    samples: Sequence[int],
    sampler: str = "kronecker",
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """The sampled and the witnessed upper bound on e(A, A_eps), and how many samples slip; (samples, eps) and (eps,).

    Raises InputError for bad eps and settings, and for an undecided limit set.
    """
    radii = np.array(check_radii(eps))
    if not len(samples):
        raise InputError("samples: no values; give at least one")
    limit, scene = classify(state).limit, state.scene
    bound, slips = (np.empty((len(samples), radii.size)) for _ in range(2))
    for i, n in enumerate(samples):
        for j, radius in enumerate(radii):
            if progress is not None:
                progress(f"{n:.0e} samples at eps = {radius:g}")
            found = sample_distance(limit, radius, SampleOptions(samples=n, sampler=sampler, seed=seed))
            bound[i, j] = found.excess_A_Aeps.bounds.upper
            slips[i, j] = sum(found.counts.get(label, 0) for label in SLIPS)
    families = [find_family(limit, radius, within=SHADOW * radius) for radius in radii]
    witnessed = np.array([np.nan if family is None else family.bound for family in families])
    unit, jump = velocity_unit(scene), float(np.linalg.norm(limit.jump))

    def number(dims: tuple[str, ...], values: np.ndarray, sentence: str, units: str) -> xr.Variable:
        return xr.Variable(dims, values, {"units": units, "long_name": sentence})

    variables = {
        "sampled_upper": number(("samples", "eps"), bound, "upper bound on e(A, A_eps) from that many samples", unit),
        "slips": number(("samples", "eps"), slips, "how many of the samples slip", "1"),
        "witnessed_upper": number(
            ("eps",), witnessed, "upper bound on e(A, A_eps) from witnesses; NaN where none were found", unit
        ),
        "half_jump": number((), np.array(jump / 2.0), "half the distance between u- and u_tilde", unit),
    }
    coordinates = {
        "samples": number(("samples",), np.array(samples), "number of samples of A_eps", "1"),
        "eps": number(("eps",), radii, "radius of the two closed balls about q and about u-", ball_unit(scene)),
    }
    source = provenance(scene=scene, scene_digest=make_kernels(scene).digest, seed=seed, command=command)
    title = f"Sampled bounds on e(A, A_eps) at {scene.name} {state.label}, {sampler} points"
    return xr.Dataset(variables, coordinates, {"title": title, "kind": "sampled_bound", "state": state.label, **source})
