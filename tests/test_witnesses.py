"""Witnesses of eq. (10): each is checked by the law at high precision from its definition, inside both balls."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from planar_scenes import SCENE_NAMES
from reference_law import Reference, gamma_squared, law, norm, to_mp

from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.member import Member, make_member
from painleve.asymptotics.witness import find_family, find_witness
from painleve.core.codes import ContactMode
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import LimitSet, limit_set

DIGITS = 110  # more than the 320 bits of the enclosures that are checked
EPS = [1e-1, 1e-6, 1e-12]
APPROACHED = [
    ("slender_rod", "critical"),
    ("slender_rod", "double_zero"),
    ("worn_tip_rod", "approached"),
    ("two_link_arm", "approached"),
]
ISOLATED = [("worn_tip_rod", "isolated"), ("two_link_arm", "isolated")]
PARADOXES = [(scene, "paradox") for scene in SCENE_NAMES]
FRACTIONS = [1e-3, 0.25, 0.5, 0.9, 0.999]


@cache
def limit_of(scene: str, name: str) -> LimitSet:
    return limit_set(make_state(load_scene(scene), name))


@cache
def reference_of(scene: str) -> Reference:
    return Reference(load_scene(scene))


def exact_offset(limit: LimitSet, member: Member) -> mpmath.matrix:
    """S(q + dq, u- + dv) - u- by the definition, at the member's exact preimage."""
    dq, dv = member.preimage
    local = reference_of(limit.state.scene.name).at_state(limit.state, dq)
    u = [to_mp(x) for x in limit.state.u]
    S = law(local, [x + to_mp(y) for x, y in zip(u, dv, strict=True)])
    return mpmath.matrix([x - y for x, y in zip(S, u, strict=True)])


def jump_of(limit: LimitSet) -> list[mpmath.mpf]:
    return [to_mp(x) - to_mp(y) for x, y in zip(limit.u_tilde, limit.state.u, strict=True)]


def distance(limit: LimitSet, offset: mpmath.matrix, fraction: float) -> mpmath.mpf:
    share = to_mp(fraction)
    return norm([x - share * y for x, y in zip(offset, jump_of(limit), strict=True)])


def inside(member: Member, eps: float) -> bool:
    """Both offsets in their balls."""
    return all(norm([to_mp(x) for x in offset]) <= to_mp(eps) for offset in member.preimage)


@pytest.mark.parametrize(("scene", "name"), [("slender_rod", "paradox"), *APPROACHED, *ISOLATED])
def test_a_member_at_any_offset_is_the_law_of_the_definition_out_of_contact_too(scene, name):
    limit, rng = limit_of(scene, name), np.random.default_rng(3)
    problem, branches = make_local_problem(limit), set()
    for i in range(12):
        dq, dv = (1e-3 * rng.normal(size=len(limit.state.q)) for _ in range(2))
        member = make_member(problem, dq, dv if i % 2 else -np.abs(dv))
        branches.add(member.branch)
        with mpmath.workdps(DIGITS):
            offset = exact_offset(limit, member)
            found = [to_mp(x) for x in member.enclosure]
            assert norm([x - y for x, y in zip(offset, found, strict=True)]) < mpmath.mpf(10) ** -80
            out = reference_of(scene).at_state(limit.state, dq).g < 0
        assert not out or member.branch is ContactMode.FREE
    assert len(branches) > 1


@pytest.mark.parametrize("eps", EPS)
@pytest.mark.parametrize(("scene", "name"), APPROACHED)
def test_every_point_of_the_segment_of_an_approached_state_has_a_witness_that_the_definition_confirms(scene, name, eps):
    limit = limit_of(scene, name)
    for fraction in FRACTIONS:
        witness = find_witness(limit, fraction, eps, within=1e-3 * eps)
        assert witness.member is not None, witness.reason
        with mpmath.workdps(DIGITS):
            assert inside(witness.member, eps)
            local = reference_of(scene).at_state(limit.state, witness.member.preimage[0])
            assert local.g >= 0
            assert gamma_squared(local) > 0
            found = distance(limit, exact_offset(limit, witness.member), fraction)
            assert found <= to_mp(1e-3) * to_mp(eps)
            assert to_mp(witness.distance[0]) <= found <= to_mp(witness.distance[1])


@pytest.mark.parametrize("eps", EPS)
@pytest.mark.parametrize(("scene", "name"), PARADOXES + APPROACHED + ISOLATED)
def test_both_ends_of_a_have_witnesses_at_every_state_that_is_indeterminate(scene, name, eps):
    """u- is S(q, u-), and u_tilde is approached at q itself as v_n -> 0-."""
    limit = limit_of(scene, name)
    start, end = (find_witness(limit, fraction, eps, within=1e-3 * eps) for fraction in (0.0, 1.0))
    assert start.distance == (0.0, 0.0) or start.distance[1] < 1e-300
    assert not start.member.dq.any()
    assert not start.member.dv.any()
    assert end.member.branch is ContactMode.STICK
    assert not end.member.dq.any()
    with mpmath.workdps(DIGITS):
        assert inside(end.member, eps)
        found = distance(limit, exact_offset(limit, end.member), 1.0)
        assert found <= to_mp(1e-3) * to_mp(eps)
        assert to_mp(end.distance[0]) <= found <= to_mp(end.distance[1])


