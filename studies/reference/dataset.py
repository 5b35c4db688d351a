"""The reproduced facts as a dataset, with what a picture of them needs: mu_c over the angle, and forces along slips."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import sympy as sp
import xarray as xr

from painleve.kernels.compiled import make_kernels
from painleve.mechanics.library import load_scene
from painleve.store import provenance
from painleve.sweep.variables import code, coded, text
from studies.reference.compare import FactStatus, Reproduction
from studies.reference.facts import Fact
from studies.reference.rod import ALPHA, MU, T, critical_friction
from studies.reference.slip import Arc
from studies.reference.slips import ABOVE, BELOW, NEAREST, fan

__all__ = ["STATUSES", "as_dataset"]

ALPHAS = (1, 2, 3, 6)
ANGLES = np.radians(np.linspace(5.0, 88.0, 167))
DISTANCES = np.logspace(0.0, np.log10(2.0 * NEAREST), 140)
SHOWN = 7  # slips from each angle
EDGES_AT = (5 / 3, 2.0)
STATUSES = tuple(status.name.lower() for status in FactStatus)


def as_dataset(found: Sequence[Reproduction], *, seed: int = 0, command: str | None = None) -> xr.Dataset:
    """Facts over (fact); mu_c over (alpha, theta) from the derivation, published values beside it; forces of slips."""
    facts = {reproduction.fact.id: reproduction.fact for reproduction in found}
    variables = {**_facts(found), **_curves(), **_published(facts), **_slips()}
    coordinates = {
        "fact": text(["fact"], list(facts), "published fact by its id"),
        "alpha": _number(("alpha",), ALPHAS, "shape of the rod, m l^2/I", "1"),
        "theta": _number(("theta",), ANGLES, "inclination of the rod", "rad"),
        "distance": _number(("distance",), DISTANCES, "angle before the edge of the band", "rad"),
        "edge_friction": _number(("edge_friction",), EDGES_AT, "coefficient of friction", "1"),
    }
    digest = make_kernels(load_scene("slender_rod")).digest
    source = provenance(scene="slender_rod", scene_digest=digest, seed=seed, command=command)
    title = "Published facts about the slender rod and what was found"
    return xr.Dataset(variables, coordinates, {"title": title, "kind": "reference", **source})


def _number(dims: tuple[str, ...], values: object, sentence: str, unit: str) -> xr.Variable:
    return xr.Variable(dims, np.asarray(values, float), {"long_name": sentence, "units": unit})


def _facts(found: Sequence[Reproduction]) -> dict[str, xr.Variable]:
    columns = {
        "statement": ([r.fact.statement for r in found], "what is stated in short"),
        "says": ([r.fact.says for r in found], "what the source says in other words"),
        "published": ([r.fact.value for r in found], "value as it is published"),
        "value_kind": ([r.fact.kind.value for r in found], "what the published value is"),
        "basis": ([r.fact.basis.value for r in found], "where the published value was seen"),
        "found": ([str(r.found.value) for r in found], "value that was found here"),
        "difference": ([r.difference or "-" for r in found], "found minus published value"),
        "route": ([r.found.route for r in found], "how the value was found"),
        "obstacle": ([r.found.obstacle for r in found], "why the fact lies outside, empty otherwise"),
        "source": ([r.fact.source.citation for r in found], "where it is published"),
        "source_read": ([r.fact.source.read for r in found], "how much of the source could be read"),
    }
    variables = {name: text(["fact"], values, sentence) for name, (values, sentence) in columns.items()}
    codes = np.array([code(r.status.name.lower(), STATUSES) for r in found])
    variables["status"] = coded(["fact"], codes, STATUSES, "whether the fact was reproduced")
    gaps = [math.nan if r.found.gap is None else r.found.gap for r in found]
    variables["gap"] = _number(("fact",), gaps, "relative difference of a second route; NaN without one", "1")
    return variables


def _curves() -> dict[str, xr.Variable]:
    function = sp.lambdify([ALPHA, T], critical_friction(), "numpy")
    values = function(np.array(ALPHAS, float)[:, None], np.tan(ANGLES))
    sentence = "critical friction from the derivation of the scene"
    return {"critical_friction": _number(("alpha", "theta"), values, sentence, "1")}


def _published(facts: dict[str, Fact]) -> dict[str, xr.Variable]:
    """Published values, as numbers, where mu_c is drawn: least values, band edges, the rod at 60 degrees, mu_C."""

    def at(fact: str, symbol: sp.Symbol, values: Sequence[float]) -> np.ndarray:
        return np.array([float(facts[fact].expression.xreplace({symbol: sp.Float(v)})) for v in values])

    angles = np.arctan(at("mu_P_slope", ALPHA, ALPHAS))
    edges = np.arctan([at(name, MU, EDGES_AT) for name in ("lower_band_edge", "upper_band_edge")])
    sixty, singular = (float(facts[name].expression) for name in ("sixty_degrees_friction", "mu_C_uniform"))
    return {
        "least_friction": _number(("alpha",), at("mu_P", ALPHA, ALPHAS), "published mu_P of the rod", "1"),
        "least_friction_angle": _number(("alpha",), angles, "published angle at mu_P", "rad"),
        "edges": _number(("side", "edge_friction"), edges, "published edges of the band, alpha = 3", "rad"),
        "sixty_degrees_friction": _number((), sixty, "published mu_c at 60 degrees, alpha = 3", "1"),
        "singular_friction": _number((), singular, "published mu_C of the uniform rod", "1"),
    }


def _slips() -> dict[str, xr.Variable]:
    """F along slips over the distance to the edge; NaN before the start and after lift-off."""
    arcs = [(mu, arc) for mu in (BELOW[1], ABOVE[0]) for arc in fan(mu, SHOWN)]
    forces = [_over_distance(arc) for _, arc in arcs]
    friction = [mu for mu, _ in arcs]
    return {
        "slip_force": _number(("slip", "distance"), forces, "contact force of the smooth slip over m gravity", "1"),
        "slip_friction": _number(("slip",), friction, "friction of the slipping rod", "1"),
    }


def _over_distance(arc: Arc) -> np.ndarray:
    """The force on the common grid, interpolated in logarithms."""
    known = arc.force > 0.0
    x, force = -np.log(arc.distance[known]), np.log(arc.force[known])
    return np.exp(np.interp(-np.log(DISTANCES), x, force, left=np.nan, right=np.nan))
