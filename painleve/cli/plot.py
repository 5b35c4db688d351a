"""`painleve plot FILE`: the figure of a dataset that was kept."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, print_json
from painleve.cli.studies import drawings_of

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


def _animate(dataset: xr.Dataset, target: Path) -> Path:
    from tqdm import tqdm

    from painleve.plotting.animation import animate

    with tqdm(unit=" frames", leave=False, delay=1.0, disable=None) as bar:
        return animate(dataset, target, progress=bar.update)
