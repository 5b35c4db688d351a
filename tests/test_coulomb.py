"""Coulomb's law with maximal dissipation: all solutions, against other eliminations, scans and constructed examples."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import mpmath
import numpy as np
import pytest
import sympy as sp
from coulomb_contacts import (
    Numbers,
    delassus,
    random_numbers,
    scene_with,
    slips_by_scanning,
    slips_by_the_quartic_in_kappa,
)

import painleve
from painleve.core.codes import ContactMode
from painleve.core.sections.segment import SegmentContact, segment_impulse
from painleve.core.space.conic_law import disc_impulse
from painleve.core.space.coulomb import COLUMNS, MOST_SOLUTIONS, coulomb_disc
from painleve.core.space.tangent_plane import Delassus
from painleve.errors import InputError
from painleve.exact.signs import Sign
from painleve.mechanics.friction import Disc, Ellipse, Polygon, Segment
from painleve.theory.coulomb.one_step import CoulombSolutions, Enumeration, coulomb_solutions

STEEP = [[10, -9, 0], [-9, 9, 0], [0, 0, 4]]  # gamma > 0 for mu = 1: a - |b| = 1
AT_REST = (0, 0, 0)


def kinds(found: CoulombSolutions) -> list[str]:
    return sorted(solution.kind for solution in found.solutions)


def impulses(found: CoulombSolutions) -> np.ndarray:
    """(n, 1 + k), sorted."""
    table = np.array([solution.impulse for solution in found.solutions])
    return table[np.lexsort(table.T.round(9))]


def project(contact: Numbers) -> np.ndarray:
    """(3,) the impulse of law (7)."""
    return np.array(disc_impulse(delassus(contact.G), contact.p, tuple(contact.v))[:3])


def on_the_circle(angle: float) -> tuple[Fraction, Fraction]:
    """A rational point of the unit circle near that angle."""
    t = Fraction(np.tan(angle / 2.0)).limit_denominator(10**6)
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


# --- the compiled solver ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("contact", random_numbers(1, 150, spread=0.7))
def test_compiled_slips_are_those_of_the_quartic_in_kappa_with_sixty_digits(contact: Numbers) -> None:
    expected = slips_by_the_quartic_in_kappa(contact)
    assert len(contact.slips()) == len(expected)
    np.testing.assert_allclose(contact.slips(), expected, rtol=1e-7)


def test_compiled_slips_are_as_many_as_a_scan_over_directions_sees() -> None:
    contacts = random_numbers(2, 1500, spread=0.5)
    counts = [len(contact.slips()) for contact in contacts]
    assert counts == [slips_by_scanning(contact) for contact in contacts]
    assert set(counts) == {0, 1, 2, 3}


def test_every_compiled_solution_satisfies_the_complementarity_conditions() -> None:
    for contact in random_numbers(3, 3000):
        for branch, *numbers in contact.solve():
            r, u = np.array(numbers[:3]), np.array(numbers[3:])
            scale = np.abs(contact.G).max() * max(1.0, np.abs(r).max()) + np.abs(contact.v).max()
            np.testing.assert_allclose(u, contact.v + contact.G @ r, rtol=0.0, atol=1e-9 * scale)
            assert u[0] == (contact.v[0] if branch == ContactMode.FREE else 0.0)
            if branch == ContactMode.STICK:
                assert r[0] >= np.hypot(r[1], r[2])
            if branch == ContactMode.SLIP:
                assert np.hypot(r[1], r[2]) == pytest.approx(r[0], rel=1e-12)
                assert r[1:] @ u[1:] == pytest.approx(-r[0] * np.hypot(u[1], u[2]), rel=1e-12)


def test_generic_contacts_have_one_solution_or_three() -> None:
    """Two solutions appear or vanish together, and far away (a large v_n > 0, no friction) there is one."""
    counts = [len(contact.solve()) for contact in random_numbers(4, 5000)]
    assert set(counts) == {1, 3}


@pytest.mark.parametrize("spread", [0.3, 1.0, 2.0])
def test_slips_are_the_zeros_of_a_function_that_is_convex_and_then_concave_and_stick_is_its_sign_at_zero(spread):
    """What proves that there are at most three solutions (docs/theory.md, section 2.6): F(k) = 0 at k = kappa/lambda,
    F'' does not increase on k > 0, and F(0) <= 0 where sticking is in the cone."""
    for contact in random_numbers(9, 60, spread=spread):
        a, b, C = contact.G[0, 0], contact.G[0, 1:], contact.G[1:, 1:]
        nu = -contact.v[0]
        q, axes = np.linalg.eigh(C - np.outer(b, b) / a)
        x, along = axes.T @ -(contact.v[1:] + b * nu / a), axes.T @ b

        def F(k, a=a, nu=nu, q=q, x=x, along=along):
            root = mpmath.sqrt(x[0] ** 2 * (q[1] + k) ** 2 + x[1] ** 2 * (q[0] + k) ** 2)
            rest = along[0] * x[0] * (q[1] + k) + along[1] * x[1] * (q[0] + k)
            return a * root - nu * (q[0] + k) * (q[1] + k) + rest

        size = float(q[1] + np.linalg.norm(x) * (a + np.linalg.norm(b)) / abs(nu))
        grid = [mpmath.mpf(size) * mpmath.mpf(10) ** (mpmath.mpf(i) / 20 - 8) for i in range(260)]
        with mpmath.workdps(30):
            values = [F(mpmath.mpf(0)), *map(F, grid)]
            bends = [mpmath.diff(F, k, 2) for k in grid[::20]]
        tiny = 1e-12 * (abs(a * np.linalg.norm(x)) + abs(nu) * size)
        assert all(later <= earlier + tiny for earlier, later in pairwise(bends))
        branches = contact.solve()[:, 0]
        changes = sum((low > 0) != (high > 0) for low, high in pairwise(values))
        assert changes == np.sum(branches == ContactMode.SLIP)
        assert (values[0] <= 0) == (ContactMode.STICK in branches)
        assert len(branches) <= 3


@pytest.mark.parametrize("gap", [1e-3, 1e-8, 1e-13])
def test_a_tiny_normal_compliance_is_not_lost(gap: float) -> None:
    """b along the slip and C diagonal: the planar slip with lambda = 1/(a - |b|), which cancellation would spoil."""
    found = np.empty((MOST_SOLUTIONS, COLUMNS))
    count = coulomb_disc(Delassus(1.0 + gap, -1.0, 0.0, 1.0, 0.0, 1.0), gap, (-1.0, -1e20, 0.0), found)
    (slip,) = [row for row in found[:count] if row[0] == ContactMode.SLIP]
    assert slip[1] == pytest.approx(1.0 / gap, rel=1e-12)


# --- exact enumeration -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("contact", random_numbers(5, 40, spread=0.5))
def test_the_exact_enumeration_finds_what_the_compiled_solver_finds(contact: Numbers) -> None:
    G = [[sp.Rational(x) for x in row] for row in contact.G.tolist()]
    v = [Fraction(x) for x in contact.v.tolist()]
    found = coulomb_solutions(scene_with(G, Disc(mu=1)), AT_REST, v)
    compiled = contact.solve()[:, 1:4]
    assert found.enumeration is Enumeration.COMPLETE
    np.testing.assert_allclose(impulses(found), compiled[np.lexsort(compiled.T.round(9))], rtol=1e-7, atol=1e-9)
    scale = np.abs(contact.v).max() + np.abs(contact.G).max() * np.abs(compiled).max()
    assert all(solution.residual <= 1e-13 * scale for solution in found.solutions)


def test_three_solutions_at_positive_gamma() -> None:
    """a = 10, b = (-9, 0), C = 9 Id, v = (-1, 1/2, 2): it sticks at (1/2, 4/9, -2/9), or slips in two directions."""
    found = coulomb_solutions(scene_with([[10, -9, 0], [-9, 9, 0], [0, 0, 9]], Disc(mu=1)), AT_REST, [-1, "1/2", 2])
    assert found.gamma.sign is Sign.POSITIVE
    assert kinds(found) == ["slip", "slip", "stick"]
    assert found.sentence == "3 solutions: stick, slip, slip"
    np.testing.assert_allclose(found.solutions[0].impulse, [1 / 2, 4 / 9, -2 / 9], rtol=1e-15)


def double_slip(t: Fraction) -> tuple[list[Fraction], tuple[Fraction, Fraction]]:
    """The v_t for which d(t) is a double root at STEEP, v_n = -1 (two linear equations in v_t), and d."""
    s, x, y = sp.symbols("s x y")
    d = sp.Matrix([(1 - s**2) / (1 + s**2), 2 * s / (1 + s**2)])
    b, C = sp.Matrix([-9, 0]), sp.diag(9, 4)
    w = sp.Matrix([x, y]) * (10 + (b.T * d)[0]) + b + C * d
    turning = d[0] * w[1] - d[1] * w[0]
    root = sp.Rational(t)
    solution = sp.solve([turning.subs(s, root), sp.diff(turning, s).subs(s, root)], [x, y])
    return [Fraction(str(solution[x])), Fraction(str(solution[y]))], tuple(Fraction(str(z.subs(s, root))) for z in d)


def test_two_slips_merge_in_one_of_multiplicity_two() -> None:
    v_t, d = double_slip(Fraction(1, 2))
    scene = scene_with(STEEP, Disc(mu=1))
    at = coulomb_solutions(scene, AT_REST, [-1, *v_t])
    (slip,) = [solution for solution in at.solutions if solution.kind == "slip"]
    assert at.enumeration is Enumeration.COMPLETE
    assert slip.multiplicity == 2
    assert kinds(at) == ["slip", "stick"]
    assert "slip (multiplicity 2)" in at.sentence
    np.testing.assert_allclose(slip.impulse[1:] / slip.impulse[0], [float(x) for x in d], rtol=1e-15)
    np.testing.assert_allclose(slip.slip, [-float(x) for x in d], rtol=1e-12)
    # one part in 10^30 to either side: doubles see no difference
    nudge = Fraction(1, 10**30)
    counts = {len(coulomb_solutions(scene, AT_REST, [-1, v_t[0], v_t[1] + sign * nudge]).solutions) for sign in (1, -1)}
    assert counts == {1, 3}


def test_irrational_data_are_counted_by_balls_and_a_double_root_of_theirs_stays_undecided() -> None:
    v_t, _ = double_slip(Fraction(1, 2))
    root = sp.sqrt(2)
    stretched = [[10, -9 * root, 0], [-9 * root, 18, 0], [0, 0, 8]]
    scene = scene_with(stretched, Disc(mu=1 / root))
    same = coulomb_solutions(scene, AT_REST, [-1, sp.Rational(v_t[0]) * root, sp.Rational(v_t[1]) * root])
    assert [solution.multiplicity for solution in same.solutions] == [1, 2]  # the normalised data are rational
    skew = scene_with([[10, -9, root / 10], [-9, 9, 0], [root / 10, 0, 9]], Disc(mu=1))
    three = coulomb_solutions(skew, AT_REST, [-1, "1/2", 2])
    assert kinds(three) == ["slip", "slip", "stick"]
    assert three.enumeration is Enumeration.COMPLETE
    turned = sp.Matrix([[1, -1, 0], [1, 1, 0], [0, 0, root]]) / root  # by 45 degrees, with b and C turned along
    change = sp.diag(1, turned[:2, :2])
    G = (change * sp.Matrix(STEEP) * change.T).tolist()
    v = change * sp.Matrix([-1, *map(sp.Rational, v_t)])
    unknown = coulomb_solutions(scene_with(G, Disc(mu=1)), AT_REST, list(v))
    assert unknown.enumeration is Enumeration.UNDECIDED
    assert "undecided: the slips" in unknown.sentence
    assert kinds(unknown) == ["stick"]


@pytest.mark.parametrize("r", [(5, 4, 3), (2, sp.sqrt(3), 1)])
def test_sticking_on_the_border_of_the_cone_is_one_solution_and_not_two(r: tuple[sp.Expr, ...]) -> None:
    """This impulse stops the tip; a slip in its direction would have kappa = 0."""
    found = coulomb_solutions(scene_with(STEEP, Disc(mu=1)), AT_REST, list(-sp.Matrix(STEEP) * sp.Matrix(r)))
    assert kinds(found) == ["stick"]
    assert found.enumeration is Enumeration.COMPLETE


def test_isotropic_data_make_the_slip_equation_vanish_and_leave_sticking() -> None:
    found = coulomb_solutions(scene_with([[1, 0, 0], [0, 3, 0], [0, 0, 3]], Disc(mu=1)), AT_REST, [-1, 0, 0])
    assert kinds(found) == ["stick"]


# --- planar contacts -------------------------------------------------------------------------------------------------


def random_planar(seed: int, count: int) -> list[tuple[list[list[Fraction]], Fraction, Fraction, list[Fraction]]]:
    """(G, minus, plus, v) with small rational numbers; some v_n are 0."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        factor = np.array(rng.integers(-3, 4, size=(2, 2))) + 4 * np.eye(2, dtype=int)
        if round(np.linalg.det(factor)) == 0:
            continue
        G = [[Fraction(int(x)) for x in row] for row in factor.T @ factor]
        minus, plus = (Fraction(int(x), 2) for x in rng.integers(0, 7, size=2))
        made.append((G, minus, plus, [Fraction(int(x)) for x in rng.integers(-3, 4, size=2)]))
    return made


