"""Facts about smooth slips: which end in the singular point, and what the contact force does on the way."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import sympy as sp

from studies.reference.compare import FoundValue
from studies.reference.rod import ALPHA, MU, T, eigenvalue_ratio, on_tangent
from studies.reference.slip import Arc, ArcEnd, SlipFlow, derive_slip, make_flow

__all__ = [
    "ABOVE",
    "BELOW",
    "fan",
    "find_bounded_force",
    "find_inconsistent_not_reached",
    "find_infinite_force",
    "find_stoss_angle",
    "find_stoss_time",
]

BELOW, ABOVE = (1.42, 1.45, 1.5), (5 / 3, 2.0)  # mu on either side of mu_C = 1.5396 of the uniform rod
# Slips start at these parts of the way to the lower edge from tan(theta) = 1/mu, where slip begins to turn the rod
# towards it, and to the upper edge from a right angle.
PLACES = (0.05, 0.35, 0.65, 0.95)
SHARES, QUICK_SHARES = 25, 7
NEAREST, NEAR = 1e-10, 1e-7  # rad from the edge: a slip into the point is judged by what it does between them
MISFIT = 1e-4  # of the force there, relative, to A x^(r - 1) + B: the terms left out are smaller by a factor x
STOSS = {"mu": 5 / 3, "theta": math.radians(31.0), "gravity": 10.0}


@lru_cache(maxsize=16)
def fan(mu: float, shares: int, *, above: bool = False) -> tuple[Arc, ...]:
    """Slips of the uniform rod towards its band of paradoxes, from consistent states below the band, or above it.

    From each angle at `shares` rates from rest to nearly lift-off.
    """
    flow = make_flow(mu)
    first, edge, sense = (math.pi / 2, flow.edges[1], -1.0) if above else (math.atan(1.0 / mu), flow.edges[0], 1.0)
    angles = [first + place * (edge - first) for place in PLACES]
    return tuple(
        flow.arc(theta, sense * flow.rate_for(theta, share), nearest=NEAREST)
        for theta in angles
        for share in np.linspace(1.0, 0.02, shares)
    )


def find_bounded_force(*, quick: bool) -> FoundValue:
    """Whether slips below mu_C lift off with a finite force before the edge."""
    arcs = [arc for mu in BELOW for arc in fan(mu, _shares(quick))]
    lifted = sum(arc.end is ArcEnd.LIFT_OFF for arc in arcs)
    nearest, growth = min(arc.distance[-1] for arc in arcs), max(arc.force.max() / arc.force[0] for arc in arcs)
    route = (
        f"{len(arcs)} slips at mu = {_listed(BELOW)}: {lifted} lift off before the edge, the nearest at "
        f"{nearest:.1g} rad; no force exceeds {growth:.3f} times that at its start"
    )
    return FoundValue(value="bounded" if lifted == len(arcs) else "not bounded", route=route)


def find_infinite_force(*, quick: bool) -> FoundValue:
    """Whether F on slips into the point is A x^(r - 1) + B near it, A > 0, r < 1, with x the distance to the edge."""
    grows, words = True, []
    for mu in ABOVE:
        ratio, arrived = _ratio(mu), _arrived(mu, quick)
        fits = [_fit(arc, ratio) for arc in arrived]
        misfit = max((fit[1] for fit in fits), default=math.inf)
        largest = max((arc.force[-1] for arc in arrived), default=0.0)
        grows &= ratio < 1.0 and misfit < MISFIT and all(fit[0] > 0.0 for fit in fits)
        words.append(
            f"mu = {mu:.4g}: {len(arrived)} come within {NEAREST:g} rad, there F is up to {largest:.0e} "
            f"m gravity and A x^{ratio - 1.0:.3f} + B to {misfit:.0e}"
        )
    return FoundValue(value="infinite" if grows else "not so", route="; ".join(words))


def find_inconsistent_not_reached(*, quick: bool) -> FoundValue:
    """Whether each slip lifts off, turns back, or has the free normal acceleration vanish as it comes to the edge."""
    mus = (*BELOW, *ABOVE)
    arcs = [arc for mu in mus for above in (False, True) for arc in fan(mu, _shares(quick), above=above)]
    lifted, turned = (sum(arc.end is end for arc in arcs) for end in (ArcEnd.LIFT_OFF, ArcEnd.TURNS_BACK))
    arrived = [(_ratio(mu), arc) for mu in ABOVE for arc in _arrived(mu, quick)]
    # beta ~ x^r, so it has to fall by this much; twice that allows for the next term
    vanishing = sum(arc.beta[-1] / arc.beta[_first_near(arc)] < 2.0 * (NEAREST / NEAR) ** r for r, arc in arrived)
    largest = max((-arc.beta[-1] for _, arc in arrived), default=0.0)
    others = len(arcs) - lifted - turned - vanishing
    route = (
        f"{len(arcs)} slips from either side of the band at mu = {_listed(mus)}: {lifted} lift off, {turned} turn "
        f"back, {vanishing} end in the 0/0 point (|beta| <= {largest:.0e} gravity at {NEAREST:g} rad, falling "
        f"like x^r), {others} elsewhere"
    )
    return FoundValue(value="not reached" if others == 0 else "reached", route=route)


def _shares(quick: bool) -> int:
    return QUICK_SHARES if quick else SHARES


def _arrived(mu: float, quick: bool) -> list[Arc]:
    return [arc for arc in fan(mu, _shares(quick)) if arc.end is ArcEnd.EDGE]


def _listed(values: tuple[float, ...]) -> str:
    return ", ".join(f"{value:.4g}" for value in values)


def _ratio(mu: float) -> float:
    """r of the uniform rod on the lower edge at this mu."""
    return float(eigenvalue_ratio().xreplace({ALPHA: sp.Integer(3), T: sp.Float(math.tan(make_flow(mu).edges[0]))}))


def _first_near(arc: Arc) -> int:
    return int(np.argmax(arc.distance < NEAR))


def _fit(arc: Arc, ratio: float) -> tuple[float, float]:
    """A of F = A x^(r - 1) + B at the end of an arc into the point, and the largest relative misfit."""
    near = arc.distance < NEAR
    x, force = arc.distance[near], arc.force[near]
    terms = np.column_stack([x ** (ratio - 1.0), np.ones_like(x)]) / force[:, None]
    coefficients = np.linalg.lstsq(terms, np.ones_like(x))[0]
    return float(coefficients[0]), float(np.abs(terms @ coefficients - 1.0).max())


def find_stoss_angle() -> FoundValue:
    """Where the smooth slip of Glocker's rod ends: the edge of its band, exactly, and where the slip arrives."""
    values = {ALPHA: sp.Integer(3), MU: sp.Rational(5, 3)}
    slopes = sp.solve(on_tangent(derive_slip().edge.xreplace(values)), T)
    exact, (flow, arc) = sp.atan(min(slopes)), _stoss()
    arrives = arc.end is ArcEnd.EDGE
    gap = abs(flow.edges[0] - float(exact)) / float(exact) if arrives else math.inf
    route = f"the edge of the band solved, and bracketed; the slip comes within {arc.distance[-1]:.0e} rad of it"
    return FoundValue(value=exact, route=route, gap=gap)


def find_stoss_time() -> FoundValue:
    """When: the slip integrated in the time dt/p, and the last stretch at its constant rate."""
    _, arc = _stoss()
    value = float(arc.t[-1] + arc.distance[-1] / arc.omega[-1])
    route = f"Newton's equations in the time dt/p by DOP853, relative tolerance 1e-13: {value:.12f}"
    return FoundValue(value=value, error=1e-11, route=route)


@lru_cache(maxsize=1)
def _stoss() -> tuple[SlipFlow, Arc]:
    flow = make_flow(STOSS["mu"], gravity=STOSS["gravity"])
    return flow, flow.arc(STOSS["theta"], 0.0)
