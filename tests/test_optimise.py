"""The method `optimise` against samples, a general-purpose optimiser and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from planar_scenes import SCENE_NAMES
from scipy.optimize import minimize

from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.optimise import OptimiseOptions, optimise_distance
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.core.codes import ContactMode
from painleve.core.farthest import farthest
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Coordinate, StateKey, make_scene
from painleve.mechanics.state import make_state
from painleve.sets import LineSegment
from painleve.theory.limit_set import LimitSet, limit_set

STATES = [(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states]
SPINNING = [  # keys of the rod with an angular velocity, one in each branch
    {"theta": "1", "slip": "-1", "omega": "3/4", "mu": "2"},
    {"theta": "atan(2)", "slip": "-2/3", "omega": "-1/2", "mu": "4/3"},
    {"theta": "atan(3 - sqrt(5))", "slip": "-1", "omega": "1/3", "mu": "2"},
    {"theta": "4/5", "slip": "3/2", "omega": "2", "mu": "1/3"},
]


def named(scene: str, state: str) -> LimitSet:
    return limit_set(make_state(load_scene(scene), state))


def spinning(keys: dict[str, str]) -> LimitSet:
    keys = dict(keys)
    mu = keys.pop("mu")
    return limit_set(make_state(load_scene("slender_rod"), keys=keys, parameters={"mu": mu}))


def random_cut_ball(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A (m, n), c (m,) and four unit normals with offsets; c vanishes or dominates now and then, A has rank one."""
    n, m = rng.integers(1, 4), rng.integers(1, 4)
    A = rng.normal(size=(m, n))
    if rng.random() < 0.3:
        A = np.outer(rng.normal(size=m), rng.normal(size=n))
    c = rng.normal(size=m) * rng.choice([0.0, 1e-6, 1.0, 10.0])
    normals = rng.normal(size=(4, n))
    return A, c, normals / np.linalg.norm(normals, axis=1)[:, None], 0.5 * rng.normal(size=4)


@pytest.mark.parametrize("count", range(5))
def test_no_point_of_a_cut_ball_is_farther_than_the_one_found_and_that_one_is_in_it(count):
    rng = np.random.default_rng(count)
    for _ in range(60):
        A, c, normals, offsets = random_cut_ball(rng)
        n, y = A.shape[1], np.zeros(A.shape[1])
        value = farthest(A, c, normals, offsets, count, n, 1.0, y)
        x = rng.normal(size=(20_000, n))
        x /= np.linalg.norm(x, axis=1)[:, None] * np.where(rng.random(len(x)) < 0.7, 1.0, 1.5)[:, None]
        inside = np.all(x @ normals[:count].T <= offsets[:count], axis=1)
        best = np.max(np.sum((x[inside] @ A.T + c) ** 2, axis=1), initial=-1.0)
        assert best <= (value * (1 + 1e-12) if value >= 0.0 else -1.0)
        if value >= 0.0:
            assert np.sum((A @ y + c) ** 2) == pytest.approx(value, rel=1e-12)
            assert np.linalg.norm(y) <= 1 + 1e-12
            assert np.all(normals[:count] @ y <= offsets[:count] + 2e-11)


def test_a_ball_that_the_half_spaces_miss_has_no_farthest_point():
    normals = np.array([[1.0, 0.0], [-1.0, 0.0]])
    assert farthest(np.eye(2), np.zeros(2), normals, np.array([-0.5, -0.5]), 2, 2, 1.0, np.zeros(2)) == -1.0
    assert farthest(np.eye(2), np.zeros(2), normals, np.array([-2.0, 3.0]), 2, 2, 1.0, np.zeros(2)) == -1.0


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("eps", [1e-1, 1e-4, 1e-8])
def test_no_sample_is_farther_than_the_member_that_optimising_finds(scene, state, eps):
    limit = named(scene, state)
    found = optimise_distance(limit, eps)
    for sampler in ("kronecker", "boundary"):
        sample = sample_distance(limit, eps, SampleOptions(samples=100_000, sampler=sampler, threads=1))
        assert sample.excess_Aeps_A.bounds.lower <= found.excess_Aeps_A.bounds.lower * (1 + 1e-9)
        if sample.excess_A_Aeps.bounds.upper and found.excess_A_Aeps.bounds.upper:
            assert found.excess_A_Aeps.bounds.upper <= sample.excess_A_Aeps.bounds.upper


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("eps", [1e-1, 1e-3, 1e-6, 1e-12])
def test_the_bound_is_a_true_member_that_attains_the_estimate_to_nine_digits(scene, state, eps):
    found = optimise_distance(named(scene, state), eps)
    member, estimate = found.excess_Aeps_A.member, found.settings["estimate"]
    assert found.excess_Aeps_A.bounds.lower == member.distance[0]
    assert found.excess_Aeps_A.bounds.side == "lower bound"
    assert member.distance[0] == pytest.approx(estimate, rel=1e-9)
    assert found.settings["estimated_error"] < 1e-9
    assert np.linalg.norm(member.dq) <= eps * (1 + 1e-15)
    assert np.linalg.norm(member.dv) <= eps * (1 + 1e-15)
    assert found.evaluations < 60_000


