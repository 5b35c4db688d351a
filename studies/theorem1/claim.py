"""Theorem 1, branch by branch, on every named state of every scene of the library.

Claim (L. Paoli, IFIP AICT 494 (2016), Theorem 1; the value in the isolated branch is the project's own): at a
tangential contact with u_tilde != u-, the values S(q_eps, v_eps) of the contact law over balls of radius eps fill, in
the limit,
- {u-, u_tilde} where gamma < 0;
- the segment [u-, u_tilde] where gamma = 0 and touching or penetrating configurations with gamma > 0 accumulate at q;
- its two ends alone where gamma = 0 and there are no such configurations: then d_H([u-, u_tilde], A_eps) tends to half
  the length of the segment.
Where gamma > 0 nothing is indeterminate, and A_eps tends to {u-}.

Command:  painleve study theorem1 [--quick]
Expected: the exact branch of each state, every verdict `consistent`, every slope of e(A_eps, A) within 0.05 of 1, or of
          1/2 on the rods in space where gamma = 0 and the jump ends in slip (see painleve.asymptotics.space.rates);
          e(A, A_eps) near 0.418 (worn tip) and 0.5 (arm) in the isolated branch. At `double_zero` and at both states
          `approached` a sample hardly ever slips, its upper bound on e(A, A_eps) stays large, and only the witnesses
          show that the excess vanishes.
Time:     about a minute on two cores, with --quick somewhat less; drawing takes half of it, and the first run after a
          change of the sources compiles the five scenes.
Files:    for each scene the distances over eps, members of A_eps, and the map of gamma: HDF5, PDF and PNG.
"""

from __future__ import annotations

from studies.study import Study
from studies.theorem1.figures import DRAWINGS
from studies.theorem1.measure import measure
from studies.theorem1.report import report

STUDY = Study(measure=measure, report=report, drawings=DRAWINGS)
