"""`painleve new-scene NAME`: a commented file to start a scene of one's own from."""

from __future__ import annotations

import argparse
import errno
import os
from pathlib import Path
from typing import Any

from painleve.cli.common import add_command, add_json, print_json
from painleve.errors import InputError


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "new-scene",
        run,
        sentence="write a commented scene file, which works as it stands, to change",
        example="painleve new-scene my_scene",
    )
    parser.add_argument("name", metavar="NAME", help="name of the scene: letters, digits and _")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="a .toml file (default: NAME.toml)")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from painleve.mechanics.scene_file import template_text

    target = options.output or Path(f"{options.name}.toml")
    text = template_text(options.name, target.as_posix())
    if target.suffix != ".toml":
        raise InputError(f"output {target}: a scene file is a .toml; give such a name")
    try:
        os.fsencode(target).decode("utf-8")
        _write_new(target, text)
    except FileExistsError:
        raise InputError(f"output {target}: exists, and may be your work; give another name with -o") from None
    except UnicodeError:
        raise InputError(f"output {target}: its name is not text in UTF-8; give another name") from None
    except OSError as error:
        raise InputError(
            f"output {target}: cannot be written ({error.strerror or error}); give another place"
        ) from None
    if options.json:
        print_json({"file": str(target)})
    else:
        print(f"{target}: change it, then try `painleve classify {target} --state paradox`")
    return 0


def _write_new(target: Path, text: str) -> None:
    """Never over a file that is there; and none is left where the disk has no room for it."""
    with target.open("xb", buffering=0) as file:
        try:
            if file.write(text.encode()) < len(text.encode()):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            os.fsync(file.fileno())
        except BaseException:
            target.unlink()
            raise
