"""Theorem 1: branches from exact arithmetic, the rates that it implies, and verdicts that say no more than is known."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from planar_scenes import SCENE_NAMES

from painleve.asymptotics.distance import Attained, Distance
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.asymptotics.theorem import Evidence, Verdict, VerdictStatus, collect, judge, slope
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.sets import Bounds
from painleve.theory.classification import Branch, Classification, classify
from painleve.theory.limit_set import LimitSet

BRANCHES = {
    ("slender_rod", "sliding"): Branch.NONE,
    ("slender_rod", "paradox"): Branch.NEGATIVE,
    ("slender_rod", "critical"): Branch.CRITICAL_APPROACHED,
    ("slender_rod", "double_zero"): Branch.CRITICAL_APPROACHED,
    ("worn_tip_rod", "sliding"): Branch.NONE,
    ("worn_tip_rod", "paradox"): Branch.NEGATIVE,
    ("worn_tip_rod", "approached"): Branch.CRITICAL_APPROACHED,
    ("worn_tip_rod", "isolated"): Branch.CRITICAL_ISOLATED,
    ("two_link_arm", "sliding"): Branch.NONE,
    ("two_link_arm", "paradox"): Branch.NEGATIVE,
    ("two_link_arm", "approached"): Branch.CRITICAL_APPROACHED,
    ("two_link_arm", "isolated"): Branch.CRITICAL_ISOLATED,
}
UNDECIDED_MU = "4/3 + 4*atan(1/5) - atan(1/239) - pi/4"  # Machin's zero
EPS = (1e-2, 1e-4, 1e-6)
REPRESENTATIVES = [("slender_rod", name) for name in ("sliding", "paradox", "critical", "double_zero")] + [
    ("worn_tip_rod", "isolated"),
    ("two_link_arm", "isolated"),
]


def sampled(limit: LimitSet, eps: float) -> Distance:
    return sample_distance(limit, eps, SampleOptions(samples=50_000, threads=1))


@cache
def classification_of(scene: str, name: str, **parameters: str) -> Classification:
    return classify(make_state(load_scene(scene), name, parameters=parameters))


@cache
def evidence_of(scene: str, name: str) -> tuple[Evidence, ...]:
    return tuple(collect(classification_of(scene, name), eps, sampled) for eps in EPS)


def verdict_of(scene: str, name: str) -> Verdict:
    return judge(classification_of(scene, name), evidence_of(scene, name))


# --- branches --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scene", "name"), BRANCHES)
def test_every_named_state_is_in_the_branch_that_its_sentence_says(scene, name):
    found = classification_of(scene, name)
    assert found.branch is BRANCHES[scene, name]
    assert found.reason
    assert found.as_dict()["branch"] == found.branch.value
    kinds = {Branch.NONE: "point", Branch.NEGATIVE: "pair"}
    assert found.as_dict()["limit_set"] == kinds.get(found.branch, "segment")


def test_every_named_state_of_the_library_is_in_the_table_above_or_is_known_for_another_reason():
    named = {(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states}
    assert named - set(BRANCHES) <= {("slender_rod", "stoss")}


@pytest.mark.parametrize("slip", ["0", "1"])
def test_with_u_tilde_equal_to_u_minus_there_is_no_branch_whatever_gamma(slip):
    for name in ("paradox", "critical"):
        found = classify(make_state(load_scene("slender_rod"), name, keys={"slip": slip}))
        assert found.branch is Branch.NONE
        assert "u_tilde = u-" in found.reason


@pytest.mark.parametrize(("mu", "reason"), [(UNDECIDED_MU, "undecided"), ("4/3", "")])
def test_what_is_undecided_of_the_limit_set_or_near_it_leaves_the_branch_undecided(mu, reason):
    """mu = 4/3 plus a zero that is not among the identities known: gamma has no sign then, and no branch is claimed."""
    found = classification_of("slender_rod", "double_zero", mu=mu)
    assert found.branch is (Branch.UNDECIDED if reason else Branch.CRITICAL_APPROACHED)
    assert reason in found.reason
    answer = found.as_dict()
    assert answer["limit_set"] == (None if reason else "segment")
    assert answer["sign_of_gamma"] == ("undecided" if reason else "zero")


@pytest.mark.parametrize(
    ("k", "branch"),
    [("2", Branch.CRITICAL_APPROACHED), ("25/6", Branch.CRITICAL_APPROACHED), ("6", Branch.CRITICAL_ISOLATED)],
)
def test_the_worn_tip_changes_branch_at_25_sixths(k, branch):
    assert classification_of("worn_tip_rod", "approached", k=k).branch is branch


# --- the rates of the theorem's limits -------------------------------------------------------------------------------


@pytest.mark.parametrize(("scene", "name"), REPRESENTATIVES)
def test_the_excess_of_a_eps_falls_like_eps_in_every_branch(scene, name):
    """d_H = C eps + o(eps) with C >= 1: free members alone give 1. At an isolated state: towards the ends of A."""
    isolated = BRANCHES[scene, name] is Branch.CRITICAL_ISOLATED
    known = [(e.ends if isolated else e.distance).excess_Aeps_A.bounds.lower for e in evidence_of(scene, name)]
    ratios = np.array(known) / EPS
    assert np.all(ratios > 0.9)
    assert np.all(ratios < 20.0)
    assert abs(slope(EPS, known) - 1.0) < 0.02
    assert verdict_of(scene, name).slope == slope(EPS, known)


@pytest.mark.parametrize(("scene", "name"), REPRESENTATIVES)
def test_sampled_evidence_is_consistent_with_the_theorem_and_claims_no_more(scene, name):
    verdict = verdict_of(scene, name)
    assert verdict.status is VerdictStatus.CONSISTENT, verdict.reason
    assert verdict.branch is BRANCHES[scene, name]


@pytest.mark.parametrize(("scene", "name"), [k for k, b in BRANCHES.items() if b is Branch.CRITICAL_ISOLATED])
def test_at_an_isolated_state_the_middle_of_a_stays_half_the_segment_away_up_to_eps(scene, name):
    half = float(np.linalg.norm(classification_of(scene, name).limit.jump)) / 2.0
    for e in evidence_of(scene, name):
        assert abs(e.distance.excess_A_Aeps.bounds.upper - half) < 2.0 * e.eps
        assert e.witnessed is None
        assert e.ends.excess_A_Aeps.bounds.upper < 2.0 * e.eps


@pytest.mark.parametrize(("scene", "name"), REPRESENTATIVES[:4])
def test_elsewhere_witnesses_shadow_a_within_a_thousandth_of_eps(scene, name):
    for e in evidence_of(scene, name):
        assert e.witnessed <= 1e-3 * e.eps


def test_the_hard_critical_state_is_not_misjudged_though_the_sampled_bound_on_indeterminacy_grows():
    """Slips are O(eps) rare: a sample of fixed size loses them, and its bound on e(A, A_eps) grows. The bound is true
    and proves nothing; the witnesses decide."""
    found = classification_of("slender_rod", "double_zero")
    options = SampleOptions(samples=20_000, sampler="uniform", threads=1)
    evidence = [collect(found, eps, lambda limit, e: sample_distance(limit, e, options)) for eps in (1e-1, 1e-2, 1e-3)]
    bounds = [e.distance.excess_A_Aeps.bounds for e in evidence]
    slips = [e.distance.counts["slip_plus"] + e.distance.counts["slip_minus"] for e in evidence]
    assert bounds[0].upper < bounds[1].upper < bounds[2].upper
    assert all(b.lower is None for b in bounds)
    assert slips[0] > 4 * slips[1] > 16 * slips[2]
    verdict = judge(found, evidence)
    assert verdict.status is VerdictStatus.CONSISTENT
    assert abs(verdict.slope - 1.0) < 0.1


@pytest.mark.parametrize("nudge", ["-1e-8", "+1e-8"])
def test_a_friction_so_near_to_critical_that_eps_does_not_resolve_it_is_undecided_and_not_refuted(nudge):
    """A is a point or a pair there, while A_eps still fills the segment: only much smaller eps can tell."""
    found = classification_of("slender_rod", "double_zero", mu=f"4/3 {nudge}")
    assert found.branch is (Branch.NONE if nudge.startswith("-") else Branch.NEGATIVE)
    evidence = [collect(found, eps, sampled) for eps in (1e-1, 1e-2)]
    verdict = judge(found, evidence)
    assert verdict.status is VerdictStatus.UNDECIDED
    assert "smaller ones are needed" in verdict.reason
    # gamma ~ 1e-8: at gamma > 0 slips reach u_tilde until |v_n| <= eps is below lambda_tilde gamma
    finer = [collect(found, eps, sampled) for eps in (1e-10, 1e-11, 1e-12)]
    assert judge(found, finer).status is VerdictStatus.CONSISTENT


def test_an_isolated_state_just_above_the_threshold_is_not_refuted_by_balls_that_are_too_large():
    """k = 4.467 against 25/6: at eps = 0.1 gamma > 0 still occurs, and members shadow all of A."""
    found = classification_of("worn_tip_rod", "isolated", k="4467/1000")
    evidence = [collect(found, eps, sampled) for eps in (1e-1, 8e-2)]
    assert judge(found, evidence).status is VerdictStatus.UNDECIDED
    finer = [collect(found, eps, sampled) for eps in (1e-3, 1e-4)]
    assert judge(found, finer).status is VerdictStatus.CONSISTENT


# --- verdicts on made-up evidence ------------------------------------------------------------------------------------


def made_up(found: Classification, eps: float, forward: Bounds, backward: Bounds, ends: Bounds) -> Evidence:
    def distance(excess: Bounds, other: Bounds) -> Distance:
        return Distance(
            limit=found.limit,
            eps=eps,
            method="made up",
            excess_Aeps_A=Attained(bounds=excess),
            excess_A_Aeps=Attained(bounds=other),
            counts={},
            evaluations=0,
            ending="made up",
        )

    known = found.branch is not Branch.CRITICAL_ISOLATED
    return Evidence(
        eps=eps,
        distance=distance(forward, backward),
        ends=distance(ends, Bounds.unknown()),
        witnessed=1e-4 * eps if known else None,
    )


def verdict_on(state: tuple[str, str], forward, backward, ends=None) -> VerdictStatus:
    """Of bounds that are functions of eps, at three eps."""
    found = classification_of(*state)
    evidence = [made_up(found, e, forward(e), backward(e), (ends or forward)(e)) for e in (1e-2, 1e-3, 1e-4)]
    return judge(found, evidence).status


POSITIVE_BRANCHES = [("slender_rod", "sliding"), ("slender_rod", "paradox"), ("slender_rod", "double_zero")]
ISOLATED = ("worn_tip_rod", "isolated")
HALF = float(np.linalg.norm(classification_of(*ISOLATED).limit.jump)) / 2.0


@pytest.mark.parametrize("state", POSITIVE_BRANCHES)
def test_only_enclosures_that_shrink_with_eps_prove(state):
    def nothing(e: float) -> Bounds:
        return Bounds.exactly(0.0)

    assert verdict_on(state, lambda e: Bounds.between(e, 2 * e), nothing) is VerdictStatus.PROVED
    assert verdict_on(state, Bounds.at_least, nothing) is VerdictStatus.CONSISTENT
    assert verdict_on(state, lambda e: Bounds.between(e, 0.5), nothing) is VerdictStatus.CONSISTENT
    assert verdict_on(state, lambda e: Bounds.between(e, 2 * e) if e > 1e-4 else Bounds.at_least(e), nothing) is (
        VerdictStatus.CONSISTENT
    )


@pytest.mark.parametrize("state", POSITIVE_BRANCHES)
def test_part_of_a_that_members_provably_miss_refutes_because_balls_are_nested(state):
    assert (
        verdict_on(state, lambda e: Bounds.between(e, 2 * e), lambda e: Bounds.between(0.2, 0.3))
        is VerdictStatus.REFUTED
    )
    assert verdict_on(state, Bounds.at_least, Bounds.at_least) is VerdictStatus.REFUTED
    # an upper bound forbids nothing, however large
    assert verdict_on(state, Bounds.at_least, lambda e: Bounds.at_most(0.4)) is VerdictStatus.CONSISTENT


@pytest.mark.parametrize("state", [*POSITIVE_BRANCHES, ISOLATED])
def test_members_that_do_not_come_nearer_decide_nothing(state):
    assert verdict_on(state, lambda e: Bounds.at_least(0.3), lambda e: Bounds.at_most(HALF)) is VerdictStatus.UNDECIDED


@pytest.mark.parametrize("state", [*POSITIVE_BRANCHES, ISOLATED])
def test_missing_evidence_decides_nothing(state):
    def unknown(e: float) -> Bounds:
        return Bounds.unknown()

    found = classification_of(*state)
    assert verdict_on(state, unknown, unknown) is VerdictStatus.UNDECIDED
    assert judge(found, []).status is VerdictStatus.UNDECIDED
    one = made_up(found, 1e-3, Bounds.exactly(1e-3), Bounds.exactly(0.0), Bounds.exactly(1e-3))
    assert judge(found, [one, one]).status is VerdictStatus.UNDECIDED
    assert judge(found, [one]).slope is None


@pytest.mark.parametrize("state", POSITIVE_BRANCHES)
def test_a_repeated_eps_counts_once(state):
    """The bounds fall like eps^1 between the first two, and not at all to the third."""
    found = classification_of(*state)
    sizes = {1e-2: 1e-2, 1e-3: 1e-3, 1e-4: 1e-3}
    evidence = [made_up(found, e, Bounds.at_least(x), Bounds.exactly(0.0), Bounds.exactly(x)) for e, x in sizes.items()]
    once = judge(found, evidence)
    assert once.slope == pytest.approx(0.5)
    for repeated in (
        [*evidence, evidence[2], evidence[2]],
        [evidence[0], *evidence],
        [e for e in evidence for _ in "ab"],
    ):
        assert judge(found, repeated) == once


def test_without_witnesses_indeterminacy_is_not_decided():
    found = classification_of("slender_rod", "double_zero")
    evidence = [made_up(found, e, Bounds.exactly(e), Bounds.at_most(e), Bounds.exactly(e)) for e in (1e-2, 1e-3)]
    blind = [Evidence(eps=e.eps, distance=e.distance, ends=e.ends, witnessed=None) for e in evidence]
    verdict = judge(found, blind)
    assert verdict.status is VerdictStatus.UNDECIDED
    assert "no witnesses" in verdict.reason


@pytest.mark.parametrize("state", [*POSITIVE_BRANCHES, ISOLATED])
@pytest.mark.parametrize(
    ("power", "enough"), [(0.0, False), (0.1, False), (0.3, False), (0.45, False), (0.55, True), (1.0, True)]
)
def test_members_have_to_come_nearer_like_the_root_of_eps_at_least(state, power, enough):
    """In the plane the theorem's rate is eps; half of it is asked for, of lower bounds and of enclosures alike."""
    half = HALF if state == ISOLATED else 0.0

    def members(e: float) -> Bounds:
        return Bounds.between(e**power, 2 * e**power)

    def known(e: float) -> Bounds:
        return Bounds.between(max(0.0, half - 2 * e**power), half)

    assert verdict_on(state, lambda e: Bounds.at_least(e**power), lambda e: Bounds.at_most(half)) is (
        VerdictStatus.CONSISTENT if enough else VerdictStatus.UNDECIDED
    )
    assert verdict_on(state, members, known) is (VerdictStatus.PROVED if enough else VerdictStatus.UNDECIDED)
    # and upper bounds that do not fall fast enough prove nothing, whatever the lower ones do
    slow = verdict_on(state, lambda e: Bounds.between(e, 5 * e**power), known)
    assert slow is (VerdictStatus.PROVED if enough else VerdictStatus.CONSISTENT)


