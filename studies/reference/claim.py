"""Published facts about Painlevé's paradox, each found again by a route of its own: found against published.

Claim: what the literature says of the sliding rod holds in this package. That is the least critical friction and the
bands of paradoxes of rods of any alpha = m l^2/I; the four regimes of a slipping contact; Jean's condition for a step
of one contact; the Génot-Brogliato point, its eigenvalues and mu_C; contact forces below and above mu_C; Glocker's rod;
how an impact without collision ends and when it must follow; Stewart's rod. The facts, their sources and how much of
each could be read are in data/reference/facts.toml. No route uses the published formula: minima, edges and
eigenvalues come from the scene by exact algebra, forces and slips from Newton's equations alone, regimes and uniqueness
from trying every mode.

Command:  painleve study reference [--quick]
Expected: every fact `reproduced` (exactly, or to every printed digit) but one: `stewart_rest` is `not reproducible`,
          for the published rod meets the floor with both ends and a scene here has one contact.
Time:     about 25 s of one core, with --quick about 15 s, a third of it imports; the first run after a change of the
          sources compiles the rod.
Files:    reference.h5 with the facts and what the figure shows; the figure as PDF and PNG.
"""

from __future__ import annotations

from studies.reference.figures import DRAWINGS
from studies.reference.measure import measure
from studies.reference.report import report
from studies.study import Study

STUDY = Study(measure=measure, report=report, drawings=DRAWINGS)
