"""The motion of a body as a GIF."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from painleve.errors import InputError
from painleve.plotting.style import STYLE, WIDTH
from painleve.plotting.trajectory import JUMPS, draw_body, frame_body, spaced
from painleve.store import check_writable, labels_of
from painleve.whole_file import written_aside

__all__ = ["FRAMES", "animate"]

FRAMES = 100  # at most
RATE = 20  # frames a second
DPI = 100
ROUNDED = 0.95  # nearer to real time than this is called so


def animate(dataset: xr.Dataset, path: str | Path, progress: Callable[[int], None] | None = None) -> Path:
    """Write the motion as a GIF, whole or not at all; `progress` hears of each frame.

    Frames are evenly spaced in time, at most one for each instant of the trajectory. Over them stand the time, how many
    times slower than the motion they are shown, and the last jump, at which the body leaves its outline.
    Raises InputError for a dataset without a body to draw and for a file that is not a .gif or cannot be written.
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
    frames, kinds = spaced(times, FRAMES), labels_of(dataset["change"])
    jumps = [int(i) for i in np.flatnonzero(np.isin(kinds, list(JUMPS)))]
    speed = _speed(float(times[-1] - times[0]), len(frames) / RATE)
    writer = PillowWriter(fps=RATE)
    with writer.saving(figure, str(path), DPI):
        for index in frames:
            body.set_data(dataset["outline_x"].values[index], dataset["outline_y"].values[index])
            axis.set_title(f"$t$ = {times[index]:.4g} s{speed}", loc="left")
            while jumps and jumps[0] <= index:
                _mark_jump(axis, dataset, jumps.pop(0), kinds)
            writer.grab_frame()
            if progress is not None:
                progress(1)


def _speed(motion: float, shown: float) -> str:
    """How much slower or faster than the motion the pictures follow each other."""
    ratio = shown / motion if motion > 0.0 else 1.0
    if ROUNDED < ratio < 1.0 / ROUNDED:
        return ", real time"
    return f", shown {ratio:.3g} times slower" if ratio > 1.0 else f", shown {1.0 / ratio:.3g} times faster"


def _mark_jump(axis: Axes, dataset: xr.Dataset, index: int, kinds: np.ndarray) -> None:
    """The body where it jumped stays in the picture, in the colour of the jump; the last jump is named above."""
    words, colour, style = JUMPS[kinds[index]]
    x, y = dataset["outline_x"].values[index], dataset["outline_y"].values[index]
    axis.plot(x, y, color=colour, linestyle=style, linewidth=1.2, zorder=1)
    axis.set_title(f"{words} at $t$ = {dataset['time'].values[index]:.4g} s", loc="right", color=colour)
