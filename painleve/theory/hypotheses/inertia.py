"""(H1): the inertia matrix is of class C^1 and symmetric positive definite."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from painleve.theory.hypotheses.claims import Claim, ClaimKind, ClaimStatus, decide
from painleve.theory.hypotheses.findings import Finding, Hypothesis, conclude, join, report
from painleve.theory.hypotheses.region import Region
from painleve.theory.hypotheses.smoothness import Level, check_smoothness

__all__ = ["check_inertia"]


def check_inertia(region: Region) -> Hypothesis:
    """(H1) on the ball; M is symmetric by construction, positive definite where all leading minors are positive."""
    smooth = check_smoothness(region, "M", list(region.state.scene.inertia), Level.ANALYTIC)
    return conclude("H1", "M is C^1 and symmetric positive definite", [smooth, *_definite(region)])


def _definite(region: Region) -> list[Finding]:
    """One finding where all minors are positive, else those that may not be."""
    decisions, findings = [], []
    for coordinates, minor in _leading_minors(region.state.scene.inertia):
        names = ", ".join(str(region.state.scene.q[i]) for i in coordinates)
        what = f"the leading minor of M in {names}"
        decision = decide(region, Claim(kind=ClaimKind.POSITIVE, expressions=(minor,)))
        decisions.append(decision)
        findings.append(report(decision, holds=f"{what} is positive", fails=f"{what} is not positive"))
    if any(d.status is not ClaimStatus.PROVED for d in decisions):
        return [f for f in findings if f.status is not ClaimStatus.PROVED]
    return [report(join(decisions), holds="the leading minors of M are positive", fails="")]


def _leading_minors(M: sp.ImmutableMatrix) -> Iterator[tuple[list[int], sp.Expr]]:
    """The leading principal minors of the blocks into which M falls apart, with their rows."""
    for block in M.connected_components():
        for size in range(1, len(block) + 1):
            rows = block[:size]
            # a determinant would expand a single entry, and with it the squares that it is written with
            yield rows, M[rows[0], rows[0]] if size == 1 else M.extract(rows, rows).det(method="berkowitz")
