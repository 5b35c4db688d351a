"""What was found of a hypothesis: its parts, each with a status and a sentence, and the worst of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_DOWN, Context

from painleve.theory.hypotheses.claims import ClaimStatus, Decision
from painleve.theory.hypotheses.region import Place

__all__ = ["Finding", "Hypothesis", "conclude", "join", "report"]

_WORST_FIRST = (ClaimStatus.REFUTED, ClaimStatus.UNDECIDED, ClaimStatus.SUPPORTED, ClaimStatus.PROVED)


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One part of a hypothesis; `place` is the point that refutes it, or near which it is undecided."""

    status: ClaimStatus
    sentence: str
    place: Place | None = None


@dataclass(frozen=True, kw_only=True)
class Hypothesis:
    """A hypothesis of the paper on a ball around a state: what it asks, how far it is settled, and by what."""

    name: str
    asks: str
    status: ClaimStatus
    sentence: str
    place: Place | None

    def __repr__(self) -> str:
        return f"Hypothesis({self.name}, {self.status.value})"

    def as_dict(self) -> dict[str, object]:
        place = None if self.place is None else self.place.as_dict()
        return {"asks": self.asks, "status": self.status.value, "sentence": self.sentence, "place": place}


def conclude(name: str, asks: str, findings: list[Finding]) -> Hypothesis:
    """A hypothesis is as settled as the worst of its parts; the sentence keeps to those."""
    status = next(s for s in _WORST_FIRST if any(f.status is s for f in findings))
    decisive = [f for f in findings if f.status is status]
    place = next((f.place for f in decisive if f.place is not None), None)
    return Hypothesis(
        name=name, asks=asks, status=status, sentence="; ".join(f.sentence for f in decisive), place=place
    )


def join(decisions: Sequence[Decision]) -> Decision:
    """Several proved claims as one: the least bound, the boxes of all."""
    return Decision(
        status=ClaimStatus.PROVED,
        place=None,
        boxes=sum(d.boxes for d in decisions),
        points=sum(d.points for d in decisions),
        bound=min(d.bound for d in decisions),
    )


def report(decision: Decision, *, holds: str, fails: str) -> Finding:
    """A decision in words: `holds` and `fails` are the two ways in which it can go."""
    place = decision.place
    if decision.status is ClaimStatus.PROVED:
        bound = f" (at least {_rounded_down(decision.bound)}, on {_count(decision.boxes, 'box', 'boxes')})"
        return Finding(status=decision.status, sentence=holds + (bound if 0.0 < decision.bound < float("inf") else ""))
    if decision.status is ClaimStatus.REFUTED:
        return Finding(status=decision.status, sentence=f"{fails} at {place}", place=place)
    tried = f"{_count(decision.points, 'point', 'points')} and {_count(decision.boxes, 'box', 'boxes')} tried"
    if decision.status is ClaimStatus.SUPPORTED:
        sentence = f"{holds} at every point tried, which proves nothing between them ({tried})"
        return Finding(status=decision.status, sentence=sentence)
    near = "" if place is None else f", near {place}"
    return Finding(status=decision.status, sentence=f"whether {holds} is undecided{near} ({tried})", place=place)


def _rounded_down(bound: float) -> str:
    """Three digits that are still a lower bound."""
    return f"{Context(prec=3, rounding=ROUND_DOWN).create_decimal_from_float(bound):g}"


def _count(n: int, one: str, many: str) -> str:
    return f"{n} {one if n == 1 else many}"
