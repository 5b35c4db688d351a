"""A_eps by sampling: streamed through compiled blocks, reproducible bit for bit on any number of threads.

A sample consists of members of A_eps and proves nothing else: it bounds e(A_eps, A) from below and e(A, A_eps) from
above (docs/theory.md, section 4).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from painleve.asymptotics.distance import Attained, Distance
from painleve.asymptotics.local import Arithmetic, Expansion, LocalProblem, make_local_problem
from painleve.asymptotics.member import Member, make_member
from painleve.core.ball_maps import uniforms_needed
from painleve.core.codes import ContactMode
from painleve.core.lane import Evaluation, LaneTally, SamplePlan
from painleve.core.lattice import kronecker_generators, kronecker_shifts
from painleve.core.reduce import PAIR, POINT, SEGMENT
from painleve.core.sampling import BLOCK, Sampler
from painleve.core.taylor import no_polynomials
from painleve.errors import InputError, nearest
from painleve.lanes import as_they_finish, thread_count
from painleve.sets import Bounds, excess_of_segment_from_profile
from painleve.theory.domain import check_domain
from painleve.theory.limit_set import LimitSet

__all__ = ["SAMPLERS", "SampleOptions", "check_eps", "check_radii", "sample_distance", "sample_members"]

SAMPLERS = tuple(s.name.lower() for s in Sampler)
LANE_BLOCKS = 1024  # 800 thousand samples: some ten milliseconds, so that progress and Ctrl-C come through
BINS = 1024  # the profile along the segment keeps the best sample in each
SMALLEST_EPS, LARGEST_EPS = 1e-30, 1e6  # 320 bits hold eps^2 beside 1 with thirty digits to spare at the least
MOST_SAMPLES = 2**50
KINDS = {"point": POINT, "pair": PAIR, "segment": SEGMENT}


@dataclass(frozen=True, kw_only=True)
class SampleOptions:
    """How to sample: number of samples, seed, sampler, threads (None: all cores), arithmetic of the rows, and a
    function called with the number of samples done since the last call."""

    samples: int = 1_000_000
    seed: int = 0
    sampler: str = "kronecker"
    threads: int | None = None
    arithmetic: Arithmetic = "automatic"
    progress: Callable[[int], None] | None = None

    def __post_init__(self) -> None:
        if not 1 <= self.samples <= MOST_SAMPLES:
            raise InputError(f"samples: {self.samples} must be between 1 and 2^50")
        if not 0 <= self.seed < 2**63:
            raise InputError(f"seed: {self.seed} must be between 0 and 2^63 - 1")
        if self.sampler not in SAMPLERS:
            hint = nearest(self.sampler, SAMPLERS)
            raise InputError(f"sampler: no {self.sampler!r}{hint}; choose one of {', '.join(SAMPLERS)}")
        thread_count(self.threads)


@dataclass
class _SampleTally:
    """What a lane keeps, and how lanes are merged: ties go to the smaller index, so the order does not matter."""

    counts: np.ndarray = field(default_factory=lambda: np.zeros(len(ContactMode), np.int64))
    best: np.ndarray = field(default_factory=lambda: np.array([-1.0, np.inf, np.inf]))
    best_index: np.ndarray = field(default_factory=lambda: np.full(3, -1, np.int64))
    bins: np.ndarray = field(default_factory=lambda: np.full((3, BINS), np.inf))
    bin_index: np.ndarray = field(default_factory=lambda: np.full(BINS, np.iinfo(np.int64).max))

    @property
    def arrays(self) -> LaneTally:
        """For a compiled lane."""
        return LaneTally(self.counts, self.best, self.best_index, self.bins, self.bin_index)

    def merge(self, other: _SampleTally) -> None:
        self.counts += other.counts
        sense = np.array([-1.0, 1.0, 1.0])
        for j in range(3):
            mine, theirs = sense[j] * self.best[j], sense[j] * other.best[j]
            if theirs < mine or (theirs == mine and other.best_index[j] < self.best_index[j]):
                self.best[j], self.best_index[j] = other.best[j], other.best_index[j]
        better = other.bins[2] < self.bins[2]
        better |= (other.bins[2] == self.bins[2]) & (other.bin_index < self.bin_index)
        self.bins[:, better], self.bin_index[better] = other.bins[:, better], other.bin_index[better]


class _Stream:
    """The sample of one ball as a function of the index: arguments of the compiled lanes, prepared once."""

    def __init__(self, problem: LocalProblem, eps: float, options: SampleOptions) -> None:
        self.problem, self.options = problem, options
        d, shape = problem.dimension, len(problem.shape)
        in_q = shape + (1 if problem.carried > 0.0 else 0)
        q_uniforms = uniforms_needed(in_q, d) if in_q else 0
        self.expansion: Expansion | None = problem.expansion(eps, options.arithmetic)
        e = self.expansion
        self.evaluation = Evaluation(e is not None, e.polynomials if e else no_polynomials())
        self.plan = SamplePlan(
            sampler=int(Sampler[options.sampler.upper()]),
            seed=options.seed,
            alphas=kronecker_generators(shape + d),
            shifts=kronecker_shifts(options.seed, shape + d),
            eps=float(eps),
            carried=problem.carried,
            q_uniforms=q_uniforms,
            uniforms=q_uniforms + uniforms_needed(d, d),
        )

    def lane(self, first: int, blocks: int) -> _SampleTally:
        tally, p = _SampleTally(), self.problem
        p.kernels.sample_lane(
            self.plan,
            self.evaluation,
            first,
            blocks,
            self.options.samples,
            p.base_state,
            KINDS[p.limit.kind],
            tally.arrays,
        )
        return tally

    def block(self, start: int) -> tuple[np.ndarray, ...]:
        """(dq, dv, branch, along, beyond, across2) of samples start ... start + BLOCK - 1; dq has all coordinates."""
        d, shape, p = self.problem.dimension, len(self.problem.shape), self.problem
        offsets, result = p.kernels.empty_block(self.plan, self.evaluation)
        p.kernels.offset_block(self.plan, self.evaluation, start, p.base_state, offsets, result)
        dq = np.zeros((d, BLOCK))
        dq[list(p.shape)] = offsets.x[:shape]
        if p.carried > 0.0:
            dq += p.carried_direction[:, None] * (offsets.room / p.carried)
        return dq, offsets.dv.copy(), *result

    def member(self, index: int) -> Member:
        """The sample of that index, evaluated rigorously. Raises ArithmeticError where its branch is undecided."""
        dq, dv, *_ = self.block(index // BLOCK * BLOCK)
        return make_member(self.problem, dq[:, index % BLOCK], dv[:, index % BLOCK])

    def place(self, index: int) -> tuple[float, float]:
        """(along, across2) of the sample of that index."""
        *_, along, _, across2 = self.block(index // BLOCK * BLOCK)
        return float(along[index % BLOCK]), float(across2[index % BLOCK])


def check_eps(eps: float) -> float:
    """eps as a float. Raises InputError unless it is positive and in the range in which the balls decide signs."""
    value = float(eps)
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"eps: {eps} must be a positive number")
    if not SMALLEST_EPS <= value <= LARGEST_EPS:
        raise InputError(f"eps: {eps} must lie between {SMALLEST_EPS:g} and {LARGEST_EPS:g}")
    return value


def check_radii(values: Iterable[float]) -> list[float]:
    """Each eps once, in the order in which they are given: one that is repeated must not count twice in a slope.

    Raises InputError as check_eps does, and if there is none.
    """
    radii = list(dict.fromkeys(check_eps(value) for value in values))
    if not radii:
        raise InputError("eps: no values; give at least one")
    return radii


def sample_distance(limit: LimitSet, eps: float, options: SampleOptions | None = None) -> Distance:
    """Bounds on both excesses from members of A_eps: e(A_eps, A) from below, e(A, A_eps) from above.

    The farthest member is evaluated again in ball arithmetic, so the lower bound is that of a true member.
    Raises InputError for eps <= 0, for a state whose limit set is undecided, and where the law is not proved to be
    defined on the ball (painleve.theory.domain).
    """
    options, eps = options or SampleOptions(), check_eps(eps)
    if limit.kind == "undecided":
        raise InputError(f"state {limit.state.label}: no distance to a limit set that is undecided: {limit.reason}")
    check_domain(limit.state, eps)
    problem = make_local_problem(limit)
    stream = _Stream(problem, eps, options)
    tally = _SampleTally()
    for part in _lanes(stream):
        tally.merge(part)
    farthest = stream.member(int(tally.best_index[0]))
    counts = {b.label: int(tally.counts[b]) for b in ContactMode if _has(problem, b)}
    return Distance(
        limit=limit,
        eps=eps,
        method="sample",
        counts=counts,
        evaluations=options.samples,
        excess_Aeps_A=Attained(bounds=Bounds.at_least(farthest.distance[0]), member=farthest),
        excess_A_Aeps=_excess_of_limit(stream, tally),
        ending=f"all {options.samples} samples were drawn",
        settings={
            "samples": options.samples,
            "seed": options.seed,
            "sampler": options.sampler,
            "arithmetic": f"taylor, order {stream.expansion.order}" if stream.expansion else "plain",
        },
    )


def sample_members(limit: LimitSet, eps: float, options: SampleOptions | None = None) -> dict[str, np.ndarray]:
    """The samples themselves, for pictures: dq, dv (n, d), S - u- (n, d) and branch (n,)."""
    options, eps = options or SampleOptions(samples=BLOCK), check_eps(eps)
    check_domain(limit.state, eps)
    problem = make_local_problem(limit)
    stream = _Stream(problem, eps, options)
    blocks = [stream.block(start)[:2] for start in range(0, options.samples, BLOCK)]
    dq = np.concatenate([b[0].T for b in blocks])[: options.samples]
    dv = np.concatenate([b[1].T for b in blocks])[: options.samples]
    values, branch = np.empty_like(dv), np.empty(len(dv), np.int64)
    law = problem.kernels.law_at
    for i in range(len(dv)):
        branch[i] = law(problem.q + dq[i], problem.p, problem.u + dv[i], values[i])
    return {"dq": dq, "dv": dv, "offset": values - problem.u, "branch": branch}


def _has(problem: LocalProblem, branch: ContactMode) -> bool:
    """Whether the scene can take that branch at all."""
    return branch is ContactMode.FREE or branch in problem.section.modes


def _lanes(stream: _Stream) -> Iterator[_SampleTally]:
    """Tallies of all lanes, on threads."""
    options, blocks = stream.options, -(-stream.options.samples // BLOCK)

    def lane(first: int) -> _SampleTally:
        return stream.lane(first, min(LANE_BLOCKS, blocks - first))

    for tally in as_they_finish(lane, range(0, blocks, LANE_BLOCKS), options.threads):
        if options.progress is not None:
            options.progress(int(tally.counts.sum()))
        yield tally


def _excess_of_limit(stream: _Stream, tally: _SampleTally) -> Attained:
    """An upper bound on e(A, A_eps) from the samples nearest to A, exact for those samples."""
    problem = stream.problem
    if problem.limit.kind == "segment":
        # The outer bins reach beyond the ends, so that the sample nearest to the line need not be near to the end.
        nearest_to_ends = tally.best_index[1:]
        known = np.isfinite(tally.bins[2])
        profile = np.hstack([tally.bins[[0, 2]][:, known], np.array([stream.place(int(i)) for i in nearest_to_ends]).T])
        value, place, nearest = excess_of_segment_from_profile(profile[0], np.sqrt(profile[1]), problem.length)
        index = int(np.concatenate([tally.bin_index[known], nearest_to_ends])[nearest])
        point = problem.u + place * problem.direction
    else:
        ends = 1 if problem.limit.kind == "point" else 2
        worst = int(np.argmax(tally.best[1 : 1 + ends]))
        value, index = float(np.sqrt(tally.best[1 + worst])), int(tally.best_index[1 + worst])
        point = problem.u + worst * problem.length * problem.direction
    return Attained(bounds=Bounds.at_most(value), member=stream.member(index), point=point)
