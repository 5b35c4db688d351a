"""Where the law is defined: what is proved of a ball, against closed forms, plain eigenvalues and every method."""

from __future__ import annotations

import re

import numpy as np
import pytest
import sympy as sp

from painleve.asymptotics.methods import METHODS, distance
from painleve.asymptotics.sample import SampleOptions, sample_members
from painleve.asymptotics.witness import find_family, find_witness
from painleve.errors import InputError
from painleve.mechanics.friction import Segment
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Coordinate, StateKey, make_scene
from painleve.mechanics.state import make_state
from painleve.theory.domain import check_domain
from painleve.theory.limit_set import limit_set

X, Y = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in ("x", "y"))
x, y = X.symbol, Y.symbol


def flat(M=None, mu=1, constraint=-y):
    """A floor y = 0, M (default: a coupled constant one), a coefficient of friction mu(x, y)."""
    return make_scene(
        name="flat",
        sentence="two coordinates over a floor",
        source="a test",
        coordinates=(X, Y),
        parameters=(),
        inertia=sp.Matrix([[2, 1], [1, 2]]) if M is None else sp.Matrix(M),
        constraint=constraint,
        tangential_displacements=(x,),
        friction=Segment(minus=mu, plus=mu),
        keys=(StateKey(name="x", unit="m", sentence="x", default="0"), StateKey(name="slip", unit="m/s", sentence="v")),
        placement={"x": x},
        velocity={"x": sp.Symbol("slip", real=True)},
    )


def at(scene, state=None, **keys):
    return make_state(scene, state, keys=keys if keys or state else {"slip": 1})


def refusal(state, eps):
    with pytest.raises(InputError) as caught:
        check_domain(state, eps)
    return str(caught.value)


# det M = 1/(4 - beta^2) > 0 where beta < 2. Over y <= 0 and |(x, y)| <= r the largest values of beta are 1 + r^2 twice,
# 1 + r + r^2 (of 1 + x + x^2 - y^2), and 9/8 + r^2 (of 1 - y + x^2 - y^2, at y = -1/4)
RADII = {"isolated": 1.0, "sliding": 1.0, "crossing": (5**0.5 - 1) / 2, "isolated_by_slope": (7 / 8) ** 0.5}


@pytest.mark.parametrize(("name", "radius"), RADII.items())
def test_M_of_the_minimal_scene_is_definite_up_to_the_radius_at_which_its_coupling_reaches_two(name, radius):
    state = at(load_scene("minimal"), name)
    check_domain(state, 0.9 * radius)
    check_domain(state, 1e-30)
    assert "M is not" in refusal(state, 1.05 * radius)


@pytest.mark.parametrize(
    ("scene", "state", "eps"),
    [
        ("minimal", "isolated", 3.0),
        ("minimal", "paradox", 1.5),
        ("minimal", "approached", 0.9),
        ("two_link_arm", "paradox", 0.3),
        ("two_link_arm", "paradox", 0.5),
        ("spatial_rod", "paradox", 0.4),
        ("spatial_rod_ellipse", "critical", 0.9),
        ("rod_on_obstacle", "double_zero", 0.5),
        ("rod_on_obstacle", "double_zero", 2.1),
        ("ellipse", "paradox", 1.0),
    ],
)
def test_what_is_proved_holds_at_random_configurations_and_what_is_refuted_fails_at_the_one_named(scene, state, eps):
    state = at(load_scene(scene), state)
    symbols, values = state.scene.q, {p.symbol: state.parameters[p.name] for p in state.scene.parameters}
    constraint = state.scene.contact.constraint.xreplace(values)
    parts = [state.scene.inertia.xreplace(values), sp.Matrix([constraint.diff(s) for s in symbols])]
    law = sp.lambdify(symbols, [constraint, *parts], "numpy")

    def margins(q):
        """g, and the least eigenvalue of M and the size of grad g, the smaller one."""
        g, M, gradient = law(*q)
        return g, min(np.linalg.eigvalsh(np.array(M, dtype=float))[0], np.linalg.norm(gradient))

    centre = np.array([state.number(s) for s in state.q])
    try:
        check_domain(state, eps)
    except InputError as refused:
        named = dict(re.findall(r"(\w+) = (-?[\d.e-]+)", str(refused).split(" at ")[1]))
        point = np.array([float(named[s.name]) for s in symbols])
        assert np.linalg.norm(point - centre) <= eps * (1.0 + 1e-9)
        g, margin = margins(point)
        assert g >= -1e-9
        assert margin <= 1e-9
        return
    offsets = np.random.default_rng(3).normal(size=(2000, len(symbols)))
    offsets *= eps / np.linalg.norm(offsets, axis=1)[:, None]
    assert all(margin > 0.0 for g, margin in (margins(centre + x) for x in offsets) if g >= 0.0)


def test_every_method_refuses_a_ball_with_configurations_at_which_S_does_not_exist():
    limit = limit_set(at(load_scene("minimal"), "isolated"))
    for name in METHODS:
        with pytest.raises(InputError, match=r"M is not positive definite at x = -1\.5, y = 0"):
            distance(limit, 3.0, name)
    for members in (
        lambda: sample_members(limit, 3.0, SampleOptions(samples=10)),
        lambda: find_family(limit, 3.0, within=1.0),
        lambda: find_witness(limit, 1.0, 3.0, within=1.0),
    ):
        with pytest.raises(InputError, match="S is not defined there"):
            members()


def test_M_need_not_be_definite_where_there_is_no_contact():
    """M = diag(2 - y, 2) is indefinite above y = 2 only, over the floor."""
    check_domain(at(flat(M=[[2 - y, 0], [0, 2]])), 3.0)
    assert "M is not positive definite" in refusal(at(flat(M=[[2 + y, 0], [0, 2]])), 3.0)


def test_negative_friction_on_the_ball_is_refused_and_friction_that_touches_zero_as_a_square_is_not():
    assert "the coefficient of friction is negative at x = " in refusal(at(flat(mu=1 + x)), 1.5)
    check_domain(at(flat(mu=1 + x)), 0.99)
    check_domain(at(flat(mu=(x - 1) ** 2)), 1.5)


def test_formulas_that_end_within_the_ball_are_refused_where_they_do():
    for M in (4 + sp.sqrt(x), 4 + sp.log(1 + x), 4 + sp.asin(x), 4 + 1 / (x + sp.Rational(1, 2))):
        state = at(flat(M=[[M, 0], [0, 2]]))
        assert re.search("M is not (defined|positive definite) at x = ", refusal(state, 1.25))
    check_domain(at(flat(M=[[4 + sp.sqrt(x), 0], [0, 2]]), x=1, slip=1), 0.99)
    assert "g is not defined at x = " in refusal(at(flat(constraint=sp.log(1 + x) - x - y)), 1.5)
    assert "the coefficient of friction is not defined" in refusal(at(flat(mu=2 + sp.sqrt(x + 1))), 1.5)


def test_what_the_boxes_do_not_decide_is_refused_as_undecided():
    """1 - cos(x) >= 0 everywhere, and no box around 0 shows it."""
    text = refusal(at(flat(mu=1 - sp.cos(x))), 0.5)
    assert "whether the coefficient of friction is nowhere negative is undecided near x = 0" in text


def test_the_state_of_a_spinning_coordinate_of_a_billion_kilograms_is_no_obstacle():
    check_domain(at(flat(M=[[10**9 + x**2, x], [x, sp.Rational(1, 10**9) + x**2]])), 1e-3)