def planar_scene(G: list[list[Fraction]], minus: Fraction, plus: Fraction) -> painleve.mechanics.scene.Scene:
    return scene_with(
        [[sp.Rational(x) for x in row] for row in G], Segment(minus=sp.Rational(minus), plus=sp.Rational(plus))
    )


@pytest.mark.parametrize(("G", "minus", "plus", "v"), random_planar(6, 60))
def test_planar_solutions_are_those_of_the_definition_in_fractions(
    G: list[list[Fraction]], minus: Fraction, plus: Fraction, v: list[Fraction]
) -> None:
    (a, b), (_, C) = G
    expected = [(Fraction(0), Fraction(0))] if v[0] >= 0 else []
    determinant = a * C - b * b
    stick = ((b * v[1] - C * v[0]) / determinant, (b * v[0] - a * v[1]) / determinant)
    if stick[0] > 0 and -minus * stick[0] <= stick[1] <= plus * stick[0]:
        expected.append(stick)
    for s, opposed in {(plus, -1), (-minus, 1)} if v[0] != 0 else ():
        if a + b * s != 0 and -v[0] / (a + b * s) > 0:
            normal = -v[0] / (a + b * s)
            if opposed * (v[1] + normal * (b + C * s)) > 0 or (minus == plus == 0):
                expected.append((normal, normal * s))
    found = coulomb_solutions(planar_scene(G, minus, plus), (0, 0), v)
    if any(solution.family is not None for solution in found.solutions):
        assert v[0] == 0
        assert 0 in (a + b * plus, a - b * minus)
        return
    assert found.enumeration is Enumeration.COMPLETE
    table = np.array(sorted(set(expected)), dtype=float).reshape(-1, 2)
    np.testing.assert_allclose(impulses(found), table[np.lexsort(table.T.round(9))], rtol=1e-14)


