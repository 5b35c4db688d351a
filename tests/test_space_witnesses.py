"""Friction in space: witnesses of eq. (10), verdicts on the named states, and the root of eps at gamma = 0."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from reference_law import to_mp
from space_scenes import CRITICAL, SCENES, STATES, Impulse, limit_of

from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.member import make_member
from painleve.asymptotics.methods import distance
from painleve.asymptotics.rates import rate
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.asymptotics.theorem import VerdictStatus, collect, judge, slope
from painleve.asymptotics.witness import find_family, find_witness
from painleve.errors import InputError
from painleve.mechanics.state import make_state
from painleve.theory.classification import Branch, classify
from painleve.theory.limit_set import LimitSet, limit_set

CRITICAL_STATES = [(scene, state) for scene, state in STATES if limit_of(scene, state).kind == "segment"]
ROOTS = [(s, x) for s, x in CRITICAL_STATES if limit_of(s, x).after != "sticks" and s != "square_rod"]
EPS = [1e-2, 1e-6, 1e-12]


def in_both_balls(member, eps: float) -> bool:
    with mpmath.workdps(110):
        return all(mpmath.norm([to_mp(x) for x in part]) <= to_mp(eps) for part in member.preimage)


def is_least(limit: LimitSet, member) -> bool:
    """The member is S at its exact preimage: it satisfies the conditions of least energy at 150 digits."""
    with mpmath.workdps(150):
        dq, dv = ([to_mp(x) for x in part] for part in member.preimage)
        v = [to_mp(x) + y for x, y in zip(limit.state.u, dv, strict=True)]
        S = [to_mp(x) + to_mp(y) for x, y in zip(limit.state.u, member.enclosure, strict=True)]
        impulse, tiny = Impulse(limit.state, list(member.preimage[0]), v, S), mpmath.mpf(10) ** -25
        assert len(dq) == len(v)
        if abs(impulse.normal_velocity) > tiny or impulse.residual > tiny:
            return False
        if mpmath.norm(impulse.velocity) < tiny:
            return True
        on_polygon = limit.state.scene.name == "square_rod"
        return impulse.is_least_on_polygon(tiny) if on_polygon else impulse.is_least_on_conic(tiny)


@pytest.mark.parametrize(("scene", "state"), CRITICAL_STATES)
@pytest.mark.parametrize("eps", EPS)
def test_a_witness_in_both_balls_comes_near_any_point_of_the_segment(scene, state, eps):
    limit = limit_of(scene, state)
    for fraction in (0.25, 0.9, 0.999999):
        witness = find_witness(limit, fraction, eps, within=1e-3 * eps)
        assert witness.member is not None
        assert in_both_balls(witness.member, eps)
        assert is_least(limit, witness.member)
        target = fraction * limit.jump
        assert np.linalg.norm(witness.member.offset - target) <= 1e-3 * eps * (1 + 1e-9) + 1e-15


@pytest.mark.parametrize(("scene", "state"), [(s, x) for s, x in STATES if limit_of(s, x).kind != "point"])
@pytest.mark.parametrize("eps", EPS)
def test_at_q_itself_a_slight_push_comes_near_the_end_of_the_jump(scene, state, eps):
    limit = limit_of(scene, state)
    witness = find_witness(limit, 1.0, eps, within=1e-3 * eps)
    assert witness.distance[1] <= 1e-3 * eps
    assert np.array_equal(witness.member.dq, np.zeros(5))
    assert in_both_balls(witness.member, eps)


@pytest.mark.parametrize(("scene", "state"), CRITICAL_STATES)
@pytest.mark.parametrize("eps", [1e-1, 1e-6])
def test_the_path_over_one_configuration_is_as_near_to_the_segment_as_its_bound_says(scene, state, eps):
    """Members between the two ends of the path, at velocities between theirs, leave no gap larger than the bound."""
    limit = limit_of(scene, state)
    problem = make_local_problem(limit)
    family = find_family(limit, eps, within=1e-3 * eps)
    assert family is not None
    assert family.bound <= 1e-3 * eps
    assert in_both_balls(family.first, eps)
    assert in_both_balls(family.last, eps)
    start, end = (member.preimage[1] for member in (family.first, family.last))
    dq, unit = list(family.first.preimage[0]), limit.jump / np.linalg.norm(limit.jump)
    places = []
    for share in np.linspace(0.0, 1.0, 41):
        dv = [(x + float(share) * (y - x)).mid() for x, y in zip(start, end, strict=True)]
        offset = make_member(problem, dq, dv).offset
        places.append(offset @ unit)
        beyond = np.clip(offset @ unit, 0.0, np.linalg.norm(limit.jump))
        if beyond == offset @ unit:
            assert np.linalg.norm(offset - beyond * unit) <= family.bound + 1e-15
    assert np.all(np.diff(places) > -family.bound)
    assert places[0] <= family.bound
    assert places[-1] >= np.linalg.norm(limit.jump) - family.bound


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_the_verdict_on_every_named_state_in_space_is_consistent(scene, state):
    found = classify(make_state(SCENES[scene], state))
    options = SampleOptions(samples=20_000)
    evidence = [
        collect(found, eps, lambda limit, radius: sample_distance(limit, radius, options)) for eps in (1e-3, 1e-5, 1e-7)
    ]
    verdict = judge(found, evidence)
    assert verdict.status is VerdictStatus.CONSISTENT
    expected = 0.5 if (scene, state) in ROOTS else 1.0
    assert verdict.slope == pytest.approx(expected, abs=0.03)
    kinds = {"sliding": Branch.NONE, "paradox": Branch.NEGATIVE, "oblique": Branch.NEGATIVE}
    assert found.branch is kinds.get(state, Branch.CRITICAL_APPROACHED)


@pytest.mark.parametrize(("scene", "state"), ROOTS)
def test_the_excess_at_an_oblique_critical_state_is_the_derived_constant_times_the_root_of_eps(scene, state):
    """The member at the derived offsets attains it; no sampled one exceeds it by more than the next order."""
    limit = limit_of(scene, state)
    problem, found = make_local_problem(limit), rate(limit)
    assert found.power == 0.5
    errors = []
    for eps in (1e-6, 1e-8, 1e-10):
        inside = 1.0 - 1e-12
        member = make_member(problem, eps * inside * found.dq, eps * inside * found.dv)
        errors.append(abs(member.distance[0] / (found.C * np.sqrt(eps)) - 1.0))
        sampled = sample_distance(limit, eps, SampleOptions(samples=50_000, sampler="boundary"))
        attained = sampled.excess_Aeps_A.bounds.lower / (found.C * np.sqrt(eps))
        assert 0.9 < attained < 1.0 + 10.0 * np.sqrt(eps)
    assert errors[-1] < 1e-4
    assert slope([1e-6, 1e-8, 1e-10], errors) == pytest.approx(0.5, abs=0.1)


def test_the_slopes_over_ten_decades_are_one_for_a_parallel_slip_and_one_half_for_an_oblique_one():
    eps = np.logspace(-2, -10, 5)
    for name, expected in (("critical", 1.0), ("critical_oblique", 0.5)):
        options = SampleOptions(samples=20_000)
        lower = [sample_distance(limit_of("spatial_rod", name), x, options).excess_Aeps_A.bounds.lower for x in eps]
        assert slope(eps, lower) == pytest.approx(expected, abs=0.01)


def test_as_the_slip_turns_parallel_the_constant_stays_and_the_eps_at_which_it_shows_shrinks_like_kappa_squared():
    """kappa, the tip's velocity across b after the jump, is 2 sin(pi - heading)."""
    constants = []
    for parts in (100, 1000):
        keys = {"theta": CRITICAL, "heading": f"{parts - 1}*pi/{parts}"}
        limit = limit_set(make_state(SCENES["spatial_rod"], keys=keys, parameters={"mu": 2}))
        problem, found = make_local_problem(limit), rate(limit)
        kappa = 2.0 * np.sin(np.pi / parts)
        constants.append(found.C)
        small, large = kappa**2 / 1000.0, kappa**2 * 100.0
        shares = [
            make_member(problem, eps * (1 - 1e-12) * found.dq, eps * (1 - 1e-12) * found.dv).distance[0]
            / (found.C * np.sqrt(eps))
            for eps in (small, large)
        ]
        assert shares[0] == pytest.approx(1.0, rel=1e-3)
        assert shares[1] < 0.1
    assert constants[0] == pytest.approx(constants[1], rel=1e-3)
    with pytest.raises(InputError, match="the jump ends in slip"):
        rate(limit_of("spatial_rod", "critical"))


def test_a_slip_parallel_to_b_has_the_root_as_well_where_the_jump_does_not_end_in_sticking():
    """On tilted axes of friction b is not an axis of Q: the slip along -b ends in slip."""
    limit = limit_of("spatial_rod_ellipse", "tilted")
    problem = make_local_problem(limit)
    assert problem.impulse.slip_across == 0.0
    assert limit.after != "sticks"
    assert rate(limit).power == 0.5


def test_a_polygon_has_the_rate_eps_where_the_disc_has_its_root():
    eps = np.logspace(-4, -10, 4)
    limit = limit_of("square_rod", "critical_oblique")
    lower = [sample_distance(limit, x, SampleOptions(samples=20_000)).excess_Aeps_A.bounds.lower for x in eps]
    assert slope(eps, lower) == pytest.approx(1.0, abs=0.01)


def test_certify_says_in_one_line_that_it_does_not_search_in_space():
    with pytest.raises(InputError, match="friction in space") as error:
        distance(limit_of("spatial_rod", "oblique"), 1e-3, "certify")
    assert "\n" not in str(error.value)
