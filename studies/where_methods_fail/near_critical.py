"""Distances on both sides of a critical value of a parameter, until eps resolves on which side it is."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from painleve.asymptotics.methods import distance
from painleve.asymptotics.sample import check_radii
from painleve.errors import InputError
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.norm_units import ball_unit, velocity_unit
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number, make_state
from painleve.store import provenance
from painleve.sweep.variables import BRANCHES, code, coded, text
from painleve.theory.classification import Branch, classify
from painleve.theory.limit_set import LimitSet

__all__ = ["NearCase", "sweep_near_critical"]


@dataclass(frozen=True, kw_only=True, eq=False)
class NearCase:
    """A state given by keys, with one parameter at critical (1 - 10^-k) and critical (1 + 10^-k) for each exponent k.

    `critical` is an exact expression, such as "4/3".
    """

    scene: Scene
    keys: Mapping[str, Number]
    parameter: str
    critical: str
    exponents: Sequence[int]

    def values(self) -> list[tuple[float, str]]:
        """(relative gap, exact value) below, from the narrowest gap on, then above."""
        gaps = [(sign, k) for sign in "-+" for k in sorted(self.exponents, reverse=True)]
        return [(float(f"{sign}1e-{k}"), f"({self.critical})*(1 {sign} 1/10**{k})") for sign, k in gaps]


def sweep_near_critical(
    cases: Sequence[NearCase],
    *,
    eps: Sequence[float],
    methods: Mapping[str, object],
    isolated: Mapping[str, object],
    progress: Callable[[str], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Bounds on both excesses, each against the exact A of its own side: the tightest of the methods named.

    `methods` maps names to options; a bound is true whichever method gave it. At isolated critical states those of
    `isolated` run too: only an enclosure tells whether e(A, A_eps) is large there or its upper bound is loose.
    All cases need as many exponents.
    Raises InputError for no cases, bad eps and states that do not exist.
    """
    radii = check_radii(eps)
    if not (cases and radii and methods) or len({len(case.exponents) for case in cases}) != 1:
        raise InputError("near a critical value: give eps, methods, and cases with equally many exponents")
    parts = [_case(case, radii, methods, isolated, progress) for case in cases]
    dataset = xr.concat(parts, "case")
    scenes = list(dict.fromkeys(case.scene for case in cases))
    source = provenance(
        scene=", ".join(s.name for s in scenes),
        seed=0,
        command=command,
        scene_digest=", ".join(make_kernels(s).digest for s in scenes),
    )
    unit = {"units": ball_unit(cases[0].scene), "long_name": "radius of the two closed balls about q and about u-"}
    title = "Distances between A and A_eps on both sides of a critical value"
    return dataset.assign_coords(eps=xr.Variable(("eps",), np.array(radii), unit)).assign_attrs(
        {"title": title, "kind": "near_critical", **source}
    )


def _case(
    case: NearCase,
    radii: Sequence[float],
    methods: Mapping[str, object],
    isolated: Mapping[str, object],
    progress: Callable[[str], None] | None,
) -> xr.Dataset:
    gaps, exact = zip(*case.values(), strict=True)
    classified = [
        classify(make_state(case.scene, keys=case.keys, parameters={case.parameter: value})) for value in exact
    ]
    forward, lower, upper = (np.empty((len(gaps), len(radii))) for _ in range(3))
    for i, classification in enumerate(classified):
        chosen = {**methods, **(isolated if classification.branch is Branch.CRITICAL_ISOLATED else {})}
        for j, radius in enumerate(radii):
            if progress is not None:
                progress(f"{case.parameter} = {exact[i]} at eps = {radius:g}")
            forward[i, j], lower[i, j], upper[i, j] = _tightest(classification.limit, radius, chosen)
    unit = velocity_unit(case.scene)

    def number(dims: tuple[str, ...], values: np.ndarray, sentence: str, units: str) -> xr.Variable:
        return xr.Variable(dims, values, {"units": units, "long_name": sentence})

    codes = np.array([code(c.branch.value, BRANCHES) for c in classified])
    jumps = np.array([np.linalg.norm(c.limit.jump) for c in classified])
    return xr.Dataset(
        {
            "excess_Aeps_A_lower": number(("value", "eps"), forward, "largest lower bound on e(A_eps, A)", unit),
            "excess_A_Aeps_lower": number(
                ("value", "eps"), lower, "largest lower bound on e(A, A_eps); NaN: none", unit
            ),
            "excess_A_Aeps_upper": number(("value", "eps"), upper, "least upper bound on e(A, A_eps)", unit),
            "distance_as_read": number(
                ("value", "eps"),
                np.fmax(forward, upper),
                "d_H as a reader takes it: the larger of the lower bound on e(A_eps, A) and the upper on e(A, A_eps)",
                unit,
            ),
            "gap": number(("value",), np.array(gaps), "relative distance of the parameter to its critical value", "1"),
            "half_jump": number(("value",), jumps / 2.0, "half the distance between u- and u_tilde", unit),
            "theorem_branch": coded(["value"], codes, BRANCHES, "branch of Theorem 1, by exact arithmetic"),
            "exact": text(["value"], list(exact), "exact value of the parameter as an expression"),
            "parameter": text(
                [],
                np.array(f"{case.scene.name}: {case.parameter} near {case.critical}", dtype=object),
                "scene and parameter of the case",
            ),
        }
    )


def _tightest(limit: LimitSet, eps: float, methods: Mapping[str, object]) -> tuple[float, float, float]:
    """e(A_eps, A) from below, e(A, A_eps) from below and from above: the best of the methods; NaN where none tells."""
    found = [distance(limit, eps, name, options) for name, options in methods.items()]
    forward, backward = [f.excess_Aeps_A.bounds for f in found], [f.excess_A_Aeps.bounds for f in found]
    return (
        max((b.lower for b in forward if b.lower is not None), default=math.nan),
        max((b.lower for b in backward if b.lower is not None), default=math.nan),
        min((b.upper for b in backward if b.upper is not None), default=math.nan),
    )