def test_an_approaching_planar_contact_has_one_solution_and_it_is_the_projection() -> None:
    seen = set()
    for G, minus, plus, v in random_planar(8, 80):
        if v[0] >= 0 or minus == plus == 0:
            continue
        found = coulomb_solutions(planar_scene(G, minus, plus), (0, 0), v)
        (a, b), (_, C) = ([float(x) for x in row] for row in G)
        mu_plus, mu_minus = float(plus), float(minus)
        contact = SegmentContact(a, b, C, a + mu_plus * b, a - mu_minus * b, mu_plus, mu_minus)
        *r, _ = segment_impulse(contact, *map(float, v))
        (solution,) = found.solutions
        np.testing.assert_allclose(solution.impulse, r, rtol=1e-12, atol=1e-15)
        seen.add((solution.kind, found.gamma.sign))
    assert seen >= {(kind, sign) for kind in ("stick", "slip") for sign in (Sign.NEGATIVE, Sign.POSITIVE)}


def test_planar_separation_at_negative_gamma_has_three_solutions() -> None:
    """G = [[10, -9], [-9, 9]], mu = 2, v = (1, -5): leave, slip with lambda = 1/8, or jam with lambda = 4."""
    found = coulomb_solutions(scene_with([[10, -9], [-9, 9]], Segment(minus=2, plus=2)), (0, 0), [1, -5])
    np.testing.assert_allclose(impulses(found), [[0, 0], [1 / 8, 1 / 4], [4, 41 / 9]], rtol=1e-15)
    assert kinds(found) == ["open", "slip", "stick"]


