"""Friction sections as data: membership and the reach against random points, and what makes a polygon one."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

from painleve.mechanics.friction import Disc, Ellipse, Polygon, Segment

HALF, ANGLE = sp.Rational(1, 2), sp.atan(sp.Rational(3, 4))
SECTIONS = {
    "segment": Segment(minus=HALF, plus=2),
    "disc": Disc(mu=sp.Rational(3, 2)),
    "ellipse": Ellipse(mu_1=2, mu_2=HALF, angle=ANGLE),
    "flat ellipse": Ellipse(mu_1=2, mu_2=0, angle=0),
    "point": Disc(mu=0),
    "polygon": Polygon(vertices=((2, -1), (1, 1), (-2, 1), (-1, -1))),
}
rng = np.random.default_rng(3)


def points_inside(section, count):
    """Convex combinations of boundary points."""
    if isinstance(section, Segment):
        ends = np.array([[-float(section.minus)], [float(section.plus)]])
    elif isinstance(section, Polygon):
        ends = np.array(section.vertices, dtype=float)
    else:
        t = rng.uniform(0, 2 * np.pi, size=50)
        ends = (np.array(section.map.evalf(20), dtype=float) @ [np.cos(t), np.sin(t)]).T
    weights = rng.dirichlet(np.full(len(ends), 0.3), size=count)
    return ends, weights @ ends


def is_member(section, s):
    """To rounding."""
    return all(float(x) >= -1e-12 for x in section.membership(sp.Matrix([sp.Float(float(x), 20) for x in s])))


@pytest.mark.parametrize("name", SECTIONS)
def test_combinations_of_boundary_points_are_members_and_points_beyond_the_reach_are_not(name):
    section = SECTIONS[name]
    ends, inside = points_inside(section, 40)
    assert all(is_member(section, s) for s in inside)
    for _ in range(40):
        b = rng.normal(size=section.dimension)
        if isinstance(section, Segment):
            reach = max(float(section.minus) * b[0], -float(section.plus) * b[0])
        else:
            reach = float(section.reach(sp.Matrix(b.tolist())))
        assert np.all(-(ends @ b) <= reach + 1e-12)
        outside = -b / (b @ b) * (reach + 1e-3)  # -b.s is larger there than anywhere in the section
        assert not is_member(section, outside)


@pytest.mark.parametrize("name", SECTIONS)
def test_zero_is_a_member_and_the_section_s_own_conditions_hold(name):
    section = SECTIONS[name]
    assert is_member(section, [0.0] * section.dimension)
    assert all(condition.expression >= 0 for condition in section.conditions)


@pytest.mark.parametrize(
    "vertices",
    [
        ((1, 1), (1, -1), (-1, -1), (-1, 1)),  # clockwise
        ((1, 0), (3, 0), (2, 1)),  # without 0
        ((1, 0), (sp.Rational(1, 10), sp.Rational(1, 10)), (0, 1), (-1, -1)),  # dented
        ((0, 10), (-6, -8), (9, 3), (-9, 3), (6, -8)),  # a star: all turns are to the left, and 0 is inside
    ],
)
def test_a_polygon_that_is_not_convex_counterclockwise_about_0_breaks_a_condition(vertices):
    assert any(condition.expression < 0 for condition in Polygon(vertices=vertices).conditions)


def test_text_is_refused_as_a_coefficient():
    """sympify would run it."""
    with pytest.raises(sp.SympifyError):
        Disc(mu="__import__('os').getcwd()")


def test_the_reaches_of_a_polygon_of_many_vertices_are_compared_as_numbers_and_not_as_formulas(monkeypatch):
    """All with all, 496 pairs of formulas of 32 vertices took sympy nine seconds."""
    corners = tuple((sp.cos(2 * sp.pi * i / 32), sp.sin(2 * sp.pi * i / 32)) for i in range(32))
    b = sp.Matrix(sp.symbols("b_1 b_2", real=True))
    compared = []
    monkeypatch.setattr(sp.Max, "_is_connected", classmethod(lambda cls, x, y: compared.append((x, y))))
    reach = Polygon(vertices=corners).reach(b)
    assert not compared
    assert len(reach.args) == 32
    monkeypatch.undo()
    for s in rng.normal(size=(5, 2)):
        largest = max(-(s[0] * float(x) + s[1] * float(y)) for x, y in corners)
        assert float(reach.xreplace({x: sp.Float(y) for x, y in zip(b, s, strict=True)})) == pytest.approx(
            largest, rel=1e-12
        )
