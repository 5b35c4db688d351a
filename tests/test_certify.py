"""Enclosures of the distances between A_eps and A: against samples, a general optimiser, closed forms and mpmath."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import mpmath
import numpy as np
import pytest
import sympy as sp
from planar_scenes import SCENE_NAMES
from scipy.optimize import minimize

from painleve.asymptotics.certify.isolation import slips_nowhere
from painleve.asymptotics.certify.method import CertifyOptions, certify_distance
from painleve.asymptotics.certify.pieces import contact_pieces
from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.optimise import optimise_distance
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import limit_set

NAMED = [
    (scene, state.name)
    for scene in SCENE_NAMES
    for state in load_scene(scene).states
    if state.name in ("sliding", "paradox", "critical", "double_zero", "approached", "isolated")
]
COARSE = CertifyOptions(width=1e-3, budget=20_000)


def limit_of(scene, state=None, **given):
    return limit_set(make_state(load_scene(scene), state, **given))


@pytest.mark.parametrize(("scene", "state"), NAMED)
@pytest.mark.parametrize("eps", [1e-2, 1e-12])
def test_enclosures_hold_every_one_of_a_million_samples_at_every_named_state(scene, state, eps):
    limit = limit_of(scene, state)
    found = certify_distance(limit, eps, COARSE)
    sampled = sample_distance(limit, eps, SampleOptions(samples=1_000_000))
    forward, backward = found.excess_Aeps_A.bounds, found.excess_A_Aeps.bounds
    assert sampled.excess_Aeps_A.bounds.lower <= forward.upper
    assert backward.lower <= sampled.excess_A_Aeps.bounds.upper
    assert forward.relative_width <= 1e-3
    # and they are not wide because the sample is poor: it comes within a fifth of them
    assert sampled.excess_Aeps_A.bounds.lower >= 0.8 * forward.lower


@pytest.mark.parametrize(("scene", "state"), NAMED)
def test_the_relative_width_asked_for_is_reached_at_the_double_zero_as_at_every_state_of_a_rod(scene, state):
    if scene == "two_link_arm":
        return
    found = certify_distance(limit_of(scene, state), 1e-12, CertifyOptions(width=1e-6))
    assert found.excess_Aeps_A.bounds.relative_width <= 1e-6


def farthest_by_slsqp(limit, eps, known, starts, rng):
    """The largest distance that a general-purpose optimiser finds from a known preimage and from random ones, with the
    compiled law in plain doubles."""
    problem = make_local_problem(limit)
    d, law, value = problem.dimension, problem.kernels.law_at, np.empty(problem.dimension)

    def distance(x):
        law(problem.q + eps * x[:d], problem.p, problem.u + eps * x[d:], value)
        offset = value - problem.u
        along = offset @ problem.direction
        if limit.kind == "segment":
            return np.linalg.norm(offset - np.clip(along, 0.0, problem.length) * problem.direction)
        ends = [0.0] if limit.kind == "point" else [0.0, problem.length]
        return min(np.linalg.norm(offset - t * problem.direction) for t in ends)

    sizes = (lambda x: 1.0 - x[:d] @ x[:d], lambda x: 1.0 - x[d:] @ x[d:])
    balls = [{"type": "ineq", "fun": size} for size in sizes]
    best = 0.0
    for start in range(starts):
        x = rng.normal(size=2 * d) if start else np.concatenate([known.dq, known.dv]) / eps
        x /= np.repeat([np.linalg.norm(x[:d]), np.linalg.norm(x[d:])], d) if start else 1.0
        found = minimize(lambda x: -distance(x) / eps, x, method="SLSQP", constraints=balls, options={"maxiter": 60})
        for point in (x, found.x):
            lengths = [max(1.0, np.linalg.norm(point[:d])), max(1.0, np.linalg.norm(point[d:]))]
            best = max(best, distance(point / np.repeat(lengths, d)))
    return best


def random_rods():
    """Rods of every branch: mu below, on and above the critical friction, with and without a spin, worn or not."""
    rng = np.random.default_rng(5)
    for case in range(12):
        t = Fraction(int(rng.integers(6, 40)), 10)
        critical = (t + 4 / t) / 3
        mu = critical + Fraction(int(rng.integers(1, 8)), 10) * (0, 1, -1)[case % 3]
        omega, slip = Fraction(int(rng.integers(-5, 6)), 5) * (case % 2), Fraction(-int(rng.integers(5, 20)), 10)
        keys = {"theta": f"atan({t})", "slip": str(slip), "omega": str(omega)}
        if case < 8:
            yield "slender_rod", keys, {"mu": str(mu)}
        else:
            yield "worn_tip_rod", keys, {"mu_0": str(mu), "theta_0": f"atan({t})", "k": str(rng.integers(0, 9))}


@pytest.mark.allow_fp_errors
@pytest.mark.parametrize(("scene", "keys", "parameters"), list(random_rods()))
def test_enclosures_hold_what_slsqp_finds_from_many_starts_on_random_states(scene, keys, parameters):
    limit, eps = limit_of(scene, keys=keys, parameters=parameters), 1e-2
    certified = certify_distance(limit, eps, COARSE).excess_Aeps_A
    found = farthest_by_slsqp(limit, eps, certified.member, 40, np.random.default_rng(1))
    assert certified.bounds.lower * (1.0 - 1e-9) <= found <= certified.bounds.upper * (1.0 + 1e-9)


@pytest.mark.parametrize(("scene", "state"), [("slender_rod", "critical"), ("two_link_arm", "approached")])
def test_enclosures_nest_as_the_budget_grows(scene, state):
    limit = limit_of(scene, state)
    options = [CertifyOptions(width=1e-9, budget=n) for n in (600, 2_000, 6_000)]
    bounds = [certify_distance(limit, 1e-3, o).excess_Aeps_A.bounds for o in options]
    for wide, narrow in pairwise(bounds):
        assert narrow.lower <= narrow.upper <= wide.upper
        # a search that reached its width stops there, and one that did not has the optimiser's member
        assert wide.lower <= narrow.lower * (1.0 + 1e-9)
    assert bounds[-1].relative_width < bounds[0].relative_width


def test_where_the_budget_ends_the_lower_bound_is_no_less_than_what_the_optimiser_finds():
    """At mu just above the critical friction slips fill a sliver of the ball, which boxes do not find in time."""
    limit = limit_of("slender_rod", keys={"theta": "atan(2)", "slip": -1}, parameters={"mu": "4/3 + 10**-20"})
    found = certify_distance(limit, 0.1, CertifyOptions(budget=2_000)).excess_Aeps_A
    optimised = optimise_distance(limit, 0.1).excess_Aeps_A
    assert found.bounds.relative_width > 1e-6
    assert found.bounds.lower >= optimised.bounds.lower > 0.43
    assert optimised.bounds.lower <= found.bounds.upper


def test_the_rate_of_the_rod_in_the_negative_branch_is_the_norm_of_the_derivative_of_sticking():
    """S = e (e.Mv)/(e.Me), e the rotation about the tip: maximise over d theta = +-1 and |dv| <= 1 with dv_n <= 0."""
    x, theta = sp.Matrix(sp.symbols("x0:3", real=True)), sp.Symbol("theta", real=True)
    M, e = sp.diag(1, 1, sp.Rational(1, 3)), sp.Matrix([-sp.sin(theta), sp.cos(theta), 1])
    S = e * (e.T * M * x)[0] / (e.T * M * e)[0]
    at = {theta: sp.atan(2), x[0]: -1, x[1]: 0, x[2]: 0}
    c = np.array(S.diff(theta).subs(at).evalf(30), dtype=float).ravel()
    P = np.array(S.jacobian(x).subs(at).evalf(30), dtype=float)
    n = np.array([0.0, 1.0, -float(sp.cos(sp.atan(2)))])
    unit, m = np.linalg.svd(P)[0][:, 0], np.linalg.svd(P)[2][0] * np.linalg.svd(P)[1][0]
    values = []
    for turn in (1.0, -1.0):
        for sense in (1.0, -1.0):
            allowed = m if sense * m @ n <= 0.0 else m - (m @ n) / (n @ n) * n  # dv = sense * the best direction
            values.append(np.linalg.norm(turn * c + sense * np.linalg.norm(allowed) * unit))
    # d theta = -1 needs penetration, cos(theta) d theta - dy >= 0: impossible with |dq| = |d theta|
    rate = max(values[:2])
    bounds = certify_distance(limit_of("slender_rod", "paradox"), 1e-10).excess_Aeps_A.bounds
    assert bounds.lower / 1e-10 - 1e-6 <= rate <= bounds.upper / 1e-10 + 1e-6


@pytest.mark.parametrize("scene", ["worn_tip_rod", "two_link_arm"])
def test_in_the_isolated_branch_the_middle_of_A_stays_away_by_half_its_length(scene):
    limit = limit_of(scene, "isolated")
    half = np.linalg.norm(limit.jump) / 2.0
    for eps in (1e-1, 1e-3, 1e-6):
        bounds = certify_distance(limit, eps, COARSE).excess_A_Aeps.bounds
        assert bounds.lower > 0.5 * half
        assert bounds.relative_width < 1e-6
        assert abs(bounds.upper - half) <= 2.0 * eps
        ends = certify_distance(limit.ends, eps, COARSE)
        assert ends.excess_A_Aeps.bounds.upper == 0.0
        assert ends.hausdorff.upper <= 2.0 * eps


def test_near_the_threshold_of_isolation_a_large_ball_is_not_called_isolated():
    """k = 4.467 > 25/6: at eps = 0.1 a good part of the configurations has gamma > 0, at 1e-3 none has."""
    limit = limit_of("worn_tip_rod", keys={"theta": "atan(2)"}, parameters={"k": "4467/1000"})
    problem = make_local_problem(limit)
    assert not slips_nowhere(problem, 0.1)
    assert slips_nowhere(problem, 1e-3)
    wide, narrow = (certify_distance(limit, eps, COARSE).excess_A_Aeps.bounds for eps in (0.1, 1e-3))
    assert wide.lower == 0.0
    assert wide.upper > 0.0
    assert narrow.lower > 0.4 * np.linalg.norm(limit.jump)


@pytest.mark.parametrize(("scene", "state"), [k for k in NAMED if k[1] != "isolated"])
def test_the_hausdorff_distance_is_the_excess_of_the_members_wherever_all_of_A_is_shadowed(scene, state):
    found = certify_distance(limit_of(scene, state), 1e-4, COARSE)
    assert found.excess_A_Aeps.bounds.upper == 0.0
    assert found.hausdorff == found.excess_Aeps_A.bounds
    assert found.excess_Aeps_A.member.distance[0] == found.hausdorff.lower


@pytest.mark.parametrize("eps", [1e-1, 1e-6, 1e-12])
def test_the_functions_of_the_sticking_piece_agree_with_mpmath_within_their_remainders(eps):
    problem = make_local_problem(limit_of("slender_rod", "double_zero"))
    piece = next(contact_pieces(problem, eps))
    models = piece.models
    xi = np.linspace(-1.0, 1.0, 9)[:, None]
    values, _ = models.at(xi)
    with mpmath.workdps(60):
        base = mpmath.atan(2)
        target = stopped(base, (-1, 0, 0))
        for x, row in zip(xi[:, 0], values, strict=True):
            theta = base + mpmath.mpf(eps) * mpmath.mpf(float(x))
            columns = [stopped(theta, [int(i == j) for i in range(3)]) for j in range(3)]
            expected = [(s - t) / mpmath.mpf(eps) for s, t in zip(stopped(theta, (-1, 0, 0)), target, strict=True)]
            expected += [columns[j][i] for i in range(3) for j in range(3)]
            for j, value in enumerate(expected):
                allowed = models.remainder[j] + 1e-13 * models.size[j]
                assert abs(mpmath.mpf(float(row[j])) - value) <= allowed
                assert allowed < 1e-6


def stopped(theta, v):
    """P v for the uniform rod with m = l = 1: what is left is the rotation about the tip."""
    e, M = (-mpmath.sin(theta), mpmath.cos(theta), mpmath.mpf(1)), (1, 1, mpmath.mpf(1) / 3)
    share = sum(a * m * b for a, m, b in zip(e, M, v, strict=True)) / sum(a * m * a for a, m in zip(e, M, strict=True))
    return [share * x for x in e]


@pytest.mark.parametrize("options", [{"width": 0.0}, {"width": 1.5}, {"budget": 0}])
def test_options_out_of_range_are_refused_by_name(options):
    with pytest.raises(InputError, match=next(iter(options))):
        CertifyOptions(**options)


def test_a_ball_too_large_for_expansions_is_refused_in_one_line():
    with pytest.raises(InputError, match="too large at this state"):
        certify_distance(limit_of("slender_rod", "double_zero"), 3.0)
