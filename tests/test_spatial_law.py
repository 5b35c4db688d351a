"""Law (7) in space: disc and polygon against many digits, a convex solver, brute force and each other."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import cvxpy as cp
import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_spatial_law import exact_disc_impulse

from painleve.core.codes import ContactMode
from painleve.core.sections.segment import SegmentContact, segment_impulse
from painleve.core.space.conic_law import disc_impulse
from painleve.core.space.polygon_law import polygon_impulse
from painleve.core.space.tangent_plane import Delassus

EPS = float(np.finfo(float).eps)
# p/a = 1 - eccentricity: circle, ellipses, parabola, hyperbolas, huge friction
SHAPES = [1.0, 0.9, 0.3, 1e-3, 1e-8, 1e-20, 1e-300, 0.0, -1e-300, -1e-20, -1e-8, -1e-3, -0.3, -3.0, -1e3, -1e6]
SOLVER = 2e-5
SEEDS = st.integers(0, 2**32 - 1)
thorough = settings(max_examples=200)


class Contact:
    """A random Delassus matrix, its tangents multiplied so that p = a - |b| is a given multiple of a."""

    def __init__(self, rng: np.random.Generator, shape: float) -> None:
        root = rng.normal(size=(3, 3))
        G = root @ root.T + 0.05 * np.eye(3)
        self.a = float(G[0, 0])
        factor = self.a * (1.0 - shape) / hypot(*G[0, 1:])
        self.b = G[0, 1:] * factor
        self.C = G[1:, 1:] * (factor if factor > 0.0 else 1.0) ** 2
        if factor == 0.0:
            self.C = self.C - np.outer(G[0, 1:], G[0, 1:]) / self.a
        self.p = shape * self.a

    @property
    def Q(self) -> np.ndarray:
        return self.C - np.outer(self.b, self.b) / self.a

    @property
    def G(self) -> Delassus:
        return Delassus(self.a, *self.b, self.C[0, 0], self.C[0, 1], self.C[1, 1])

    def impulse(self, v: np.ndarray) -> tuple[np.ndarray, ContactMode]:
        *r, branch = disc_impulse(self.G, self.p, tuple(v))
        return np.array(r), ContactMode(branch)

    def polygon(self, vertices: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ContactMode]:
        p = self.a + vertices @ self.b
        *r, branch = polygon_impulse(self.G, vertices, p, tuple(v))
        return np.array(r), ContactMode(branch)

    def narrower_disc(self, radius: float, v: np.ndarray) -> np.ndarray:
        """The impulse of the disc of this radius."""
        (b_1, b_2), C = radius * self.b, radius * radius * self.C
        p = self.a - hypot(b_1, b_2)
        G = Delassus(self.a, b_1, b_2, C[0, 0], C[0, 1], C[1, 1])
        r_n, r_1, r_2, _ = disc_impulse(G, p, (v[0], radius * v[1], radius * v[2]))
        return np.array([r_n, radius * r_1, radius * r_2])

    def energy(self, r: np.ndarray, v: np.ndarray) -> float:
        G = np.block([[np.array([[self.a]]), self.b[None, :]], [self.b[:, None], self.C]])
        return float(0.5 * r @ G @ r + v @ r)

    def velocity(self, rng: np.random.Generator, low: float, high: float) -> np.ndarray:
        """Tangential velocities of the size of the compliance, a normal one smaller or larger by powers of ten."""
        v = rng.normal(size=3) * np.sqrt([self.a, self.C[0, 0], self.C[1, 1]])
        v[0] = -abs(v[0]) * 10.0 ** rng.uniform(low, high)
        return v


def relative_error(found: np.ndarray, exact: tuple) -> float:
    difference = [mpmath.mpf(float(x)) - y for x, y in zip(found, exact[:3], strict=True)]
    return float(mpmath.norm(difference) / mpmath.norm(exact[:3]))


@pytest.mark.parametrize("shape", SHAPES)
def test_the_disc_s_impulse_is_exact_to_rounding_for_every_sign_of_gamma(shape):
    """Relative to itself, in units of what the rounding of Q alone does to it."""
    rng = np.random.default_rng(11)
    seen = set()
    for k in range(12 if 0.0 < abs(shape) < 1e-200 else 30):
        contact = Contact(rng, shape)
        v = contact.velocity(rng, *((-3.0, 1.0) if k % 2 else (-24.0, 0.0)))
        found, branch = contact.impulse(v)
        exact = exact_disc_impulse(contact.a, contact.p, contact.b, contact.C, v)
        assert branch.label == exact[3]
        assert relative_error(found, exact) <= 10.0 * EPS * np.linalg.cond(contact.Q)
        seen.add(branch)
    assert ContactMode.SLIP in seen


def solver_impulse(contact: Contact, v: np.ndarray, vertices: np.ndarray | None = None) -> np.ndarray:
    """The definition as a convex programme: the cone, the vanishing normal velocity, the least energy."""
    G = np.block([[np.array([[contact.a]]), contact.b[None, :]], [contact.b[:, None], contact.C]])
    root = np.linalg.cholesky(G)
    r = cp.Variable(3)
    if vertices is None:
        cone = [cp.norm(r[1:]) <= r[0]]
    else:
        x = cp.Variable(len(vertices), nonneg=True)
        cone = [r == np.column_stack([np.ones(len(vertices)), vertices]).T @ x]
    energy = cp.sum_squares(root.T @ r + np.linalg.solve(root, v))
    problem = cp.Problem(cp.Minimize(energy), [*cone, G[0] @ r == -v[0]])
    problem.solve(solver="CLARABEL", tol_gap_abs=1e-10, tol_gap_rel=1e-10, tol_feas=1e-10)
    return root.T @ (np.array(r.value))


def energy_norm(contact: Contact, r: np.ndarray) -> np.ndarray:
    G = np.block([[np.array([[contact.a]]), contact.b[None, :]], [contact.b[:, None], contact.C]])
    return np.linalg.cholesky(G).T @ r


@pytest.mark.parametrize("shape", [1.0, 0.9, 0.3, 1e-2, 0.0, -1e-2, -0.3, -3.0])
def test_the_disc_s_impulse_is_the_projection_that_an_interior_point_solver_finds(shape):
    rng = np.random.default_rng(12)
    for _ in range(20):
        contact = Contact(rng, shape)
        v = contact.velocity(rng, -1.5, 1.0)
        found, _ = contact.impulse(v)
        expected = solver_impulse(contact, v)
        # A gap of 1e-10 in the energy is a distance of 1e-5 in its metric, of the size of the data.
        size = np.linalg.norm(expected) + np.linalg.norm(v)
        np.testing.assert_allclose(energy_norm(contact, found), expected, rtol=0, atol=SOLVER * size)


def random_polygon(rng: np.random.Generator) -> np.ndarray:
    """3 to 8 points on an ellipse about 0, which is inside or, in one of four, on an edge."""
    n = int(rng.integers(3, 9))
    angles = np.sort(2.0 * pi * (np.arange(n) + 0.8 * rng.uniform(size=n)) / n)
    points = np.column_stack([rng.uniform(0.5, 2.0) * np.cos(angles), rng.uniform(0.5, 2.0) * np.sin(angles)])
    if n > 3 or np.all(np.diff([*angles, angles[0] + 2.0 * pi]) < pi):
        return points if rng.uniform() < 0.75 else points - 0.5 * (points[0] + points[1])
    return points - points.mean(axis=0)


@pytest.mark.parametrize("shape", [1.0, 0.9, 0.3, 1e-2, 0.0, -1e-2, -0.3, -3.0])
def test_the_polygon_s_impulse_is_the_projection_that_an_interior_point_solver_finds(shape):
    rng = np.random.default_rng(13)
    branches = []
    for _ in range(20):
        contact, vertices = Contact(rng, shape), random_polygon(rng)
        v = contact.velocity(rng, -1.5, 1.0)
        found, branch = contact.polygon(vertices, v)
        branches.append(branch)
        expected = solver_impulse(contact, v, vertices)
        size = np.linalg.norm(expected) + np.linalg.norm(v)
        np.testing.assert_allclose(energy_norm(contact, found), expected, rtol=0, atol=SOLVER * size)
    assert {ContactMode.SLIP} <= set(branches) <= {ContactMode.SLIP, ContactMode.STICK}


@given(SEEDS, st.sampled_from(SHAPES), st.integers(-500, 500))
@thorough
def test_the_law_in_space_is_positively_homogeneous_over_300_powers_of_ten(seed, shape, exponent):
    rng = np.random.default_rng(seed)
    contact, vertices = Contact(rng, shape), random_polygon(rng)
    v = contact.velocity(rng, -6.0, 1.0)
    for law in (contact.impulse, lambda v: contact.polygon(vertices, v)):
        found, branch = law(v)
        scaled, same = law(np.ldexp(v, exponent))
        assert same is branch
        error = np.linalg.norm(np.ldexp(scaled, -exponent) - found)
        assert error <= 10.0 * EPS * np.linalg.cond(contact.Q) * np.linalg.norm(found)


@pytest.mark.parametrize("shape", [0.9, 0.3, 1e-2, 0.0, -1e-2, -0.3, -3.0])
def test_no_point_of_a_fine_grid_on_the_edge_of_the_cone_has_less_energy(shape):
    rng = np.random.default_rng(16)
    angles = np.linspace(0.0, 2.0 * pi, 20001)
    s = np.column_stack([np.cos(angles), np.sin(angles)])
    for _ in range(20):
        contact = Contact(rng, shape)
        v = contact.velocity(rng, -4.0, 0.0)
        found, _ = contact.impulse(v)
        lift = contact.a + s @ contact.b
        r_n = -v[0] / lift[lift > 1e-6 * contact.a]
        r = np.column_stack([r_n, r_n[:, None] * s[lift > 1e-6 * contact.a]])
        G = np.block([[np.array([[contact.a]]), contact.b[None, :]], [contact.b[:, None], contact.C]])
        energies = 0.5 * np.einsum("ij,jk,ik->i", r, G, r) + r @ v
        least = contact.energy(found, v)
        assert least <= energies.min() + 1e-12 * (abs(least) + v @ np.linalg.solve(G, v))
        assert abs(G[0] @ found + v[0]) <= 4.0 * EPS * (np.abs(G[0]) @ np.abs(found))
        assert hypot(*found[1:]) <= found[0] * (1.0 + 4.0 * EPS)


def test_without_friction_the_impulse_is_normal_and_no_number_is_undefined():
    for v in ([-2.0, 0.0, 0.0], [-2e-300, 0.0, 0.0]):
        none = Delassus(4.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        assert disc_impulse(none, 4.0, tuple(v)) == (-v[0] / 4.0, 0.0, 0.0, ContactMode.SLIP)
        G, point = Delassus(4.0, 0.5, 0.1, 1.0, 0.2, 1.0), np.zeros((1, 2))
        assert polygon_impulse(G, point, np.array([4.0]), (v[0], 1.0, 2.0)) == (
            -v[0] / 4.0,
            0.0,
            0.0,
            ContactMode.SLIP,
        )


@pytest.mark.parametrize(
    "mu", [1e-25, 1e-31, 1e-45, 1e-55, 1e-62, 1e-70, 1e-90, 1e-155, 1e-162, 1e-163, 1e-200, 1e-300]
)
def test_friction_that_vanishes_beside_one_opposes_the_slip_of_a_frictionless_impact(mu):
    """The energy's second-order terms go like mu^2, and vanish below 1e-162; products of them vanish earlier."""
    rng = np.random.default_rng(4)
    for _ in range(50):
        L, v = rng.normal(size=(3, 3)), rng.normal(size=3) - np.array([3.0, 0.0, 0.0])
        G = L @ L.T + 0.1 * np.eye(3)
        b, C = mu * G[0, 1:], mu * (mu * G[1:, 1:])
        contact = Delassus(G[0, 0], b[0], b[1], C[0, 0], C[0, 1], C[1, 1])
        r = disc_impulse(contact, G[0, 0] - np.hypot(*b), (v[0], mu * v[1], mu * v[2]))
        slip = v[1:] - G[0, 1:] * (v[0] / G[0, 0])
        expected = -v[0] / G[0, 0] * np.array([1.0, *(-slip / np.linalg.norm(slip))])
        np.testing.assert_allclose(r[:3], expected, rtol=1e-9, atol=1e-12)
        assert r[3] == ContactMode.SLIP


