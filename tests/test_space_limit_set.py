"""A(q, u-) with friction in space: exact ends against brute force, and what must not change them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import sympy as sp

from painleve.errors import InputError
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Disc, Ellipse, Polygon
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Coordinate, make_scene
from painleve.mechanics.state import make_state
from painleve.theory.classification import classify
from painleve.theory.limit_set import limit_set

HALF = sp.Rational(1, 2)
UNIT_SQUARE = Polygon(vertices=((1, -1), (1, 1), (-1, 1), (-1, -1)))
SECTIONS = {
    "disc": Disc(mu=sp.Rational(3, 2)),
    "ellipse": Ellipse(mu_1=2, mu_2=sp.Rational(3, 4), angle=sp.atan(sp.Rational(3, 4))),
    "square": Polygon(vertices=((3, -3), (3, 3), (-3, 3), (-3, -3))),
    "triangle": Polygon(vertices=((2, 0), (-1, 2), (-1, -2))),
}
DIRECTIONS = 400_000
ACCURACY = 10 * 2 * np.pi / DIRECTIONS  # relative to the slip


def block(inverse, section):
    """A point above the floor z = 0 whose inverse inertia is the given 3 x 3 matrix: G in the order (x, y, z)."""
    x, y, z = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in "xyz")
    return make_scene(
        name="block",
        sentence="a point with any inertia",
        source="a test",
        coordinates=(x, y, z),
        parameters=(),
        inertia=sp.Matrix(inverse).inv(),
        constraint=-z.symbol,
        tangential_displacements=(x.symbol, y.symbol),
        friction=section,
    )


@cache
def cases():
    """Inverse inertias and slips in small integers, among which gamma is often negative."""
    random = np.random.default_rng(7)
    found = []
    while len(found) < 24:
        L = random.integers(-3, 4, size=(3, 3))
        inverse = L @ L.T + np.eye(3, dtype=int)
        slip = random.integers(-3, 4, size=2)
        if slip.any():
            found.append((inverse.tolist(), slip.tolist()))
    return found


def least_energy(inverse, section, slip):
    """The velocity of least kinetic energy over u- + M^-1 R that stays tangential: the best impulse in each of many
    directions, then the best direction."""
    G, v = np.array(inverse, dtype=float), np.array(slip, dtype=float)
    angle = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    d = np.array([np.cos(angle), np.sin(angle)])
    r_n = -G[2, :2] @ d / G[2, 2]  # beside a unit r_t
    Q = G[:2, :2] - np.outer(G[:2, 2], G[2, :2]) / G[2, 2]
    size = np.where(admitted(section, d, r_n), np.maximum(0.0, -(v @ d) / np.sum(d * (Q @ d), axis=0)), 0.0)
    best = np.argmin(size * (v @ d) + size**2 * np.sum(d * (Q @ d), axis=0) / 2)
    return np.append(v, 0.0) + G @ (size[best] * np.append(d[:, best], r_n[best]))


def admitted(section, r_t, r_n):
    """Whether the impulses are in the friction cone; on its boundary, up to rounding."""
    if isinstance(section, Polygon):
        corners = np.array(section.vertices, dtype=float)
        sides = [
            (q - p)[0] * (r_t[1] - p[1] * r_n) - (q - p)[1] * (r_t[0] - p[0] * r_n)
            for p, q in zip(corners, np.roll(corners, -1, axis=0), strict=True)
        ]
        return (r_n >= 0) & (np.min(sides, axis=0) >= -1e-12)
    E = np.array(section.map.evalf(20), dtype=float)
    return np.linalg.norm(np.linalg.solve(E, r_t), axis=0) <= r_n + 1e-12


@pytest.mark.parametrize("name", SECTIONS)
def test_the_jump_ends_where_a_search_of_all_directions_finds_the_least_kinetic_energy(name):
    kinds = set()
    for inverse, slip in cases():
        state = make_state(block(inverse, SECTIONS[name]), keys={"u_x": slip[0], "u_y": slip[1]})
        limit = limit_set(state)
        kinds.add((limit.kind, limit.reason))
        expected = least_energy(inverse, SECTIONS[name], slip)
        assert np.allclose(limit.u_plus, expected, atol=ACCURACY * np.linalg.norm(slip)), (inverse, slip)
    assert {kind for kind, _ in kinds} == {"point", "pair"}
    assert any("sticks" in reason for _, reason in kinds)
    assert any("slips on" in reason for _, reason in kinds)


@pytest.mark.parametrize("name", SECTIONS)
def test_gamma_is_the_least_compliance_over_a_fine_grid_of_the_boundary(name):
    """From below by no more than the grid leaves open, and never above."""
    section = SECTIONS[name]
    if isinstance(section, Polygon):
        points = np.array(section.vertices, dtype=float)  # the least of a linear function is at a vertex
    else:
        t = np.linspace(0, 2 * np.pi, 20001)
        points = (np.array(section.map.evalf(20), dtype=float) @ [np.cos(t), np.sin(t)]).T
    for inverse, _ in cases():
        d = derive(block(inverse, section))
        G = np.array(inverse, dtype=float)
        least = (G[2, 2] + points @ G[2, :2]).min()
        assert -1e-12 < least - float(d.gamma) < 1e-6


def rotated(section, angle):
    """The section as seen from tangents turned by minus that angle, and the rotation."""
    c, s = sp.cos(angle), sp.sin(angle)
    if isinstance(section, Disc):
        return section
    if isinstance(section, Ellipse):
        return Ellipse(mu_1=section.mu_1, mu_2=section.mu_2, angle=section.angle + angle)
    return Polygon(vertices=tuple((c * x - s * y, s * x + c * y) for x, y in section.vertices))


@pytest.mark.parametrize("name", SECTIONS)
def test_turning_the_tangent_frame_turns_the_limit_set_and_nothing_else(name):
    angle = sp.atan(sp.Rational(5, 12))  # rational sine and cosine
    turn = sp.Matrix([[sp.cos(angle), -sp.sin(angle), 0], [sp.sin(angle), sp.cos(angle), 0], [0, 0, 1]])
    for inverse, slip in cases()[:8]:
        v = turn * sp.Matrix([*slip, 0])
        here = limit_set(make_state(block(inverse, SECTIONS[name]), keys={"u_x": slip[0], "u_y": slip[1]}))
        other = block(turn * sp.Matrix(inverse) * turn.T, rotated(SECTIONS[name], angle))
        there = limit_set(make_state(other, keys={"u_x": v[0], "u_y": v[1]}))
        assert (there.kind, there.gamma.sign) == (here.kind, here.gamma.sign)
        assert np.allclose(np.array(turn, dtype=float) @ here.u_plus, there.u_plus, atol=1e-13)


def test_polygons_about_the_disc_have_limits_that_close_in_on_its_own():
    found = [
        (m, s, limit_set(make_state(block(m, SECTIONS["disc"]), keys={"u_x": s[0], "u_y": s[1]}))) for m, s in cases()
    ]
    inverse, slip, limit = next(f for f in found if f[2].reason.endswith("slips on in another direction"))
    disc = limit.u_plus
    errors = []
    for n in (8, 32, 128):
        corners = tuple(
            (sp.Rational(round(1.5e9 * np.cos(t)), 10**9), sp.Rational(round(1.5e9 * np.sin(t)), 10**9))
            for t in 2 * np.pi * (np.arange(n) + 0.3) / n
        )
        state = make_state(block(inverse, Polygon(vertices=corners)), keys={"u_x": slip[0], "u_y": slip[1]})
        errors.append(np.linalg.norm(limit_set(state).u_plus - disc))
    assert errors[1] < errors[0] / 8
    assert errors[2] < errors[1] / 8  # like 1/n^2


@pytest.mark.parametrize(("spatial", "planar"), [("paradox", "paradox"), ("critical", "critical")])
def test_a_slip_along_the_rod_has_the_limit_set_of_the_rod_in_the_plane(spatial, planar):
    space = classify(make_state(load_scene("spatial_rod"), spatial))
    plane = classify(make_state(load_scene("slender_rod"), planar))
    assert space.branch is plane.branch
    x, y, z, theta, phi = space.limit.u_plus
    assert np.allclose([x, z, theta], plane.limit.u_plus, atol=1e-15)
    assert (y, phi) == (0.0, 0.0)


def test_the_azimuth_turns_the_jump_and_nothing_else():
    rod = load_scene("spatial_rod")
    here = limit_set(make_state(rod, "oblique"))
    there = limit_set(make_state(rod, "oblique", keys={"phi": "atan(3/4)"}))
    c, s = 0.8, 0.6
    assert there.kind == here.kind == "pair"
    assert np.allclose(
        there.jump,
        [c * here.jump[0] - s * here.jump[1], s * here.jump[0] + c * here.jump[1], *here.jump[2:]],
        atol=1e-14,
    )


def test_at_gamma_zero_a_polygon_with_an_edge_across_b_claims_nothing():
    """The square's edge s_1 = -1 is where a + b.s = 0: a whole edge of impulses keeps the tip on the floor."""
    inverse = [[4, 0, 2], [0, 1, 0], [2, 0, 2]]
    limit = limit_set(make_state(block(inverse, UNIT_SQUARE), keys={"u_x": 1, "u_y": 1}))
    assert limit.kind == "undecided"
    assert "the ray of impulses is not unique" in limit.reason


