"""No member slips at an isolated state: the proof, against closed forms and against balls in which members do slip."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

from painleve.asymptotics.certify.isolation import slips_nowhere
from painleve.asymptotics.certify.method import CertifyOptions, certify_distance
from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.mechanics.friction import Segment
from painleve.mechanics.scene import Coordinate, StateKey, make_scene
from painleve.mechanics.scene_file.build import scene_of_text
from painleve.mechanics.state import make_state
from painleve.theory.classification import Branch, classify

BRAKE = """
name = "brake"
sentence = "rod hinged above a moving board, which is a coordinate of its own"
[coordinates]
phi = { unit = "rad", sentence = "angle of the rod from the downward vertical" }
s = { unit = "m", sentence = "position of the board" }
[parameters]
H = { unit = "m", sentence = "height of the hinge", default = "1/2" }
mu = { unit = "1", sentence = "friction", default = 0.5, range = "nonnegative" }
[mechanics]
kinetic_energy = "u_phi**2/6 + 5*u_s**2"
[contact]
height = "H - cos(phi)"
tangential_displacements = "sin(phi) - s"
[friction]
kind = "segment"
mu = "mu"
[keys]
phi = { unit = "rad", sentence = "angle" }
board = { unit = "m/s", sentence = "speed of the board", default = 1 }
[velocity]
s = "board"
[contact_parameters]
H = "cos(phi)"
"""


def brake():
    scene = scene_of_text("brake.toml", BRAKE)
    return classify(make_state(scene, keys={"phi": "pi/6", "board": -1}, parameters={"mu": "1/sqrt(3)"}))


@pytest.mark.parametrize("eps", [0.3, 1e-1, 1e-3, 1e-12])
def test_a_hinged_rod_keeps_the_middle_of_A_away_from_its_members_by_half_of_one_less_eps(eps):
    """Free members fill B(u-, eps), u- = (0, -1), and sticking stops both coordinates: what is farthest is where the
    distances t - eps and 1 - t are equal."""
    found = brake()
    assert found.branch is Branch.CRITICAL_ISOLATED
    bounds = certify_distance(found.limit, eps).excess_A_Aeps.bounds
    assert bounds.lower <= (1.0 - eps) / 2.0 <= bounds.upper
    assert bounds.relative_width < 1e-11
    # gamma > 0 asks for a smaller angle, and so for less than contact: by the compiled law no sample slips there
    sampled = sample_distance(found.limit, eps, SampleOptions(samples=20_000))
    assert sampled.counts["slip_plus"] + sampled.counts["slip_minus"] == 0
    assert sampled.excess_A_Aeps.bounds.upper >= bounds.lower


def carried_scene():
    """gamma ~ -x^2 - z^2 - 20 z^3 and g = z/2 - y: at z < 0, where gamma may be positive, y alone makes contact."""
    x, z, y = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in "xzy")
    mu = sp.Rational(5, 4) + x.symbol**2 + z.symbol**2 + 20 * z.symbol**3
    return make_scene(
        name="carried",
        sentence="two coordinates of the law, and one that only carries the contact",
        source="a test",
        coordinates=(x, z, y),
        parameters=(),
        inertia=sp.Matrix([[4, 0, 1], [0, 1, 0], [1, 0, 1]]).inv(),
        constraint=z.symbol / 2 - y.symbol,
        tangential_displacements=(x.symbol,),
        friction=Segment(minus=mu, plus=mu),
        keys=(StateKey(name="slip", unit="m/s", sentence="slip", default="1"),),
        velocity={"x": sp.Symbol("slip", real=True)},
    )


def test_a_coordinate_that_carries_the_contact_is_not_forgotten_where_g_falls_with_the_others():
    found = classify(make_state(carried_scene()))
    assert found.branch is Branch.CRITICAL_ISOLATED
    problem = make_local_problem(found.limit)
    slipping = sample_distance(found.limit, 0.1, SampleOptions(samples=200_000))
    assert slipping.counts["slip_minus"] > 0  # as gamma > 0 at z = -0.08, where y = -0.05 keeps g >= 0
    assert not slips_nowhere(problem, 0.1)
    certified = certify_distance(found.limit, 0.1, CertifyOptions(width=0.1, budget=500)).excess_A_Aeps.bounds
    assert certified.lower <= slipping.excess_A_Aeps.bounds.upper < 0.25 * np.linalg.norm(found.limit.jump)
    assert slips_nowhere(problem, 1e-3)