@pytest.mark.parametrize("eps", EPS)
@pytest.mark.parametrize(("scene", "name"), ISOLATED)
def test_no_interior_point_of_the_segment_of_an_isolated_state_has_a_witness_and_the_statement_says_why(
    scene, name, eps
):
    limit = limit_of(scene, name)
    witness = find_witness(limit, 0.5, eps, within=0.1 * float(np.linalg.norm(limit.jump)))
    assert witness.member is None
    assert witness.distance is None
    assert "none exists if q is isolated" in witness.reason
    assert find_family(limit, eps, within=1e-3 * eps) is None


@pytest.mark.parametrize("eps", EPS)
@pytest.mark.parametrize(("scene", "name"), APPROACHED)
def test_the_bound_of_a_family_bounds_the_distance_of_a_fine_grid_of_a_to_its_members(scene, name, eps):
    """Members between the two ends are formed by the definition from velocities between theirs."""
    limit = limit_of(scene, name)
    family = find_family(limit, eps, within=1e-3 * eps)
    assert family is not None
    assert family.bound <= 1e-3 * eps
    assert family.first.preimage[0] == family.last.preimage[0]
    first, last = (member.preimage[1] for member in (family.first, family.last))
    with mpmath.workdps(DIGITS):
        local = reference_of(scene).at_state(limit.state, family.first.preimage[0])
        u, jump = [to_mp(x) for x in limit.state.u], jump_of(limit)
        members = []
        for i in range(41):
            share = mpmath.mpf(i) / 40
            dv = [(1 - share) * to_mp(x) + share * to_mp(y) for x, y in zip(first, last, strict=True)]
            assert norm(dv) <= to_mp(eps)
            S = law(local, [x + y for x, y in zip(u, dv, strict=True)])
            members.append([x - y for x, y in zip(S, u, strict=True)])
        for i in range(101):
            point = [mpmath.mpf(i) / 100 * x for x in jump]
            nearest = min(to_segment(point, start, end) for start, end in pairwise(members))
            assert nearest <= to_mp(family.bound) * (1 + mpmath.mpf(10) ** -3)


def to_segment(point: list, start: list, end: list) -> mpmath.mpf:
    """Distance to a stretch between two neighbouring members, all of which are members too."""
    along, offset = ([x - y for x, y in zip(z, start, strict=True)] for z in (end, point))
    share = mpmath.fdot(offset, along) / mpmath.fdot(along, along)
    share = min(max(share, mpmath.mpf(0)), mpmath.mpf(1))
    return norm([x - share * y for x, y in zip(offset, along, strict=True)])


@pytest.mark.parametrize(("scene", "name"), PARADOXES)
def test_of_a_pair_no_point_but_its_ends_is_asked_for(scene, name):
    limit = limit_of(scene, name)
    with pytest.raises(InputError, match=r"fraction: 0.5 is not in A = \{u-, u_tilde\}"):
        find_witness(limit, 0.5, 0.1, within=0.1)
    family = find_family(limit, 1e-6, within=1e-9)
    assert family.bound <= 1e-9
    assert (family.first.branch, family.last.branch) == (ContactMode.FREE, ContactMode.STICK)


def test_where_nothing_is_indeterminate_u_minus_is_its_own_witness():
    limit = limit_of("slender_rod", "sliding")
    family = find_family(limit, 1e-3, within=1e-6)
    assert family.bound == 0.0
    assert find_witness(limit, 0.7, 1e-3, within=1e-6).distance[1] < 1e-300


@pytest.mark.parametrize(
    ("fraction", "eps", "within", "message"),
    [
        (-0.1, 0.1, 0.1, "fraction: -0.1 must be between"),
        (1.1, 0.1, 0.1, "fraction: 1.1 must be between"),
        (float("nan"), 0.1, 0.1, "fraction: nan must be"),
        (0.5, 0.0, 0.1, "eps: 0.0 must be a positive number"),
        (0.5, float("nan"), 0.1, "eps: nan must be"),
        (0.5, 0.1, -1.0, "within: -1.0 must be a positive number"),
    ],
)
def test_a_question_without_sense_is_refused_in_one_line(fraction, eps, within, message):
    with pytest.raises(InputError, match=message):
        find_witness(limit_of("slender_rod", "critical"), fraction, eps, within=within)
