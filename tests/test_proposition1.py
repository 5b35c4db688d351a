"""Proposition 1's margins under rounding: with masses and units of every size, and where the step is wrong."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from dynamics_scenes import hinged_rod

from painleve.core.codes import ContactMode
from painleve.dynamics.proposition1 import MARGINS, _inverse_root, check_proposition1
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import make_start
from painleve.dynamics.trajectory import Trajectory
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

H = 1e-3


def braked(mass: float, speed: float) -> Trajectory:
    """The rod on the board, which moves at that speed: it holds the rod (0 and -1) or slides under it."""
    start = make_start(hinged_rod(), q={"phi": "pi/6", "s": 0}, u={"s": speed}, parameters={"M_b": mass})
    return simulate(start, step=H, until=0.1)


@pytest.mark.parametrize("mass", [1.0, 1e3, 1e6, 1e9, 1e12])
@pytest.mark.parametrize("speed", [0.0, 1.0, -1.0])
def test_a_coordinate_of_great_mass_does_not_make_rounding_look_like_a_failure(mass: float, speed: float) -> None:
    found = braked(mass, speed)
    assert found.statistics["free"] < found.steps
    assert found.proposition1 is not None
    for name in MARGINS:
        assert found.proposition1.worst(name)[0] <= 1e-15


@pytest.mark.parametrize("mass", [1.0, 1e4])
def test_a_wrong_friction_reads_as_its_distance_from_the_cone_over_the_momentum_of_the_board(mass: float) -> None:
    """A thousandth more friction than the cone has: 1e-3 r_t sqrt(det G/(rho . G rho)) from its edge rho."""
    found = braked(mass, 1.0)
    assert found.statistics["slip_plus"] + found.statistics["slip_minus"] == found.steps
    i, u = 50, found.u.copy()
    phi, (normal, tangential) = found.q[i, 0], found.r[i]
    columns = np.array([[np.sin(phi), 0.0], [np.cos(phi), -1.0]]) @ np.diag([np.sqrt(3.0), mass**-0.5])
    u[i] += 1e-3 * tangential * np.array([3.0 * np.cos(phi), -1.0 / mass])
    margins = check_proposition1(found.start, found.t, np.full(100, H), found.q, u, found.branch == 1, 0.0)
    G, rho = columns @ columns.T, np.array([1.0, tangential / normal])
    distance = 1e-3 * abs(tangential) * np.sqrt(np.linalg.det(G) / (rho @ G @ rho))
    momentum = np.sqrt(mass) * (u[i, 1] + u[i - 1, 1])
    assert margins.membership[i - 1] == pytest.approx(distance / momentum, rel=2e-2)
    assert found.proposition1.membership[i - 1] < 1e-16


def test_the_margins_do_not_depend_on_the_unit_of_mass() -> None:
    state = make_state(load_scene("slender_rod"), "sliding")
    light, heavy = (
        simulate(make_state(state.scene, "sliding", parameters={"m": m}), step=H, until=0.3) for m in (1, 2**40)
    )
    for name in MARGINS:
        np.testing.assert_allclose(
            getattr(light.proposition1, name), getattr(heavy.proposition1, name), rtol=1e-9, atol=1e-15
        )


def test_the_bound_on_the_norm_is_tight_where_a_light_body_falls_beside_a_heavy_one() -> None:
    """The norm of M^-1/2 to many digits: its error is not magnified by the ratio of the masses.

    The rod falls freely and at rest: only the light coordinate moves, and (7.2) is an equality.
    """
    start = make_start(hinged_rod(), q={"phi": "pi/4", "s": 0}, parameters={"M_b": 1e12})
    found = simulate(start, step=H, until=0.02)
    assert (found.branch == ContactMode.FREE).all()
    assert found.proposition1 is not None
    with mp.workdps(40):
        for i, margin in enumerate(found.proposition1.norm_bound):
            q, u, u1 = found.q[i + 1], found.u[i], found.u[i + 1]
            f = mp.mpf(-4.905) * mp.sin(mp.mpf(q[0]))
            root = mp.sqrt(mp.mpf(1) / 3)
            gap = abs(mp.mpf(u1[0])) * root - abs(mp.mpf(u[0])) * root - H * abs(f) / root
            size = (abs(mp.mpf(u1[0])) + abs(mp.mpf(u[0])) + 3 * H * abs(f)) * root
            assert float(gap / size) == pytest.approx(margin, abs=2e-16)
            assert abs(margin) < 1e-15


@pytest.mark.parametrize("mass", [1.0, 1e6, 1e12])
def test_the_norm_of_the_inverse_root_is_known_to_rounding_for_coupled_masses(mass: float) -> None:
    """A pendulum of mass 1 on a cart: the least eigenvalue of M comes from its characteristic polynomial."""
    M = np.array([[mass + 1.0, 0.9], [0.9, 1.0]])
    with mp.workdps(60):
        trace, det = mp.mpf(M[0, 0]) + 1, mp.mpf(M[0, 0]) - mp.mpf(0.9) ** 2
        expected = float(1 / mp.sqrt((trace - mp.sqrt(trace**2 - 4 * det)) / 2))
    root = _inverse_root(M[None])[0]
    assert np.linalg.norm(root, ord=2) == pytest.approx(expected, rel=1e-15)


def test_where_m_is_not_positive_definite_there_are_no_margins_and_elsewhere_there_are() -> None:
    roots = _inverse_root(np.array([np.diag([1.0, 4.0]), np.diag([1.0, -1.0]), [[np.inf, 0.0], [0.0, 1.0]]]))
    np.testing.assert_array_equal(roots[0], np.diag([1.0, 0.5]))
    assert np.isnan(roots[1:]).all()
