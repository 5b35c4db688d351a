"""Coulomb's right velocities at a tangential contact: against the projection, nearby impacts and constructed
examples."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from coulomb_contacts import Numbers, random_numbers, scene_with

from painleve.core.codes import ContactMode
from painleve.errors import InputError
from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.friction import Disc, Polygon, Segment
from painleve.mechanics.library import SCENE_NAMES, load_scene
from painleve.mechanics.state import State, make_state
from painleve.sets import LineSegment as Line
from painleve.sets import Points
from painleve.theory.coulomb.limit import CoulombLimitSet, coulomb_limit_set
from painleve.theory.coulomb.one_step import coulomb_solutions
from painleve.theory.limit_set import limit_set

STATES = [(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states]
PLANAR = [(scene, state) for scene, state in STATES if load_scene(scene).contact.section.dimension < 2]


def tangential(G: list[list[object]], friction: Disc | Polygon | Segment, *v_t: object) -> State:
    """The state of `scene_with` with that slip."""
    keys = {f"u_x{1 + i}": speed for i, speed in enumerate(v_t)}
    return make_state(scene_with(G, friction), keys=keys)


def jumps(found: CoulombLimitSet) -> list[tuple[str, tuple[sp.Expr, ...], int | None]]:
    return [(jump.kind, jump.impulse, jump.multiplicity) for jump in found.jumps[1:]]


def same(x: tuple[sp.Expr, ...], y: tuple[sp.Expr, ...]) -> bool:
    return all(exact_sign(p - q).sign is Sign.ZERO for p, q in zip(x, y, strict=True))


@pytest.mark.parametrize(("scene", "state"), PLANAR)
def test_in_the_plane_coulomb_and_the_projection_admit_the_same_velocities_exactly(scene: str, state: str) -> None:
    made = make_state(load_scene(scene), state)
    coulomb, projected = limit_set(made, "coulomb"), limit_set(made)
    isolated = [jump.velocity for jump in coulomb.jumps if jump.end is None]
    assert same(isolated[0], made.u)
    match projected.kind:
        case "point":
            assert len(coulomb.jumps) == 1
        case "pair":
            assert len(coulomb.jumps) == 2
            assert same(isolated[1], projected.u_tilde)
        case "segment":
            (family,) = [jump for jump in coulomb.jumps if jump.end is not None]
            assert same(family.velocity, made.u)
            assert same(family.end, projected.u_tilde)
            (line,) = coulomb.parts
            assert isinstance(line, Line)
            np.testing.assert_allclose(line.end, projected.u_plus, atol=1e-15)


@pytest.mark.parametrize("seed", range(25))
def test_random_planar_contacts_agree_with_the_projection_too(seed: int) -> None:
    rng = np.random.default_rng(seed)
    factor = rng.integers(-3, 4, size=(2, 2)) + 4 * np.eye(2, dtype=int)
    G = [[sp.Integer(int(x)) for x in row] for row in factor.T @ factor + np.eye(2, dtype=int)]
    critical = abs(G[0][0] / G[0][1]) if G[0][1] != 0 else sp.Integer(1)
    mu = critical * [sp.Rational(1, 2), 1, 2][seed % 3]
    state = tangential(G, Segment(minus=mu, plus=mu), int(rng.choice([-2, 1, 3])))
    coulomb, projected = limit_set(state, "coulomb"), limit_set(state)
    assert {"point": "finite", "pair": "finite", "segment": "family"}[projected.kind] == coulomb.kind
    reached = {jump.end or jump.velocity for jump in coulomb.jumps}
    assert reached == {state.u, tuple(map(sp.nsimplify, projected.u_tilde))}


def test_generic_paradoxes_have_an_odd_number_of_jumps_exactly_where_friction_would_drive_the_slip() -> None:
    """c = a - b.v_t/|v_t| < 0: an odd number; c > 0: an even one."""
    seen = set()
    for contact in random_numbers(11, 20_000, spread=0.8):
        tangent = Numbers(contact.G, contact.v * [0, 1, 1])
        if tangent.p >= 0.0:
            continue
        branches = tangent.solve()[:, 0].tolist()
        compliance = tangent.G[0, 0] - tangent.G[0, 1:] @ tangent.v[1:] / np.hypot(*tangent.v[1:])
        assert len(branches[1:]) % 2 == (compliance < 0.0)
        seen.add((branches.count(ContactMode.STICK), branches.count(ContactMode.SLIP)))
    assert seen >= {(0, 0), (1, 0), (0, 1), (1, 1)}


@pytest.mark.parametrize(
    ("G", "v_t", "expected"),
    [
        ([[1, -1, 0], [-1, 2, -2], [0, -2, 5]], (-1, 2), ["slip"]),
        ([[1, -2, 0], [-2, 5, -2], [0, -2, 5]], (-1, 2), ["slip", "stick"]),
        ([[7, -8, 0], [-8, 11, -3], [0, -3, 5]], (-1, 1), ["slip", "slip"]),
        ([[10, -18, 0], [-18, 36, 0], [0, 0, 16]], (-1, 1), ["stick"]),
    ],
)
def test_isolated_jumps_are_limits_of_the_solutions_of_slight_impacts_and_of_slight_departures(
    G: list[list[int]], v_t: tuple[int, int], expected: list[str]
) -> None:
    """The first has gamma = 0: there its jump, a double root, is the limit from one side, and of none from the
    other."""
    state = tangential(G, Disc(mu=1), *v_t)
    found = coulomb_limit_set(state)
    limits = [np.array(jump.impulse, dtype=float) for jump in found.jumps[1:]]
    for v_n in (Fraction(-1, 10**20), Fraction(1, 10**20)):
        near = [s.impulse for s in coulomb_solutions(state.scene, state.q, [v_n, *v_t]).solutions]
        far = [r for r in near if np.abs(r).max() > 1e-3]
        if found.gamma.sign is Sign.NEGATIVE:
            assert sorted(kind for kind, *_ in jumps(found)) == expected
            assert len(far) == len(limits)
            assert all(min(np.abs(r - limit).max() for r in far) < 1e-13 for limit in limits)
        for r in far:
            assert min(np.abs(r - limit).max() for limit in limits) < 1e-6


def test_at_gamma_zero_a_slip_that_friction_turns_jumps_to_one_velocity() -> None:
    """a = 9, b = (-9, 0), C = [[10, 1], [1, 4]], v_t = (-3, -1): d = (1, 0), b + C d = (1, 1), lambda = 1, u_t = (-2,
    0)."""
    G = [[9, -9, 0], [-9, 10, 1], [0, 1, 4]]
    found = coulomb_limit_set(tangential(G, Disc(mu=1), -3, -1))
    assert found.gamma.sign is Sign.ZERO
    assert found.kind == "finite"
    assert jumps(found) == [("slip", (1, 1, 0), 2)]
    assert found.jumps[1].velocity == (0, -2, 0)
    assert found.reason == "gamma is zero: stay at u-, or jump to slip"
    (points,) = found.parts
    assert isinstance(points, Points)
    np.testing.assert_array_equal(points.members, [[0, -3, -1], [0, -2, 0]])
    # parallel to b, but turned by friction: no jump at all
    assert jumps(coulomb_limit_set(tangential(G, Disc(mu=1), -3, 0))) == []


def test_at_gamma_zero_a_slip_along_b_that_friction_does_not_turn_has_the_segment_of_the_plane() -> None:
    G = [[9, -9, 0], [-9, 10, 0], [0, 0, 4]]
    found = coulomb_limit_set(tangential(G, Disc(mu=1), -3, 0))
    assert found.kind == "family"
    (line,) = found.parts
    np.testing.assert_array_equal([line.start, line.end], [[0, -3, 0], [0, 0, 0]])
    assert found.reason == "gamma is zero: stay at u-, or take any velocity of a family up to sticking"
    # oblique: the projection jumps to another slip, and Coulomb's law does not
    oblique = tangential(G, Disc(mu=1), -3, 1)
    assert jumps(limit_set(oblique, "coulomb")) == []
    assert limit_set(oblique).kind == "segment"


@pytest.mark.parametrize("state", ["sliding", "oblique", "critical_oblique", "double_zero"])
def test_the_oblique_rod_in_space_jumps_by_the_projection_and_not_by_coulomb(state: str) -> None:
    made = make_state(load_scene("spatial_rod"), state)
    assert jumps(limit_set(made, "coulomb")) == []
    assert (limit_set(made).kind == "point") == (state == "sliding")


def test_a_vertex_that_meets_the_critical_line_gives_a_family_between_two_slips_or_to_sticking() -> None:
    """gamma = 0 at the vertex (1, 0) of a square: u_t in its normal cone for an interval of impulses."""
    square = Polygon(vertices=((1, 0), (0, 1), (-1, 0), (0, -1)))
    G = [[9, -9, 0], [-9, 10, 0], [0, 0, 4]]
    found = coulomb_limit_set(tangential(G, square, -3, 1))
    (family,) = [jump for jump in found.jumps if jump.end is not None]
    # u_t = (lambda - 3, 1) with u_t.(-1, +-1) >= 0: 0 <= lambda <= 2
    assert (family.impulse, family.end_impulse) == ((0, 0, 0), (2, 2, 0))
    assert family.end == (0, -1, 1)


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_every_state_of_the_library_is_decided(scene: str, state: str) -> None:
    assert coulomb_limit_set(make_state(load_scene(scene), state)).kind != "undecided"


def test_an_unknown_law_is_named() -> None:
    state = make_state(load_scene("slender_rod"), "paradox")
    with pytest.raises(InputError, match="no law 'newton'; choose projection or coulomb"):
        limit_set(state, "newton")
