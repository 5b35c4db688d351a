"""Formulas of docs/theory.md, sections 1, 2, 3, 4, 6, 9 and 10, by computer algebra and by exact enumeration."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

import painleve
from painleve.exact.signs import Sign, exact_sign
from painleve.theory.coulomb.one_step import Enumeration, enumerate_solutions
from painleve.theory.coulomb.problem import ContactProblem

a, C, beta, nu = sp.symbols("a C beta nu", positive=True)
b, v_n, v_t, t, k = sp.symbols("b v_n v_t t k", real=True)
q_11, q_12, q_22, w_1, w_2, X, Y, W, x_1, x_2, q_1, q_2 = sp.symbols(
    "q_11 q_12 q_22 w_1 w_2 X Y W x_1 x_2 q_1 q_2", real=True
)
p, A = a - beta, a + beta
D = A + p * t**2
CONIC = sp.Matrix([nu * (1 - t**2) / D, 2 * nu * t / D])


def vanishes(expression: sp.Expr) -> bool:
    return sp.simplify(expression) == 0


# --- section 1 -------------------------------------------------------------------------------------------------------


def test_1_5_moments_about_another_point_and_the_inertia_between_two_joints() -> None:
    """Sums over four points of mass, of which the formulas know the three moments alone."""
    rng = np.random.default_rng(5)

    def vector() -> sp.Matrix:
        return sp.Matrix(rng.integers(-9, 10, 3).tolist())

    def about(point: sp.Matrix) -> tuple[sp.Expr, sp.Matrix, sp.Matrix]:
        arms = [(m, x - point) for m, x in parts]
        second = [m * (y.dot(y) * sp.eye(3) - y * y.T) for m, y in arms]
        return sum(m for m, _ in parts), sum((m * y for m, y in arms), sp.zeros(3, 1)), sum(second, sp.zeros(3, 3))

    parts = [(sp.Integer(m), vector()) for m in (1, 2, 3, 5)]
    o_j, o_k, e_j, e_k = vector(), vector(), vector(), vector()
    (m, h, J), (_, moved, turned), r = about(o_k), about(o_j), o_k - o_j
    assert moved == h + m * r
    assert turned == J + (2 * r.dot(h) + m * r.dot(r)) * sp.eye(3) - r * h.T - h * r.T - m * r * r.T
    velocity = {"revolute": lambda e, o, x: e.cross(x - o), "prismatic": lambda e, o, x: e}
    wrench = {"revolute": (e_k.cross(h), J * e_k), "prismatic": (m * e_k, h.cross(e_k))}
    for far, (F, N) in wrench.items():
        for near, along in {"revolute": N + r.cross(F), "prismatic": F}.items():
            whole = sum(m * velocity[near](e_j, o_j, x).dot(velocity[far](e_k, o_k, x)) for m, x in parts)
            assert whole == e_j.dot(along)


# --- section 2 -------------------------------------------------------------------------------------------------------


def test_2_3_the_sticking_impulse_is_the_least_point_of_the_energy_on_the_line_of_no_normal_velocity() -> None:
    stick = -sp.Matrix([[a, b], [b, C]]).inv() * sp.Matrix([v_n, v_t])
    least = -(v_t - b * v_n / a) / (C - b**2 / a)
    assert vanishes(stick[1] - least)
    assert vanishes(stick[0] - (b * v_t - C * v_n) / (a * C - b**2))


def test_2_4_the_half_angle_runs_over_the_conic_and_its_tangent_is_as_stated() -> None:
    assert vanishes(a * nu * (1 + t**2) / D + beta * CONIC[0] - nu)  # a |r_t| + b.r_t = nu
    slope = CONIC.diff(t)
    assert vanishes(slope[0] * (A - p * t**2) - slope[1] * (-2 * a * t))


def test_2_4_the_quartic_of_the_stationary_points_has_these_coefficients() -> None:
    velocity = sp.Matrix([[q_11, q_12], [q_12, q_22]]) * CONIC + sp.Matrix([w_1, w_2])
    along = (velocity.T * sp.Matrix([-2 * a * t, A - p * t**2]))[0, 0]
    stated = [
        A * (nu * q_12 + A * w_2),
        2 * (A * (nu * q_22 - a * w_1) - a * nu * q_11),
        -6 * a * nu * q_12,
        2 * (a * (nu * q_11 - p * w_1) - p * nu * q_22),
        p * (nu * q_12 - p * w_2),
    ]
    assert vanishes(sp.expand(along * D) - sum(f * t**i for i, f in enumerate(stated)))


def test_2_4_a_point_is_visible_where_the_stated_form_in_t_is_positive() -> None:
    normal = sp.Matrix([a * (1 - t**2) + beta * (1 + t**2), 2 * a * t])  # times 1 + t^2
    assert vanishes((normal.T * CONIC)[0, 0] - nu * (1 + t**2))
    k_0, k_1, k_2 = A * X - nu * W, a * Y, -(p * X + nu * W)
    seen = normal[0] * X + normal[1] * Y - nu * W * (1 + t**2)
    assert vanishes(seen - (k_0 + 2 * k_1 * t + k_2 * t**2))
    R = sp.sqrt(X**2 + Y**2)
    assert vanishes(k_1**2 - k_0 * k_2 - (a * R + beta * X - nu * W) * (a * R - beta * X + nu * W))


def test_2_6_the_second_derivative_in_the_proof_of_at_most_three_solutions() -> None:
    form = x_1**2 * (q_2 + k) ** 2 + x_2**2 * (q_1 + k) ** 2
    assert vanishes(2 * form * form.diff(k, 2) - form.diff(k) ** 2 - 4 * x_1**2 * x_2**2 * (q_1 - q_2) ** 2)


def test_2_6_at_zero_the_function_of_that_proof_says_whether_the_tip_sticks() -> None:
    b_1, b_2 = sp.symbols("b_1 b_2", real=True)
    first, second = x_1 / q_1, x_2 / q_2  # -Q^-1 w with x = -w
    line = nu * q_1 * q_2 - b_1 * x_1 * q_2 - b_2 * x_2 * q_1
    assert vanishes(line - q_1 * q_2 * (nu - b_1 * first - b_2 * second))


# --- sections 3, 4 and 9 ---------------------------------------------------------------------------------------------


def test_3_1_the_jump_in_the_plane() -> None:
    s = -a / b
    size = a + 2 * b * s + C * s**2
    assert vanishes(size - (C * s**2 - a))
    assert vanishes(size - a * (a * C - b**2) / b**2)
    assert vanishes(-v_t * s / size - b * v_t / (a * C - b**2))


def test_4_3_a_feasible_impulse_stays_within_the_semi_minor_axis_of_the_ray_and_the_code_s_bound_is_no_less() -> None:
    c = sp.Symbol("c", positive=True)  # y^2 <= 2 r_n c - c^2 with r_n = (nu - beta c)/p
    across = 2 * c * (nu - beta * c) / p - c**2
    (best,) = sp.solve(across.diff(c), c)
    assert vanishes(across.subs(c, best) - nu**2 / (p * A))
    # beta^-1 sqrt((a + beta)/(4 p)) against 1/sqrt(p (a + beta)): their quotient is (a + beta)/(2 beta) >= 1 for p >= 0
    assert vanishes((A / (4 * p) / beta**2) * (p * A) - (A / (2 * beta)) ** 2)


def test_9_2_the_half_width_of_the_chord() -> None:
    size = sp.Symbol("Lambda", positive=True)
    along = (nu - a * size) / beta
    gap = (nu - p * size) / beta
    assert vanishes(size**2 - along**2 - (2 * size * gap - gap**2))


def test_9_1_the_rod_s_rate_is_the_stated_maximum() -> None:
    cosine, sine = 1 / np.sqrt(5), 2 / np.sqrt(5)
    size = np.sqrt(5 / 8)
    tilt = np.sqrt(1 - 2 * cosine**2 / (5 * (1 + cosine**2)))
    ends = [(xi, m) for xi in (1.0, -1 / np.sqrt(1 + cosine**2)) for m in (-size, size * tilt)]
    largest = max(2 * (m + 0.75 * xi * cosine) ** 2 + 9 / 16 * (xi * sine) ** 2 for xi, m in ends)
    rod = painleve.load_scene("slender_rod")
    found = painleve.rate(painleve.limit_set(painleve.make_state(rod, "paradox")))
    assert pytest.approx(np.sqrt(largest), rel=1e-14) == found.C
    assert pytest.approx(np.sqrt(np.sqrt(105) / 10 + 221 / 120), rel=1e-14) == found.C


# --- section 6 -------------------------------------------------------------------------------------------------------

m, l, inertia, mu, alpha, theta, omega, g_0 = sp.symbols("m l I mu alpha theta omega g_0", positive=True)  # noqa: E741
T = sp.Symbol("T", positive=True)  # tan(theta)


def rod_rows() -> tuple[sp.Expr, sp.Expr]:
    """(a, b) of section 6.1."""
    return 1 / m + l**2 * sp.cos(theta) ** 2 / inertia, -(l**2) * sp.sin(theta) * sp.cos(theta) / inertia


def test_6_1_the_critical_friction_of_a_rod_and_where_it_is_least() -> None:
    normal, coupling = rod_rows()
    critical = (normal / -coupling).subs(inertia, m * l**2 / alpha).subs(theta, sp.atan(T))
    assert vanishes(critical - (1 + alpha + T**2) / (alpha * T))
    assert sp.solve((1 + alpha + T**2) / (alpha * T) - 2 * sp.sqrt(1 + alpha) / alpha, T) == [sp.sqrt(1 + alpha)]


def test_6_2_the_worn_tip_s_derivatives() -> None:
    critical = (sp.tan(theta) + 4 * sp.cot(theta)) / 3
    found = [sp.simplify(critical.diff(theta, n).subs(theta, sp.atan(2))) for n in (1, 2, 3)]
    assert found == [0, sp.Rational(25, 3), sp.Rational(75, 2)]


def test_6_5_the_ratio_of_the_eigenvalues_at_the_genot_brogliato_point() -> None:
    normal, coupling = rod_rows()
    compliance = (normal + mu * coupling).subs(inertia, m * l**2 / alpha)
    turning = (mu * l * sp.sin(theta) - l * sp.cos(theta)) / (m * l**2 / alpha)
    free = l * omega**2 * sp.sin(theta) - g_0
    slope = -compliance.diff(theta)  # p = p_1 x, x the distance before the edge
    ratio = (
        (turning * free.diff(omega) / (slope * omega))
        .subs(theta, sp.atan(T))
        .subs(mu, (1 + alpha + T**2) / (alpha * T))
    )
    assert vanishes(ratio - 2 * T**2 / (1 + alpha - T**2))
    drift = free.diff(theta).subs(omega, sp.sqrt(g_0 / (l * sp.sin(theta))))
    assert vanishes(drift - g_0 / sp.tan(theta))
    edge = ((1 + alpha + T**2) / (alpha * T)).subs(T, sp.sqrt((1 + alpha) / 3))  # where the ratio is 1
    assert vanishes(edge - 2 / sp.sqrt(3) * 2 * sp.sqrt(1 + alpha) / alpha)


def test_6_6_both_maps_are_solved_as_stated() -> None:
    r, d, place = sp.symbols("r d X", positive=True)

    def kept(x: sp.Expr) -> sp.Expr:
        return sp.gamma(x) / sp.gamma(x - r) + d * (x - 1) / (1 - r)

    assert vanishes(sp.gammasimp(kept(place - 1) - (kept(place) * (1 - r / (place - 1)) - d)))
    B = sp.Symbol("B", positive=True)  # the strict map with d = 0: L = 1/B
    following = place - 1 / B
    assert vanishes(following * (B - r / following) - (place * B - (1 + r)))


# --- section 10 ------------------------------------------------------------------------------------------------------

HALF = sp.Rational(5, 2)
SQUARE = [(HALF, -HALF), (HALF, HALF), (-HALF, HALF), (-HALF, -HALF)]
OCTAGON = [(4, 0), (3, 3), (0, 4), (-3, 3), (-4, 0), (-3, -3), (0, -4), (3, -3)]
SMALL = [(sp.Rational(3 * x, 8), sp.Rational(3 * y, 8)) for x, y in OCTAGON]
MANY = {
    "an octagon at gamma > 0, 5": (
        SMALL,
        [[38, 12, 21], [12, 45, -20], [21, -20, 29]],
        [-1, sp.Rational(37, 4), sp.Rational(-9, 2)],
        5,
        Sign.POSITIVE,
    ),
    "a square, 5": (
        SQUARE,
        [[11, 14, 15], [14, 36, 28], [15, 28, 25]],
        [-1, sp.Rational(-11, 2), -2],
        5,
        Sign.NEGATIVE,
    ),
    "an octagon, 7": (OCTAGON, [[17, 10, -5], [10, 17, -16], [-5, -16, 17]], [-1, -3, 5], 7, Sign.NEGATIVE),
}


@pytest.mark.parametrize(("vertices", "delassus", "velocity", "count", "sign"), MANY.values(), ids=MANY)
def test_10_1_coulomb_s_problem_on_a_polygon_can_have_more_than_three_solutions(
    vertices, delassus, velocity, count, sign
):
    """By exact enumeration; each solution satisfies the law to rounding."""
    G = sp.ImmutableMatrix(delassus)
    gamma = min(G[0, 0] + G[0, 1] * x + G[0, 2] * y for x, y in vertices)
    found = enumerate_solutions(
        ContactProblem(
            scene=painleve.load_scene("spatial_rod"),
            velocity=sp.ImmutableMatrix(velocity),
            constraint=exact_sign(sp.Integer(0)),
            gamma=exact_sign(gamma),
            delassus=G,
            contact_velocity=sp.ImmutableMatrix(velocity),
            responses=G,
            vertices=tuple(sp.ImmutableMatrix(v) for v in vertices),
            section_map=None,
        )
    )
    assert (len(found.solutions), found.enumeration) == (count, Enumeration.COMPLETE)
    assert found.gamma.sign is sign
    assert max(solution.residual for solution in found.solutions) < 1e-12
    impulses = np.array([solution.impulse for solution in found.solutions])
    apart = np.linalg.norm(impulses[:, None] - impulses[None], axis=2) + np.eye(count)
    assert apart.min() > 1e-3


def test_10_2_the_minimal_scene_s_inertia_loses_definiteness_on_the_unit_circle() -> None:
    scene = painleve.load_scene("minimal")
    state = painleve.make_state(scene, "isolated")
    x, y = scene.q
    rules = {s: value for s, value in state.substitution.items() if s not in scene.q}
    determinant = scene.inertia.det().xreplace(rules)
    assert vanishes(determinant - 1 / (4 - (1 + x**2 + y**2) ** 2))