def distance_to(limit: LimitSet, points: np.ndarray) -> float:
    A = limit.point_set
    if isinstance(A, LineSegment):
        unit = A.direction
        along = np.clip((points - A.start) @ unit, 0.0, A.length)
        return float(np.linalg.norm(points - A.start - along * unit))
    return float(np.min(np.linalg.norm(points - A.members, axis=1)))


def slsqp(limit: LimitSet, eps: float, starts: int = 6) -> float:
    """max dist(S, A)/eps by scipy's SLSQP over (dq, dv) on each branch of the law, where a + s b is above rounding."""
    problem = make_local_problem(limit)
    d, at, rows = problem.dimension, problem.parts, np.empty(problem.base.size)

    def law(z: np.ndarray, branch: ContactMode) -> tuple[np.ndarray, list[float]]:
        """S on that branch, and what must be >= 0 for it to be S; all divided by eps."""
        v = problem.u + eps * z[d:]
        problem.kernels.rows_at(problem.q + eps * z[:d], problem.p, rows)
        w, H = rows[at.w_n], rows[at.H[0]]
        (b,), (C,), (minus, mu_plus, mu_minus) = rows[at.b], rows[at.C], rows[at.section]
        G, Y = np.array([[rows[at.a], b], [b, C]]), np.stack([rows[at.Y_n], rows[at.Y_t[0]]])
        v_n, stick = w @ v, -np.linalg.solve(G, [w @ v, H @ v])
        room = [rows[at.g] / eps, -v_n / eps, 1.0 - z[:d] @ z[:d], 1.0 - z[d:] @ z[d:]]
        edges, mu = {1: rows[at.edge_plus], -1: minus}, {1: mu_plus, -1: mu_minus}
        over = {s: s * stick[1] * edges[s] + mu[s] * v_n for s in (1, -1)}
        if branch is ContactMode.STICK:
            return v + stick @ Y, [*room, *(-over[s] / eps if edges[s] > 0.0 else 0.0 for s in (1, -1))]
        s = 1 if branch is ContactMode.SLIP_PLUS else -1
        lam = -v_n / edges[s] if edges[s] > 1e-300 else 0.0
        return v + lam * (Y[0] + s * mu[s] * Y[1]), [*room, over[s] / eps, (edges[s] - 1e-12) / eps]

    rng, best = np.random.default_rng(1), 1.0
    for branch in (ContactMode.STICK, ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS):
        for _ in range(starts):
            z = np.concatenate([x / np.linalg.norm(x) for x in rng.normal(size=(2, d))]) * rng.uniform(0.3, 1.0)
            with np.errstate(all="ignore"):
                result = minimize(
                    lambda z, b=branch: -distance_to(limit, law(z, b)[0]) / eps,
                    z,
                    method="SLSQP",
                    constraints={"type": "ineq", "fun": lambda z, b=branch: np.array(law(z, b)[1])},
                    options={"maxiter": 300, "ftol": 1e-15},
                )
                if min(law(result.x, branch)[1]) > -1e-11:
                    best = max(best, -float(result.fun))
    return best


CASES = [pytest.param(named(*s), id="-".join(s)) for s in STATES] + [
    pytest.param(spinning(keys), id=f"spin-{i}") for i, keys in enumerate(SPINNING)
]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Values in x were outside bounds")
@pytest.mark.parametrize("limit", CASES)
def test_a_general_purpose_optimiser_from_many_starts_finds_the_same_supremum(limit):
    eps = 0.03
    estimate = optimise_distance(limit, eps).settings["estimate"] / eps
    assert slsqp(limit, eps) == pytest.approx(estimate, rel=1e-9)


