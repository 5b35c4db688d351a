"""`painleve critical SCENE --along KEY`: at which friction, and where, a mechanism enters the paradox."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from painleve.cli.common import add_command, add_json, add_scene, add_state, assignments, print_json
from painleve.errors import InputError

if TYPE_CHECKING:
    from flint import arb

    from painleve.theory.critical import CriticalState, CriticalStates

LONG = 60  # characters of a closed form that is printed for a person


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "critical",
        run,
        sentence="list the critical states along a curve and the extrema of mu_c",
        example="painleve critical slender_rod --along theta --set mu=2",
    )
    add_scene(parser)
    parser.add_argument("--along", required=True, metavar="KEY", help="the state key that varies; the others are fixed")
    parser.add_argument("--from", dest="low", metavar="EXPR", help="where it begins (default: the key's interval)")
    parser.add_argument("--to", dest="high", metavar="EXPR", help="where it ends")
    add_state(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.mechanics.library import load_scene
    from painleve.theory.critical import critical_states

    scene = load_scene(options.scene)
    names = [word for word in options.state if "=" not in word]
    keys = assignments([word for word in options.state if "=" in word], "--state")
    if len(names) > 1:
        raise InputError(f"--state: {' and '.join(names)} are two names; give one, then KEY=EXPR to change it")
    parameters = assignments(options.parameters, "--set")
    found = critical_states(
        scene,
        options.along,
        low=options.low,
        high=options.high,
        name=names[0] if names else None,
        keys=keys,
        parameters=parameters,
    )
    if options.json:
        print_json(as_dict(found))
    else:
        print("\n".join(_text(found)))
    return 0


def as_dict(found: CriticalStates) -> dict[str, object]:
    """For machines: numbers as they are enclosed, closed forms as text."""
    least = found.least
    return {
        "scene": found.scene.name,
        "along": found.along,
        "from": str(found.low),
        "to": str(found.high),
        "zeros": [_entry(x) for x in found.zeros],
        "extrema": [_entry(x) for x in found.extrema],
        "least": None if least is None else _entry(least),
        "ends": [_number(x) for x in found.ends],
        "outside": [_ends(x) for x in found.outside],
        "changing": list(found.changing),
        "note": found.note,
        "status": "all found" if not found.unresolved else "some intervals are undecided",
    }


def _entry(x: CriticalState) -> dict[str, object]:
    return {
        "status": x.status.value,
        "value": _number(x.enclosure),
        "enclosure": _ends(x.enclosure),
        "exact": None if x.place is None else str(x.place),
        "critical_friction": _number(x.friction_enclosure),
        "critical_friction_enclosure": _ends(x.friction_enclosure),
        "critical_friction_exact": None if x.friction is None else str(x.friction),
        "extremum": None if x.extremum is None else x.extremum.value,
        "kind": x.kind.value,
        "reason": x.reason,
    }


def _number(x: arb) -> float:
    return float(x.mid()) if x.is_finite() else float("nan")


def _ends(x: arb) -> list[float]:
    return [float(x.lower()), float(x.upper())]


def _text(found: CriticalStates) -> list[str]:
    lines = [f"{found.scene.name}, along {found.along} from {found.low} to {found.high}"]
    lines += ["", "gamma = 0 at the scene's friction:", *([_line(found, x) for x in found.zeros] or ["  nowhere"])]
    lines += ["", "mu_c is stationary, and of which kind the state is with mu = mu_c:"]
    lines += [_line(found, x) for x in found.extrema] or [f"  {found.note or 'nowhere'}"]
    lines += ["", _conclusion(found)]
    if found.changing:
        lines.append(f"{', '.join(found.changing)} change along the curve: each state touches another obstacle")
    for interval in found.outside:
        low, high = _ends(interval)
        lines.append(f"left out: {found.along} in [{low:.9g}, {high:.9g}], where there is no state or M degenerates")
    return lines


def _line(found: CriticalStates, x: CriticalState) -> str:
    what = f"{x.extremum.value}, " if x.extremum is not None else ""
    return (
        f"  {found.along} = {_value(x.place, x.enclosure)}  mu_c = {_value(x.friction, x.friction_enclosure)}\n"
        f"      {what}{x.status.value}, {x.kind.value}: {x.reason}"
    )


def _value(exact: object, enclosure: arb) -> str:
    short = "" if exact is None or len(str(exact)) > LONG else f"{exact} = "
    if not enclosure.is_finite():
        return f"{short}unknown"
    low, high = _ends(enclosure)
    if high - low > 1e-9 * max(abs(low), abs(high), 1e-9):
        return f"{short}in [{low:.12g}, {high:.12g}]"
    number = f"{_number(enclosure):.10g}"
    return number if short == f"{number} = " else f"{short}{number}"


def _conclusion(found: CriticalStates) -> str:
    proof = "no other was missed: proved" if not found.unresolved else "some intervals above could not be resolved"
    if found.least is None:
        return proof
    least = found.least
    return (
        f"least friction of a paradox on this curve: {_value(least.friction, least.friction_enclosure)}, "
        f"at {found.along} = {_value(least.place, least.enclosure)}; {proof}"
    )
