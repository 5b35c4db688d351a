"""The limit law over the ratio of the eigenvalues, and the local map over its drift: the lines of the figures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from painleve.core.jam_map import jam_fraction, limit_law
from studies.plurality.jam_law import CONTACTS

__all__ = ["law_curves"]

RATIOS = np.array([*np.linspace(0.02, 0.98, 33), np.nextafter(1.0, 0.0), 1.0, 2.0])  # the law falls to 0 at r = 1
DRIFTS = np.logspace(-3.0, 0.7, 25)
PHASES = 2000


def law_curves(mapped: Sequence[float]) -> dict[str, xr.Variable]:
    """Coordinates and variables beside those of the cases; `mapped`: the ratios whose map is wanted over the drift."""

    def variable(dims: tuple[str, ...], values: object, sentence: str) -> xr.Variable:
        return xr.Variable(dims, np.asarray(values, float), {"long_name": sentence, "units": "1"})

    law = [[limit_law(float(r), strict=contact == "strict") for r in RATIOS] for contact in CONTACTS]
    fraction = [[jam_fraction(r, float(d), strict=True, phases=PHASES) for d in DRIFTS] for r in mapped]
    return {
        "law_ratio": variable(("law_ratio",), RATIOS, "ratio r of the eigenvalues, of the limit law"),
        "limit_law": variable(("test", "law_ratio"), law, "limit of the fraction, under the strict test and kept"),
        "map_ratio": variable(("map_ratio",), mapped, "ratio r of the eigenvalues, of the local map"),
        "map_drift": variable(("map_drift",), DRIFTS, "drift d of the local map"),
        "map_fraction": variable(
            ("map_ratio", "map_drift"),
            np.reshape(fraction, (len(mapped), len(DRIFTS))),
            "the local map's fraction, strict test",
        ),
    }
