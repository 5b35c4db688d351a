"""Friction in space does not know coordinates or units: the rod described by its tip, and in other units."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

from painleve.kernels.compiled import make_kernels
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Disc, Ellipse
from painleve.mechanics.library import load_scene
from painleve.mechanics.library.slender_rod import MU
from painleve.mechanics.library.spatial_rod import make_spatial_rod
from painleve.mechanics.scene import Coordinate, make_scene
from painleve.mechanics.state import make_state
from painleve.theory.coulomb.one_step import coulomb_solutions
from painleve.theory.limit_set import limit_set

HALF = sp.Rational(1, 2)
SECTIONS = {
    "disc": Disc(mu=MU.symbol),
    "ellipse": Ellipse(mu_1=MU.symbol, mu_2=MU.symbol / 2, angle=sp.atan(sp.Rational(4, 3))),
}
STATES = [  # rational sines, cosines and half-angle tangents
    {"theta": "2*atan(1/2)", "phi": "atan(3/4)", "slip": "1", "heading": "pi - atan(5/12)", "mu": "3/2"},
    {"theta": "2*atan(1/2)", "phi": "0", "slip": "2", "heading": "pi", "mu": "3"},
    {"theta": "2*atan(1/3)", "phi": "atan(3/4)", "slip": "1/3", "heading": "-2*atan(2)", "mu": "3"},
]


def by_centre(section):
    return make_spatial_rod(
        name="by_centre", sentence="by its centre", friction=section, friction_parameters=(MU,), states=()
    )


def by_tip(section):
    """Coordinates: centre (x, y), height Z of the tip, tau = tan(theta/2) and the azimuth; m = l = 1, I = 1/3."""
    x, y, Z, tau, phi = (Coordinate(name=n, unit="m", sentence=n) for n in ("x", "y", "Z", "tau", "phi"))
    c = (1 - tau.symbol**2) / (1 + tau.symbol**2)
    theta_rate = 2 / (1 + tau.symbol**2) * tau.velocity
    rise = Z.velocity + c * theta_rate
    energy = (x.velocity**2 + y.velocity**2 + rise**2) / 2 + (theta_rate**2 + (c * phi.velocity) ** 2) / 6
    return make_scene(
        name="by_tip",
        sentence="by its tip",
        source="a test",
        coordinates=(x, y, Z, tau, phi),
        parameters=(MU,),
        kinetic_energy=energy,
        constraint=-Z.symbol,
        friction=section,
        tangential_displacements=(x.symbol - c * sp.cos(phi.symbol), y.symbol - c * sp.sin(phi.symbol)),
    )


def centre_velocity(theta, u):
    """From the rates of (x, y, Z, tau, phi) to those of (x, y, z, theta, phi)."""
    theta_rate = 2 / (1 + np.tan(theta / 2) ** 2) * u[3]
    return np.array([u[0], u[1], u[2] + np.cos(theta) * theta_rate, theta_rate, u[4]])


def both(section, keys):
    """The same state of both scenes: the rod translates without turning."""
    keys = dict(keys)
    parameters = {"mu": keys.pop("mu")}
    state = make_state(by_centre(section), keys=keys, parameters=parameters)
    theta, phi = state.q[3], state.q[4]
    tip = {"tau": sp.tan(theta / 2), "phi": phi, "u_x": state.u[0], "u_y": state.u[1]}
    return state, make_state(by_tip(section), keys=tip, parameters=parameters)


@pytest.mark.parametrize("name", SECTIONS)
@pytest.mark.parametrize("keys", STATES)
def test_the_limit_set_is_the_same_jump_in_other_coordinates(name, keys):
    here, there = both(SECTIONS[name], keys)
    first, second = limit_set(here), limit_set(there)
    assert (first.kind, first.gamma.sign) == (second.kind, second.gamma.sign)
    assert np.allclose(first.u_plus, centre_velocity(here.number(here.q[3]), second.u_plus), atol=1e-13)
    # gamma is not invariant, |grad g|^2 gamma is
    sizes = [s.number(derive(s.scene).gradient_squared) for s in (here, there)]
    assert first.gamma_value * sizes[0] == pytest.approx(second.gamma_value * sizes[1], rel=1e-13)


@pytest.mark.parametrize("name", SECTIONS)
@pytest.mark.parametrize("keys", STATES)
def test_coulomb_s_solutions_have_the_same_impulses_in_other_coordinates(name, keys):
    here, there = both(SECTIONS[name], keys)
    mu = {"mu": keys["mu"]}
    v_here = [*here.u[:2], here.u[2] - HALF, *here.u[3:]]
    v_there = [*there.u[:2], there.u[2] - HALF, *there.u[3:]]
    first = coulomb_solutions(here.scene, here.q, v_here, parameters=mu)
    second = coulomb_solutions(there.scene, there.q, v_there, parameters=mu)
    assert len(first.solutions) == len(second.solutions) >= 1
    for x, y in zip(first.solutions, second.solutions, strict=True):
        assert x.kind is y.kind
        assert np.allclose(x.impulse, y.impulse, atol=1e-12 * np.linalg.norm(x.impulse))


@pytest.mark.parametrize("name", SECTIONS)
def test_the_compiled_law_gives_the_same_velocities_in_other_coordinates(name):
    rng = np.random.default_rng(2)
    law = {make: make_kernels(make(SECTIONS[name])).law_at for make in (by_centre, by_tip)}
    branches = set()
    for _ in range(200):
        theta, phi, mu = rng.uniform(0.2, 1.4), rng.uniform(-3, 3), 10 ** rng.uniform(-1, 1)
        u = rng.normal(size=5) * [1, 1, 0.1, 1, 1]
        q = np.array([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), np.sin(theta), theta, phi])
        at_centre, at_tip = np.empty(5), np.empty(5)
        parameters = np.array([1.0, 1.0, 1.0 / 3.0, mu, 9.81])
        # a little into the floor: in contact, whatever rounding does to g
        branch = law[by_centre](q - [0, 0, 1e-12, 0, 0], parameters, centre_velocity(theta, u), at_centre)
        q[2:4] = -1e-12, np.tan(theta / 2)
        other = law[by_tip](q, np.array([mu]), u, at_tip)
        assert branch == other
        branches.add(branch)
        size = np.linalg.norm(at_centre)
        assert np.allclose(at_centre, centre_velocity(theta, at_tip), atol=1e-9 * size)
    assert len(branches) == 3  # free, stick and slip


@pytest.mark.parametrize("name", ["paradox", "oblique", "critical_oblique"])
def test_other_units_of_mass_length_and_time_change_nothing_but_the_units(name):
    """Grams, centimetres and milliseconds for kilograms, metres and seconds."""
    rod = load_scene("spatial_rod")
    plain = limit_set(make_state(rod, name))
    mass, length, time = 1000, 100, 1000
    slip = sp.Rational(length, time)
    other = limit_set(make_state(rod, name, keys={"slip": slip}, parameters={"m": mass, "l": length}))
    speeds = np.array([length / time] * 3 + [1 / time] * 2)
    assert other.kind == plain.kind
    assert np.allclose(other.u_plus, plain.u_plus * speeds, rtol=1e-13, atol=1e-16)
    assert float(other.multiplier) == pytest.approx(float(plain.multiplier) * mass * length / time, rel=1e-13)
