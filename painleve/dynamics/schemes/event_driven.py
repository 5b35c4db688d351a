"""Event-driven integration: smooth motion in one contact mode at a time, changes of mode located as events.

In contact the acceleration-level problem is solved (painleve.dynamics.modes); impacts follow the law S. Where no
acceleration solves it, or more than one does, the method ends and says so: it has no rule to go on.
Order 8 between events (Dormand and Prince, DOP853 of scipy).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from scipy.integrate import DOP853

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, Ending
from painleve.dynamics.arc import ArcPoint, Dense, Event, follow
from painleve.dynamics.grid import TimeGrid
from painleve.dynamics.modes import ContactPoint, Mode, closed_modes
from painleve.dynamics.outline import allowed_depth, depth_through, where_through
from painleve.dynamics.recorder import Recorder
from painleve.dynamics.scheme import Integrated, Progress
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory

NAME = "event_driven"
MOST_EVENTS = 10_000
ROUNDING = 1e-11  # relative to 1 + |u|: velocities of the tip below this are zero when a mode is chosen


class _Stop(Exception):
    """The method cannot go on."""

    def __init__(self, ending: Ending, detail: str = "") -> None:
        super().__init__(detail)
        self.ending, self.detail = ending, detail


class _EventDrivenRun:
    """One integration: the state moves from arc to arc."""

    def __init__(self, start: Start, grid: TimeGrid, options: Mapping[str, float], progress: Progress) -> None:
        self.start, self.grid, self.options, self.progress = start, grid, options, progress
        self.d, self.recorder, self.events = len(start.q), Recorder(start), 0
        self.place, self.mode, self.allowed = self.recorder.last, Mode.FREE, allowed_depth(start)

    @property
    def t(self) -> float:
        return self.place.t

    @property
    def y(self) -> np.ndarray:
        return self.place.y

    def point(self, t: float, y: np.ndarray) -> ContactPoint:
        return ContactPoint.at(self.start, t, y[: self.d], y[self.d : 2 * self.d])

    def go(self) -> Trajectory:
        ending, detail = Ending.REACHED_END, ""
        try:
            if self.start.g >= -self.start.rounding:
                self.mode = self.after_contact()
            while self.t < self.grid.t[-1]:
                if self.events > MOST_EVENTS:
                    raise _Stop(Ending.TOO_MANY_EVENTS, f"{MOST_EVENTS}")
                self.mode = self.arc(self.mode)
                self.events += 1
        except _Stop as stop:
            ending, detail = stop.ending, stop.detail
        except KeyboardInterrupt:
            ending = Ending.INTERRUPTED
        if self.t > self.recorder.last.t:
            self.record_here()
        return self.recorder.trajectory(NAME, dict(self.options), ending, detail, {"events": self.events})

    def arc(self, mode: Mode) -> Mode:
        """Integrate to the next event or the end; returns the next mode."""
        events, end = {**self.mode_events(mode), **self.outline_event()}, float(self.grid.t[-1])
        with np.errstate(all="ignore"):
            solver = DOP853(
                lambda t, y: self.rate(t, y, mode),
                self.t,
                self.y,
                end,
                rtol=self.options["rtol"],
                atol=self.options["atol"],
                first_step=self.first_step(mode, end),
            )
            happened = follow(solver, list(events), self.accept)
        self.record_here()
        if solver.status == "failed":
            raise _Stop(Ending.STEP_SIZE_UNDERFLOW, f"at t = {self.t:.9g}, {mode.label}")
        return mode if happened is None else list(events.values())[happened]()

    def first_step(self, mode: Mode, end: float) -> float | None:
        """Where the tip only hops, no longer than to the top of the hop; None leaves it to the integrator.

        A first step beyond the whole hop would end below the floor, and the landing would be found at the take-off.
        """
        point = self.point(self.t, self.y)
        if mode is not Mode.FREE or not (point.v_n > 0.0 > point.beta_n):
            return None
        return min(point.v_n / -point.beta_n, end - self.t)

    def rate(self, t: float, y: np.ndarray, mode: Mode) -> np.ndarray:
        point = self.point(t, y)
        force = point.force(mode)
        return np.concatenate([y[self.d : 2 * self.d], point.acceleration + point.response(*force), force])

    def accept(self, place: ArcPoint, dense: Dense) -> None:
        """The grid's instants within a step; the state moves to its end."""
        inside = self.recorder.passed(self.grid, place.t)
        if len(inside):
            self.recorder.add(inside, dense(inside).T, np.full(len(inside), self.mode))
        before, self.place = self.place, place
        self.progress(place.t - before.t)

    def record_here(self) -> None:
        self.recorder.add(np.array([self.t]), self.y[None, :], np.array([self.mode]))

    def push(self, normal: float, tangential: float) -> None:
        """Change the velocity by an impulse at the contact."""
        y = self.y.copy()
        y[self.d : 2 * self.d] += self.point(self.t, y).response(normal, tangential)
        self.place = ArcPoint(self.t, y)

    def mode_events(self, mode: Mode) -> dict[Event, Callable[[], Mode]]:
        """Functions that fall through zero when a mode ends, and what follows."""
        if mode is Mode.FREE:
            # A tip that leaves the contact may stand above g = 0 by the drift of the arcs before: it meets the floor
            # again where it left it. A test of g = 0 would never see it come back.
            level = max(0.0, self.point(self.t, self.y).g)
            return {Event(lambda t, y: level - self.point(t, y).g): self.after_contact}
        force: dict[Event, Callable[[], Mode]] = {Event(lambda t, y: self.point(t, y).force(mode)[0]): self.lift_off}
        if mode is Mode.FRICTIONLESS:
            return force
        if mode is Mode.STICK:
            return {**force, **self.edge_event(Mode.SLIP_PLUS), **self.edge_event(Mode.SLIP_MINUS)}
        sign = 1.0 if mode is Mode.SLIP_MINUS else -1.0
        return {
            Event(lambda t, y: sign * self.point(t, y).v_t, self.at_rest): self.end_slip,
            Event(lambda t, y: -self.point(t, y).beta_n): self.lift_off,
            Event(lambda t, y: self.point(t, y).edge(mode)): self.lose_edge,
        }

    def outline_event(self) -> dict[Event, Callable[[], Mode]]:
        """The outline must not go through the floor."""
        if self.allowed == math.inf:
            return {}
        return {Event(lambda t, y: self.allowed - depth_through(self.start, y[: self.d])): self.fall_through}

    def fall_through(self) -> Mode:
        raise _Stop(Ending.THROUGH_FLOOR, where_through(self.start, self.t, self.y[: self.d]))

    @property
    def at_rest(self) -> float:
        """Velocities of the tip up to this are zero."""
        return ROUNDING * (1.0 + float(np.abs(self.y[self.d : 2 * self.d]).sum()))

    def edge_event(self, side: Mode) -> dict[Event, Callable[[], Mode]]:
        """Sticking ends when its force leaves the cone over an edge; on the edge it still sticks."""
        noise = self.point(self.t, self.y).reserve_noise(side)
        return {Event(lambda t, y: self.point(t, y).reserve(side), noise): lambda: self.begin_slip(side)}

    def begin_slip(self, side: Mode) -> Mode:
        if self.point(self.t, self.y).edge(side) <= 0.0:
            raise _Stop(Ending.INDETERMINATE, f"sticking ends where {side.label} and lift-off both solve it")
        return side

    def lose_edge(self) -> Mode:
        raise _Stop(Ending.INCONSISTENT, f"the contact force of the slip grows without bound at t = {self.t:.9g}")

    def after_contact(self) -> Mode:
        """The mode at a landing or at the start; impacts and rounding are projected out."""
        point = self.point(self.t, self.y)
        small = self.at_rest
        if point.v_n > small:
            return Mode.FREE
        slip = 0 if abs(point.v_t) <= small or not point.planar else int(math.copysign(1, point.v_t))
        if point.v_n < -small:
            slip = self.impact(point)
        elif slip == 0 and point.planar:
            self.push(*point.stopping_impulse())
        return self.choose(slip)

    def end_slip(self) -> Mode:
        """A tip that comes to rest is at rest: what is left of its velocity is rounding, and the drift of the arc.

        Left there, a drift away from the floor, of the size of the tolerance, would pass for a lift-off.
        """
        self.push(*self.point(self.t, self.y).stopping_impulse())
        return self.choose(0)

    def lift_off(self) -> Mode:
        """A contact opens with v_n = 0; the drift of the arc is taken away here too."""
        point = self.point(self.t, self.y)
        self.push(-point.v_n / point.a, 0.0)
        return Mode.FREE

    def impact(self, point: ContactPoint) -> int:
        """u+ = S(q, u-); returns the sign of the slip that is left."""
        normal, tangential, branch = point.impact()
        self.push(normal, tangential)
        self.place.y[2 * self.d :] += normal, tangential
        change = Change.FRICTIONAL_IMPACT if point.planar else Change.IMPACT
        self.recorder.add(np.array([self.t]), self.y[None, :], np.array([branch]), change)
        return {ContactMode.SLIP_PLUS: -1, ContactMode.SLIP_MINUS: 1}.get(branch, 0)

    def choose(self, slip: int) -> Mode:
        """The one mode that solves the contact problem. Raises _Stop where there is none, or more than one."""
        modes = closed_modes(self.point(self.t, self.y), slip)
        if not modes:
            raise _Stop(Ending.INCONSISTENT, f"at t = {self.t:.9g}")
        if len(modes) > 1:
            count = {2: "two", 3: "three", 4: "four"}[len(modes)]
            names = ", ".join("lift-off" if m is Mode.FREE else m.label for m in modes)
            raise _Stop(Ending.INDETERMINATE, f"{count}: {names}; at t = {self.t:.9g}")
        return modes[0]


def integrate(start: Start, grid: TimeGrid, options: Mapping[str, float], progress: Progress) -> Trajectory:
    """The trajectory on the grid's instants and at every event."""
    return _EventDrivenRun(start, grid, options, progress).go()


SCHEME = Integrated(
    name=NAME,
    sentence="smooth motion between located events, complementarity of accelerations and contact forces",
    source="P. Lötstedt, ZAMM 61 (1981) 605-615; F. Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral "
    "Contacts, 1996",
    order=8,
    options={"rtol": 1e-10, "atol": 1e-12},
    integrate=integrate,
)
