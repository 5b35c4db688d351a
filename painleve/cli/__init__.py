"""The command line `painleve`: exit status 0, or 2 with one clear line on stderr where the input is at fault."""

from __future__ import annotations

import argparse
import contextlib
import re
import signal
import sys
from collections.abc import Mapping, Sequence
from typing import NoReturn

from painleve.cli import (
    check,
    classify,
    critical,
    derive,
    distance,
    ensemble,
    import_robot,
    map_friction,
    new_scene,
    plot,
    rate,
    scan,
    scenes,
    simulate,
    study,
    sweep,
)
from painleve.cli.process import drop_output, ended_by, print_anything, terminable
from painleve.errors import InputError, nearest
from painleve.notes import one_line
from painleve.progress import reporting

__all__ = ["main"]

COMMANDS = (
    scenes,
    new_scene,
    import_robot,
    derive,
    check,
    classify,
    critical,
    map_friction,
    scan,
    distance,
    rate,
    sweep,
    study,
    plot,
    simulate,
    ensemble,
)


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line, without the usage text."""

    def error(self, message: str) -> NoReturn:
        choice = re.search(r"invalid choice: '(.*)' \(choose from (.*)\)", message)
        hint = nearest(choice[1], re.findall(r"[\w-]+", choice[2])) if choice else ""
        raise InputError(f"{message}{hint}; see {self.prog} --help")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    print_anything()
    with terminable() as heard:
        status = _run(arguments)
        try:
            if sys.stdout is not None:
                sys.stdout.flush()
        except OSError as error:
            status = _without_output(error)
    return ended_by(heard[0]) if heard else status


def _run(arguments: Sequence[str] | None) -> int:
    try:
        words = sys.argv[1:] if arguments is None else list(arguments)
        parser, commands = _parser()
        _check_words(words, commands)
        options = parser.parse_args(words)
        with reporting(_tell):
            return int(options.run(options))
    except InputError as error:
        return _complain(str(error))
    except OSError as error:
        if error.filename is None:
            return _without_output(error)
        return _complain(f"{error.filename}: {error.strerror or error}")
    except ArithmeticError as error:
        return _complain(f"the numbers asked for cannot be decided: {error}")
    except KeyboardInterrupt:
        _complain("interrupted")
        return ended_by(signal.SIGINT)


def _without_output(error: OSError) -> int:
    """What was to be printed cannot be: a reader that is gone, as `head` when it has enough, wants no word about it."""
    drop_output()
    if isinstance(error, BrokenPipeError):
        return ended_by(signal.SIGPIPE)
    return _complain(f"the output cannot be written: {error.strerror or error}")


def _tell(work: str) -> None:
    """The line of long work: a stream that is gone takes nothing away from it."""
    with contextlib.suppress(AttributeError, OSError, ValueError):
        print(f"painleve: {one_line(work)} ...", file=sys.stderr, flush=True)


def _complain(message: str) -> int:
    with contextlib.suppress(AttributeError, OSError):  # nobody may be there to read it
        print(f"painleve: {one_line(message)}", file=sys.stderr, flush=True)
    return 2


def _check_words(words: Sequence[str], commands: Mapping[str, argparse.ArgumentParser]) -> None:
    """Refuse an unknown command or option with the nearest that there is, before argparse misses another."""
    if not words or words[0].startswith("-"):
        return
    name = words[0]
    if name not in commands:
        raise InputError(f"no command {name!r}{nearest(name, commands)}; choose one of {', '.join(commands)}")
    known = re.findall(r"(?<![\w-])--[a-z-]+", commands[name].format_help())
    for word in words[1:]:
        option = word.partition("=")[0]
        if option == "--":
            return
        if option.startswith("--") and not any(k.startswith(option) for k in known):
            raise InputError(f"no option {option!r}{nearest(option, known)}; see painleve {name} --help")


def _parser() -> tuple[argparse.ArgumentParser, Mapping[str, argparse.ArgumentParser]]:
    """The parser, and those of the commands by their names."""
    parser = _Parser(
        prog="painleve",
        description="Painlevé paradoxes: derive scenes, decide Theorem 1, measure A_eps against A.",
        epilog="example: painleve classify slender_rod --state paradox",
    )
    parser.add_argument("--version", action="version", version=_version())
    commands = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=_Parser)
    for command in COMMANDS:
        command.register(commands)
    return parser, commands.choices


def _version() -> str:
    from importlib.metadata import version

    return f"painleve {version('painleve')}"


if __name__ == "__main__":
    sys.exit(main())
