"""`painleve map SCENE --over NAME=A:B`: where a workspace is paradoxical, and from which friction on."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from painleve.cli.common import add_command, add_json, add_scene, add_state, assignments, print_json
from painleve.errors import InputError

POINTS = 400  # on an axis
YES = 2  # the code of that answer


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "map",
        run,
        sentence="draw the critical friction and the paradoxical regions over one or two axes, in floats",
        example="painleve map slender_rod --over theta=0.1:1.5 mu=0:3 --state critical -o rod.png",
    )
    add_scene(parser)
    parser.add_argument(
        "--over",
        nargs="+",
        action="extend",
        required=True,
        metavar="NAME=A:B",
        help="one or two state keys, coordinates or parameters, and their ranges; NAME=A:B:N for N points",
    )
    add_state(parser)
    parser.add_argument("--slip", choices=("+", "-", "both"), default="both", help="the sense of the slip (both)")
    parser.add_argument(
        "--let-others-sink", action="store_true", help="keep configurations in which another part is below the plane"
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="the figure; its data lie beside it as .h5")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.mechanics.library import load_scene
    from painleve.plotting import draw, save_figure
    from painleve.store import check_writable, save
    from painleve.sweep.friction_map import map_friction

    scene = load_scene(options.scene)
    axes = read_axes(options.over)
    names = [word for word in options.state if "=" not in word]
    if len(names) > 1:
        raise InputError(f"--state: {' and '.join(names)} are two names; give one, then KEY=EXPR to change it")
    keys = assignments([word for word in options.state if "=" in word], "--state")
    parameters = assignments(options.parameters, "--set")
    data = check_writable(options.output.with_suffix(".h5")) if options.output else None
    dataset = map_friction(
        scene,
        axes,
        state=names[0] if names else None,
        keys=keys,
        parameters=parameters,
        others_above=not options.let_others_sink,
    )
    senses = {"+": ("plus",), "-": ("minus",), "both": ("plus", "minus")}[options.slip]
    dataset.attrs["drawn_senses"] = " ".join(senses)
    if data is not None:
        save_figure(draw(dataset), options.output)
        save(dataset, data)
    summary = summarise(dataset, senses)
    if options.json:
        print_json(summary)
    else:
        print("\n".join(_text(summary, options.output)))
    return 0


def read_axes(words: list[str]) -> dict[str, np.ndarray]:
    """NAME=A:B or NAME=A:B:N, exact ends, as floats."""
    from painleve.exact.balls import ball
    from painleve.exact.parse import exact_number

    axes: dict[str, np.ndarray] = {}
    for name, text in assignments(words, "--over").items():
        parts = text.split(":")
        if len(parts) not in (2, 3):
            raise InputError(f"--over: {name}={text} is not NAME=A:B or NAME=A:B:N")
        low, high = (float(ball(exact_number(x, where=f"--over {name}"), bits=64).mid()) for x in parts[:2])
        points = parts[2] if len(parts) == 3 else str(POINTS)
        if not (points.isascii() and points.isdigit() and 2 <= int(points) <= 100_000):
            raise InputError(f"--over: {points!r} is no number of points from 2 to 100000")
        if not low < high:
            raise InputError(f"--over: the range of {name}, {parts[0]} to {parts[1]}, is empty")
        axes[name] = np.linspace(low, high, int(points))
    return axes


def summarise(dataset: Any, senses: tuple[str, ...]) -> dict[str, object]:
    """The least critical friction on the grid and where it is, by sense, and the paradoxical share of the grid."""
    admitted = dataset["admitted"].values == YES
    found: dict[str, object] = {"scene": dataset.attrs["scene"], "admitted": float(admitted.mean())}
    for sense in senses:
        critical = dataset[f"critical_friction_{sense}"]
        values = np.where(np.isfinite(critical.values), critical.values, np.inf)
        place = np.unravel_index(int(values.argmin()), values.shape)
        least = float(values[place])
        at = {str(d): float(dataset[d].values[i]) for d, i in zip(critical.dims, place, strict=True)}
        negative = dataset[f"gamma_negative_{sense}"].values[admitted] == YES
        found[sense] = {
            "least_on_grid": least if np.isfinite(least) else None,
            "at": at if np.isfinite(least) else None,
            "gamma_negative": float(negative.mean()) if negative.size else None,
        }
    return found


def _text(summary: dict[str, Any], output: Path | None) -> list[str]:
    lines = [f"{summary['scene']}"]
    for sense, sign in (("plus", "v_t > 0"), ("minus", "v_t < 0")):
        if sense in summary:
            found = summary[sense]
            where = ", ".join(f"{name} = {value:.6g}" for name, value in (found["at"] or {}).items())
            value = f"least mu_c on the grid {found['least_on_grid']:.6g}, at {where}" if where else ""
            least = value or "no critical friction"
            share = "none admitted" if found["gamma_negative"] is None else f"{100 * found['gamma_negative']:.3g} %"
            lines.append(f"  slip {sign}  {least}; gamma < 0 at the scene's friction in {share} of the grid")
    if summary["admitted"] < 1.0:
        lines.append(f"  admitted      {100 * summary['admitted']:.3g} % of the grid: elsewhere another part is below")
    return [*lines, f"wrote {output} and {output.with_suffix('.h5')}"] if output else lines
