"""`painleve distance SCENE`: e(A_eps, A), e(A, A_eps) and d_H by one of the methods."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, add_scene, add_state, print_json, read_state, real
from painleve.cli.method import add_method, read_method

if TYPE_CHECKING:
    from painleve.asymptotics.distance import Distance


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "distance",
        run,
        sentence="bound the distances between A_eps and its limit set at a state",
        example="painleve distance slender_rod --state critical --eps 1e-3 --samples 1e6",
    )
    add_scene(parser)
    add_state(parser)
    parser.add_argument("--eps", type=real, required=True, metavar="E", help="radius of the balls around q and u-")
    add_method(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.asymptotics.methods import distance
    from painleve.asymptotics.sample import check_eps
    from painleve.asymptotics.theorem import SHADOW
    from painleve.asymptotics.witness import find_family
    from painleve.theory.limit_set import limit_set

    eps = check_eps(options.eps)
    limit = limit_set(read_state(options))
    with read_method(options) as (name, settings):
        found = distance(limit, eps, name, settings)
    family = find_family(limit, eps, within=SHADOW * eps)
    witnessed = None if family is None else family.bound
    if options.json:
        print_json({**found.as_dict(), "witnessed": {"lower": None, "upper": witnessed}})
    else:
        _print(found, witnessed)
    return 0


def _print(found: Distance, witnessed: float | None) -> None:
    state = found.limit.state
    print(f"{state.scene.name}, {state.label}, eps = {found.eps:g}, method {found.method}: {found.ending}")
    for name, attained in (("e(A_eps, A)", found.excess_Aeps_A), ("e(A, A_eps)", found.excess_A_Aeps)):
        print(f"  {name:12} {attained.bounds}")
        if attained.member is not None:
            member = attained.member
            print(
                f"  {'':12} by a member that is {member.branch.label}, dq = {_vector(member.dq)}, "
                f"dv = {_vector(member.dv)}"
            )
    if witnessed is None:
        print(f"  {'':12} no witnesses: none were found that shadow all of A")
    else:
        print(f"  {'':12} ≤ {witnessed:.4e} (upper bound) by witnesses, built as the proof of Theorem 1 builds them")
    print(f"  {'d_H':12} {found.hausdorff}")
    if found.counts:
        print("  members      " + ", ".join(f"{name} {number}" for name, number in found.counts.items()))
    for name, value in found.settings.items():
        print(f"  {name:12} {value}")


def _vector(values: Any) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in values) + ")"
