"""Compliant contact: a spring and a damper under the tip, and Coulomb's law regularised at small slip.

    lambda_n = k g + c dg/dt while g > 0 and lambda_n > 0, else 0;  c = 2 zeta sqrt(k/a);  lambda_t = s lambda_n,
    s = mu_plus tanh(-v_t/v_s) where v_t < 0 and -mu_minus tanh(v_t/v_s) where v_t > 0

Its velocity is continuous: a jump shows as a fast motion. The damper's force starts with a step, so the arcs of open
and of closed contact are integrated apart. Stiff; Radau IIA of scipy, order 5.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from scipy.integrate import solve_ivp

from painleve.core.codes import Branch
from painleve.core.motion_codes import Ending
from painleve.dynamics.grid import Grid
from painleve.dynamics.modes import ContactPoint
from painleve.dynamics.recorder import Recorder
from painleve.dynamics.scheme import Integrated
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory
from painleve.errors import InputError

NAME = "compliant"
WINDOWS = 100  # the grid is integrated in parts, so that an interrupted run keeps those that are done
MOST_ARCS = 100_000


def spring_force(point: ContactPoint, options: Mapping[str, float]) -> float:
    """k g + c dg/dt, what the spring and the damper of a closed contact exert along w_n."""
    stiffness = options["stiffness"]
    return stiffness * point.rows[0] - 2.0 * options["damping_ratio"] * math.sqrt(stiffness / point.a) * point.v_n


def contact_force(point: ContactPoint, options: Mapping[str, float]) -> tuple[float, float]:
    """(lambda_n, lambda_t) of a closed contact."""
    normal = spring_force(point, options)
    if not point.planar:
        return normal, 0.0
    mode = Branch.SLIP_PLUS if point.v_t < 0.0 else Branch.SLIP_MINUS
    return normal, normal * point.ratio(mode) * math.tanh(abs(point.v_t) / options["slip_speed"])


class _Run:
    """One integration: arcs of open and of closed contact, in windows of the grid."""

    def __init__(self, start: Start, grid: Grid, options: Mapping[str, float]) -> None:
        self.start, self.grid, self.options, self.d = start, grid, options, len(start.q)
        self.recorder, self.evaluations, self.arcs = Recorder(start), 0, 0
        self.t, self.y = start.t, self.recorder.last
        self.closed = self.closure(self.t, self.y) > 0.0
        self.longest = float(grid.h.max()) if len(grid.h) else math.inf

    def point(self, t: float, y: np.ndarray) -> ContactPoint:
        return ContactPoint.at(self.start, t, y[: self.d], y[self.d : 2 * self.d])

    def closure(self, t: float, y: np.ndarray) -> float:
        """Positive where the contact is closed: it penetrates, and it pushes."""
        point = self.point(t, y)
        return min(self.options["stiffness"] * point.rows[0], spring_force(point, self.options))

    def rate(self, t: float, y: np.ndarray) -> np.ndarray:
        point = self.point(t, y)
        force = contact_force(point, self.options) if self.closed else (0.0, 0.0)
        return np.concatenate([y[self.d : 2 * self.d], point.acceleration + point.response(*force), force])

    def go(self) -> Trajectory:
        ending, detail = Ending.REACHED_END, ""
        try:
            for last in np.unique(np.linspace(0, len(self.grid.h), WINDOWS + 1).astype(int))[1:]:
                while self.t < self.grid.t[last] and ending is Ending.REACHED_END:
                    ending = self.arc(float(self.grid.t[last]))
        except KeyboardInterrupt:
            ending = Ending.INTERRUPTED
        if ending is Ending.STEP_SIZE_UNDERFLOW:
            detail = f"at t = {self.t:.9g}"
        counts = {"evaluations": self.evaluations, "arcs": self.arcs}
        return self.recorder.trajectory(NAME, dict(self.options), ending, detail, counts)

    def arc(self, end: float) -> Ending:
        """Integrate until the contact opens or closes, or to the end; record the grid's instants on the way."""
        event = _switch(self.closure, -1 if self.closed else 1)
        inside = self.grid.t[(self.grid.t > self.t) & (self.grid.t <= end)]
        with np.errstate(all="ignore"):
            solution = solve_ivp(
                self.rate, (self.t, end), self.y, method="Radau", dense_output=True, events=event,
                rtol=self.options["rtol"], atol=self.options["atol"], max_step=self.longest,
            )  # fmt: skip
        self.evaluations, self.arcs = self.evaluations + int(solution.nfev), self.arcs + 1
        before, self.t, self.y = self.recorder.last, float(solution.t[-1]), solution.y[:, -1]
        inside = inside[inside <= self.t]
        if len(inside):
            y = solution.sol(inside).T
            self.recorder.add(inside, y, _branches(self.start, inside, y, before, self.options))
        if solution.status < 0:
            return Ending.STEP_SIZE_UNDERFLOW
        if solution.status == 1:
            self.closed = not self.closed
        return Ending.REACHED_END if self.arcs <= MOST_ARCS else Ending.TOO_MANY_EVENTS


def _switch(function: Callable[[float, np.ndarray], float], direction: int) -> Callable[[float, np.ndarray], float]:
    """An event of its own: the integrator reads attributes, which a method cannot carry."""

    def event(t: float, y: np.ndarray) -> float:
        return function(t, y)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event


def integrate(start: Start, grid: Grid, options: Mapping[str, float]) -> Trajectory:
    """The trajectory on the grid's instants."""
    for name, value in options.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"scheme {NAME}: {name} = {value} must be a positive number")
    return _Run(start, grid, options).go()


def _branches(
    start: Start, t: np.ndarray, y: np.ndarray, before: np.ndarray, options: Mapping[str, float]
) -> np.ndarray:
    """What the contact did up to each instant: nothing, sticking (a slip below the regularisation), or slip."""
    d = len(start.q)
    pushed = np.diff(y[:, 2 * d], prepend=before[2 * d]) > 0.0
    codes = np.zeros(len(t), np.int8)
    for i in np.flatnonzero(pushed):
        point = ContactPoint.at(start, t[i], y[i, :d], y[i, d : 2 * d])
        slipping = Branch.SLIP_PLUS if point.v_t < 0.0 else Branch.SLIP_MINUS
        at_rest = abs(point.v_t) <= options["slip_speed"]
        codes[i] = Branch.FRICTIONLESS if not point.planar else Branch.STICK if at_rest else slipping
    return codes


SCHEME = Integrated(
    name=NAME,
    sentence="spring and damper under the tip, regularised Coulomb friction",
    source="A. Champneys and P. Várkonyi, IMA J. Appl. Math. 81 (2016) 538-588 (arXiv 1601.03545)",
    order=5,
    options={"stiffness": 1e6, "damping_ratio": 1.0, "slip_speed": 1e-4, "rtol": 1e-8, "atol": 1e-10},
    integrate=integrate,
)
