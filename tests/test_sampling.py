"""What the sampler of A_eps promises: true members, the same on any number of threads, and the extremal ones kept."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from fractions import Fraction
from functools import cache

import flint
import numpy as np
import pytest
from planar_scenes import SCENE_NAMES
from scipy import stats

from painleve import sets
from painleve.asymptotics.distance import Distance
from painleve.asymptotics.local import LocalProblem, make_local_problem
from painleve.asymptotics.member import make_member, row_balls
from painleve.asymptotics.sample import BINS, KINDS, SAMPLERS, SampleOptions, _Stream, sample_distance, sample_members
from painleve.core.codes import ContactMode
from painleve.core.reduce import distance_squared
from painleve.core.sampling import BLOCK
from painleve.core.sections.segment import SegmentBase, SegmentChange, SegmentContact, segment_impulse, split
from painleve.core.taylor import monomial_block, polynomial_block, sparse_polynomials
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import limit_set

STATES = [(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states]
RADII = (1e-1, 1e-4, 1e-8, 1e-12)
KINDS_OF_STATE = [
    ("slender_rod", "sliding"),
    ("slender_rod", "paradox"),
    ("slender_rod", "critical"),
    ("two_link_arm", "approached"),
]
SAMPLES = 20_000
SIGNIFICANCE = 1e-3
UNCHANGED = SegmentChange(0.0, 0.0, 0.0, 0.0, 0.0)
BIN_EDGE = 1e-9  # of a bin's width: how near to its edge another rounding may move a sample to the next bin


@cache
def problem_of(scene: str, state: str) -> LocalProblem:
    return make_local_problem(limit_set(make_state(load_scene(scene), state)))


def some_samples(problem: LocalProblem, eps: float, sampler: str, step: int = 21) -> list[tuple[np.ndarray, ...]]:
    """(dq, dv, branch, along, beyond, across2) of every `step`-th sample of one block."""
    block = _Stream(problem, eps, SampleOptions(sampler=sampler, seed=5)).block(1000 * BLOCK)
    return [tuple(x[..., i] for x in block) for i in range(0, BLOCK, step)]


def fingerprint(distance: Distance) -> str:
    """Every bit of a result: counts, bounds, and both extremal samples with their preimages."""
    attained = [distance.excess_Aeps_A, distance.excess_A_Aeps]
    numbers = [
        [m.dq.tobytes().hex(), m.dv.tobytes().hex(), m.offset.tobytes().hex()]
        for m in (a.member for a in attained)
        if m is not None
    ]
    bounds = [str(a.bounds.as_dict()) for a in attained]
    return json.dumps([dict(distance.counts), bounds, numbers])


# --- members ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("eps", RADII)
def test_the_law_through_blocks_is_the_law_in_ball_arithmetic(scene: str, state: str, eps: float):
    """Branch for branch. The balls evaluate the definition at 320 bits from the exact state and share no formula.

    Distances to A agree to 1e-9, which is what the offsets are for: plain double precision errs by 1e-16/eps. Beside it
    stands 1e-13 eps, because a distance can vanish: the arm that sticks stands still, and u_tilde is rest.
    """
    problem = problem_of(scene, state)
    for sampler in SAMPLERS:
        for dq, dv, branch, along, beyond, across2 in some_samples(problem, eps, sampler):
            member = make_member(problem, dq, dv)
            assert member.branch == branch
            squared = distance_squared(KINDS[problem.limit.kind], float(along), float(beyond), float(across2))
            assert math.sqrt(squared) == pytest.approx(member.distance[0], rel=1e-9, abs=1e-13 * eps)


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("eps", [1e-1, 1e-12])
def test_every_sample_is_in_both_closed_balls_and_in_contact_where_it_claims_to_be(scene: str, state: str, eps: float):
    """In rational arithmetic, the coordinates that carry the contact included; g >= 0 in ball arithmetic."""
    problem, squared = problem_of(scene, state), Fraction(eps) ** 2
    for sampler in SAMPLERS:
        for dq, dv, branch, *_ in some_samples(problem, eps, sampler, step=5):
            assert sum(Fraction(float(x)) ** 2 for x in dq) <= squared
            assert sum(Fraction(float(x)) ** 2 for x in dv) <= squared
            if branch != ContactMode.FREE:
                assert row_balls(problem, [flint.arb(float(x)) for x in dq])[0] >= 0


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_samples_come_near_to_the_spheres_of_both_balls(sampler: str):
    """The margin that keeps samples inside is of the order of rounding: points within 1% of both spheres are drawn."""
    members = sample_members(
        problem_of("slender_rod", "paradox").limit, 1e-3, SampleOptions(samples=SAMPLES, sampler=sampler)
    )
    assert np.linalg.norm(members["dv"], axis=1).max() > 0.99e-3
    assert np.linalg.norm(members["dq"], axis=1).max() > 0.99e-3


# --- reproducible ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scene", "state"), KINDS_OF_STATE)
@pytest.mark.parametrize("sampler", SAMPLERS)
def test_one_two_and_five_threads_give_the_same_bits(scene: str, state: str, sampler: str):
    """Four lanes of blocks, the last one cut in the middle of a block."""
    limit = problem_of(scene, state).limit
    results = [
        fingerprint(sample_distance(limit, 1e-2, SampleOptions(samples=2_500_001, sampler=sampler, threads=n)))
        for n in (1, 2, 5)
    ]
    assert results[1:] == results[:1] * 2


INTERPRETED = """
import sys, warnings
warnings.simplefilter("ignore")  # integers of NumPy warn where they wrap, as those of the sequence are meant to
sys.path.insert(0, {tests!r})
import test_sampling
print(test_sampling.two_small_results())
"""


def two_small_results() -> str:
    cases, samples = (("critical", "kronecker"), ("paradox", "uniform")), BLOCK + 100
    limits = [problem_of("slender_rod", state).limit for state, _ in cases]
    options = [SampleOptions(samples=samples, sampler=sampler, threads=1) for _, sampler in cases]
    return "\n".join(fingerprint(sample_distance(x, 1e-2, o)) for x, o in zip(limits, options, strict=True))


def test_compiled_and_interpreted_kernels_give_the_same_bits():
    """No fast-math: the compiler neither reorders sums nor fuses products, so Python's own arithmetic must agree."""
    interpreted = _run(INTERPRETED, NUMBA_DISABLE_JIT="1")
    assert interpreted == two_small_results()


