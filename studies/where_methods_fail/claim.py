"""Where methods fail: rare slips, cancellation, and parameters near a critical value; and which method to use when.

Claims (the project's own):
- At the hard critical state (`double_zero`: mu = 4/3, tan theta = 2) e(A, A_eps) = 0 for every eps, and the sampled
  bound on it grows as eps falls, whatever the number of samples. Witnesses do not care.
- There plain doubles lose the sign of gamma by eps = 1e-8; then they let samples slip that do not, and members that
  slip miss their place by the length of A. Arithmetic without cancellation keeps ten digits down to eps = 1e-14.
- With a parameter just beside its critical value d_H is that of the wrong side, until eps resolves the difference: for
  mu = 4/3 (1 + delta) at eps ~ sqrt(delta), for mu = 4/3 (1 - delta) only at eps ~ delta. Beside k = 25/6, where the
  worn tip's state turns isolated, e(A, A_eps) is proved to be large only below some eps.

Command:  painleve study where_methods_fail [--quick]
Expected: see the claims; the table of methods is filled from runs of this study.
Time:     about three minutes, with --quick half a minute; more where the scenes are not yet compiled.
Files:    sampled_bound, rounding, near_critical: HDF5, PDF and PNG; methods_<eps>.h5.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from tqdm import tqdm

from painleve.asymptotics.certify.method import CertifyOptions
from painleve.asymptotics.optimise import OptimiseOptions
from painleve.asymptotics.sample import SampleOptions
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw, save_figure
from painleve.store import check_writable, save
from painleve.sweep.variables import BRANCHES, code
from studies.benchmark.work_precision import RUN_OUTCOMES, DistanceEffort, sweep_work_precision
from studies.study import StudyResult
from studies.text_table import text_table
from studies.where_methods_fail.figures import DRAWINGS
from studies.where_methods_fail.near_critical import NearCase, sweep_near_critical
from studies.where_methods_fail.rounding import sweep_rounding
from studies.where_methods_fail.sampled_bound import sweep_sampled_bound

HARD = ("slender_rod", "double_zero")
STATES = (
    ("slender_rod", "paradox"),
    ("slender_rod", "critical"),
    HARD,
    ("worn_tip_rod", "isolated"),
    ("two_link_arm", "approached"),
    ("two_link_arm", "isolated"),
)
ESTIMATE, PROOF = 1e-2, 1e-3  # relative errors that serve a reader who wants a number, or a claim settled
Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Size:
    """How much is run."""

    bound_eps: np.ndarray
    bound_samples: Sequence[int]
    rounding_eps: np.ndarray
    members: int
    rounding_samples: int
    near_eps: np.ndarray
    near_samples: int
    guide_eps: Sequence[float]
    states: Sequence[tuple[str, str]]
    effort: DistanceEffort


FULL = Size(
    bound_eps=np.logspace(-1, -7, 13),
    bound_samples=(10**3, 10**5, 10**7),
    rounding_eps=np.logspace(-1, -14, 14),
    members=100,
    rounding_samples=10**7,
    near_eps=np.logspace(-1, -8, 15),
    near_samples=200_000,
    guide_eps=(1e-3, 1e-9),
    states=STATES,
    effort=DistanceEffort(
        samples=(10**4, 10**6), naive_samples=(10**5,), widths=(1e-1, PROOF), reference_width=1e-5, repetitions=1
    ),
)
QUICK = Size(
    bound_eps=np.logspace(-1, -7, 4),
    bound_samples=(10**3, 10**5),
    rounding_eps=np.logspace(-2, -14, 5),
    members=20,
    rounding_samples=10**5,
    near_eps=np.logspace(-1, -8, 5),
    near_samples=20_000,
    guide_eps=(1e-3,),
    states=STATES[1:3],
    effort=DistanceEffort(
        samples=(10**4,), naive_samples=(10**4,), widths=(PROOF,), reference_width=1e-4, repetitions=1
    ),
)


def run(output: Path, *, quick: bool = False, seed: int = 0) -> StudyResult:
    """Measure, draw and tabulate; `output` is an existing folder."""
    check_writable(output / "rounding.h5")
    size = QUICK if quick else FULL
    with tqdm(leave=False, disable=None, file=sys.stderr, unit="point") as bar:

        def progress(label: str) -> None:
            bar.set_description(label)
            bar.update()

        drawn = _drawn(size, seed, progress)
        guides = {f"methods_{eps:.0e}": _guide(size, eps, seed, progress) for eps in size.guide_eps}
    files: list[Path] = []
    for stem, dataset in drawn.items():
        figure = draw(dataset, DRAWINGS)
        files.append(save(dataset, output / f"{stem}.h5"))
        files += [save_figure(figure, output / f"{stem}.{suffix}") for suffix in ("pdf", "png")]
    files += [save(dataset, output / f"{stem}.h5") for stem, dataset in guides.items()]
    rows = [row for dataset in guides.values() for row in _advice(dataset)]
    facts = {
        "sampled_bound": _bound_facts(drawn["sampled_bound"]),
        "rounding": _rounding_facts(drawn["rounding"]),
        "near_critical": list(_near_facts(drawn["near_critical"])),
    }
    return StudyResult(
        table=_table(facts, rows), files=tuple(files), data={**facts, "methods": rows}, status=_status(facts)
    )


def _drawn(size: Size, seed: int, progress: Progress) -> dict[str, xr.Dataset]:
    hard, rod, worn = make_state(load_scene(HARD[0]), HARD[1]), load_scene("slender_rod"), load_scene("worn_tip_rod")
    keys = {"theta": "atan(2)"}
    cases = (
        NearCase(scene=rod, keys=keys, parameter="mu", critical="4/3", exponents=(2, 4, 6)),
        NearCase(scene=worn, keys=keys, parameter="k", critical="25/6", exponents=(1, 2, 3)),
    )
    methods = {"optimise": OptimiseOptions(), "sample": SampleOptions(samples=size.near_samples, seed=seed)}
    return {
        "sampled_bound": sweep_sampled_bound(
            hard, eps=size.bound_eps, samples=size.bound_samples, seed=seed, progress=progress
        ),
        "rounding": sweep_rounding(
            hard,
            eps=size.rounding_eps,
            members=size.members,
            samples=size.rounding_samples,
            seed=seed,
            progress=progress,
        ),
        "near_critical": sweep_near_critical(
            cases,
            eps=size.near_eps,
            methods=methods,
            isolated={"certify": CertifyOptions(width=1e-1)},
            progress=progress,
        ),
    }


def _guide(size: Size, eps: float, seed: int, progress: Progress) -> xr.Dataset:
    states = [make_state(load_scene(scene), name) for scene, name in size.states]
    return sweep_work_precision(states, eps=eps, effort=size.effort, seed=seed, progress=progress)


def _bound_facts(dataset: xr.Dataset) -> dict[str, object]:
    """The sampled bound of the largest sample at its least and at the smallest eps, beside the witnessed one."""
    bound, last = dataset["sampled_upper"].values[-1], int(np.argmin(dataset["eps"].values))
    least = int(np.argmin(bound))
    return {
        "samples": int(dataset["samples"].values[-1]),
        "least": float(bound[least]),
        "least_at_eps": float(dataset["eps"].values[least]),
        "smallest_eps": float(dataset["eps"].values[last]),
        "sampled_upper": float(bound[last]),
        "witnessed_upper": float(dataset["witnessed_upper"].values[last]),
    }


def _rounding_facts(dataset: xr.Dataset) -> dict[str, object]:
    """Where plain doubles lose the sign of gamma, and the largest errors of both arithmetics at farthest members."""
    eps = dataset["eps"].values
    lost = eps[dataset["wrong_sign"].values > 0.1]
    return {
        "sign_lost_from_eps": float(lost.max()) if lost.size else None,
        "worst_witness_error": float(dataset["witness_error"].max()),
        "worst_plain_error": float(dataset["plain_error_farthest"].max()),
        "worst_cancellation_free_error": float(dataset["kept_error_farthest"].max()),
        "smallest_eps": float(eps.min()),
    }


def _near_facts(dataset: xr.Dataset) -> Iterator[dict[str, object]]:
    """From which eps on downwards the distances show the own side of each value, if they do at the smallest eps.

    At an isolated state the lower bound on e(A, A_eps) has to exceed half its limit; else d_H, as read, has to be
    within a factor two of what it is proportional to.
    """
    order = np.argsort(dataset["eps"].values)
    eps = dataset["eps"].values[order]
    for i in range(dataset.sizes["case"]):
        for j in range(dataset.sizes["value"]):
            one = dataset.isel(case=i, value=j)
            read = np.fmax(one["excess_Aeps_A_lower"], one["excess_A_Aeps_upper"]).values[order]
            if int(one["theorem_branch"]) == code("critical_isolated", BRANCHES):
                shown = one["excess_A_Aeps_lower"].values[order] > float(one["half_jump"]) / 2.0
            else:
                ratio = read / eps * eps[0] / read[0]
                shown = (ratio < 2.0) & (ratio > 0.5)
            count = int(np.argmin(shown)) if not shown.all() else len(shown)
            yield {
                "case": str(one["parameter"].item()),
                "gap": float(one["gap"]),
                "resolved_at_eps": float(eps[count - 1]) if count else None,
                "all_resolved": bool(shown.all()),
                "d_H_at_smallest_eps": float(read[0]),
            }


def _advice(dataset: xr.Dataset) -> Iterator[dict[str, object]]:
    """For each state the fastest run whose number is right to ESTIMATE, and the fastest that proves it to PROOF."""
    for i, state in enumerate(dataset["state"].values):
        one = dataset.isel(state=i)
        sampled = [j for j, name in enumerate(one["series"].values) if str(name).startswith("sample")]
        worst = max(sampled, key=lambda j: (float(one["setting"][j]), float(one["error"][j])))
        yield {
            "state": str(state),
            "eps": float(dataset["eps"]),
            "most_samples": float(one["setting"][worst]),
            "worst_sampled_error": float(one["error"][worst]),
            "worst_sampled_outcome": ("not_run", *RUN_OUTCOMES)[int(one["outcome"][worst])],
            "number": _fastest(one, one["error"].values <= ESTIMATE),
            "proof": _fastest(one, one["proved"].values <= PROOF),
        }


def _fastest(one: xr.Dataset, good: np.ndarray) -> dict[str, object] | None:
    seconds = np.where(good, one["seconds"].values, np.inf)
    best = int(np.argmin(seconds))
    if not np.isfinite(seconds[best]):
        return None
    return {
        "method": str(one["series"].values[best]),
        "setting": float(one["setting"][best]),
        "seconds": float(seconds[best]),
        "error": float(one["error"][best]),
        "proved": float(one["proved"][best]),
    }


def _table(facts: dict, rows: list[dict]) -> str:
    bound, rounding = facts["sampled_bound"], facts["rounding"]
    lost = rounding["sign_lost_from_eps"]
    at = "none" if lost is None else f"{lost:.0e}"
    notes = [
        f"At {' '.join(HARD)}, where e(A, A_eps) = 0:",
        f"  {bound['samples']:.0e} samples bound it by {bound['least']:.1e} at eps = {bound['least_at_eps']:.0e}, but",
        f"  by {bound['sampled_upper']:.1e} at {bound['smallest_eps']:.0e}; there witnesses bound it by "
        f"{bound['witnessed_upper']:.1e}.",
        f"  Plain doubles lose the sign of gamma from eps = {at} on; their errors of dist(S, A) at the farthest",
        f"  member reach {rounding['worst_plain_error']:.0e}, those without cancellation "
        f"{rounding['worst_cancellation_free_error']:.0e}, down to eps = {rounding['smallest_eps']:.0e}.",
    ]
    near = [
        (
            f["case"],
            f"{f['gap']:+.0e}",
            "not" if f["resolved_at_eps"] is None else f"{f['resolved_at_eps']:.0e}" + " or more" * f["all_resolved"],
            f"{f['d_H_at_smallest_eps']:.2e}",
        )
        for f in facts["near_critical"]
    ]
    advice = [
        (
            r["state"],
            f"{r['eps']:.0e}",
            f"{r['worst_sampled_error']:.1e} ({r['worst_sampled_outcome']})",
            _said(r["number"]),
            _said(r["proof"]),
        )
        for r in rows
    ]
    columns = (
        "state",
        "eps",
        f"worst of {max(r['most_samples'] for r in rows):.0e} samples, rel. error",
        f"a number to {ESTIMATE:.0e}: fastest",
        f"proved to {PROOF:.0e}: fastest",
    )
    near_table = text_table(("parameter", "relative gap", "resolved at eps", "d_H at the smallest eps"), near)
    said = "Which method, when (measured here, warm):"
    return "\n".join([*notes, "", near_table, "", said, text_table(columns, advice)])


def _said(choice: dict | None) -> str:
    if choice is None:
        return "none of the runs"
    setting = "" if np.isnan(choice["setting"]) else f" {choice['setting']:.0e}"
    return f"{choice['method']}{setting} ({choice['seconds']:.2g} s)"


def _status(facts: dict) -> str:
    bound, witnessed = facts["sampled_bound"]["sampled_upper"], facts["sampled_bound"]["witnessed_upper"]
    return f"At the hardest point samples bound an excess of zero by {bound:.2g}, witnesses by {witnessed:.1e}."
