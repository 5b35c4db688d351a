"""`painleve study NAME`: reproduce a claim; the studies live beside the package in its source checkout."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from painleve.cli.common import add_command, add_json, count, print_json
from painleve.cli.studies import CHECKOUT, claim_of, study_names, title_of
from painleve.errors import InputError, nearest


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "study",
        run,
        sentence="run a study: one claim, its figures and its table",
        example="painleve study theorem1 --quick",
    )
    parser.add_argument("name", nargs="?", metavar="NAME", help="the study; without it the studies are listed")
    parser.add_argument("--quick", action="store_true", help="a reduced run, for a first look and for CI")
    parser.add_argument("--seed", type=count, default=0, metavar="S", help="seed of all sampling (default 0)")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="DIR", help="where figures and data go (default data/NAME in the checkout)"
    )
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    names = study_names()
    if options.name is None:
        return _list(names, options.json)
    if options.name not in names:
        raise InputError(f"study: no {options.name!r}{nearest(options.name, names)}; choose one of {', '.join(names)}")
    output = options.output or CHECKOUT / "data" / options.name
    if output.exists() and not output.is_dir():
        raise InputError(f"output {output}: is a file; give a folder")
    output.mkdir(parents=True, exist_ok=True)
    result = claim_of(options.name).STUDY.run(output, quick=options.quick, seed=options.seed)
    if options.json:
        files = [str(path) for path in result.files]
        print_json({"study": options.name, "status": result.status, "files": files, **result.data})
        return 0
    print(result.table)
    print(result.status)
    print("\n".join(f"  {path}" for path in result.files))
    return 0


def _list(names: list[str], as_json: bool) -> int:
    sentences = {name: title_of(name) for name in names}
    if as_json:
        print_json(sentences)
        return 0
    for name, sentence in sentences.items():
        print(f"{name:20} {sentence}")
    return 0
