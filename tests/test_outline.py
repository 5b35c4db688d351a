"""The outline of a body over the floor: a motion ends where a point that the contact does not hold up goes through."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from dynamics_scenes import X, Y, block
from scipy.integrate import quad

from painleve.core.motion_codes import Ending, FixedStep, MemberOutcome
from painleve.core.stepping import Fates, Rounding, SteppingMethod
from painleve.dynamics.ensemble import run_ensemble
from painleve.dynamics.outline import depth_rounding
from painleve.dynamics.schemes import SCHEME_NAMES
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import Start, as_start, make_start
from painleve.kernels.motion import loops
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Outline
from painleve.mechanics.state import make_state

ROD = load_scene("slender_rod")
FALLING = make_state(ROD, keys={"theta": "1/2", "slip": 0}, parameters={"mu": 0})


def lies_flat_at(theta: float) -> float:
    """When a rod on ice (m = l = 1) that is let go at this angle lies flat: its centre falls straight, energy says how.

    (cos^2 + 1/3) theta'^2 = 2 g (sin theta_0 - sin theta); theta = theta_0 - x^2 takes the singularity away.
    """

    def slowness(x: float) -> float:
        angle = theta - x * x
        fallen = 2.0 * np.cos(theta - x * x / 2.0) * np.sin(x * x / 2.0)  # sin theta_0 - sin theta
        ratio = x * x / fallen if x > 0.0 else 1.0 / np.cos(theta)
        return float(2.0 * np.sqrt((np.cos(angle) ** 2 + 1.0 / 3.0) * ratio / (2.0 * 9.81)))

    return float(quad(slowness, 0.0, np.sqrt(theta))[0])


@pytest.mark.parametrize("scheme", SCHEME_NAMES)
def test_a_rod_that_falls_flat_ends_when_its_other_end_reaches_the_floor(scheme: str) -> None:
    found = simulate(FALLING, scheme=scheme, step=1e-3, until=2.0)
    assert found.ending is Ending.THROUGH_FLOOR
    assert found.t[-1] == pytest.approx(lies_flat_at(0.5), abs=4e-3)
    height, before = (q[1] + np.sin(q[2]) for q in (found.q[-1], found.q[-2]))
    assert before >= -1e-8
    assert height < 0.0
    assert -height < 1e-3 * abs(found.u[-1, 1] + np.cos(found.q[-1, 2]) * found.u[-1, 2]) + 1e-8
    depth, time = f"{-height:.3g}", f"{found.t[-1]:.9g}"
    assert found.sentence.endswith(f"(point 2 of the outline is {depth} m below the floor at t = {time})")
    assert found.as_dict()["status"] == "through_floor"


def test_a_rod_that_lies_flat_from_the_start_is_through_the_floor_at_once() -> None:
    for scheme in SCHEME_NAMES:
        found = simulate(make_state(ROD, keys={"theta": 0, "slip": 0}), scheme=scheme, step=1e-2, until=1.0)
        assert found.ending is Ending.THROUGH_FLOOR
        assert found.t[-1] <= 0.02


@pytest.mark.parametrize("scheme", [s for s in SCHEME_NAMES if s not in ("event_driven", "compliant")])
def test_a_member_of_an_ensemble_goes_through_the_floor_when_its_trajectory_does(scheme: str) -> None:
    found = run_ensemble(FALLING, scheme=scheme, step=1e-3, window=0.5, count=20, until=2.0, keep=True)
    assert found.counts[MemberOutcome.THROUGH_FLOOR] == 20
    assert found.as_dict()["fractions"]["through_floor"] == 1.0
    assert found.members is not None
    for step, time, steps in zip(found.members.step, found.members.time, found.members.steps, strict=True):
        alone = simulate(FALLING, scheme=scheme, step=step, until=2.0, monitor=False)
        assert (alone.t[-1], alone.steps) == (time, steps)


def test_what_is_decided_above_the_floor_is_not_touched_by_it() -> None:
    """The jams and lift-offs of Glocker's rod, member by member, where the floor is watched and where nothing is."""
    start, n = as_start(make_state(ROD, "stoss")), 300
    q, u, h = np.tile(start.q, (n, 1)), np.tile(start.u, (n, 1)), np.linspace(0.9e-3, 1.1e-3, n)
    method, fates = SteppingMethod(int(FixedStep.CONTACT_DYNAMICS), 0.0, 0.0), []
    for rounding in (depth_rounding(start), np.inf):
        fates.append(Fates(np.zeros(n, np.int8), np.zeros(n), np.zeros(n, np.int64)))
        start.motion.run_members(method, Rounding(start.rounding, rounding), 0.0, 1.0, h, q, u, start.p, fates[-1])
    for watched, unwatched in zip(*fates, strict=True):
        np.testing.assert_array_equal(watched, unwatched)
    assert set(fates[0].outcome) == {MemberOutcome.JUMP, MemberOutcome.LIFT_OFF}