def test_the_middle_of_an_isolated_segment_stays_half_its_length_less_eps_over_two_away():
    """The tip of the arm that sticks stops the arm: members are u_tilde itself or within eps of u-."""
    limit = named("two_link_arm", "isolated")
    length = float(np.linalg.norm(limit.jump))
    for eps in (1e-2, 1e-5, 1e-9):
        upper = optimise_distance(limit, eps).excess_A_Aeps.bounds.upper
        assert upper == pytest.approx((length - eps) / 2, rel=1e-13)


@pytest.mark.parametrize(("scene", "state"), [s for s in STATES if s[1] != "isolated"])
def test_witnesses_bound_the_excess_of_A_by_less_than_a_thousandth_of_eps(scene, state):
    for eps in (1e-2, 1e-12):
        assert optimise_distance(named(scene, state), eps).excess_A_Aeps.bounds.upper <= 1e-3 * eps


def test_the_ends_of_a_segment_are_a_pair_that_members_stay_near_only_where_it_is_isolated():
    eps = 1e-3
    isolated, approached = named("worn_tip_rod", "isolated").ends, named("worn_tip_rod", "approached").ends
    assert optimise_distance(isolated, eps).excess_Aeps_A.bounds.lower < 2 * eps
    half = float(np.linalg.norm(approached.jump)) / 2
    assert optimise_distance(approached, eps).excess_Aeps_A.bounds.lower == pytest.approx(half, rel=2e-2)


def bead(height: sp.Expr, x: sp.Symbol) -> LimitSet:
    """A bead of mass 1 in the plane above a frictionless wall y >= height(x), sliding past x = 0 at unit speed."""
    coordinates = [Coordinate(name=n, unit="m", sentence=n) for n in ("x", "y")]
    u_x, u_y = (c.velocity for c in coordinates)
    scene = make_scene(
        name="bead",
        sentence="a bead on a wall",
        source="a test",
        coordinates=coordinates,
        parameters=(),
        kinetic_energy=(u_x**2 + u_y**2) / 2,
        constraint=height - coordinates[1].symbol,
        keys=[StateKey(name="speed", unit="m/s", sentence="speed along the wall", default="1")],
        placement={"x": sp.Integer(0), "y": height.subs(x, 0)},
        velocity={"x": sp.Symbol("speed", real=True)},
    )
    return limit_set(make_state(scene, keys={"speed": "1"}))


def test_without_friction_a_flat_wall_gives_eps_and_a_curved_one_what_brute_force_gives():
    x = sp.Symbol("x", real=True)
    eps = 0.05
    assert optimise_distance(bead(sp.Integer(0) * x, x), eps).settings["estimate"] == pytest.approx(eps, rel=1e-12)
    estimate = optimise_distance(bead(2 * x**2, x), eps).settings["estimate"]
    angle = np.linspace(0.0, 2 * np.pi, 4001)
    best = 0.0
    for dx in np.linspace(-eps, eps, 2001):  # contact is always possible: dy may be as low as -sqrt(eps^2 - dx^2)
        if 2 * dx**2 + np.sqrt(eps**2 - dx**2) < 0.0:
            continue
        normal = np.array([-4 * dx, 1.0]) / np.hypot(4 * dx, 1.0)
        v = np.array([[1.0], [0.0]]) + eps * np.stack([np.cos(angle), np.sin(angle)])
        S = v - np.outer(normal, np.minimum(normal @ v, 0.0))
        best = max(best, float(np.max(np.linalg.norm(S - [[1.0], [0.0]], axis=0))))
    assert best <= estimate * (1 + 1e-12)
    assert best == pytest.approx(estimate, rel=1e-5)
    assert estimate > 1.5 * eps


def test_what_cannot_be_optimised_is_refused_in_one_line():
    limit = named("slender_rod", "paradox")
    with pytest.raises(InputError, match=r"^eps: 0 must be a positive number$"):
        optimise_distance(limit, 0)
    with pytest.raises(InputError, match=r"^starts: 0 must be between"):
        OptimiseOptions(starts=0)
