"""`painleve sweep SCENE`: distances over eps and parameters, kept as HDF5."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from painleve.cli.common import add_command, add_json, add_scene, add_state, keeping, print_json, read_state_words, real
from painleve.cli.method import add_method, read_method
from painleve.cli.process import ended_by
from painleve.errors import InputError

if TYPE_CHECKING:
    import xarray as xr


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "sweep",
        run,
        sentence="measure the distances over eps, states and parameters, and keep them as HDF5",
        example="painleve sweep slender_rod --state 'theta=atan(2)' --over mu=1,4/3,2 --eps 1e-1 1e-2 1e-3 -o sweep.h5",
    )
    add_scene(parser)
    add_state(parser)
    parser.add_argument("--eps", type=real, nargs="+", required=True, metavar="E", help="radii of the balls")
    parser.add_argument(
        "--over",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=EXPR,EXPR,...",
        help="values of a parameter or a state key to sweep",
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="the HDF5 file to write")
    add_method(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from tqdm import tqdm

    from painleve.mechanics.library import load_scene
    from painleve.store import check_output
    from painleve.sweep import sweep_distances

    target = check_output(options.output)
    scene = load_scene(options.scene)
    names, keys, parameters = read_state_words(options, scene)
    over = _over(options.over)
    points = max(1, len(names)) * len(options.eps)
    for values in over.values():
        points *= len(values)
    bar = tqdm(total=points, leave=False, delay=1.0, disable=None, file=sys.stderr)  # none where nobody watches
    with read_method(options, quiet=True) as (method, settings), bar:

        def progress(label: str) -> None:
            bar.set_postfix_str(label)
            bar.update()

        dataset = sweep_distances(
            scene,
            eps=options.eps,
            states=names,
            keys=keys,
            parameters=parameters,
            over=over,
            method=method,
            options=settings,
            progress=progress,
        )
    with keeping(dataset, target) as written:
        verdicts = list(_verdicts(dataset))
        if options.json:
            sizes = {str(name): int(size) for name, size in dataset.sizes.items()}
            file, status = written and str(written), dataset.attrs["status"]
            facts = {"file": file, "status": status, "dimensions": sizes, "points": points, "verdicts": verdicts}
            print_json(facts)
        else:
            _print(verdicts)
            if written:
                print(f"{written}: {_points(dataset, points)}; `painleve plot {written}` draws them")
    return 0 if dataset.attrs["status"] == "complete" else ended_by(signal.SIGINT)


def _print(verdicts: Sequence[dict[str, str]]) -> None:
    for verdict in verdicts:
        known, judged = verdict["branch"] != "not_run", verdict["status"] != "not_run"
        if judged:
            print("{point}: {branch}; {status}: {reason}".format(**verdict))
        elif known:
            print("{point}: {branch}; interrupted before its verdict".format(**verdict))
        else:
            print(
                "{point}: ".format(**verdict) + (f"failed: {verdict['failure']}" if verdict["failure"] else "not run")
            )
        if verdict["failure"] and known:
            print("  failed at an eps: {failure}".format(**verdict))


def _points(dataset: xr.Dataset, points: int) -> str:
    number = f"{points} {'point' if points == 1 else 'points'}"
    ran = int((dataset["outcome"] != 0).sum())
    return number if dataset.attrs["status"] == "complete" else f"interrupted after {ran} of {number}"


def _verdicts(dataset: xr.Dataset) -> Iterator[dict[str, str]]:
    """What the sweep says of Theorem 1 at each state and combination of swept values."""
    names = {name: dataset[name].attrs["flag_meanings"].split() for name in ("theorem_branch", "verdict")}
    swept = dataset["verdict"].dims
    for index in np.ndindex(*dataset["verdict"].shape):
        spot = dataset.isel(dict(zip(swept, index, strict=True)))
        places = [str(spot["state"].item())]
        places += [f"{name}={spot[f'{name}_exact'].item()}" for name in swept if name != "state"]
        branch, status = (names[name][int(spot[name])] for name in ("theorem_branch", "verdict"))
        reason = str(spot["verdict_reason"].item())
        yield {
            "point": " ".join(places),
            "branch": branch,
            "status": status,
            "reason": reason,
            "failure": _failure(spot),
        }


def _failure(spot: xr.Dataset) -> str:
    """Why a point failed, the first of them; empty where none did."""
    return next((str(reason) for reason in spot["outcome_reason"].values if reason), "")


def _over(words: list[str]) -> dict[str, list[str]]:
    table: dict[str, list[str]] = {}
    for word in words:
        name, equals, values = word.partition("=")
        if not equals or not name or not all(v.strip() for v in values.split(",")):
            raise InputError(f"--over: {word!r} is not NAME=EXPR,EXPR,...")
        table[name] = [v.strip() for v in values.split(",")]
    return table
