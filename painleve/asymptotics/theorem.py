"""Theorem 1 (paper, section 3): what measured distances say of the statement of the branch that holds at a state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from painleve.asymptotics.distance import Distance
from painleve.asymptotics.sections.listed import asymptotics_of
from painleve.asymptotics.witness import find_family
from painleve.sets import Bounds
from painleve.theory.classification import Branch, Classification
from painleve.theory.limit_set import LimitSet

__all__ = ["Evidence", "Verdict", "VerdictStatus", "collect", "judge", "slope"]

SHADOW = 1e-3  # how near, in units of eps, the witnesses of eq. (10) are asked to come
ROUNDING = 1e-12  # relative, of half the segment's length as it is compared with bounds
# Of an excess that tends to zero. In the plane the slope is 1; in space it is 1 or, where gamma = 0 and the jump ends
# in slip, 1/2 (painleve.asymptotics.space.rates): measured slopes scatter about it and must not fail for that.
LEAST_SLOPE, LEAST_SLOPE_OF_ROOT = 0.5, 0.4
RATES_PART = 0.75  # half-way between the two


class VerdictStatus(Enum):
    """What is known of a statement. PROVED: every bound that it needs is decided on both sides."""

    PROVED = "proved"
    CONSISTENT = "consistent"
    REFUTED = "refuted"
    UNDECIDED = "undecided"


@dataclass(frozen=True, kw_only=True, eq=False)
class Evidence:
    """What is known at one eps: the distances between A and A_eps, those between {u-, u_tilde} and A_eps (the same
    unless A is a segment), and an upper bound on e(A, A_eps) from witnesses (None: none were found)."""

    eps: float
    distance: Distance
    ends: Distance
    witnessed: float | None

    def __repr__(self) -> str:
        there, back = self.distance.excess_Aeps_A.bounds, self.distance.excess_A_Aeps.bounds
        witnessed = "no witnesses" if self.witnessed is None else f"by witnesses {Bounds.at_most(self.witnessed)}"
        return f"Evidence(eps = {self.eps:g}, e(A_eps, A) {there}, e(A, A_eps) {back}, {witnessed})"


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What distances at several eps say of the branch's statement; slope: of log e(A_eps, A) against log eps."""

    branch: Branch
    status: VerdictStatus
    reason: str
    slope: float | None

    def __repr__(self) -> str:
        slope = "" if self.slope is None else f", slope {self.slope:.3g}"
        return f"Verdict({self.branch.value}, {self.status.value}{slope})"


def collect(classification: Classification, eps: float, measure: Callable[[LimitSet, float], Distance]) -> Evidence:
    """Measure the distances at one eps by the given method, and look for witnesses."""
    limit = classification.limit
    distance = measure(limit, eps)
    ends = measure(limit.ends, eps) if limit.kind == "segment" else distance
    family = find_family(limit, eps, within=SHADOW * eps)
    return Evidence(eps=eps, distance=distance, ends=ends, witnessed=family.bound if family else None)


def judge(classification: Classification, evidence: Sequence[Evidence]) -> Verdict:
    """What the evidence says of the branch's statement; of a repeated eps the first counts.

    CONSISTENT rests on one-sided numbers, PROVED on enclosures at every eps given (the limit itself is the theorem's).
    REFUTED needs a bound that the statement forbids whatever happens at smaller eps. Balls are nested, so e(A, A_eps)
    can only grow as eps falls, and a lower bound on it does; e(A_eps, A) can always fall later, as it does where mu is
    so near to critical that eps does not resolve the difference: numbers that have not begun to fall decide nothing.
    """
    once: dict[float, Evidence] = {}
    for e in evidence:
        once.setdefault(e.eps, e)
    evidence = list(once.values())
    forward = [_forward(classification, e) for e in evidence]
    rate = slope([e.eps for e in evidence], [bounds.lower or 0.0 for bounds in forward])
    status, reason = _status(classification, evidence, rate)
    return Verdict(branch=classification.branch, status=status, reason=reason, slope=rate)


def _forward(classification: Classification, evidence: Evidence) -> Bounds:
    """Of e(A_eps, .), from the set that A_eps tends to."""
    isolated = classification.branch is Branch.CRITICAL_ISOLATED
    return (evidence.ends if isolated else evidence.distance).excess_Aeps_A.bounds


