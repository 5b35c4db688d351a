"""Where a jump of the velocity starts, and what is a jump at all: against NumPy, and at two step sizes."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from dynamics_scenes import Reference, block, space_block
from scipy.optimize import brentq

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, FixedStep
from painleve.core.stepping import SteppingMethod
from painleve.dynamics.contact_rows import gamma_along
from painleve.dynamics.fixed_step import empty_track
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import as_start, make_start
from painleve.dynamics.trajectory import Trajectory
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

ROD = load_scene("slender_rod")
SCHEMES = ("contact_dynamics", "moreau_jean", "stewart_trinkle", "anitescu_potra", "schatzman_paoli")


def where(scheme: str, found: Trajectory, i: int) -> tuple[tuple, np.ndarray]:
    """(t, q, u) at which step i takes the force, and q at which it takes the law."""
    (t, t1), (q, q1), (u, u1) = (column[i - 1 : i + 1] for column in (found.t, found.q, found.u))
    if scheme == "contact_dynamics":
        return (t1, q1, u), q1
    if scheme == "moreau_jean":
        middle = q + (t1 - t) / 2 * u
        return ((t + t1) / 2, middle, (u + u1) / 2), middle
    return (t, q, u), (q1 if scheme == "schatzman_paoli" else q)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_jump_goes_from_the_free_velocity_of_its_step_at_the_gamma_of_its_law(scheme: str) -> None:
    values = {"beta": 0.2, "bend": 0.6, "mu": 0.5, "weight": 8.0, "drag": 0.5, "beat": 4.0}
    reference, h = Reference(block(), values), 1e-2
    start = make_start(block(), q={"x": 0.3, "y": 0.5}, u={"x": 3, "y": -1}, parameters=values)
    found = simulate(start, scheme=scheme, step=h, until=1.0)
    assert found.jumps
    for jump in found.jumps:
        place, at = where(scheme, found, jump.index)
        M, f, *_ = reference.at(*place)
        free = found.u[jump.index - 1] + h * np.linalg.solve(M, f.ravel())
        np.testing.assert_allclose(jump.u_minus, free, rtol=1e-9, atol=1e-11)
        M, _, _, w, H, minus, plus = reference.at(0.0, at, place[2])
        compliances = [w.ravel() @ np.linalg.solve(M, (w + s * H).ravel()) for s in (plus, -minus)]
        assert jump.gamma == pytest.approx(min(compliances) / (w.T @ w).item(), rel=1e-12)


def kinetic(M: np.ndarray, x: np.ndarray) -> float:
    return math.sqrt(x @ M @ x)


class Stop:
    """A rod that turns about its tip, whose slip friction stops in the first step; `size` and `speed` say of how much.

    critical: mu over the value at which a + mu_plus b vanishes where the law is taken. A little below 1 there is no
    paradox and the contact force of the slip is large; above 1 there is one. free: F of docs/theory.md, section 7.
    """

    h, theta, gravity = 1e-4, math.pi / 3, 9.81

    def __init__(self, slip: float, omega: float, critical: float) -> None:
        M, inverse, end = np.diag([1.0, 1.0, 1 / 3]), np.diag([1.0, 1.0, 3.0]), self.theta + self.h * omega
        w, H = np.array([0.0, 1.0, -math.cos(end)]), np.array([1.0, 0.0, math.sin(end)])
        W, a, self.critical = np.array([w, H]).T, w @ inverse @ w, critical
        v = np.array([slip - omega * math.sin(self.theta), omega * math.cos(self.theta), omega])
        v[1] -= self.h * self.gravity
        self.keys = {"theta": "pi/3", "omega": omega, "slip": slip}
        self.mu = -critical * a / (w @ inverse @ H)
        self.size = kinetic(M, inverse @ W @ np.linalg.solve(W.T @ inverse @ W, W.T @ v))
        self.speed = kinetic(M, v)
        self.free = self.h * (self.gravity + omega**2 * math.sin(end) / math.sqrt(a))

    def change(self, flight: int) -> Change:
        """What the step that stops it is, after so many steps without contact."""
        start = as_start(make_state(ROD, keys=self.keys, parameters={"mu": self.mu}))
        track, method = empty_track(start, 1), SteppingMethod(int(FixedStep.CONTACT_DYNAMICS), 0.0, 1e-6)
        t, h = np.array([0.0, self.h]), np.array([self.h])
        _, _, since = start.motion.run(method, flight, math.inf, t, h, h, start.p, track)
        assert since == 0
        assert track.branch[1] == ContactMode.STICK
        rows, _, _ = start.tabulate(np.zeros(1), track.q[1:], track.u[1:])
        assert (gamma_along(start.motion, rows)[0] > 0.0) == (self.critical < 1.0)
        return Change(track.change[1])


@pytest.mark.parametrize(
    ("omega", "critical", "least"),
    [
        (2.0, 1.0 - 1e-4, lambda stop, flight: stop.speed / 10.0),
        (0.0, 1.0 - 1e-4, lambda stop, flight: 10.0 * stop.free * (flight + 1)),
        (0.1, 1.5, lambda stop, flight: 3.0 * stop.free * (flight + 1)),
    ],
    ids=["a tenth of the speed", "ten times the free change since the last contact", "in a paradox three times that"],
)
def test_a_stop_is_a_jump_if_it_takes_more_than(
    omega: float, critical: float, least: Callable[[Stop, int], float]
) -> None:
    for flight in (0, 1):

        def excess(slip: float, flight: int = flight) -> float:
            stop = Stop(slip, omega, critical)
            return stop.size - least(stop, flight)

        limit = brentq(excess, -1e-4, -1.0)
        assert Stop(0.99 * limit, omega, critical).change(flight) is Change.ORDINARY
        assert Stop(1.01 * limit, omega, critical).change(flight) is Change.JUMP_WITHOUT_COLLISION


def test_an_approach_faster_than_ten_steps_of_free_fall_is_a_collision() -> None:
    h, weight = 1e-3, 10.0
    for factor, kinds in ((0.99, []), (1.01, [Change.FRICTIONAL_IMPACT])):
        u = {"x": 1, "y": -(10.0 * factor - 1.0) * weight * h}
        start = make_start(block(), q={"x": 0, "y": 0}, u=u, parameters={"weight": weight, "mu": "1/4"})
        assert [jump.kind for jump in simulate(start, step=h, until=h).jumps] == kinds


def test_a_slip_that_follows_the_edge_of_its_wedge_has_no_jump_but_the_one_that_does_not_shrink() -> None:
    """The edge turns under a slip that follows it, and each step changes the velocity by more than free motion does."""
    values = {"beta": -0.25, "c": -0.57, "bend": -0.53, "mu": 5, "nu": 3.5, "angle": 1.65, "weight": 19}
    q, u = {"x": 1.74, "y": 0, "z": 0}, {"x": -0.35, "y": 1.9}
    start = make_start(space_block("ellipse"), q=q, u=u, parameters=values)
    kept, others = [], []
    for h in (1e-4, 1e-5):
        found = simulate(start, step=h, until=30 * h)
        (jump,) = found.jumps
        assert jump.gamma < 0.0
        sizes = np.linalg.norm(np.diff(found.u, axis=0), axis=1)
        kept.append(sizes[jump.index - 1])
        others.append(np.delete(sizes, jump.index - 1).max())
    assert kept[1] == pytest.approx(kept[0], rel=1e-2)
    assert others[1] < others[0] / 3
