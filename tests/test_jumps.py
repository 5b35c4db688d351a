"""Where a jump of the velocity starts, and what is a jump at all: against NumPy, and at two step sizes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from dynamics_scenes import Reference, block, space_block
from scipy.optimize import brentq

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import make_start
from painleve.dynamics.trajectory import Trajectory
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import State, make_state

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


def stopped(slip: float) -> tuple[State, float]:
    """A rod that turns about its tip, whose slip friction stops at once; the part of the speed that this takes.

    a + mu_plus b is a little above zero where the law is taken, and the contact force of the slip accordingly large.
    """
    theta, omega, h = math.pi / 3, 2.0, 1e-4
    M, inverse, end = np.diag([1.0, 1.0, 1 / 3]), np.diag([1.0, 1.0, 3.0]), theta + h * omega
    w, H = np.array([0.0, 1.0, -math.cos(end)]), np.array([1.0, 0.0, math.sin(end)])
    W, mu = np.array([w, H]).T, -(w @ inverse @ w) / (w @ inverse @ H) * (1.0 - 1e-4)
    v = np.array([slip - omega * math.sin(theta), omega * math.cos(theta) - h * 9.81, omega])
    taken = inverse @ W @ np.linalg.solve(W.T @ inverse @ W, W.T @ v)
    state = make_state(ROD, keys={"theta": "pi/3", "omega": omega, "slip": slip}, parameters={"mu": mu})
    return state, kinetic(M, taken) / kinetic(M, v)


def test_a_stop_without_a_paradox_is_a_jump_if_it_takes_a_tenth_of_the_speed() -> None:
    limit = brentq(lambda slip: stopped(slip)[1] - 0.1, -0.01, -1.0)
    for slip, jumps in ((0.99 * limit, []), (1.01 * limit, [Change.JUMP_WITHOUT_COLLISION])):
        found = simulate(stopped(slip)[0], step=1e-4, until=2e-4, contact_tolerance=1e-6)
        assert found.branch[1] == ContactMode.STICK
        assert found.contact_quantities()["gamma"][1] > 0.0
        assert [jump.kind for jump in found.jumps] == jumps


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