def test_nothing_happens_where_the_normal_velocity_is_not_outward():
    contact = Contact(np.random.default_rng(0), -0.3)
    for v_n in (0.0, 1e-300, 1.0):
        found, branch = contact.impulse(np.array([v_n, 1.0, -2.0]))
        assert branch is ContactMode.FREE
        assert not found.any()


@pytest.mark.parametrize("shape", [0.3, 0.0, -0.3])
def test_a_regular_polygon_is_between_its_circles_and_tends_to_the_disc_quadratically(shape):
    rng = np.random.default_rng(14)
    contact = Contact(rng, shape)
    v = np.array([-0.01, *(-3.0 * contact.b / hypot(*contact.b) + [0.5, 1.0])])
    disc, branch = contact.impulse(v)
    assert branch is ContactMode.SLIP
    least, gaps = contact.energy(disc, v), []
    for n in (16, 64, 256):
        angles = 2.0 * pi * (np.arange(n) + 0.3) / n
        corners = np.column_stack([np.cos(angles), np.sin(angles)])
        inscribed = contact.energy(contact.polygon(corners, v)[0], v)
        circumscribed = contact.energy(contact.polygon(corners / cos(pi / n), v)[0], v)
        assert circumscribed < least < inscribed
        assert inscribed <= contact.energy(contact.narrower_disc(cos(pi / n), v), v)
        gaps.append(inscribed - circumscribed)
    # between two circles whose radii differ by pi^2/(2 n^2): at each step a 16th, but for where the corners are
    assert gaps[0] / gaps[2] == pytest.approx(256.0, rel=0.5)


