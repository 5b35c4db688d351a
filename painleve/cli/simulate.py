"""`painleve simulate SCENE`: one trajectory by any scheme."""

from __future__ import annotations

import argparse
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, keeping, print_json
from painleve.cli.motion import add_motion, read_options, read_start
from painleve.errors import InputError

if TYPE_CHECKING:
    from painleve.dynamics.trajectory import Trajectory

BAR = "{percentage:3.0f}%|{bar}| t = {n:.3g} of {total:.3g} s [{elapsed}<{remaining}]"


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "simulate",
        run,
        sentence="follow one trajectory and report its jumps and Proposition 1's margins",
        example="painleve simulate slender_rod --state stoss --step 1e-3 --until 1",
    )
    add_motion(parser)
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="keep the trajectory in this HDF5 file")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from tqdm import tqdm

    from painleve.core.motion_codes import Ending
    from painleve.dynamics.simulate import simulate
    from painleve.store import check_output

    target = options.output and check_output(options.output)
    with tqdm(total=options.until, bar_format=BAR, leave=False, delay=1.0, disable=None) as bar:
        trajectory = simulate(
            read_start(options),
            scheme=options.scheme,
            step=options.step,
            until=options.until,
            contact_tolerance=options.contact_tolerance,
            options=read_options(options),
            progress=lambda covered: bar.update(min(covered, bar.total - bar.n)),
        )
    if trajectory.ending is Ending.NOT_FINITE:
        raise InputError(f"{trajectory.sentence}; after {trajectory.steps} steps, at t = {trajectory.t[-1]:.6g}")
    with _keeping(trajectory, target):
        if options.json:
            print_json(trajectory.as_dict())
        else:
            _print(trajectory)
    return 0


def _keeping(trajectory: Trajectory, target: Path | None) -> AbstractContextManager[Path | None]:
    from painleve.sweep.trajectories import trajectory_dataset

    return keeping(trajectory_dataset(trajectory), target) if target else nullcontext()


def _print(trajectory: Trajectory) -> None:
    from painleve.dynamics.proposition1 import MARGIN_SCALE

    facts = trajectory.as_dict()
    print(f"{trajectory.start.scene.name}, {trajectory.start.label}: {facts['ending']}")
    for note in trajectory.notes:
        print(f"  note       {note}")
    print(f"  steps      {trajectory.steps}, t = {trajectory.t[-1]:.9g} s at the end")
    for jump in trajectory.jumps:
        print(f"  jump       t = {jump.time:.9g} s, {jump.kind.label}, gamma = {jump.gamma:.6g}")
    for name, values in (("q", trajectory.q[-1]), ("u", trajectory.u[-1])):
        coordinates = trajectory.start.scene.coordinates
        print(f"  {name:10} " + ", ".join(f"{c.name} {x:.9g}" for c, x in zip(coordinates, values, strict=True)))
    margins = trajectory.proposition1
    if margins is not None:
        for name, margin in margins.as_dict().items():
            print(f"  Proposition 1, {name}: worst margin {margin:.3g} at step {margins.steps()[name]}")
        print(f"  (a margin is positive where the statement fails; {MARGIN_SCALE})")