def test_contact_points_are_told_from_the_others_exactly() -> None:
    watched = {
        name: list(scene.outline.depths(scene.contact.constraint))
        for name in ("slender_rod", "worn_tip_rod", "two_link_arm", "planar_body", "ellipse")
        if (scene := load_scene(name)).outline is not None
    }
    # of the rod its other end, of the arm its shoulder and its elbow, of the rectangle three corners, once each
    assert watched == {
        "slender_rod": [1],
        "worn_tip_rod": [1],
        "two_link_arm": [0, 1],
        "planar_body": [1, 2, 3],
        "ellipse": [],
    }


def test_no_point_of_the_ellipse_is_below_its_contact() -> None:
    """The contact is the lowest point of the ellipse, so none of those that are drawn needs watching."""
    scene, random = load_scene("ellipse"), np.random.default_rng(0)
    assert scene.outline is not None
    depths = [-y for _, y in scene.outline.points]
    function = sp.lambdify([*scene.q, *scene.p], [scene.contact.constraint, *depths])
    for _ in range(200):
        m, inertia, mu, gravity = 1.0, 1.0, 0.5, 9.81
        q, axes = random.normal(0.0, 2.0, 3), random.uniform(0.05, 3.0, 2)
        g, *others = function(*q, m, *axes, inertia, mu, gravity)
        assert max(others) <= g + 1e-14 * (1.0 + abs(g))


def test_a_contact_that_no_algebra_knows_is_never_deeper_than_itself() -> None:
    outline = Outline(points=((X, Y), (X, Y * (sp.sin(X) ** 2 + sp.cos(X) ** 2)), (X, Y + 1)), floor=sp.Integer(0))
    assert list(outline.depths(-Y)) == [1, 2]
    random, counts = np.random.default_rng(3), [0, 0]
    for _ in range(400):
        q, allowed = tuple(random.normal(size=2).tolist()), float(random.uniform(0.0, 0.5))
        g, depth = q[0] ** 2 / 2.0 - q[1], -q[0] - q[1] - 0.25  # of the templates' sample
        through = loops.is_through(q, (0.0,) * 4, allowed)
        assert through == (depth > allowed and depth > g + allowed)
        counts[through] += 1
    assert min(counts) > 20


def leaning(omega: float) -> Start:
    """The rod with its contact point on the floor and its other end 2 sin(0.3) below it."""
    sine = float(np.sin(0.3))
    velocity = {"y": -omega * float(np.cos(0.3)) * -1.0, "theta": omega}
    return make_start(ROD, q={"x": 0, "y": -sine, "theta": -0.3}, u=velocity, parameters={"gravity": 0, "mu": 0})


def test_an_outline_that_starts_below_the_floor_ends_nothing_until_it_goes_deeper() -> None:
    rises, sinks = (simulate(leaning(omega), step=1e-3, until=0.1) for omega in (1.0, -1.0))
    assert rises.ending is Ending.REACHED_END
    assert sinks.ending is Ending.THROUGH_FLOOR
    assert sinks.steps == 1
    for found in (rises, sinks):
        assert "at the start the outline is 0.591 m below the floor: only what goes deeper" in found.notes[0]


@pytest.mark.parametrize("scheme", ["event_driven", "compliant"])
def test_a_dip_between_the_steps_of_an_integrator_is_found_where_it_is_recorded(scheme: str) -> None:
    """Without gravity a rod that spins once in 0.1 s needs few steps: its end is below the floor for part of a turn."""
    omega = -20.0 * np.pi
    start = make_start(ROD, q={"x": 0, "y": 0.9, "theta": 0.1}, u={"theta": omega}, parameters={"gravity": 0, "mu": 0})
    found = simulate(start, scheme=scheme, step=1e-3, until=0.05)
    assert found.ending is Ending.THROUGH_FLOOR
    assert found.t[-1] == pytest.approx((-np.arcsin(0.9) - 0.1) / omega, abs=1e-3)


def test_a_scene_without_an_outline_says_that_nothing_else_is_watched() -> None:
    found = simulate(make_start(block(), q={"x": 0, "y": 1}), step=0.1, until=0.2)
    assert found.notes == ("without an outline nothing but the contact point is kept above the floor",)
    assert found.as_dict()["notes"] == list(found.notes)
    assert found.to_xarray().attrs["notes"] == found.notes[0]
    assert simulate(FALLING, step=1e-2, until=0.02).notes == ()