@given(SEEDS, st.sampled_from([0.9, 0.3, 1e-8, 0.0, -1e-8, -0.3, -3.0]), st.floats(0.0, 6.3))
@thorough
def test_a_rotation_of_the_tangent_frame_rotates_the_impulse(seed, shape, angle):
    rng = np.random.default_rng(seed)
    contact = Contact(rng, shape)
    v = contact.velocity(rng, -6.0, 1.0)
    found, _ = contact.impulse(v)
    turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
    contact.b, contact.C = turn @ contact.b, turn @ contact.C @ turn.T
    turned, _ = contact.impulse(np.array([v[0], *(turn @ v[1:])]))
    error = np.linalg.norm(turned - [found[0], *(turn @ found[1:])])
    assert error <= 100.0 * EPS * np.linalg.cond(contact.Q) * np.linalg.norm(found)


@pytest.mark.parametrize("shape", [0.9, 0.3, 1e-8, 0.0, -1e-8, -0.3, -3.0])
def test_a_planar_problem_in_space_has_the_planar_answer(shape):
    """b and v_t along the first axis, a principal one of C: the problem is symmetric, and so is its one solution."""
    rng = np.random.default_rng(15)
    for _ in range(200):
        a, sense = rng.uniform(0.5, 2.0), rng.choice([-1.0, 1.0])
        b, p = sense * a * (1.0 - shape), a * shape
        C_11, C_22, v_n, v_t = (
            b * b / a * rng.uniform(1.05, 3.0),
            rng.uniform(0.1, 2.0),
            -rng.uniform(0.0, 1.0),
            rng.normal(),
        )
        edges = (a + abs(b), p) if sense > 0.0 else (p, a + abs(b))
        planar = segment_impulse(SegmentContact(a, b, C_11, *edges, 1.0, 1.0), v_n, v_t)
        segment = np.array([[-1.0, 0.0], [1.0, 0.0]])
        G = Delassus(a, b, 0.0, C_11, 0.0, C_22)
        spatial = polygon_impulse(G, segment, np.array(edges[::-1]), (v_n, v_t, 0.0))
        np.testing.assert_allclose([*spatial[:2], spatial[2]], [*planar[:2], 0.0], rtol=1e-13, atol=1e-13)
        assert (spatial[3] == ContactMode.STICK) == (planar[2] == ContactMode.STICK)


