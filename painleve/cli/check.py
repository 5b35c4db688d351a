"""`painleve check SCENE`: the hypotheses of Theorem 1 near a state, and the units of the scene."""

from __future__ import annotations

import argparse
import textwrap
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, add_scene, add_state, assignments, print_json, read_state
from painleve.errors import InputError

if TYPE_CHECKING:
    from painleve.mechanics.scene import Scene
    from painleve.theory.hypotheses.check import HypothesesCheck

WIDTH = 118


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "check",
        run,
        sentence="check the hypotheses (H1) to (H4) of Theorem 1 near a state, or near each named state, and the units",
        example="painleve check slender_rod --state paradox --radius 1/10",
    )
    add_scene(parser)
    add_state(parser)
    parser.add_argument(
        "--radius",
        default=None,
        metavar="R",
        help="of the ball around the state, an exact number (default 1/10), in the scene's units",
    )
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.theory.hypotheses.check import DEFAULT_RADIUS, check_hypotheses

    radius = DEFAULT_RADIUS if options.radius is None else options.radius
    if options.state:
        found = check_hypotheses(read_state(options), radius=radius)
        if options.json:
            print_json({**found.as_dict(), "units": _units(found.state.scene)})
        else:
            _print_one(found)
            _print_units(found.state.scene)
        return 0
    checks = [check_hypotheses(state, radius=radius) for state in _named_states(options)]
    if options.json:
        states = {c.state.label: c.as_dict() for c in checks}
        print_json({"scene": options.scene, "states": states, "units": _units(checks[0].state.scene)})
    else:
        _print_table(checks)
        _print_units(checks[0].state.scene)
    return 0


def _units(scene: Scene) -> dict[str, Any]:
    """The units for machines; without pint why they are not checked."""
    from painleve.mechanics.units.check import Agreement, check_units

    try:
        return check_units(scene).as_dict()
    except InputError as reason:
        return {"status": Agreement.UNCHECKED.value, "reason": str(reason)}


def _print_units(scene: Scene) -> None:
    """One line where all agree, else one a quantity that does not, or that could not be checked."""
    facts = _units(scene)
    if "reason" in facts:
        print(f"\nunits: {facts['status']}: {facts['reason']}")
        return
    agree, open_ones = facts["agree"], facts["open"]
    known = f", {len(open_ones)} do not or could not be checked" if open_ones else ""
    print(f"\nunits: {len(agree)} quantities agree{known}")
    for found in open_ones:
        line = "{what}: {status}: {sentence}".format(**found)
        print(textwrap.fill(line, WIDTH, initial_indent="  ", subsequent_indent="     "))


def _named_states(options: argparse.Namespace) -> list[Any]:
    from painleve.mechanics.library import load_scene
    from painleve.mechanics.state import make_state

    scene = load_scene(options.scene)
    if not scene.states:
        return [read_state(options)]  # says that a state is needed, and its keys
    parameters = assignments(options.parameters, "--set")
    return [make_state(scene, named.name, parameters=parameters) for named in scene.states]


def _print_one(found: HypothesesCheck) -> None:
    print(f"{found.state.scene.name}, {found.state.label}: {_ball(found)}")
    for h in found.hypotheses:
        print(f"\n({h.name}) {h.status.value}: {h.asks}")
        print(textwrap.fill(h.sentence, WIDTH, initial_indent="     ", subsequent_indent="     "))
    print(f"\n{found.theorem.value}: {found.sentence}")


def _print_table(checks: list[HypothesesCheck]) -> None:
    """One row a state; then a sentence for whatever is not proved."""
    print(f"{checks[0].state.scene.name}: {_ball(checks[0])}\n")
    names = [h.name for h in checks[0].hypotheses]
    rows = [["state", *names, "Theorem 1"]]
    rows += [[c.state.label, *(h.status.value for h in c.hypotheses), c.theorem.value] for c in checks]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        print("  ".join(f"{word:{width}}" for word, width in zip(row, widths, strict=True)).rstrip())
    open_ones = [(c, h) for c in checks for h in c.hypotheses if h.status.value != "proved"]
    for check, hypothesis in open_ones:
        line = f"{check.state.label}, ({hypothesis.name}) {hypothesis.status.value}: {hypothesis.sentence}"
        print("\n" + textwrap.fill(line, WIDTH, subsequent_indent="     "))


def _ball(found: HypothesesCheck) -> str:
    return f"hypotheses of Theorem 1 on the closed ball of radius {float(found.radius):g} around q"