def test_a_critical_planar_contact_has_a_family_that_ends_in_sticking() -> None:
    found = coulomb_solutions(
        scene_with([[10, -9], [-9, 9]], Segment(minus=0, plus=sp.Rational(10, 9))), (0, 0), [0, -1]
    )
    (family,) = [solution for solution in found.solutions if solution.family is not None]
    assert family.multiplicity is None
    np.testing.assert_allclose(family.family, [[0, 0], [1, 10 / 9]], rtol=1e-15)
    np.testing.assert_allclose(family.family_velocities, [[0, -1], [0, 0]], atol=1e-15)
    assert kinds(found) == ["open", "slip", "stick"]
    assert family.residual <= 1e-14


def test_a_planar_contact_in_space_has_its_planar_solutions_and_others_in_mirrored_pairs() -> None:
    for G, _, plus, v in random_planar(9, 25):
        if plus == 0 or v[0] == 0:
            continue
        flat = coulomb_solutions(planar_scene(G, plus, plus), (0, 0), v)
        embedded = [[sp.Rational(x) for x in row] + [0] for row in G] + [[0, 0, 2]]
        space = coulomb_solutions(scene_with(embedded, Disc(mu=sp.Rational(plus))), AT_REST, [*v, 0])
        table = impulses(space)
        inside = table[np.abs(table[:, 2]) < 1e-12]
        np.testing.assert_allclose(inside[:, :2], impulses(flat), rtol=1e-12, atol=1e-14)
        outside = table[np.abs(table[:, 2]) >= 1e-12]
        mirrored = outside * [1, 1, -1]
        np.testing.assert_allclose(np.sort(mirrored[:, 2]), np.sort(outside[:, 2]), rtol=1e-12)


