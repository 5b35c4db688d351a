"""`painleve scenes`: what the library, or a scene of the user's own, has."""

from __future__ import annotations

import argparse
from typing import Any

from painleve.cli.common import add_command, add_json, print_json


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "scenes",
        run,
        sentence="list the scenes with their keys, parameters and named states",
        example="painleve scenes",
    )
    parser.add_argument(
        "scenes", nargs="*", metavar="SCENE", help="these alone, files of your own among them (default: the library)"
    )
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.mechanics.library import SCENE_NAMES, load_scene

    scenes = [load_scene(name) for name in options.scenes or SCENE_NAMES]
    if options.json:
        print_json(
            {
                s.name: {
                    "sentence": s.sentence,
                    "keys": {k.name: {"unit": k.unit, "sentence": k.sentence, "default": k.default} for k in s.keys},
                    "parameters": {
                        p.name: {"unit": p.unit, "sentence": p.sentence, "default": p.default} for p in s.parameters
                    },
                    "states": {
                        n.name: {"sentence": n.sentence, "keys": dict(n.keys), "parameters": dict(n.parameters)}
                        for n in s.states
                    },
                }
                for s in scenes
            }
        )
        return 0
    for scene in scenes:
        print(f"{scene.name}: {scene.sentence}")
        print("  keys        " + ", ".join(f"{k.name} [{k.unit}]" for k in scene.keys))
        print("  parameters  " + ", ".join(f"{p.name} [{p.unit}]" for p in scene.parameters))
        for state in scene.states:
            print(f"  --state {state.name:12} {state.sentence}")
        print()
    return 0
