"""Convergence: the observed order of every scheme on motions with contact, and what accuracy costs.

Claim: where the solution is unique, the Contact Dynamics scheme converges as the step h -> 0. It is proved in three
situations (L. Paoli, IFIP AICT 494 (2016), references [9], [5], [15]): M = m Id with friction or without, any M without
friction, any M with friction. The order is the project's own observation: 1 in the distance of graphs in (t, u), in
which a jump shifted by one step costs a step; and so it is for every fixed-step scheme, also for those of higher order
where nothing touches.

Motions: impacts without rebound, frictional impacts, smooth sliding, slip to stick; M constant and M(q). References are
closed forms for the point mass, else an event-driven integration at rtol 1e-13. The event-driven method is thus judged
by itself at a tighter tolerance wherever the reference is not a closed form.
The order is the slope of log error against log h through the largest error of several step sizes near each level; of
the event-driven method against its tolerance, of the compliant contact against its time scale 1/sqrt(a k).

Command:  painleve study convergence [--quick]
Expected: order 1 within the errors stated for all fixed-step schemes and motions. The event-driven method is exact to
          rounding on the point mass. The compliant contact (damping ratio 1) converges with order 1 where there is no
          collision; after a collision it rebounds with exp(-2) = 0.135 of the speed, at any stiffness: its limit is
          another law of impact, and its error does not fall.
Time:     two to three minutes, with --quick half a minute; half a minute more where the scenes are not yet compiled.
Files:    convergence.h5, .pdf and .png.
"""

from __future__ import annotations

from studies.convergence.figures import DRAWINGS
from studies.convergence.measure import measure
from studies.convergence.report import report
from studies.study import Study

STUDY = Study(measure=measure, report=report, drawings=DRAWINGS)