def test_where_the_normal_and_the_tangents_are_uncoupled_coulomb_and_the_projection_are_one_law() -> None:
    for contact in random_numbers(13, 400):
        G, v = contact.G.copy(), contact.v * [-1.0 if contact.v[0] > 0.0 else 1.0, 1.0, 1.0]
        G[0, 1:] = G[1:, 0] = 0.0
        (solution,) = Numbers(G, v).solve()
        *r, branch = disc_impulse(delassus(G), G[0, 0], tuple(v))
        assert solution[0] == branch
        np.testing.assert_allclose(solution[1:4], r, rtol=1e-6, atol=1e-9 * r[0])
    coupled = [n for n in random_numbers(14, 400, spread=0.5) if n.v[0] < 0.0 and len(n.slips()) == 1 == len(n.solve())]
    apart = [np.abs(n.slips()[0] - project(n)).max() > 1e-3 * n.slips()[0, 0] for n in coupled]
    assert sum(apart) > len(apart) / 2  # coupled, they are two laws


# --- invariance ------------------------------------------------------------------------------------------------------


def test_turning_the_tangents_turns_the_solutions() -> None:
    c, s = sp.Rational(3, 5), sp.Rational(4, 5)
    turn = sp.diag(1, sp.Matrix([[c, -s], [s, c]]))
    G, v = sp.Matrix([[10, -9, 0], [-9, 9, 0], [0, 0, 9]]), sp.Matrix([-1, sp.Rational(1, 2), 2])
    plain = coulomb_solutions(scene_with(G.tolist(), Disc(mu=1)), AT_REST, list(v))
    turned = coulomb_solutions(scene_with((turn * G * turn.T).tolist(), Disc(mu=1)), AT_REST, list(turn * v))
    back = impulses(turned) @ np.array(turn, dtype=float)
    np.testing.assert_allclose(back[np.lexsort(back.T.round(9))], impulses(plain), rtol=1e-14)


