"""No cancellation: near an exact state g, v_n, a + s b, S and distances against mpmath at 60 digits, down to 1e-12."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from planar_scenes import SCENE_NAMES
from reference_law import DIGITS, Reference, dot, law, norm, to_mp

from painleve.asymptotics.local import Arithmetic, LocalProblem, make_local_problem
from painleve.asymptotics.member import make_member
from painleve.asymptotics.optimise import OptimiseOptions, optimise_distance
from painleve.asymptotics.rates import rate
from painleve.asymptotics.sample import SampleOptions, _Stream
from painleve.core.sampling import BLOCK
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import LimitSet, limit_set

EPS = 1e-12
CORRECT = 1e-6  # relative
STATES = [(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states]


def named(scene: str, state: str) -> LimitSet:
    return limit_set(make_state(load_scene(scene), state))


def floats(problem: LocalProblem, dq: np.ndarray, dv: np.ndarray, eps: float, arithmetic: Arithmetic) -> list[float]:
    """g, v_n and a + s b on both edges in doubles, from differences of rows."""
    d, rows = problem.dimension, problem.kernels.rows
    x = (dq[list(problem.shape)] / eps)[:, None]
    change = problem.differences(eps, problem.expansion(eps, arithmetic), x)[:, 0]
    row = problem.base + change
    v_n = change[1 : 1 + d] @ problem.u + row[1 : 1 + d] @ dv
    return [change[0] + problem.carried * (problem.carried_direction @ dq), v_n] + [
        row[rows.index(edge)] for edge in ("edge_plus", "edge_minus")
    ]


def digits(limit: LimitSet, dq: np.ndarray, dv: np.ndarray) -> list[mpmath.mpf]:
    local = Reference(limit.state.scene).at_state(limit.state, list(dq))
    v = [to_mp(u) + to_mp(y) for u, y in zip(limit.state.u, dv, strict=True)]
    return [local.g, dot(local.w_n, mpmath.matrix(v)), *local.lifts()]


def errors(limit: LimitSet, eps: float, arithmetic: Arithmetic, count: int = 20) -> np.ndarray:
    """(count, 4) relative errors of g, v_n, a + mu_plus b and a - mu_minus b at random offsets."""
    problem, rng = make_local_problem(limit), np.random.default_rng(7)
    found = []
    for _ in range(count):
        dq, dv = (eps * x / np.linalg.norm(x) for x in rng.normal(size=(2, problem.dimension)))
        dq = eps * (dq / eps)  # as the product that the rows are evaluated at
        exact = digits(limit, dq, dv)
        close = floats(problem, dq, dv, eps, arithmetic)
        found.append([float(abs((to_mp(y) - x) / x)) for x, y in zip(exact, close, strict=True)])
    return np.array(found)


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_offsets_of_1e_12_leave_six_digits_of_g_of_the_normal_velocity_and_of_both_compliances(scene, state):
    with mpmath.workdps(DIGITS):
        assert np.max(errors(named(scene, state), EPS, "automatic")) < CORRECT


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_plain_evaluation_has_lost_them(scene, state):
    with mpmath.workdps(DIGITS):
        assert np.max(errors(named(scene, state), EPS, "plain")) > CORRECT


@pytest.mark.parametrize("eps", [1e-8, 1e-10, 1e-12])
def test_at_the_double_zero_plain_evaluation_loses_the_sign_of_gamma_and_the_expansion_keeps_it(eps):
    """gamma is positive on both sides of arctan 2, of the size of eps^2."""
    limit = named("slender_rod", "double_zero")
    problem = make_local_problem(limit)
    x = np.linspace(-1.0, 1.0, 400)[None, :]
    edge = problem.kernels.rows.index("edge_plus")
    signs = {}
    for arithmetic in ("automatic", "plain"):
        change = problem.differences(eps, problem.expansion(eps, arithmetic), x)
        signs[arithmetic] = np.mean(problem.base[edge] + change[edge] > 0.0)
    assert signs["automatic"] == 1.0
    assert signs["plain"] < 0.9


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_members_at_1e_12_and_their_distances_agree_with_60_digits(scene, state):
    limit = named(scene, state)
    problem = make_local_problem(limit)
    stream = _Stream(problem, EPS, SampleOptions(samples=BLOCK, threads=1))
    dq, dv, branch, along, beyond, across2 = stream.block(0)
    chosen = [i for code in np.unique(branch) for i in np.flatnonzero(branch == code)[:6]]
    with mpmath.workdps(DIGITS):
        reference = Reference(limit.state.scene)
        u = [to_mp(x) for x in limit.state.u]
        jump = [to_mp(x - y) for x, y in zip(limit.u_tilde, limit.state.u, strict=True)]
        length = norm(jump)
        for i in chosen:
            local = reference.at_state(limit.state, list(dq[:, i]))
            S = law(local, [x + to_mp(y) for x, y in zip(u, dv[:, i], strict=True)])
            z = [s - x for s, x in zip(S, u, strict=True)]
            t = mpmath.fdot(z, jump) / length if length > 0 else mpmath.mpf(0)
            rho = norm([x - t * y / length for x, y in zip(z, jump, strict=True)]) if length > 0 else norm(z)
            near = min(abs(t), abs(t - length))
            # Where S = u_tilde exactly, the rounding of offsets of the size of EPS is what is left.
            allowed = CORRECT * mpmath.sqrt(near**2 + rho**2) + 1e-14 * EPS
            assert abs(rho - mpmath.sqrt(to_mp(across2[i]))) <= allowed
            assert abs(abs(to_mp(along[i] if abs(t) < abs(t - length) else beyond[i])) - near) <= allowed
            member = make_member(problem, dq[:, i], dv[:, i])
            assert int(member.branch) == branch[i]
            assert max(abs(to_mp(x) - y) for x, y in zip(member.enclosure, z, strict=True)) <= 1e-40


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_the_distance_at_1e_12_is_the_rate_times_eps_to_nine_digits(scene, state):
    limit = named(scene, state)
    found = rate(limit)
    against = limit.ends if "tends to" in found.sentence else limit
    assert optimise_distance(against, EPS).excess_Aeps_A.bounds.lower / EPS == pytest.approx(found.C, rel=1e-9)


def test_the_plain_rows_put_the_distance_at_1e_12_out_by_more_than_a_millionth():
    """At the paradox, whose rate is sqrt(360 sqrt(105) + 6630)/60."""
    exact = float(mpmath.sqrt(360 * mpmath.sqrt(105) + 6630) / 60)
    estimates = {
        a: optimise_distance(named("slender_rod", "paradox"), EPS, OptimiseOptions(arithmetic=a)).settings["estimate"]
        for a in ("automatic", "plain")
    }
    assert estimates["automatic"] / EPS == pytest.approx(exact, rel=1e-9)
    assert abs(estimates["plain"] / EPS - exact) > 1e-6
