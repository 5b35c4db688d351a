"""`painleve import MODEL`: a scene file from a robot's file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from painleve.cli.common import add_command, assignments
from painleve.errors import InputError


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "import",
        run,
        sentence="write a scene file from a robot's file, MJCF or URDF (needs the package mujoco)",
        example="painleve import hopper.xml --body foot --geom foot_geom --end 0 --planar -o hopper_heel.toml",
    )
    parser.add_argument("model", type=Path, metavar="MODEL", help="the robot's file, MODEL.xml or MODEL.urdf")
    parser.add_argument("--body", required=True, metavar="BODY", help="the body that touches")
    place = parser.add_mutually_exclusive_group(required=True)
    place.add_argument("--geom", metavar="GEOM", help="its geom that touches: a sphere, or a capsule with --end")
    place.add_argument("--point", nargs=3, metavar=("X", "Y", "Z"), help="its point that touches, in its own frame")
    parser.add_argument("--end", type=int, choices=(0, 1), help="the end of a capsule that touches")
    parser.add_argument("--plane", metavar="NAME", help="the plane that it touches (default: the only one of the file)")
    parser.add_argument(
        "--lock", nargs="+", action="extend", default=[], metavar="JOINT=VALUE", help="joints that are held at a value"
    )
    parser.add_argument(
        "--planar", action="store_true", help="the robot moves in one plane: friction along one tangent"
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="the scene file, FILE.toml")


def run(options: argparse.Namespace) -> int:
    from painleve.mechanics.robot_file.contact import choose_contact
    from painleve.mechanics.robot_file.read import read_robot
    from painleve.mechanics.robot_file.scene_text import robot_scene_text
    from painleve.mechanics.scene_file.build import scene_of_text
    from painleve.whole_file import write_whole

    target = options.output
    if target.suffix != ".toml":
        raise InputError(f"-o: {target} is no scene file; give a name that ends in .toml")
    if target.exists():
        raise InputError(f"{target} exists already; give another name, or remove it")
    robot = read_robot(options.model, assignments(options.lock, "--lock"))
    chosen = choose_contact(
        robot,
        options.model,
        body=options.body,
        geom=options.geom,
        end=options.end,
        point=options.point,
        plane=options.plane,
    )
    text = robot_scene_text(robot, options.model, chosen, options.planar)
    scene = scene_of_text(target.name, text)  # refused here, what cannot be read back leaves no file
    write_whole(target, text.encode())
    print(f"{target}: {scene.sentence}")
    print(f"  coordinates  {', '.join(c.name for c in scene.coordinates)}")
    print(f"  friction     {float(chosen.friction):g}")
    for line in text.splitlines():
        if line.startswith("# Written"):
            print(f"  left out     {line.partition('Left out: ')[2].rstrip('.')}")
    return 0