def test_other_units_of_mass_length_and_time_change_nothing_but_the_units() -> None:
    G, v = sp.Matrix([[10, -9, 0], [-9, 9, 0], [0, 0, 9]]), sp.Matrix([-1, sp.Rational(1, 2), 2])
    plain = coulomb_solutions(scene_with(G.tolist(), Disc(mu=1)), AT_REST, list(v))
    other = coulomb_solutions(scene_with((G / 7).tolist(), Disc(mu=1)), AT_REST, list(v * sp.Rational(11, 3)))
    np.testing.assert_allclose(impulses(other), impulses(plain) * 7 * 11 / 3, rtol=1e-14)
    assert kinds(other) == kinds(plain)


def test_an_ellipse_is_the_unit_disc_in_stretched_tangents() -> None:
    """Maximal dissipation does not see a linear change of the tangents; a turned ellipse has irrational numbers
    here."""
    G, v = sp.Matrix([[10, -9, 1], [-9, 9, 1], [1, 1, 9]]), sp.Matrix([-1, sp.Rational(1, 2), 2])
    for angle, mu_1, mu_2 in ((0, 2, sp.Rational(1, 2)), (sp.pi / 6, 2, 1), (sp.Rational(3, 10), 1, 3)):
        E = sp.diag(1, sp.rot_ccw_axis3(angle)[:2, :2] * sp.diag(mu_1, mu_2))
        ellipse = coulomb_solutions(
            scene_with(G.tolist(), Ellipse(mu_1=mu_1, mu_2=mu_2, angle=angle)), AT_REST, list(v)
        )
        disc = coulomb_solutions(scene_with((E.T * G * E).tolist(), Disc(mu=1)), AT_REST, list(E.T * v))
        back = impulses(disc) @ np.array(E.T, dtype=float)
        np.testing.assert_allclose(back[np.lexsort(back.T.round(9))], impulses(ellipse), rtol=1e-12, atol=1e-15)


# --- polygons --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("G", "v"),
    [
        ([[10, -9, 0], [-9, 9, 0], [0, 0, 9]], [-1, Fraction(1, 2), 2]),
        (STEEP, [-1, 3, 1]),
        ([[10, -15, 0], [-15, 25, 0], [0, 0, 9]], [1, -20, 1]),
    ],
)
def test_a_disc_is_the_limit_of_polygons(G: list[list[int]], v: list[Fraction]) -> None:
    """In Hausdorff's distance: a staircase of vertices and edges can cross the slip equation several times near a
    root."""
    round_ = impulses(coulomb_solutions(scene_with(G, Disc(mu=1)), AT_REST, v))
    errors = []
    for corners in (12, 48):
        vertices = [on_the_circle(2.0 * np.pi * (i + 0.37) / corners - np.pi) for i in range(corners)]
        polygon = Polygon(vertices=tuple((sp.Rational(x), sp.Rational(y)) for x, y in vertices))
        found = impulses(coulomb_solutions(scene_with(G, polygon), AT_REST, v))
        apart = np.linalg.norm(found[:, None, :] - round_[None, :, :], axis=2)
        errors.append(max(apart.min(axis=0).max(), apart.min(axis=1).max()))
    assert errors[1] < errors[0] / 2.0
    assert errors[1] < 0.1 * np.abs(round_).max()


