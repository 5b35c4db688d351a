"""`painleve classify SCENE`: the branch of Theorem 1 at a state."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, add_scene, add_state, print_json, read_state

if TYPE_CHECKING:
    from painleve.mechanics.state import State


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
    parser.add_argument(
        "--law",
        choices=("projection", "coulomb"),
        default="projection",
        help="projection: the paper's (7), of which Theorem 1 speaks (default); coulomb: the right velocities of "
        "Coulomb's law with maximal dissipation, the same but for friction in space",
    )
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.theory.classification import classify

    if options.law == "coulomb":
        return _run_coulomb(options)
    found = classify(read_state(options))
    if options.json:
        print_json(found.as_dict())
        return 0
    limit = found.limit
    print(f"{limit.state.scene.name}, {limit.state.label}")
    other = "; in space not Coulomb's, which --law coulomb answers for" if _in_space(limit.state) else ""
    print(f"  law        projection, the paper's (7){other}")
    print(f"  branch     {found.branch.value}: {found.reason}")
    print(f"  statement  {found.statement}")
    print(f"  gamma      {limit.gamma_value:.12g} (its sign is exact: {limit.gamma.sign.name.lower()})")
    print(f"  limit set  {limit.kind}")
    for name, values in (("u-", limit.u_minus), ("u_tilde", limit.u_plus)):
        print(f"  {name:10} {_velocity(limit.state, values)}")
    return 0


def _run_coulomb(options: argparse.Namespace) -> int:
    """Coulomb's right velocities, of which Theorem 1 says nothing in space."""
    from painleve.theory.limit_set import limit_set

    found = limit_set(read_state(options), law="coulomb")
    if options.json:
        print_json(found.as_dict())
        return 0
    print(f"{found.state.scene.name}, {found.state.label}")
    print("  law        Coulomb's, with maximal dissipation")
    print(f"  solutions  {found.kind}: {found.reason}")
    print(f"  gamma      {found.gamma.value:.12g} (its sign is exact: {found.gamma.sign.name.lower()})")
    for jump in found.jumps:
        name = "u-" if jump.kind == "open" else jump.kind
        print(f"  {name:10} {_velocity(found.state, found.floats(jump.velocity))}")
        if jump.end is not None:
            print(f"  {'... to':10} {_velocity(found.state, found.floats(jump.end))}")
    return 0


def _in_space(state: State) -> bool:
    return state.scene.contact.section.dimension == 2


def _velocity(state: State, values: Iterable[float]) -> str:
    pairs = zip(state.scene.coordinates, values, strict=True)
    return ", ".join(f"{c.name} {value:.12g} {c.unit}/s" for c, value in pairs)
