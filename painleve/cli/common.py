"""What the commands share: the arguments that give a scene and a state, numbers, and printing."""

from __future__ import annotations

import argparse
import json
import math
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from painleve.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from painleve.mechanics.scene import Scene
    from painleve.mechanics.state import State

__all__ = [
    "add_command",
    "add_json",
    "add_scene",
    "add_state",
    "assignments",
    "count",
    "keeping",
    "print_json",
    "read_state",
    "read_state_words",
    "real",
]

_WHOLE = re.compile(r"[+-]?[0-9]+")
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")


def add_command(
    commands: Any, name: str, run: Callable[[argparse.Namespace], int], *, sentence: str, example: str
) -> argparse.ArgumentParser:
    """A subcommand with its sentence and one example in its help."""
    parser: argparse.ArgumentParser = commands.add_parser(
        name, help=sentence, description=sentence, epilog=f"example: {example}"
    )
    parser.set_defaults(run=run)
    return parser


def add_scene(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene",
        metavar="SCENE",
        help="a scene of the library (`painleve scenes` lists them), or "
        "a file of your own, FILE.toml (`painleve new-scene` writes one)",
    )


def add_state(parser: argparse.ArgumentParser) -> None:
    """--state and --set, each with one or more values."""
    parser.add_argument(
        "--state",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME|KEY=EXPR",
        help="a named state, or exact keys such as theta='atan(2)' slip=-1; keys after a name override it",
    )
    parser.add_argument(
        "--set",
        nargs="+",
        action="extend",
        default=[],
        metavar="PARAM=EXPR",
        dest="parameters",
        help="exact values of parameters, such as mu=4/3",
    )


def add_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print one JSON object for machines")


def read_state(options: argparse.Namespace) -> State:
    """The exact state that the arguments give."""
    from painleve.mechanics.library import load_scene
    from painleve.mechanics.state import make_state

    scene = load_scene(options.scene)
    names, keys, parameters = read_state_words(options, scene)
    if len(names) > 1:
        raise InputError(f"--state: {' and '.join(names)} are two names; give one, then KEY=EXPR to change it")
    state = make_state(scene, names[0] if names else None, keys=keys, parameters=parameters)
    _note_degrees(scene, keys)
    return state


def _note_degrees(scene: Scene, given: Mapping[str, str]) -> None:
    """One line on stderr for an angle beyond a full turn: allowed, and likely to be degrees."""
    from painleve.exact.parse import parse_number

    for key in scene.keys:
        if key.unit == "rad" and key.name in given and abs(parse_number(given[key.name], where=key.name)) > 2 * math.pi:
            print(
                f"painleve: note: {key.name} = {given[key.name]} is in radians, more than a full turn; "
                "degrees are written such as 60*pi/180",
                file=sys.stderr,
            )


def read_state_words(options: argparse.Namespace, scene: Scene) -> tuple[list[str], dict[str, str], dict[str, str]]:
    """(names of states, state keys, parameters) as they were given."""
    if not options.state:
        known = f"one of {', '.join(s.name for s in scene.states)}" if scene.states else ""
        keys = " ".join(f"{k.name}=EXPR" for k in scene.keys)
        raise InputError(f"--state is needed: {', or '.join(way for way in (known, keys) if way)}")
    names = [word for word in options.state if "=" not in word]
    given = assignments([word for word in options.state if "=" in word], "--state")
    return names, given, assignments(options.parameters, "--set")


def assignments(words: Sequence[str], option: str) -> dict[str, str]:
    """NAME=EXPR words as a table."""
    table: dict[str, str] = {}
    for word in words:
        name, equals, value = word.partition("=")
        name = name.strip()
        if not equals or not name or not value.strip():
            raise InputError(f"{option}: {word!r} is not NAME=EXPR")
        if name in table:
            raise InputError(f"{option}: {name} is given twice")
        table[name] = value.strip()
    return table


def real(text: str) -> float:
    """A float for argparse, written as numbers are: nan, inf, 1_000 and the digits of other scripts are refused."""
    value = float(text) if _NUMBER.fullmatch(text.strip(" ")) else math.nan
    if not math.isfinite(value):
        raise ValueError(text)
    return value


def count(text: str) -> int:
    """A whole number for argparse; 1e6 is one."""
    if _WHOLE.fullmatch(text.strip(" ")):
        return int(text)
    value = real(text)
    if not value.is_integer():
        raise ValueError(text)
    return int(value)


@contextmanager
def keeping(dataset: xr.Dataset, target: Path) -> Iterator[Path | None]:
    """Write a dataset, then do what stands inside: a disk that fails takes the file and not what is printed.

    Gives the file, or None where it could not be written; the InputError that says why is raised at the end.
    """
    from painleve.store import save

    try:
        written, failure = save(dataset, target), None
    except InputError as error:
        written, failure = None, error
    yield written
    if failure is not None:
        raise failure


def print_json(data: object) -> None:
    """Strict JSON: numbers that are not finite become null."""
    text = json.dumps(_strict(data), indent=2, ensure_ascii=False)
    try:
        text.encode(getattr(sys.stdout, "encoding", None) or "ascii")
    except UnicodeEncodeError:
        text = json.dumps(_strict(data), indent=2)
    print(text)


def _strict(data: object) -> object:
    if isinstance(data, dict):
        return {str(key): _strict(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_strict(value) for value in data]
    if isinstance(data, float) and not math.isfinite(data):
        return None
    return data
