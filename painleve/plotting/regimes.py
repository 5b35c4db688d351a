"""The four regimes of a sliding contact over two state keys."""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from painleve.plotting.style import PALETTE, panels, spoken, with_unit

__all__ = ["draw_regimes"]

# Signs of the compliance and of the free acceleration, fill and hatching: colours differ in lightness, and the two
# regimes without a unique solution are hatched too.
REGIONS = {
    "slip": (1, -1, "white", ""),
    "lift_off": (1, 1, PALETTE["sky"], ""),
    "inconsistent": (-1, -1, PALETTE["vermilion"], "////"),
    "indeterminate": (-1, 1, PALETTE["yellow"], "...."),
}
EDGES: tuple[tuple[str, Literal["-", "--"], str], ...] = (
    ("slip_compliance", "-", "compliance $p = 0$"),
    ("free_acceleration", "--", "free acceleration $\\beta = 0$"),
)


def draw_regimes(dataset: xr.Dataset) -> Figure:
    """Regions of the regimes, bounded by the curves on which the compliance or the free acceleration vanishes."""
    x, y = (str(dim) for dim in dataset["regime"].dims)
    figure, (axis,) = panels(1, columns=1, height=3.0)
    handles: list[Patch | Line2D] = []
    for name, (p_sign, beta_sign, colour, hatch) in REGIONS.items():
        # Contours between the points of the grid meet along the edges; squares of codes would leave steps.
        inside = np.minimum(p_sign * dataset["slip_compliance"], beta_sign * dataset["free_acceleration"])
        if (inside > 0.0).any():
            axis.contourf(dataset[x], dataset[y], inside.T, levels=[0.0, np.inf], colors=[colour], hatches=[hatch])
            handles.append(Patch(facecolor=colour, hatch=hatch, edgecolor="black", linewidth=0.5, label=spoken(name)))
    for variable, style, label in EDGES:
        axis.contour(dataset[x], dataset[y], dataset[variable].T, levels=[0.0], colors="black", linestyles=style)
        handles.append(Line2D([], [], color="black", linestyle=style, label=label))
    axis.set_xlabel(with_unit(dataset[x].attrs["long_name"].split(": ")[-1], dataset[x]))
    axis.set_ylabel(with_unit(dataset[y].attrs["long_name"].split(": ")[-1], dataset[y]))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure
