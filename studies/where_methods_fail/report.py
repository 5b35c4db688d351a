"""Where methods fail, in words and numbers, and a table of the method to use when."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from studies.parts import Report
from studies.text_table import text_table
from studies.where_methods_fail.facts import ESTIMATE, PROOF, advice, bound_facts, near_facts, rounding_facts
from studies.where_methods_fail.measure import HARD

__all__ = ["report"]


def report(datasets: Mapping[str, xr.Dataset]) -> Report:
    """Of all datasets."""
    rows = [row for stem, dataset in datasets.items() if stem.startswith("methods_") for row in advice(dataset)]
    facts = {
        "sampled_bound": bound_facts(datasets["sampled_bound"]),
        "rounding": rounding_facts(datasets["rounding"]),
        "near_critical": list(near_facts(datasets["near_critical"])),
    }
    return Report(table=_table(facts, rows), data={**facts, "methods": rows}, status=_status(facts))


def _table(facts: dict[str, Any], rows: list[dict[str, Any]]) -> str:
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
    chosen = [
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
    return "\n".join([*notes, "", near_table, "", said, text_table(columns, chosen)])


def _said(choice: dict[str, Any] | None) -> str:
    if choice is None:
        return "none of the runs"
    setting = "" if np.isnan(choice["setting"]) else f" {choice['setting']:.0e}"
    return f"{choice['method']}{setting} ({choice['seconds']:.2g} s)"


def _status(facts: dict[str, Any]) -> str:
    bound, witnessed = facts["sampled_bound"]["sampled_upper"], facts["sampled_bound"]["witnessed_upper"]
    return f"At the hardest point samples bound an excess of zero by {bound:.2g}, witnesses by {witnessed:.1e}."
