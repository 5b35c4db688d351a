"""One door to the figures: the kind of the dataset chooses, and the name of the file chooses the format."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Protocol

import matplotlib as mpl
import xarray as xr
from matplotlib.figure import Figure

from painleve.errors import InputError
from painleve.plotting.distances import draw_distances
from painleve.plotting.friction_map import draw_friction_map
from painleve.plotting.gamma_map import draw_gamma_map
from painleve.plotting.layouts import LAYOUTS
from painleve.plotting.members import draw_members
from painleve.plotting.regimes import draw_regimes
from painleve.plotting.style import STYLE
from painleve.plotting.trajectory import draw_trajectory
from painleve.store import check_writable, hold_to_layout
from painleve.whole_file import said_of, write_whole

__all__ = ["DRAWINGS", "Drawing", "draw", "save_figure"]

Drawing = Callable[[xr.Dataset], Figure]
DRAWINGS: Mapping[str, Drawing] = MappingProxyType(
    {
        "distances": draw_distances,
        "members": draw_members,
        "friction_map": draw_friction_map,
        "gamma_map": draw_gamma_map,
        "regimes": draw_regimes,
        "trajectory": draw_trajectory,
    }
)
# Without dates, the same dataset gives the same bytes.
WITHOUT_DATE = {"pdf": {"CreationDate": None}, "svg": {"Date": None}, "png": {}}


class Recorded(Protocol):
    """A result that makes a dataset of itself, such as a trajectory."""

    def to_xarray(self) -> xr.Dataset: ...


def draw(result: xr.Dataset | Recorded, more: Mapping[str, Drawing] | None = None) -> Figure:
    """The figure of a dataset of this package, or of a trajectory.

    `more`: drawings of further kinds, such as those of a study. Raises InputError for a kind that has no figure, and
    for a dataset that does not hold what its kind does.
    """
    dataset = result if isinstance(result, xr.Dataset) else result.to_xarray()
    kind, drawings = str(dataset.attrs.get("kind", "unknown")), {**DRAWINGS, **(more or {})}
    if kind not in drawings:
        raise InputError(f"no figure for a dataset of kind {kind!r}; there are figures of {', '.join(drawings)}")
    hold_to_layout(dataset, LAYOUTS.get(kind, ""))
    with mpl.rc_context(STYLE):
        figure = drawings[kind](dataset)
        # Laid out once here and not again for each format: that would be half of the time of saving it.
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
    return figure


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Write a figure as PDF, PNG or SVG, by the suffix, whole or not at all. Raises InputError where it cannot."""
    target = check_writable(path)
    form = target.suffix.removeprefix(".").lower()
    if form not in WITHOUT_DATE:
        raise InputError(f"output {target}: cannot draw {form or 'a file without a suffix'}; use .pdf, .png or .svg")
    content = io.BytesIO()  # a writer that a full disk stops leaves its file open
    with said_of(target), mpl.rc_context({**STYLE, "svg.hashsalt": "painleve"}):
        figure.savefig(content, format=form, metadata=WITHOUT_DATE[form])
        write_whole(target, content.getbuffer())
    return target