@pytest.mark.parametrize(("power", "enough"), [(0.3, False), (0.38, False), (0.45, True), (0.5, True)])
def test_in_space_at_gamma_zero_the_rate_is_the_root_of_eps_and_less_is_asked_for(power, enough):
    found = classification_of("spatial_rod", "critical")
    evidence = [
        made_up(found, e, Bounds.at_least(e**power), Bounds.unknown(), Bounds.unknown()) for e in (1e-2, 1e-3, 1e-4)
    ]
    assert judge(found, evidence).status is (VerdictStatus.CONSISTENT if enough else VerdictStatus.UNDECIDED)
    paradox = classification_of("spatial_rod", "paradox")
    elsewhere = [
        made_up(paradox, e.eps, Bounds.at_least(e.eps**power), Bounds.unknown(), Bounds.unknown()) for e in evidence
    ]
    expected = VerdictStatus.CONSISTENT if power >= 0.5 else VerdictStatus.UNDECIDED
    assert judge(paradox, elsewhere).status is expected


def test_an_isolated_state_is_proved_by_enclosures_of_both_parts_of_its_statement_alone():
    def near_ends(e: float) -> Bounds:
        return Bounds.between(e, 2 * e)

    def away(e: float) -> Bounds:
        return Bounds.between(HALF - 2 * e, HALF)

    assert verdict_on(ISOLATED, near_ends, away) is VerdictStatus.PROVED
    assert verdict_on(ISOLATED, near_ends, lambda e: Bounds.at_most(HALF)) is VerdictStatus.CONSISTENT
    assert verdict_on(ISOLATED, near_ends, lambda e: Bounds.between(0.0, HALF)) is VerdictStatus.CONSISTENT
    assert verdict_on(ISOLATED, Bounds.at_least, away) is VerdictStatus.CONSISTENT
    assert verdict_on(ISOLATED, near_ends, lambda e: Bounds.unknown()) is VerdictStatus.UNDECIDED
    assert verdict_on(ISOLATED, near_ends, lambda e: Bounds.at_most(0.1 * HALF)) is VerdictStatus.UNDECIDED
    assert verdict_on(ISOLATED, near_ends, lambda e: Bounds.at_least(1.1 * HALF)) is VerdictStatus.REFUTED
    # half the length is rounded: what exceeds it by rounding refutes nothing, what exceeds it by more does
    rounded, more = (Bounds.at_least(HALF * (1.0 + x)) for x in (5e-13, 1e-11))
    assert verdict_on(ISOLATED, near_ends, lambda e: rounded) is VerdictStatus.PROVED
    assert verdict_on(ISOLATED, near_ends, lambda e: more) is VerdictStatus.REFUTED


def test_an_undecided_branch_stays_undecided_whatever_is_measured():
    found = classification_of("slender_rod", "sliding")
    undecided = Classification(branch=Branch.UNDECIDED, limit=found.limit, neighbours=None, reason="no proof")
    evidence = [made_up(undecided, e, *[Bounds.exactly(e)] * 3) for e in (1e-2, 1e-3)]
    assert judge(undecided, evidence).status is VerdictStatus.UNDECIDED


def test_the_slope_of_a_power_is_its_exponent_and_zeros_are_left_out():
    eps = [1e-1, 1e-2, 1e-3]
    assert slope(eps, [3 * e**0.75 for e in eps]) == pytest.approx(0.75, rel=1e-12)
    assert slope(eps, [0.0, 1e-2, 1e-3]) == pytest.approx(1.0, rel=1e-12)
    assert slope(eps, [0.0, 0.0, 1.0]) is None
    assert slope([1e-2, 1e-2], [1.0, 2.0]) is None
