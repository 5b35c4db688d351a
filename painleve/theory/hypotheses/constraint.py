"""(H2): g is of class C^1, its gradient locally Lipschitz, and not zero near {g = 0}."""

from __future__ import annotations

import sympy as sp

from painleve.mechanics.derive import derive
from painleve.theory.hypotheses.claims import Claim, ClaimKind, ClaimStatus, decide
from painleve.theory.hypotheses.findings import Finding, Hypothesis, conclude, report
from painleve.theory.hypotheses.region import Region
from painleve.theory.hypotheses.smoothness import Level, check_smoothness

__all__ = ["check_constraint", "gradient_claim"]


def check_constraint(region: Region) -> Hypothesis:
    """(H2) on the ball: an analytic g has bounded second derivatives there."""
    g = region.state.scene.contact.constraint
    findings = [check_smoothness(region, "g", [g], Level.ANALYTIC), _gradient(region)]
    asks = "g is C^1, grad g is locally Lipschitz and does not vanish near {g = 0}"
    return conclude("H2", asks, findings)


def gradient_claim(region: Region, *, where: sp.Expr | None = None) -> Claim:
    """grad g is not zero."""
    components = tuple(e for e in derive(region.state.scene).normal if e != 0)
    return Claim(kind=ClaimKind.NONZERO, expressions=components, where=where)


def _gradient(region: Region) -> Finding:
    """On the whole ball, so that n is defined there; where that fails, on {g = 0} alone, as the hypothesis has it."""
    decision = decide(region, gradient_claim(region))
    whole = report(decision, holds="grad g does not vanish on the ball", fails="grad g vanishes")
    if whole.status is ClaimStatus.PROVED:
        return whole
    contact = decide(region, gradient_claim(region, where=region.state.scene.contact.constraint))
    if contact.status is ClaimStatus.UNDECIDED:
        if whole.status is not ClaimStatus.REFUTED:
            return whole
        sentence = f"{whole.sentence}, and whether that is near {{g = 0}} is undecided"
        return Finding(status=ClaimStatus.UNDECIDED, sentence=sentence, place=whole.place)
    found = report(contact, holds="grad g does not vanish near {g = 0}", fails="grad g and g vanish")
    if found.status is ClaimStatus.PROVED and whole.status is ClaimStatus.REFUTED:
        sentence = f"{found.sentence}; elsewhere {whole.sentence}, so that n is defined on a smaller ball only"
        return Finding(status=ClaimStatus.PROVED, sentence=sentence)
    return found