def _run(code: str, **environment: str) -> str:
    command = [sys.executable, "-c", code.format(tests=os.path.dirname(__file__))]
    run = subprocess.run(command, env=os.environ | environment, text=True, check=True, capture_output=True)
    return run.stdout.strip()


@pytest.mark.parametrize("samples", [1, BLOCK - 1, BLOCK, BLOCK + 1, 10 * BLOCK + 7])
@pytest.mark.parametrize(("scene", "state"), KINDS_OF_STATE)
def test_every_sample_is_counted_once(scene: str, state: str, samples: int):
    distance = sample_distance(problem_of(scene, state).limit, 1e-2, SampleOptions(samples=samples))
    assert sum(distance.counts.values()) == samples == distance.evaluations


MEMORY = """
import resource, sys
sys.path.insert(0, {tests!r})
from test_sampling import SampleOptions, problem_of, sample_distance
limit, peaks = problem_of("slender_rod", "critical").limit, []
for samples in (10**6, 10**8):
    sample_distance(limit, 1e-3, SampleOptions(samples=samples, threads=2))
    peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
print((peaks[1] - peaks[0]) * 1024)
"""


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="ru_maxrss counts in kibibytes on Linux alone")
def test_a_hundred_million_samples_need_no_more_memory_than_a_million():
    """One byte a sample would be 10^8."""
    assert int(_run(MEMORY)) < 10**7


# --- extremal samples ------------------------------------------------------------------------------------------------


