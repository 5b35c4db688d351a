"""`painleve scan SCENE`: the least critical friction over a mechanism's range, and how much of it is paradoxical."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, add_scene, add_state, assignments, count, print_json
from painleve.errors import InputError

if TYPE_CHECKING:
    from painleve.sweep.scan import Least, Scan, Share


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "scan",
        run,
        sentence="search a mechanism's range for the least critical friction, and estimate its paradoxical share",
        example="painleve scan hopper_heel.toml --range rooty=-1/5,1/5",
    )
    add_scene(parser)
    parser.add_argument(
        "--range",
        nargs="+",
        action="extend",
        default=[],
        dest="ranges",
        metavar="NAME=LOW,HIGH",
        help="ranges of keys, coordinates or parameters (default: a mechanism's joints between their limits)",
    )
    add_state(parser)
    parser.add_argument("--points", type=count, default=200_000, metavar="N", help="points of the search (200000)")
    parser.add_argument("--seed", type=count, default=0, help="of the lattice (0)")
    parser.add_argument(
        "--let-others-sink", action="store_true", help="keep configurations in which another part is below the plane"
    )
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.mechanics.library import load_scene
    from painleve.sweep.scan import scan_friction

    scene = load_scene(options.scene)
    names = [word for word in options.state if "=" not in word]
    if len(names) > 1:
        raise InputError(f"--state: {' and '.join(names)} are two names; give one, then KEY=EXPR to change it")
    ranges = {}
    for name, text in assignments(options.ranges, "--range").items():
        ends = text.split(",")
        if len(ends) != 2:
            raise InputError(f"--range: {name}={text} is not NAME=LOW,HIGH")
        ranges[name] = (ends[0], ends[1])
    found = scan_friction(
        scene,
        ranges=ranges,
        state=names[0] if names else None,
        keys=assignments([word for word in options.state if "=" in word], "--state"),
        parameters=assignments(options.parameters, "--set"),
        points=options.points,
        seed=options.seed,
        others_above=not options.let_others_sink,
    )
    if options.json:
        print_json(found.as_dict())
    else:
        print("\n".join(_text(found)))
    return 0


def _text(found: Scan) -> list[str]:
    space = found.scene.contact.section.dimension > 1
    lines = [f"{found.scene.name}: {found.points} points over {', '.join(found.ranges)}"]
    for sense, sign in (("plus", "v_t > 0"), ("minus", "v_t < 0")):
        heading = "every direction" if space else f"slip {sign}"
        lines += _least(heading, found.least[sense])
        lines.append(
            f"    gamma < 0 at the scene's friction in {_share(found.negative[sense])} of the range (estimate)"
        )
        if space:
            break
    if not space:
        lines.append(f"  in either sense, gamma < 0 in {_share(found.paradoxical)} (estimate)")
    if found.admitted.value < 1.0:
        lines.append(
            f"  looked at: {_share(found.admitted)} of the range, without configurations in which another part is "
            "below the plane (--let-others-sink keeps them)"
        )
    return lines


def _least(heading: str, least: Least | None) -> list[str]:
    if least is None:
        return [f"  {heading}: no configuration has a critical friction"]
    where = ", ".join(f"{name} = {value:.6g}" for name, value in least.at.items())
    return [f"  {heading}: least mu_c <= {least.upper:.8g} (upper bound: attained in floats), at {where}"]


def _share(share: Share) -> str:
    return f"{100 * share.value:.3g} +- {100 * share.error:.1g} %"
