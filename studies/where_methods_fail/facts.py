"""What the datasets say in a few numbers: where samples and doubles fail, and which method to use when."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from painleve.sweep.variables import BRANCHES, code
from studies.benchmark.work_precision import RUN_OUTCOMES

__all__ = ["ESTIMATE", "PROOF", "advice", "bound_facts", "near_facts", "rounding_facts"]

ESTIMATE, PROOF = 1e-2, 1e-3  # relative errors that serve a reader who wants a number, or a claim settled


def bound_facts(dataset: xr.Dataset) -> dict[str, Any]:
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


def rounding_facts(dataset: xr.Dataset) -> dict[str, Any]:
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


def near_facts(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
    """From which eps on downwards the distances show the own side of each value, if they do at the smallest eps.

    At an isolated state the lower bound on e(A, A_eps) has to exceed half its limit; else d_H, as read, has to be
    within a factor two of what it is proportional to.
    """
    order = np.argsort(dataset["eps"].values)
    eps = dataset["eps"].values[order]
    for i in range(dataset.sizes["case"]):
        for j in range(dataset.sizes["value"]):
            one = dataset.isel(case=i, value=j)
            read = one["distance_as_read"].values[order]
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


def advice(dataset: xr.Dataset) -> Iterator[dict[str, Any]]:
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


def _fastest(one: xr.Dataset, good: np.ndarray) -> dict[str, Any] | None:
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
