"""The hypotheses of Theorem 1 on a ball around a state (paper, section 3), each proved, refuted or neither."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from fractions import Fraction

from painleve.errors import InputError
from painleve.exact.parse import exact_number
from painleve.exact.signs import Sign
from painleve.mechanics.state import Number, State
from painleve.progress import told
from painleve.theory.hypotheses.claims import ClaimStatus
from painleve.theory.hypotheses.constraint import check_constraint
from painleve.theory.hypotheses.findings import Hypothesis
from painleve.theory.hypotheses.inertia import check_inertia
from painleve.theory.hypotheses.region import Region
from painleve.theory.hypotheses.section import check_one_dimensional, check_section, check_strictly_convex
from painleve.theory.limit_set import limit_set

__all__ = ["DEFAULT_RADIUS", "Applicability", "HypothesesCheck", "check_hypotheses"]

# Theorem 1 needs some ball only; this one is large enough to be a statement about the mechanism and not about a point.
DEFAULT_RADIUS = Fraction(1, 10)


class Applicability(Enum):
    """What the hypotheses and the sign of gamma(q) make of Theorem 1 at the state."""

    APPLIES = "Theorem 1 applies"
    SUPPORTED = "Theorem 1 applies if what is supported numerically holds"
    NOTHING = "nothing to apply"
    REFUTED = "a hypothesis is refuted on this ball"
    UNDECIDED = "undecided"


_VERDICTS = {
    ClaimStatus.REFUTED: Applicability.REFUTED,
    ClaimStatus.UNDECIDED: Applicability.UNDECIDED,
    ClaimStatus.SUPPORTED: Applicability.SUPPORTED,
}


@dataclass(frozen=True, kw_only=True, eq=False)
class HypothesesCheck:
    """(H1), (H2), (H3), (H4) and (H'4) on the closed ball of that radius around the state, and what follows."""

    state: State
    radius: Fraction
    hypotheses: tuple[Hypothesis, ...]
    theorem: Applicability
    sentence: str

    def __repr__(self) -> str:
        found = ", ".join(f"{h.name} {h.status.value}" for h in self.hypotheses)
        return f"HypothesesCheck({self.state.scene.name!r}, {self.state.label!r}, {found}: {self.theorem.value})"

    def __getitem__(self, name: str) -> Hypothesis:
        return next(h for h in self.hypotheses if h.name == name)

    def as_dict(self) -> dict[str, object]:
        """For machines."""
        return {
            "scene": self.state.scene.name,
            "state": self.state.label,
            "radius": float(self.radius),
            "hypotheses": {h.name: h.as_dict() for h in self.hypotheses},
            "theorem": {"status": self.theorem.value, "sentence": self.sentence},
        }


@told(lambda state, **__: f"checking the hypotheses near {state.scene.name}, {state.label}")
def check_hypotheses(state: State, *, radius: Number = DEFAULT_RADIUS) -> HypothesesCheck:
    """Check the hypotheses of Theorem 1 on the closed Euclidean ball B(q, radius), in the scene's units.

    The paper states (H1) to (H3) for all of R^d, and (H4) or (H'4) on some ball; its proof uses them near q alone, and
    near q is where they are checked. `proved` rests on exact arithmetic and on rigorous enclosures over the whole ball,
    `refuted` comes with a point, `supported numerically` with the number of points tried.

    Raises InputError for a radius that is not a positive rational number.
    """
    region = Region(state=state, radius=_radius(radius))
    checks = (check_inertia, check_constraint, check_section, check_one_dimensional, check_strictly_convex)
    hypotheses = tuple(check(region) for check in checks)
    theorem, sentence = _apply(state, hypotheses)
    return HypothesesCheck(state=state, radius=region.radius, hypotheses=hypotheses, theorem=theorem, sentence=sentence)


def _radius(value: Number) -> Fraction:
    number = exact_number(value, where="radius")
    if not (number.is_Rational and number > 0):
        raise InputError(f"radius: give a positive rational number such as 1/10, not {str(value)[:40]}")
    return Fraction(int(number.p), int(number.q))


def _apply(state: State, hypotheses: tuple[Hypothesis, ...]) -> tuple[Applicability, str]:
    """M^-1 R(q) meets T(q) outside 0 if and only if gamma(q) <= 0."""
    limit = limit_set(state)
    sign, value = limit.gamma.sign, f"gamma(q) = {limit.gamma_value:.6g}"
    if sign is Sign.POSITIVE:
        return Applicability.NOTHING, f"{value} > 0: M^-1 R(q) meets T(q) in 0 alone, and nothing is indeterminate"
    if sign is Sign.UNDECIDED:
        return Applicability.UNDECIDED, f"the sign of gamma(q) is undecided: {limit.gamma.reason}"
    meets = "gamma(q) = 0" if sign is Sign.ZERO else f"{value} < 0"
    because = f"{meets}: M^-1 R(q) meets T(q) outside 0"
    needed = _needed(hypotheses)
    for status, verdict in _VERDICTS.items():
        names = ", ".join(name for name, found in needed.items() if found is status)
        if names:
            return verdict, f"{because}; {status.value}: {names}"
    return Applicability.APPLIES, f"{because}, and {', '.join(needed)} hold"


def _needed(hypotheses: tuple[Hypothesis, ...]) -> dict[str, ClaimStatus]:
    """The theorem asks for (H4) or (H'4): the one that is settled, else both together."""
    *others, line, convex = hypotheses
    for status in (ClaimStatus.PROVED, ClaimStatus.SUPPORTED, ClaimStatus.UNDECIDED):
        either = [h.name for h in (line, convex) if h.status is status]
        if either:
            return {h.name: h.status for h in others} | {either[0]: status}
    return {h.name: h.status for h in others} | {f"{line.name} and {convex.name}": ClaimStatus.REFUTED}
