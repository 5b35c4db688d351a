"""Two laws of friction: where the paper's projection (7) and Coulomb's maximal dissipation part, on a rod in space.

Claims (the project's own; the rod is uniform, in space, on a floor with a disc of friction of radius mu; psi is the
angle of the slip against b, the coupling of the normal to the tangents, and mu_c = a/|b|):
- tangential problem, v_n = 0. Law (7) has a jump exactly where mu > mu_c and |psi| < pi/2 + arccos(mu_c/mu). Coulomb's
  law has one exactly where sticking is in the friction cone, and then law (7) sticks too: two solutions where friction
  would drive the slip (mu cos psi > mu_c), else three, for a slip joins u- and sticking. Between the two edges law (7)
  jumps and Coulomb's law stays at u-;
- impacts, v_n < 0: Coulomb's law has one solution or three, three only near the tangential problem. The two laws part
  at gamma > 0 as well. They are one where the tip sticks, and where the slip is parallel to b.

Command:  painleve study laws [--quick]
Expected: no point of the grid beside the edges of the claims, and every count confirmed that exact arithmetic checks.
          Largest distances at a slip of speed 1: 1.08 at 45 degrees and 1.66 at tan theta = 2 for v_n = 0; at
          gamma > 0 0.74 and 0.68 for v_n = -0.01, 0.09 and 0.10 for v_n = -1. Three solutions on 6.4 % and 3.7 % of
          the rectangle |psi| <= pi, mu < 4 for v_n = 0, on 3.2 % and 1.1 % for v_n = -0.01.
Time:     half a minute, with --quick a few seconds; a change of the sources compiles the two laws first.
Files:    the maps of two configurations and four normal velocities (HDF5), and a figure of two of them (PDF and PNG).
"""

from __future__ import annotations

from studies.laws.figures import DRAWINGS
from studies.laws.measure import measure
from studies.laws.report import report
from studies.study import Study

STUDY = Study(measure=measure, report=report, drawings=DRAWINGS)