def brute_force(problem: LocalProblem, eps: float, sampler: str) -> tuple[dict[str, np.ndarray], sets.Cloud]:
    """The same points, S by its plain definition one point at a time, and the cloud of their values."""
    members = sample_members(problem.limit, eps, SampleOptions(samples=SAMPLES, sampler=sampler))
    return members, sets.Cloud(problem.u + members["offset"])


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("sampler", SAMPLERS)
def test_the_sample_kept_is_the_farthest_of_all(scene: str, state: str, sampler: str):
    problem, eps = problem_of(scene, state), 1e-1
    attained = sample_distance(problem.limit, eps, SampleOptions(samples=SAMPLES, sampler=sampler)).excess_Aeps_A
    members, cloud = brute_force(problem, eps, sampler)
    farthest = sets.excess(cloud, problem.limit.point_set)
    assert attained.bounds.lower == pytest.approx(farthest.bounds.lower, rel=1e-12)
    assert attained.member is not None
    # Where all that stick stand still, many are the farthest but for rounding: the one kept must be one of them.
    index = int(np.argmin(np.abs(members["dv"] - attained.member.dv).sum(axis=1)))
    assert np.array_equal(members["dv"][index], attained.member.dv)
    assert np.array_equal(members["dq"][index], attained.member.dq)
    own = sets.excess(sets.Points(cloud.members[index : index + 1]), problem.limit.point_set).bounds.upper
    assert own == pytest.approx(farthest.bounds.lower, rel=1e-12)


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("sampler", SAMPLERS)
def test_the_excess_of_A_is_that_from_the_same_samples_but_for_the_bins(scene: str, state: str, sampler: str):
    """For points and pairs the two are equal; along a segment the best sample of each bin is kept, and what is left
    out can only enlarge the bound."""
    problem, eps = problem_of(scene, state), 1e-1
    bound = sample_distance(problem.limit, eps, SampleOptions(samples=SAMPLES, sampler=sampler)).excess_A_Aeps.bounds
    members, cloud = brute_force(problem, eps, sampler)
    every = sets.excess(problem.limit.point_set, cloud).bounds.upper
    if problem.limit.kind != "segment":
        assert bound.upper == pytest.approx(every, rel=1e-9)
        return
    assert bound.upper >= every * (1.0 - 1e-9)
    assert bound.upper == pytest.approx(_excess_by_bins(problem, members["offset"]), rel=1e-9)


def _excess_by_bins(problem: LocalProblem, offset: np.ndarray) -> float:
    """The bound again, by sorting: of each bin the sample nearest to the line, and those nearest to either end."""
    t = offset @ problem.direction
    rho = np.linalg.norm(offset - t[:, None] * problem.direction, axis=1)
    place = t * BINS / problem.length
    inner = place[(place > 0.5) & (place < BINS - 0.5)]
    assert np.abs(inner - np.round(inner)).min() > BIN_EDGE  # else the comparison could depend on rounding
    bins = np.clip(place.astype(int), 0, BINS - 1)
    order = np.lexsort((np.arange(len(t)), rho, bins))
    kept = list(order[np.unique(bins[order], return_index=True)[1]])
    kept += [int(np.argmin(rho**2 + t**2)), int(np.argmin(rho**2 + (t - problem.length) ** 2))]
    segment = sets.LineSegment(np.zeros(2), np.array([problem.length, 0.0]))
    return float(sets.excess(segment, sets.Cloud(np.stack([t[kept], rho[kept]], axis=1))).bounds.upper)


def test_slips_at_the_double_zero_are_as_rare_as_once_measured():
    """Section 6 of docs/theory.md: of 20,000 uniform samples 183, 15 and 1 slipped at eps = 1e-1, 1e-2, 1e-3."""
    limit, many = problem_of("slender_rod", "double_zero").limit, 10**7
    for eps, noted in ((1e-1, 183), (1e-2, 15), (1e-3, 1)):
        counts = sample_distance(limit, eps, SampleOptions(samples=many, sampler="uniform")).counts
        slipping = counts["slip_plus"] + counts["slip_minus"]
        assert stats.binomtest(noted, 20_000, slipping / many).pvalue > SIGNIFICANCE
        assert slipping / many == pytest.approx(0.1 * eps, rel=0.2)  # a fraction O(eps)