HALF = Fraction(5, 2)
SQUARE = [(HALF, -HALF), (HALF, HALF), (-HALF, HALF), (-HALF, -HALF)]
OCTAGON = [(4, 0), (3, 3), (0, 4), (-3, 3), (-4, 0), (-3, -3), (0, -4), (3, -3)]


@pytest.mark.parametrize(
    ("vertices", "G", "v", "slips"),
    [
        (SQUARE, [[11, 14, 15], [14, 36, 28], [15, 28, 25]], [-1, Fraction(-11, 2), -2], 4),
        (OCTAGON, [[17, 10, -5], [10, 17, -16], [-5, -16, 17]], [-1, -3, 5], 6),
    ],
    ids=["square", "octagon"],
)
def test_on_a_polygon_coulomb_s_law_has_five_and_seven_solutions_where_a_disc_has_three_at_most(vertices, G, v, slips):
    polygon = Polygon(vertices=tuple((sp.Rational(x), sp.Rational(y)) for x, y in vertices))
    found = coulomb_solutions(scene_with(G, polygon), AT_REST, v)
    assert found.enumeration is Enumeration.COMPLETE
    assert kinds(found) == ["slip"] * slips + ["stick"]
    corners, matrix = np.array(vertices, dtype=float), np.array(G, dtype=float)
    for solution in found.solutions:  # by the law itself, in plain numbers
        r = np.array(solution.impulse)
        u = np.array(v, dtype=float) + matrix @ r
        assert r[0] > 0.0
        assert abs(u[0]) < 1e-12
        assert r[1:] @ u[1:] == pytest.approx(r[0] * (corners @ u[1:]).min(), abs=1e-11)
    radius = float(np.linalg.norm(corners, axis=1).max())
    round_ = coulomb_solutions(scene_with(G, Disc(mu=sp.Rational(radius))), AT_REST, v)
    assert len(round_.solutions) <= 3


def test_polygon_solutions_are_those_of_every_face_of_the_cone_by_hand() -> None:
    """A square with G diagonal, v = (-1, 3, 1): at the vertex (-1, -1) u_t = (3 - 1, 1 - 2) is not in the normal cone;
    on the edge s_1 = -1 u_t2 = 0 gives s_2 = -1/2."""
    square = Polygon(vertices=((-1, -1), (1, -1), (1, 1), (-1, 1)))
    found = coulomb_solutions(scene_with([[1, 0, 0], [0, 1, 0], [0, 0, 2]], square), AT_REST, [-1, 3, 1])
    (slip,) = found.solutions
    np.testing.assert_allclose(slip.impulse, [1, -1, -1 / 2], rtol=1e-15)
    np.testing.assert_allclose(slip.contact_velocity, [0, 2, 0], atol=1e-15)
    assert slip.residual == 0.0


