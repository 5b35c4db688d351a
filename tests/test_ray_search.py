"""The search along rays from many starts: against the search on charts of two coordinates, and on a flat floor."""

from __future__ import annotations

from functools import partial

import pytest

from painleve.asymptotics import ray_search
from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.methods import distance
from painleve.asymptotics.ray_search import RaySearch
from painleve.asymptotics.sample import KINDS
from painleve.asymptotics.search import PlaneSearch
from painleve.core.codes import ContactMode
from painleve.core.excess import REACH
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import limit_set

EPS = 1e-3


def limit_of(scene, state=None, **given):
    return limit_set(make_state(load_scene(scene), state, **given))


def searches(limit, eps=EPS):
    """By rays and by charts, over the same two coordinates."""
    problem = make_local_problem(limit)
    differences = partial(problem.differences, eps, problem.expansion(eps))
    return [kind(problem, eps, KINDS[limit.kind], differences) for kind in (RaySearch, PlaneSearch)]


@pytest.mark.parametrize(
    ("scene", "state"),
    [("two_link_arm", "paradox"), ("two_link_arm", "approached"), ("minimal", "crossing"), ("minimal", "approached")],
)
def test_rays_find_what_charts_find_where_both_can_search(scene, state):
    rays, plane = searches(limit_of(scene, state))
    for branch in rays.branches:
        mine, theirs = (search.best((branch,), search.kind) for search in (rays, plane))
        assert (mine is None) == (theirs is None)
        if mine is not None:
            assert mine.value == pytest.approx(theirs.value, rel=1e-6)
    reaches = [search.best((ContactMode.STICK,), REACH) for search in (rays, plane)]
    if reaches[1] is not None:
        assert reaches[0].value == pytest.approx(reaches[1].value, rel=1e-6, abs=1e-6)


def test_a_stencil_turned_at_random_comes_to_the_same_top(monkeypatch):
    monkeypatch.setattr(ray_search, "LARGEST_LATTICE", 1)
    rays, plane = searches(limit_of("two_link_arm", "paradox"))
    found, expected = (search.best(search.branches, search.kind) for search in (rays, plane))
    assert found.value == pytest.approx(expected.value, rel=1e-6)


@pytest.mark.parametrize(("theta", "mu"), [("atan(2)", "1/2"), ("pi/4", "5/3")])
def test_on_an_obstacle_of_a_thousand_kilometres_a_rod_is_a_rod_on_a_floor(theta, mu):
    """Three coordinates of the law instead of one; curvature changes the distance by about 1e-6 of it."""
    keys = {"theta": theta}
    round_ = distance(limit_of("rod_on_obstacle", keys=keys, parameters={"mu": mu, "R": 10**6}), EPS, "optimise")
    flat = distance(limit_of("slender_rod", keys=keys, parameters={"mu": mu}), EPS, "optimise")
    assert round_.settings["estimate"] == pytest.approx(flat.settings["estimate"], rel=2e-6)
    assert round_.excess_Aeps_A.bounds.lower == pytest.approx(flat.excess_Aeps_A.bounds.lower, rel=2e-6)
    assert "if the search missed no higher maximum" in round_.ending
    assert "if the search" not in flat.ending
