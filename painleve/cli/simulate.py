"""`painleve simulate SCENE`: one trajectory by any scheme."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, print_json
from painleve.cli.motion import add_motion, read_start

if TYPE_CHECKING:
    from painleve.dynamics.trajectory import Trajectory


def register(commands: Any) -> None:
    parser = add_command(
        commands, "simulate", run, sentence="follow one trajectory and report its jumps and Proposition 1's margins",
        example="painleve simulate slender_rod --state stoss --step 1e-3 --until 1",
    )  # fmt: skip
    add_motion(parser)
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="keep the trajectory in this HDF5 file")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.dynamics.simulate import simulate
    from painleve.store import check_writable

    target = options.output and check_writable(options.output)
    trajectory = simulate(
        read_start(options), scheme=options.scheme, step=options.step, until=options.until,
        contact_tolerance=options.contact_tolerance,
    )  # fmt: skip
    if target is not None:
        _keep(trajectory, target)
    if options.json:
        print_json(trajectory.as_dict())
    else:
        _print(trajectory)
    return 0


def _keep(trajectory: Trajectory, target: Path) -> None:
    from painleve.kernels.compiled import make_kernels
    from painleve.store import provenance, save

    scene = trajectory.start.scene
    dataset = trajectory.to_xarray()
    source = provenance(scene=scene.name, scene_digest=make_kernels(scene).digest, seed=0)
    title = f"Trajectory of {scene.name} by {trajectory.scheme}: {scene.sentence}"
    save(dataset.assign_attrs({**source, "title": title, "kind": "trajectory"}), target)


def _print(trajectory: Trajectory) -> None:
    facts = trajectory.as_dict()
    print(f"{trajectory.start.scene.name}, {trajectory.start.label}: {facts['ending']}")
    print(f"  steps      {trajectory.steps}, t = {trajectory.t[-1]:.9g} s at the end")
    for jump in trajectory.jumps:
        print(f"  jump       t = {jump.time:.9g} s, {jump.kind.label}, gamma = {jump.gamma:.6g}")
    for name, values in (("q", trajectory.q[-1]), ("u", trajectory.u[-1])):
        coordinates = trajectory.start.scene.coordinates
        print(f"  {name:10} " + ", ".join(f"{c.name} {x:.9g}" for c, x in zip(coordinates, values, strict=True)))
    if trajectory.proposition1 is not None:
        for name, margin in trajectory.proposition1.as_dict().items():
            print(f"  {name}: {margin}")
