"""Where methods fail: rare slips, cancellation, and parameters near a critical value; and which method to use when.

Claims (the project's own):
- At the hard critical state (`double_zero`: mu = 4/3, tan theta = 2) e(A, A_eps) = 0 for every eps, and the sampled
  bound on it grows as eps falls, whatever the number of samples. Witnesses do not care.
- There plain doubles lose the sign of gamma by eps = 1e-8; then they let samples slip that do not, and members that
  slip miss their place by the length of A. Arithmetic without cancellation keeps ten digits down to eps = 1e-14.
- With a parameter just beside its critical value d_H is that of the wrong side, until eps resolves the difference: for
  mu = 4/3 (1 + delta) at eps ~ sqrt(delta), for mu = 4/3 (1 - delta) only at eps ~ delta. Beside k = 25/6, where the
  worn tip's state turns isolated, e(A, A_eps) is proved to be large only below some eps.

Command:  painleve study where_methods_fail [--quick]
Expected: see the claims; the table of methods is filled from runs of this study.
Time:     about three minutes, with --quick half a minute; more where the scenes are not yet compiled.
Files:    sampled_bound, rounding, near_critical: HDF5, PDF and PNG; methods_<eps>.h5.
"""

from __future__ import annotations

from studies.study import Study
from studies.where_methods_fail.figures import DRAWINGS
from studies.where_methods_fail.measure import measure
from studies.where_methods_fail.report import report

STUDY = Study(measure=measure, report=report, drawings=DRAWINGS)
