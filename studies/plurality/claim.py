"""Do velocity jumps without collision survive h -> 0, and is the limit plural? Glocker's rod and the jam law.

Claims. The Contact Dynamics scheme (L. Paoli, IFIP AICT 494 (2016), section 2) follows a rod that slides into its
Génot-Brogliato point. A step size either jams there (a jump of the velocity without collision) or lifts off.
1. For the rod of C. Glocker, Dynamik von Starrkörpersystemen mit Reibung und Stössen (1995), 5.3.4, both happen in
   every decade of step sizes from 1e-2 to 1e-7, and the times of the jumps tend to that of the exact slip. A narrow
   window of step sizes holds a part of a period of the phase that decides: its fraction is no probability.
2. With r the ratio of the eigenvalues at the point, the fraction that jams tends to 1/(1 + r) under the paper's contact
   test g >= 0 for r < 1, to 1 - r where the tip is kept on the floor, and to 0 for r >= 1; nothing else of the slip
   matters. Derived in painleve.core.jam_map (first order in h near the point), measured here.
3. At finite h the fraction, over step sizes and starts, is that of a local map with one number
   d ~ h^((1-r)/(1+r)). Over the step sizes of one start alone it scatters about that by some hundredths.
4. At states with gamma < 0, known to eps, the fraction that jumps within 1.6 sqrt(h) s is a function of eps/h as
   h -> 0. Where the free normal acceleration beta is negative (inconsistent) everything jumps that comes to the floor,
   all of it in that time up to eps/h = 1.6^2 |beta|/2 = 12.5/s; where beta is positive (indeterminate) nothing jumps
   up to eps/h = 3/s; for larger eps/h both ends of A are approached. Measured.
5. Which limit other schemes and the compliant contact choose there. Measured.

Command:  painleve study plurality [--quick]
Expected: fractions of both outcomes in each decade; fractions that agree with the map (chi-square about one a degree
          of freedom, under both contact tests), and tend to the law.
Time:     about five minutes, with --quick half a minute.
Files:    outcomes over the step size and the jam law: HDF5, PDF and PNG.
"""

from __future__ import annotations

from studies.plurality.figures import DRAWINGS
from studies.plurality.measure import measure
from studies.plurality.report import report
from studies.study import Study

STUDY = Study(measure=measure, report=report, drawings=DRAWINGS)
