"""`painleve rate SCENE`: the constant C in d_H = C eps + o(eps), or C sqrt(eps) + o(sqrt(eps))."""

from __future__ import annotations

import argparse
from typing import Any

from painleve.cli.common import add_command, add_json, add_scene, add_state, print_json, read_state


def register(commands: Any) -> None:
    parser = add_command(
        commands, "rate", run, sentence="the rate of Theorem 1 from first derivatives: C in d_H = C eps + o(eps)",
        example="painleve rate slender_rod --state paradox",
    )  # fmt: skip
    add_scene(parser)
    add_state(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.asymptotics.limit_set import limit_set
    from painleve.asymptotics.rates import rate

    found = rate(limit_set(read_state(options)))
    facts = found.as_dict()
    if options.json:
        print_json(facts)
        return 0
    for name, value in facts.items():
        print(f"  {name:12} {value}")
    return 0