def _status(
    classification: Classification, evidence: Sequence[Evidence], rate: float | None
) -> tuple[VerdictStatus, str]:
    if classification.branch is Branch.UNDECIDED:
        return VerdictStatus.UNDECIDED, classification.reason
    forbidden = _forbidden(classification, evidence)
    if forbidden is not None:
        return VerdictStatus.REFUTED, forbidden
    if rate is None:
        return VerdictStatus.UNDECIDED, "distances at two values of eps at least are needed"
    if rate < _least_slope(classification):
        return VerdictStatus.UNDECIDED, (
            f"members of A_eps have not come nearer at these eps (eps^{rate:.2f}): "
            "smaller ones are needed, or they stay away"
        )
    if classification.branch is Branch.CRITICAL_ISOLATED:
        return _isolated_status(classification, evidence)
    missing = [e.eps for e in evidence if e.witnessed is None]
    if missing:
        return VerdictStatus.UNDECIDED, f"no witnesses of e(A, A_eps) -> 0 were found at eps = {missing[0]:g}"
    if _enclosed(classification, evidence):
        return VerdictStatus.PROVED, "both excesses are enclosed at every eps, and witnesses shadow all of A"
    near = "eps" if rate is None or rate > RATES_PART else "the root of eps"
    return VerdictStatus.CONSISTENT, f"members of A_eps come as near to A as {near}, and witnesses shadow all of A"


def _forbidden(classification: Classification, evidence: Sequence[Evidence]) -> str | None:
    """Where (10) holds e(A, A_eps) is zero at every eps; at an isolated state it never exceeds half the segment."""
    isolated = classification.branch is Branch.CRITICAL_ISOLATED
    most = _half(classification) * (1.0 + ROUNDING) if isolated else 0.0
    for e in evidence:
        lower = e.distance.excess_A_Aeps.bounds.lower
        if lower is not None and lower > most:
            return f"at eps = {e.eps:g} and all below it, e(A, A_eps) is at least {lower:.3g}; {most:.3g} is allowed"
    return None


def _isolated_status(classification: Classification, evidence: Sequence[Evidence]) -> tuple[VerdictStatus, str]:
    """e(A, A_eps) must tend to half the segment's length: members near the ends come no nearer."""
    half = _half(classification)
    last = min(evidence, key=lambda e: e.eps)
    backward = last.distance.excess_A_Aeps.bounds
    if backward.upper is None and backward.lower is None:
        return VerdictStatus.UNDECIDED, "nothing is known of e(A, A_eps)"
    if backward.upper is not None and backward.upper < half / 2.0:
        return VerdictStatus.UNDECIDED, (
            f"at eps = {last.eps:g} all of A is still within {backward.upper:.3g} of A_eps: "
            "smaller ones are needed, or q is not isolated"
        )
    if _enclosed(classification, evidence) and all(_middle_is_away(half, e) for e in evidence):
        return (
            VerdictStatus.PROVED,
            f"enclosures at every eps: A_eps tends to the ends of A, the middle stays {half:.6g} away",
        )
    return (
        VerdictStatus.CONSISTENT,
        f"members near the ends of A only are found; the middle of A is {half:.6g} away from them",
    )


def _half(classification: Classification) -> float:
    return float(np.linalg.norm(classification.limit.jump)) / 2.0


def _enclosed(classification: Classification, evidence: Sequence[Evidence]) -> bool:
    """Whether e(A_eps, .) is bounded from above at every eps, by bounds that tend to zero themselves."""
    uppers = [_forward(classification, e).upper for e in evidence]
    known = [upper for upper in uppers if upper is not None]
    rate = slope([e.eps for e in evidence], known) if len(known) == len(uppers) else None
    return rate is not None and rate >= _least_slope(classification)


def _least_slope(classification: Classification) -> float:
    limit = classification.limit
    slow = limit.critical and asymptotics_of(limit.state.scene.contact).slowest_power < 1.0
    return LEAST_SLOPE_OF_ROOT if slow else LEAST_SLOPE


def _middle_is_away(half: float, evidence: Evidence) -> bool:
    """Members within E of the ends leave the middle half - E at least: the enclosure must say no less."""
    lower, ends = evidence.distance.excess_A_Aeps.bounds.lower, evidence.ends.excess_Aeps_A.bounds.upper
    return lower is not None and ends is not None and lower >= (half - ends) * (1.0 - ROUNDING)


def slope(eps: Sequence[float], values: Sequence[float]) -> float | None:
    """Least-squares slope of log value against log eps; None without two positive values."""
    x, y = np.asarray(eps, dtype=float), np.asarray(values, dtype=float)
    known = y > 0.0
    if known.sum() < 2 or np.ptp(np.log(x[known])) == 0.0:
        return None
    return float(np.polyfit(np.log(x[known]), np.log(y[known]), 1)[0])
