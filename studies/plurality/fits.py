"""How well the local map fits the measured fractions, and how fast these come to the law."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import chi2

from painleve.store import labels_of

__all__ = ["fits_of"]


def fits_of(dataset: xr.Dataset) -> dict[str, dict[str, Any]]:
    """How well the map fits: chi-square over all cases where it is neither 0 nor 1, by contact test."""
    found: dict[str, dict[str, Any]] = {}
    for contact in ("strict", "kept"):
        one = dataset.isel(case=np.flatnonzero(labels_of(dataset["contact"]) == contact))
        p, n, f = (one[name].values for name in ("local_map", "effective_count", "fraction"))
        inside = (p > 0.0) & (p < 1.0)
        residual = (f - p)[inside]
        square = float((residual**2 * n[inside] / (p * (1.0 - p))[inside]).sum())
        found[contact] = {
            "chi_square": square,
            "degrees": int(inside.sum()),
            "p_value": float(chi2.sf(square, inside.sum())),
            "largest_residual": float(np.abs(residual).max()),
            "jams_where_the_map_has_none": int(np.round((f * one["count"].values)[p == 0.0]).sum()),
        }
    found["approach"] = {
        f"{c} {name}": _power(dataset, c, name) for c in ("strict", "kept") for name in ("fraction", "local_map")
    }
    return found


def _power(dataset: xr.Dataset, contact: str, name: str) -> float:
    """The fitted power of h with which a fraction comes to the limit law on one slip; NaN where too few differ."""
    chosen = (dataset["group"].values == "approach") & (labels_of(dataset["contact"]) == contact)
    one = dataset.isel(case=np.flatnonzero(chosen))
    gap = np.abs(one["law"].values - one[name].values)
    seen = gap > (one["upper"].values - one["lower"].values)  # twice the interval's half width
    if seen.sum() < 2:
        return float("nan")
    return float(np.polyfit(np.log(one["step"].values[seen]), np.log(gap[seen]), 1)[0])
