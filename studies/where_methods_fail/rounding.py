"""Plain doubles against cancellation-free arithmetic near one exact state, judged in ball arithmetic."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import flint
import numpy as np
import xarray as xr

from painleve.asymptotics.ball_arithmetic import BITS
from painleve.asymptotics.local import Arithmetic, LocalProblem, make_local_problem
from painleve.asymptotics.member import Member, base_balls, make_member, row_balls
from painleve.asymptotics.optimise import optimise_distance
from painleve.asymptotics.sample import SampleOptions, check_radii, sample_distance
from painleve.asymptotics.witness import find_witness
from painleve.core.codes import ContactMode
from painleve.errors import InputError
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.norm_units import ball_unit
from painleve.mechanics.state import State
from painleve.store import provenance
from painleve.sweep.variables import LAW_BRANCHES, text
from painleve.theory.classification import classify
from painleve.theory.limit_set import LimitSet
from studies.benchmark.naive import naive_members, point_distances, uniform_ball

__all__ = ["QUANTITIES", "sweep_rounding"]

QUANTITIES = ("gamma", "v_n", "distance")
ARITHMETICS: tuple[Arithmetic, ...] = ("plain", "taylor")
SLIPS = [LAW_BRANCHES.index(mode.label) for mode in (ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS)]
FRACTIONS = (0.1, 0.3, 0.5, 0.7, 0.9)  # of the way from u- to u_tilde


def sweep_rounding(
    state: State,
    *,
    eps: Sequence[float],
    members: int,
    samples: int,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Relative errors of plain doubles near a critical state, and branch counts of `samples` samples.

    The plain evaluation adds the offsets to q and u- first, as any code does that knows nothing of the base state. It
    is judged at `members` offset states that are uniform among those that touch with v_n < 0; at witnesses, which slip
    there and are spread along A; and at the farthest member that optimise finds. There the cancellation-free
    arithmetic is judged too: it computes the distance, and balls evaluate it again.

    Raises InputError for bad eps, no members, and a limit set that is not a segment.
    """
    radii = check_radii(eps)
    limit = classify(state).limit
    if not radii or members < 1:
        raise InputError("eps, members: give at least one value and one member")
    if limit.kind != "segment":
        raise InputError(f"state {state.label}: A is not a segment ({limit.reason}); choose a critical state")
    problem = make_local_problem(limit)
    parts = []
    for radius in radii:
        if progress is not None:
            progress(f"rounding at eps = {radius:g}")
        parts.append(_at_eps(problem, radius, members, samples, seed))
    dataset = xr.concat(parts, "eps")
    unit = {"units": ball_unit(state.scene), "long_name": "radius of the two closed balls about q and about u-"}
    source = provenance(scene=state.scene, scene_digest=make_kernels(state.scene).digest, seed=seed, command=command)
    title = f"Plain and cancellation-free arithmetic at {state.scene.name} {state.label}"
    return dataset.assign_coords(eps=xr.Variable(("eps",), np.array(radii), unit)).assign_attrs(
        {"title": title, "kind": "rounding", "state": state.label, **source}
    )


def _at_eps(problem: LocalProblem, eps: float, members: int, samples: int, seed: int) -> xr.Dataset:
    errors, wrong_sign = _plain_errors(problem, eps, members, seed)
    plain_far, kept_far = _farthest_errors(problem.limit, eps)
    counts = np.full((len(ARITHMETICS), len(LAW_BRANCHES)), -1, dtype=np.int64)
    for i, arithmetic in enumerate(ARITHMETICS):
        found = sample_distance(problem.limit, eps, SampleOptions(samples=samples, seed=seed, arithmetic=arithmetic))
        for label, count in found.counts.items():
            counts[i, LAW_BRANCHES.index(label)] = count

    def number(dims: tuple[str, ...], values: np.ndarray | float, sentence: str) -> xr.Variable:
        return xr.Variable(dims, np.asarray(values), {"units": "1", "long_name": sentence})

    median, largest = np.median(errors, axis=1), errors.max(axis=1)
    variables = {
        "plain_error_median": number(("quantity",), median, "median relative error of plain doubles"),
        "plain_error_largest": number(("quantity",), largest, "largest relative error of plain doubles"),
        "wrong_sign": number((), wrong_sign, "share of states at which plain doubles give gamma a wrong sign"),
        "witness_error": number(
            (),
            _witness_error(problem, eps),
            "error of plain doubles in S, in lengths of A, at witnesses spread along A: the largest",
        ),
        "plain_error_farthest": number((), plain_far, "relative error of plain doubles at the farthest member"),
        "kept_error_farthest": number(
            (),
            kept_far,
            "distance that cancellation-free arithmetic finds against that of the true member beside it, relative",
        ),
        "counts": number(("arithmetic", "law_branch"), counts, "samples by branch of the law; -1 where not run"),
        "slips": number(("arithmetic",), np.maximum(counts[:, SLIPS], 0).sum(axis=1), "how many of the samples slip"),
        "samples": number((), samples, "number of samples of A_eps"),
    }
    coordinates = {
        "quantity": text(["quantity"], list(QUANTITIES), "number that is evaluated near the state"),
        "arithmetic": text(["arithmetic"], list(ARITHMETICS), "how the scene's functions of q are evaluated"),
        "law_branch": text(["law_branch"], list(LAW_BRANCHES), "branch of the discrete contact law S"),
    }
    return xr.Dataset(variables, coordinates)


