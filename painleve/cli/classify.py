"""`painleve classify SCENE`: the branch of Theorem 1 at a state."""

from __future__ import annotations

import argparse
from typing import Any

from painleve.cli.common import add_command, add_json, add_scene, add_state, print_json, read_state


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "classify",
        run,
        sentence="decide in exact arithmetic which branch of Theorem 1 holds at a state",
        example="painleve classify slender_rod --state theta='atan(2)' slip=-1 --set mu=4/3",
    )
    add_scene(parser)
    add_state(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.theory.classification import classify

    found = classify(read_state(options))
    if options.json:
        print_json(found.as_dict())
        return 0
    limit = found.limit
    coordinates = limit.state.scene.coordinates
    print(f"{limit.state.scene.name}, {limit.state.label}")
    print(f"  branch     {found.branch.value}: {found.reason}")
    print(f"  statement  {found.statement}")
    print(f"  gamma      {limit.gamma_value:.12g} (its sign is exact: {limit.gamma.sign.name.lower()})")
    print(f"  limit set  {limit.kind}")
    for name, values in (("u-", limit.u_minus), ("u_tilde", limit.u_plus)):
        parts = (f"{c.name} {value:.12g} {c.unit}/s" for c, value in zip(coordinates, values, strict=True))
        print(f"  {name:10} " + ", ".join(parts))
    return 0