def test_at_gamma_zero_a_polygon_s_vertex_gives_one_ray():
    inverse = [[4, 0, 1], [0, 4, 1], [1, 1, 2]]
    limit = limit_set(make_state(block(inverse, UNIT_SQUARE), keys={"u_x": 1, "u_y": 2}))
    assert limit.kind == "segment"
    assert np.allclose(limit.u_plus, least_energy(inverse, UNIT_SQUARE, [1, 2]), atol=ACCURACY)


def test_gamma_is_exactly_zero_where_a_pythagorean_triple_makes_it_so():
    """a = 5, b = (3, 4), mu = 1."""
    inverse = [[9, 1, 3], [1, 9, 4], [3, 4, 5]]
    limit = limit_set(make_state(block(inverse, Disc(mu=1)), keys={"u_x": 1, "u_y": 1}))
    assert (limit.kind, limit.gamma_value) == ("segment", 0.0)
    s = sp.Matrix([-sp.Rational(3, 5), -sp.Rational(4, 5)])
    reduced = sp.Matrix([[9, 1], [1, 9]]) - sp.Matrix([3, 4]) * sp.Matrix([[3, 4]]) / 5
    assert limit.multiplier == sp.Rational(7, 5) / (s.T * reduced * s)[0, 0]


def test_without_slip_nothing_is_indeterminate():
    limit = limit_set(make_state(block([[9, 1, 6], [1, 9, 4], [6, 4, 9]], Disc(mu=2)), keys={}))
    assert limit.kind == "point"


@pytest.mark.parametrize(
    ("section", "message"),
    [
        (Disc(mu=-1), "the coefficient of friction is -1 there"),
        (Ellipse(mu_1=1, mu_2=-HALF, angle=0), "the coefficient of friction is -0.5 there"),
        (Polygon(vertices=((1, 1), (1, -1), (-1, -1), (-1, 1))), "of the friction polygon on which"),  # clockwise
        (Polygon(vertices=((1, 0), (3, 0), (2, 1))), "of the friction polygon on which 0 lies"),
        (Polygon(vertices=((0, 10), (-6, -8), (9, 3), (-9, 3), (6, -8))), "of the friction polygon on which"),  # star
    ],
)
def test_a_section_that_is_none_is_refused_at_the_state(section, message):
    with pytest.raises(InputError, match=message):
        make_state(block([[2, 0, 0], [0, 2, 0], [0, 0, 2]], section), keys={"u_x": 1})