# --- stages ----------------------------------------------------------------------------------------------------------


def test_the_law_by_selection_is_the_law_by_cases():
    """At v_n < 0 and without a jump the offset form gives the whole impulse, that of the law's definition."""
    chance, seen = np.random.default_rng(3), set()
    for _ in range(20_000):
        root = chance.normal(size=(2, 2))
        (a, b), (_, C) = root @ root.T + 1e-3 * np.eye(2)
        plus, minus = chance.exponential(2.0, size=2)
        v_n, v_t = -chance.exponential(), chance.normal()
        edges = a + plus * b, a - minus * b
        contact = SegmentContact(a, b, C, *edges, plus, minus)
        *expected, branch = segment_impulse(contact, v_n, v_t)
        code, tau, *found = split(True, contact, UNCHANGED, v_n, v_t, SegmentBase(0.0, 0.0), 0.0, 0)
        assert (code, tau) == (branch, 0.0)
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-12 * float(np.abs(expected).max()))
        seen.add((code, min(edges) > 0.0))
    assert seen == {
        (c, side) for c in (ContactMode.STICK, ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS) for side in (True, False)
    }


@pytest.mark.parametrize("edge", [0.0, -1.0, 5e-324])
def test_what_is_not_selected_may_be_infinite_and_does_no_harm(edge: float):
    """An edge that cannot lift, or is as good as that, makes its quotient infinite; the tip sticks all the same."""
    contact, still = SegmentContact(1.0, 0.0, 1.0, edge, edge, 1.0, 1.0), SegmentBase(0.0, 0.0)
    code, tau, e_n, e_t = split(True, contact, UNCHANGED, -2.0, 0.5, still, 0.0, 0)
    assert (code, tau, e_n, e_t) == (ContactMode.STICK, 0.0, 2.0, -0.5)
    free = split(False, contact, UNCHANGED, 2.0, 0.5, still, 0.0, 0)
    assert free == (ContactMode.FREE, 0.0, 0.0, 0.0)


def _monomials(variables: int, degree: int) -> tuple[list[tuple[int, ...]], np.ndarray, np.ndarray]:
    powers = [p for p in np.ndindex(*(degree + 1,) * variables) if 1 <= sum(p) <= degree]
    powers.sort(key=sum)
    factors = [next(j for j, power in enumerate(p) if power) for p in powers]
    lower = [tuple(power - (j == f) for j, power in enumerate(p)) for p, f in zip(powers, factors, strict=True)]
    return powers, np.array([powers.index(p) if any(p) else -1 for p in lower]), np.array(factors)


@pytest.mark.parametrize(("variables", "degree"), [*((1, n) for n in range(2, 11)), (2, 1), (2, 2), (2, 5), (3, 3)])
def test_sparse_rows_are_the_polynomials_of_their_table(variables: int, degree: int):
    """Against rational arithmetic; with zero rows, missing terms and multiples of other rows among them."""
    chance = np.random.default_rng(degree)
    powers, parents, factors = _monomials(variables, degree)
    table = chance.normal(size=(6, len(powers)))
    table[1] = 0.0
    table[2, ::2] = 0.0
    table[4] = -table[0] / 3.0
    polynomials = sparse_polynomials(parents, factors, table)
    assert list(polynomials.like) == [0, 1, 2, 3, 0, 5]
    x, values = chance.uniform(-1.0, 1.0, size=(variables, 9)), np.empty((6, 9))
    monomials = np.empty((polynomials.parents.size, 9))
    monomial_block(polynomials, x, monomials)
    polynomial_block(polynomials, monomials, values)
    for i, column in enumerate(x.T):
        terms = [math.prod(Fraction(t) ** k for t, k in zip(column, p, strict=True)) for p in powers]
        for r, row in enumerate(table):
            summands = [Fraction(c) * t for c, t in zip(row, terms, strict=True)]
            scale = float(sum(map(abs, summands)))
            assert abs(values[r, i] - float(sum(summands))) <= 2 * (len(powers) + 2) * 2.0**-53 * scale
