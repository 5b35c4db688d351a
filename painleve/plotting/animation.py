"""The motion of a body as a GIF."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import xarray as xr
from matplotlib.animation import PillowWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from painleve.errors import InputError
from painleve.plotting.style import STYLE, WIDTH
from painleve.plotting.trajectory import draw_body, frame_body, spaced
from painleve.store import check_writable
from painleve.whole_file import written_aside

__all__ = ["FRAMES", "animate"]

FRAMES = 100  # at most
RATE = 20  # frames a second
DPI = 100


def animate(dataset: xr.Dataset, path: str | Path, progress: Callable[[int], None] | None = None) -> Path:
    """Write the motion as a GIF with the time on it, whole or not at all; `progress` hears of each frame.

    Frames are evenly spaced in time, at most one for each instant of the trajectory. Raises InputError for a dataset
    without a body to draw and for a file that is not a .gif or cannot be written.
    """
    target = check_writable(path)
    if target.suffix.lower() != ".gif":
        raise InputError(f"output {target}: an animation is a .gif; give such a name")
    if dataset.attrs.get("kind") != "trajectory" or "outline_x" not in dataset:
        raise InputError("no animation for this dataset: it needs a trajectory of a scene that has an outline")
    with written_aside(target, ".gif") as aside, mpl.rc_context(STYLE):  # Pillow chooses the format by the suffix
        _write(dataset, aside, progress)
    return target


def _write(dataset: xr.Dataset, path: Path, progress: Callable[[int], None] | None) -> None:
    figure = Figure(figsize=(WIDTH, 2.6), layout="constrained", dpi=DPI)
    FigureCanvasAgg(figure)
    axis = figure.subplots()
    frame_body(axis, dataset)
    body, times = draw_body(axis, dataset, 0, 0.0), dataset["time"].values
    writer = PillowWriter(fps=RATE)
    with writer.saving(figure, str(path), DPI):
        for index in spaced(times, FRAMES):
            body.set_data(dataset["outline_x"].values[index], dataset["outline_y"].values[index])
            axis.set_title(f"$t$ = {times[index]:.4g} s", loc="left")
            writer.grab_frame()
            if progress is not None:
                progress(1)
