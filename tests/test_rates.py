"""The constant C in d_H = C eps + o(eps): closed form, the optimised distance as eps -> 0, and the constraints."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from planar_scenes import SCENE_NAMES

from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.member import make_member
from painleve.asymptotics.optimise import optimise_distance
from painleve.asymptotics.rates import rate
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import LimitSet, limit_set

STATES = [(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states]
SPINNING = [  # theta, slip, angular velocity, mu of the rod
    ("1", "-1", "3/4", "2"),
    ("atan(2)", "-1", "1", "2"),
    ("atan(2)", "-2/3", "-1/2", "4/3"),
    ("atan(3 - sqrt(5))", "-1", "1/3", "2"),
    ("atan(3 + sqrt(5))", "-1", "2", "2"),
    ("4/5", "3/2", "2", "1/3"),
    ("4/5", "0", "2", "1/3"),
]


def named(scene: str, state: str) -> LimitSet:
    return limit_set(make_state(load_scene(scene), state))


def rod(theta: str, slip: str, omega: str, mu: str) -> LimitSet:
    keys = {"theta": theta, "slip": slip, "omega": omega}
    return limit_set(make_state(load_scene("slender_rod"), keys=keys, parameters={"mu": mu}))


CASES = [pytest.param(named(*s), id="-".join(s)) for s in STATES] + [
    pytest.param(rod(*s), id=" ".join(s)) for s in SPINNING
]


def measured(limit: LimitSet) -> LimitSet:
    """What d_H is measured against: the ends of A where the rate is said to be of them."""
    return limit.ends if "tends to" in rate(limit).sentence else limit


@pytest.mark.parametrize("limit", CASES)
def test_the_distance_over_eps_tends_to_the_rate(limit):
    """Its error is linear in eps: at 1e-9 it is below 1e-7, and a step of Richardson's removes it at 1e-4."""
    C, against = rate(limit).C, measured(limit)
    tiny = optimise_distance(against, 1e-9).settings["estimate"] / 1e-9
    assert tiny == pytest.approx(C, rel=1e-7)
    coarse, fine = (optimise_distance(against, eps).settings["estimate"] / eps for eps in (2e-4, 1e-4))
    assert 2 * fine - coarse == pytest.approx(C, rel=2e-6)


@pytest.mark.parametrize("limit", CASES)
def test_the_offsets_that_attain_the_rate_give_a_member_at_that_distance(limit):
    """At eps = 1e-20, second orders are below rounding; a nudge of 1e-6 keeps clear of the boundaries of the branch."""
    found, eps = rate(limit), 1e-20
    problem = make_local_problem(measured(limit))
    inward = problem.base[1 : 1 + problem.dimension]
    if found.part == "free":
        assert found.C == 1.0
        return
    dv = (1 - 1e-5) * found.dv - 1e-6 * inward / np.linalg.norm(inward)
    dq = (1 - 1e-5) * found.dq + 1e-6 * problem.carried_direction - 1e-6 * inward * (problem.carried == 0.0)
    member = make_member(problem, eps * dq, eps * dv)
    assert member.distance[0] / eps == pytest.approx(found.C, rel=1e-3)


@pytest.mark.parametrize("slip", ["-1", "-1/3", "-7"])
def test_the_closed_form_of_the_uniform_rod_is_the_one_written_down(slip):
    """C^2 = max of 2 (m + 3 xi c/4)^2 + 9 xi^2 s^2/16 over the four corners, times slip where xi stands."""
    for theta in ("1", "atan(2)", "5/4"):
        found = rate(rod(theta, slip, "0", "3"))
        c, s = (f(sp.sympify(theta)) for f in (sp.cos, sp.sin))
        speed = sp.Abs(sp.sympify(slip))
        sine = sp.sqrt(1 - 2 * c**2 / (5 * (1 + c**2)))
        corners = [
            sp.sqrt(2 * (m + 3 * xi * speed * c / 4) ** 2 + 9 * (xi * speed * s) ** 2 / 16)
            for xi in (1, -1 / sp.sqrt(1 + c**2))
            for m in (-sp.sqrt(sp.Rational(5, 8)), sp.sqrt(sp.Rational(5, 8)) * sine)
        ]
        expected = max(float(x) for x in corners)
        assert found.part == "sticking"
        assert pytest.approx(expected, rel=1e-11) == found.C
        assert float(found.closed_form) == pytest.approx(expected, rel=1e-14)


def test_at_the_paradox_the_constant_is_a_surd():
    found = rate(named("slender_rod", "paradox"))
    squared = 2 * (sp.sqrt(sp.Rational(5, 8) * sp.Rational(14, 15)) + 3 / (4 * sp.sqrt(5))) ** 2 + sp.Rational(9, 20)
    assert sp.simplify(found.closed_form**2 - squared) == 0


def test_an_angular_velocity_couples_the_two_balls_and_leaves_no_closed_form():
    found = rate(rod("1", "-1", "3/4", "2"))
    assert found.closed_form is None
    assert found.C > 1.0


def test_without_its_constraints_the_sticking_map_would_give_too_large_a_constant():
    """The norm of the derivative over both whole balls, as a matrix problem, against the constrained one."""
    limit = named("slender_rod", "paradox")
    c, s = 1 / np.sqrt(5), 2 / np.sqrt(5)
    n = 0.75 * np.array([-s, c, 1 / 3])  # S = (n . v) (-sin, cos, 1), and its derivative in theta
    free = max(
        np.linalg.norm((m + x * 0.75 * c) * np.array([-s, c, 1]) + x * 0.75 * s * np.array([-c, -s, 0]))
        for m in (-np.linalg.norm(n), np.linalg.norm(n))
        for x in (-1.0, 1.0)
    )
    assert free - 1e-2 > rate(limit).C


def test_the_arm_that_sticks_has_the_rate_of_its_free_members():
    for state in ("paradox", "approached", "isolated"):
        found = rate(named("two_link_arm", state))
        assert (found.C, found.part) == (1.0, "free")


def test_the_rate_at_an_isolated_state_is_that_of_the_ends_and_says_so():
    found = rate(named("worn_tip_rod", "isolated"))
    assert "d_H({u-, u_tilde}, A_eps) = C eps" in found.sentence
    assert pytest.approx(rate(named("worn_tip_rod", "paradox")).C, rel=1e-12) == found.C
    assert found.as_dict()["C"] == found.C
