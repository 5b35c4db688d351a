"""Speed against accuracy: the error in d_H(A, A_eps) that each method leaves, and what it costs.

Claim (the project's own): at one radius eps, optimising finds d_H to the resolution of a proved reference in a fraction
of a second, and certifying proves it in about a second; from ten thousand times the samples, uniform points gain one
digit and points weighted towards the spheres two. At a critical state a sample misses the rare slips: its bounds are
true, and a reader who takes them for d_H is misled by orders of magnitude.

What is compared is the number that a reader takes for d_H: the middle of an enclosure where the method gives one, else
max(lower bound on e(A_eps, A), upper bound on e(A, A_eps)), as if these were exact. The naive baseline is what one
writes first in NumPy. The reference is the narrowest enclosure that is proved; its half width is stated, and drawn as a
band.

Command:  painleve study speed_accuracy [--quick]
Expected: optimise within the band at all states; certify down to 1e-6; sampled numbers off by more than a factor two,
          marked as misleading, at `critical` below 1e5 samples, and at `double_zero` even with a million; at the
          isolated states every method finds d_H, about half the length of A, to 1e-3.
Time:     two to three minutes, with --quick half a minute; more where the scenes are not yet compiled.
Files:    speed_accuracy.h5, .pdf and .png.
"""

from __future__ import annotations

from studies.speed_accuracy.figures import DRAWINGS
from studies.speed_accuracy.measure import measure
from studies.speed_accuracy.report import report
from studies.study import Study

STUDY = Study(measure=measure, report=report, drawings=DRAWINGS)