def _plain_errors(problem: LocalProblem, eps: float, members: int, seed: int) -> tuple[np.ndarray, float]:
    """Relative errors (quantity, states in contact), and the share of wrong signs of gamma."""
    random, limit = np.random.default_rng(seed), problem.limit
    exact: list[tuple[float, float, float]] = []
    offsets: list[tuple[np.ndarray, np.ndarray]] = []
    while len(exact) < members:
        dq, dv = (uniform_ball(random, 1, problem.dimension, eps)[0] for _ in range(2))
        member = make_member(problem, dq, dv)
        if member.branch is not ContactMode.FREE:
            exact.append(_quantities(problem, member))
            offsets.append((dq, dv))
    plain = naive_members(limit, *(np.array(x) for x in zip(*offsets, strict=True)))
    edge = plain.edge_plus if limit.edge == 1 else plain.edge_minus
    truth = np.array(exact).T
    found = np.array([edge, plain.normal_velocity, point_distances(limit, plain.values)])
    return np.abs(found - truth) / np.abs(truth), float(np.mean(np.sign(edge) != np.sign(truth[0])))


def _witness_error(problem: LocalProblem, eps: float) -> float:
    """Largest error of S, in lengths of the jump, over witnesses whose preimages are rounded to doubles; NaN where none
    slips."""
    limit, errors = problem.limit, []
    for fraction in FRACTIONS:
        witness = find_witness(limit, fraction, eps, within=eps).member
        if witness is not None:
            exact = make_member(problem, witness.dq, witness.dv)
            plain = naive_members(limit, witness.dq[None], witness.dv[None]).values[0]
            errors.append(np.linalg.norm(plain - problem.u - exact.offset) / problem.length)
    return float(np.max(errors, initial=0.0)) if errors else float("nan")


def _quantities(problem: LocalProblem, member: Member) -> tuple[float, float, float]:
    """gamma |grad g|^2 on the edge that attains it, v_n and dist(S, A), to dozens of digits before they are rounded."""
    table = problem.kernels.rows
    with flint.ctx.workprec(BITS):
        rows, u = row_balls(problem, [flint.arb(float(x)) for x in member.dq]), base_balls(problem)[2]
        v = [x + flint.arb(float(y)) for x, y in zip(u, member.dv, strict=True)]
        v_n = sum((w * x for w, x in zip(rows[table.parts.w_n], v, strict=True)), flint.arb(0))
        gamma = rows[table.edges[problem.limit.edge]]
        return float(gamma.mid()), float(v_n.mid()), sum(member.distance) / 2.0


def _farthest_errors(limit: LimitSet, eps: float) -> tuple[float, float]:
    """Relative errors of dist(S, A) at the farthest member of optimise: in plain doubles, and as optimise found it."""
    found = optimise_distance(limit, eps)
    member, exact = found.excess_Aeps_A.member, found.excess_Aeps_A.bounds.lower
    if member is None or not exact:
        raise ArithmeticError(f"eps = {eps:g}: no farthest member was found")
    plain = point_distances(limit, naive_members(limit, member.dq[None], member.dv[None]).values)[0]
    estimate = float(str(found.settings["estimate"]))
    return abs(plain - exact) / exact, abs(estimate - exact) / exact