def test_an_edge_along_which_the_slip_stays_across_it_is_a_family() -> None:
    """By hand: on the edge s_1 = 1 u_2 = 0 whatever s_2, lambda = 1/(1/2 + s_2), and u_1 < 0 for s_2 > 1/12, where it
    sticks; so the impulses from (12/7, 12/7, 1/7) to the corner (2/3, 2/3, 2/3)."""
    half = sp.Rational(1, 2)
    G = [[2, -3 * half, 1], [-3 * half, 9, 1], [1, 1, 4]]
    square = Polygon(vertices=((-1, -1), (1, -1), (1, 1), (-1, 1)))
    found = coulomb_solutions(scene_with(G, square), AT_REST, [-1, -13, -4])
    (family,) = [solution for solution in found.solutions if solution.family is not None]
    ends = family.family[np.argsort(family.family[:, 0])]
    np.testing.assert_allclose(ends, [[2 / 3, 2 / 3, 2 / 3], [12 / 7, 12 / 7, 1 / 7]], rtol=1e-15)
    assert family.multiplicity is None
    assert family.residual <= 1e-14
    (stick,) = [solution for solution in found.solutions if solution.kind == "stick"]
    np.testing.assert_allclose(stick.impulse, ends[1], rtol=1e-15)


# --- where there is nothing to enumerate -----------------------------------------------------------------------------


def test_away_from_contact_only_the_free_velocity_remains() -> None:
    found = coulomb_solutions(scene_with(STEEP, Disc(mu=1)), (1, 0, 0), [-1, 2, 3])
    assert kinds(found) == ["open"]
    np.testing.assert_array_equal(found.solutions[0].velocity, [-1, 2, 3])
    assert found.solutions[0].residual == 0.0


@pytest.mark.parametrize("friction", [None, Disc(mu=0), Segment(minus=0, plus=0)])
def test_without_friction_there_is_one_solution(friction: Disc | Segment | None) -> None:
    G = STEEP if not isinstance(friction, Segment) else [[10, -9], [-9, 9]]
    velocity = [-1, 2, 3][: len(G)]
    found = coulomb_solutions(scene_with(G, friction), (0,) * len(G), velocity)
    assert kinds(found) == ["frictionless"]
    np.testing.assert_allclose(found.solutions[0].velocity[:2], [0, 2 - 9 / 10], rtol=1e-15)
    assert kinds(coulomb_solutions(scene_with(G, friction), (0,) * len(G), [1, *velocity[1:]])) == ["open"]


def test_the_library_s_rod_in_space_at_its_states() -> None:
    rod = painleve.load_scene("spatial_rod")
    for state in rod.states:
        made = painleve.make_state(rod, state.name)
        found = coulomb_solutions(rod, made.q, made.u, parameters=made.parameters)
        assert found.enumeration is Enumeration.COMPLETE
        assert found.solutions[0].kind == "open"
        assert all(solution.residual < 1e-14 for solution in found.solutions)


def test_numbers_are_read_by_name_and_order_alike_and_a_float_is_its_decimal() -> None:
    scene = scene_with(STEEP, Disc(mu=1))
    listed = coulomb_solutions(scene, (0, 0, 0), (-1, 0.1, "1/5"))
    named = coulomb_solutions(scene, {"x2": 0, "x1": 0, "x0": 0}, {"u_x0": -1, "u_x2": Fraction(1, 5), "u_x1": "0.1"})
    np.testing.assert_array_equal(impulses(listed), impulses(named))


@pytest.mark.parametrize(
    ("q", "v", "message"),
    [
        ((0, 0), (-1, 0, 0), "q needs 3 numbers (x0, x1, x2), not 2"),
        ((0, 0, 0), {"u_x0": 1, "u_x1": 2, "x2": 3}, "missing or unknown: u_x2, x2"),
        ((0, 0, "__import__('os')"), (-1, 0, 0), "q: x2"),
        ((0, 0, 0), "-1", "v needs 3 numbers"),
        ((0, 0, float("nan")), (-1, 0, 0), "q: x2"),
    ],
)
def test_bad_numbers_are_named_in_one_line(q: object, v: object, message: str) -> None:
    with pytest.raises(InputError) as error:
        coulomb_solutions(scene_with(STEEP, Disc(mu=1)), q, v)
    assert message in str(error.value)
    assert "\n" not in str(error.value)
