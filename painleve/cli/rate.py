"""`painleve rate SCENE`: the constant C in d_H = C eps + o(eps), or C sqrt(eps) + o(sqrt(eps))."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, add_scene, add_state, print_json, read_state

if TYPE_CHECKING:
    from painleve.asymptotics.rates import Rate


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "rate",
        run,
        sentence="the rate of Theorem 1 from first derivatives: C in d_H = C eps + o(eps)",
        example="painleve rate slender_rod --state paradox",
    )
    add_scene(parser)
    add_state(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.asymptotics.rates import rate
    from painleve.theory.limit_set import limit_set

    found = rate(limit_set(read_state(options)))
    if options.json:
        print_json(found.as_dict())
    else:
        _print(found)
    return 0


def _print(found: Rate) -> None:
    state = found.limit.state
    print(f"{state.scene.name}, {state.label}: {found.sentence}")
    print(f"  C            {found.C:.15g}, in the scene's units; a maximum found by search, exact to rounding")
    if found.closed_form is not None:
        print(f"  closed form  {found.closed_form}")
    print(f"  attained     in the part {found.part!r}, to first order at")
    for name, values in (("dq", found.dq), ("dv", found.dv)):
        print(f"  {name + '/eps':12} ({', '.join(f'{x:.9g}' for x in values)})")