@pytest.mark.parametrize("seed", range(20))
def test_the_law_passes_from_the_ellipse_through_the_parabola_to_the_hyperbola_without_a_jump(seed):
    """At a fixed v_n < 0 the region changes continuously with p, and so does its point nearest to the sticking one."""
    rng = np.random.default_rng(seed)
    v = np.array([-abs(rng.normal()), *(3.0 * rng.normal(size=2))])
    at_zero, _ = Contact(np.random.default_rng(seed), 0.0).impulse(v)
    changes = []
    for step in (1e-4, 1e-6, 1e-8):
        sides = [Contact(np.random.default_rng(seed), sign * step).impulse(v)[0] for sign in (1.0, -1.0)]
        changes.append(max(np.linalg.norm(r - at_zero) for r in sides) / np.linalg.norm(at_zero))
    assert changes[1] < changes[0] / 50
    assert changes[2] < changes[1] / 50  # linear in p: a factor of 100 each


@pytest.mark.parametrize("shape", [0.9, 0.3, 1e-8, 0.0, -1e-8, -0.3, -3.0])
def test_a_disc_whose_b_slip_and_principal_axis_are_parallel_has_the_planar_answer(shape):
    """By symmetry; and whether the answer is stick or slip is told alike."""
    rng = np.random.default_rng(5)
    for _ in range(50):
        a, C, across = 1.0, 1.0 + rng.exponential(), rng.exponential()
        b = (1.0 - shape) * a * rng.choice([-1.0, 1.0])
        C += b * b / a
        v_n, v_t = -rng.exponential() * 10.0 ** rng.uniform(-6, 0), rng.normal()
        p = shape * a
        plus, minus = (p, a + abs(b)) if b < 0.0 else (a + abs(b), p)
        r_n, r_t, planar = segment_impulse(SegmentContact(a, b, C, plus, minus, 1.0, 1.0), v_n, v_t)
        n, r_1, r_2, branch = disc_impulse(Delassus(a, b, 0.0, C, 0.0, across), p, (v_n, v_t, 0.0))
        assert (branch == ContactMode.STICK) == (planar == ContactMode.STICK)
        assert r_2 == pytest.approx(0.0, abs=1e-14 * n)
        assert (n, r_1) == pytest.approx((r_n, r_t), rel=1e-12, abs=1e-13 * r_n)
