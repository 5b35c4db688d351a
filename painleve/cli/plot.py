"""`painleve plot FILE`: the figure of a dataset that was kept."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, print_json
from painleve.cli.studies import drawings_of
from painleve.errors import InputError

if TYPE_CHECKING:
    import xarray as xr


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "plot",
        run,
        sentence="draw the figure of a dataset that sweep, simulate or a study wrote",
        example="painleve plot sweep.h5 -o sweep.pdf",
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="the HDF5 file")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FIGURE",
        help="a .pdf, .png or .svg file (default: FILE with .png); with --animate a .gif",
    )
    parser.add_argument("--animate", action="store_true", help="write the motion of a trajectory as a .gif")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.plotting.draw import DRAWINGS, draw, save_figure
    from painleve.store import check_writable, load

    target = check_writable(options.output or options.file.with_suffix(".gif" if options.animate else ".png"))
    dataset = load(options.file)
    with answering_for(options.file):
        if options.animate:
            written = _animate(dataset, target)
        else:
            kind = str(dataset.attrs["kind"])
            written = save_figure(draw(dataset, None if kind in DRAWINGS else drawings_of(kind)), target)
    if options.json:
        print_json({"file": str(written)})
    else:
        print(written)
    return 0


@contextmanager
def answering_for(file: Path) -> Iterator[None]:
    """One line where a file is built as it should be, and holds numbers of which nothing, or not all, can be drawn."""
    from painleve.notes import one_line, say

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            yield
        except InputError:
            raise
        except Exception as error:
            why = one_line(str(error)) or type(error).__name__
            raise InputError(f"input {file}: no figure can be drawn of what it holds ({why})") from error
    if caught:
        say(f"{file}: the figure may not show what it holds: {caught[0].message}")


def _animate(dataset: xr.Dataset, target: Path) -> Path:
    from tqdm import tqdm

    from painleve.plotting.animation import animate

    with tqdm(unit=" frames", leave=False, delay=1.0, disable=None) as bar:
        return animate(dataset, target, progress=bar.update)
