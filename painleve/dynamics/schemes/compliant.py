"""Compliant contact: a spring and a damper under the tip, and Coulomb's law regularised at small slip.

    lambda_n = k g + c dg/dt while g > 0 and lambda_n > 0, else 0;  c = 2 zeta sqrt(k/a);  lambda_t = s lambda_n,
    s = mu_plus tanh(-v_t/v_s) where v_t < 0 and -mu_minus tanh(v_t/v_s) where v_t > 0

Its velocity is continuous: a jump shows as a fast motion. The damper's force starts with a step, so the arcs of open
and of closed contact are integrated apart. Stiff; Radau IIA of scipy, order 5.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from scipy.integrate import Radau

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Ending
from painleve.dynamics.arc import ArcPoint, Dense, Event, follow
from painleve.dynamics.grid import TimeGrid
from painleve.dynamics.modes import ContactPoint
from painleve.dynamics.outline import allowed_depth, depth_through, where_through
from painleve.dynamics.recorder import Recorder
from painleve.dynamics.scheme import Integrated, Progress
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory

NAME = "compliant"
MOST_ARCS = 100_000


def spring_force(point: ContactPoint, options: Mapping[str, float]) -> float:
    """k g + c dg/dt, what the spring and the damper of a closed contact exert along w_n."""
    stiffness = options["stiffness"]
    return stiffness * point.g - 2.0 * options["damping_ratio"] * math.sqrt(stiffness / point.a) * point.v_n


def contact_force(point: ContactPoint, options: Mapping[str, float]) -> tuple[float, float]:
    """(lambda_n, lambda_t) of a closed contact."""
    normal = spring_force(point, options)
    if not point.planar:
        return normal, 0.0
    mode = ContactMode.SLIP_PLUS if point.v_t < 0.0 else ContactMode.SLIP_MINUS
    return normal, normal * point.ratio(mode) * math.tanh(abs(point.v_t) / options["slip_speed"])


class _CompliantRun:
    """One integration: arcs of open and of closed contact."""

    def __init__(self, start: Start, grid: TimeGrid, options: Mapping[str, float], progress: Progress) -> None:
        self.start, self.grid, self.options, self.progress, self.d = start, grid, options, progress, len(start.q)
        self.recorder, self.evaluations, self.arcs = Recorder(start), 0, 0
        self.place = self.recorder.last
        self.closed = self.closure(*self.place) > 0.0
        allowed = allowed_depth(start)
        self.outline = Event(lambda t, y: allowed - depth_through(start, y[: self.d]))
        self.longest = float(grid.h.max()) if len(grid.h) else math.inf

    def point(self, t: float, y: np.ndarray) -> ContactPoint:
        return ContactPoint.at(self.start, t, y[: self.d], y[self.d : 2 * self.d])

    def closure(self, t: float, y: np.ndarray) -> float:
        """Positive where the contact is closed: it penetrates, and it pushes."""
        point = self.point(t, y)
        return min(self.options["stiffness"] * point.g, spring_force(point, self.options))

    def rate(self, t: float, y: np.ndarray) -> np.ndarray:
        point = self.point(t, y)
        force = contact_force(point, self.options) if self.closed else (0.0, 0.0)
        return np.concatenate([y[self.d : 2 * self.d], point.acceleration + point.response(*force), force])

    def go(self) -> Trajectory:
        ending, detail = Ending.REACHED_END, ""
        try:
            while self.place.t < self.grid.t[-1] and ending is Ending.REACHED_END:
                ending = self.arc()
        except KeyboardInterrupt:
            ending = Ending.INTERRUPTED
        if self.place.t > self.recorder.last.t:
            self.record(np.array([self.place.t]), self.place.y[None, :])
        if ending is Ending.STEP_SIZE_UNDERFLOW:
            detail = f"at t = {self.place.t:.9g}"
        if ending is Ending.THROUGH_FLOOR:
            detail = where_through(self.start, self.place.t, self.place.y[: self.d])
        counts = {"evaluations": self.evaluations, "arcs": self.arcs}
        return self.recorder.trajectory(NAME, dict(self.options), ending, detail, counts)

    def arc(self) -> Ending:
        """Integrate until the contact opens or closes, or to the end."""
        sign = 1.0 if self.closed else -1.0
        with np.errstate(all="ignore"):
            solver = Radau(
                self.rate,
                self.place.t,
                self.place.y,
                float(self.grid.t[-1]),
                rtol=self.options["rtol"],
                atol=self.options["atol"],
                max_step=self.longest,
            )
            switched = follow(solver, [Event(lambda t, y: sign * self.closure(t, y)), self.outline], self.accept)
        self.evaluations, self.arcs = self.evaluations + int(solver.nfev), self.arcs + 1
        if solver.status == "failed":
            return Ending.STEP_SIZE_UNDERFLOW
        if switched == 1:
            return Ending.THROUGH_FLOOR
        if switched == 0:
            self.closed = not self.closed
        return Ending.REACHED_END if self.arcs <= MOST_ARCS else Ending.TOO_MANY_EVENTS

    def accept(self, place: ArcPoint, dense: Dense) -> None:
        """The grid's instants within a step; the state moves to its end."""
        inside = self.recorder.passed(self.grid, place.t)
        if len(inside):
            self.record(inside, dense(inside).T)
        before, self.place = self.place, place
        self.progress(place.t - before.t)

    def record(self, t: np.ndarray, y: np.ndarray) -> None:
        self.recorder.add(t, y, _branches(self.start, t, y, self.recorder.last.y, self.options))


def integrate(start: Start, grid: TimeGrid, options: Mapping[str, float], progress: Progress) -> Trajectory:
    """The trajectory on the grid's instants."""
    return _CompliantRun(start, grid, options, progress).go()


def _branches(
    start: Start, t: np.ndarray, y: np.ndarray, before: np.ndarray, options: Mapping[str, float]
) -> np.ndarray:
    """What the contact did up to each instant: nothing, sticking (a slip below the regularisation), or slip."""
    d = len(start.q)
    pushed = np.diff(y[:, 2 * d], prepend=before[2 * d]) > 0.0
    codes = np.zeros(len(t), np.int8)
    for i in np.flatnonzero(pushed):
        point = ContactPoint.at(start, t[i], y[i, :d], y[i, d : 2 * d])
        slipping = ContactMode.SLIP_PLUS if point.v_t < 0.0 else ContactMode.SLIP_MINUS
        at_rest = abs(point.v_t) <= options["slip_speed"]
        codes[i] = ContactMode.FRICTIONLESS if not point.planar else ContactMode.STICK if at_rest else slipping
    return codes


SCHEME = Integrated(
    name=NAME,
    sentence="spring and damper under the tip, regularised Coulomb friction",
    source="A. Champneys and P. Várkonyi, IMA J. Appl. Math. 81 (2016) 538-588 (arXiv 1601.03545)",
    order=5,
    options={"stiffness": 1e6, "damping_ratio": 1.0, "slip_speed": 1e-4, "rtol": 1e-8, "atol": 1e-10},
    integrate=integrate,
)
