"""`painleve study NAME`: reproduce a claim; the studies live beside the package in its source checkout."""

from __future__ import annotations

import argparse
import ast
import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from painleve.cli.common import add_command, add_json, count, print_json
from painleve.errors import InputError

CHECKOUT = Path(__file__).parents[2]


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
    folder = CHECKOUT / "studies"
    names = sorted(path.stem for path in folder.glob("*.py"))
    if not names:
        raise InputError("there are no studies beside this installation; run them from a checkout of the sources")
    if options.name is None:
        return _list(folder, names, options.json)
    if options.name not in names:
        raise InputError(f"study: no {options.name!r}; choose one of {', '.join(names)}")
    output = options.output or CHECKOUT / "data" / options.name
    if output.exists() and not output.is_dir():
        raise InputError(f"output {output}: is a file; give a folder")
    output.mkdir(parents=True, exist_ok=True)
    result = _load(folder / f"{options.name}.py").run(output, quick=options.quick, seed=options.seed)
    if options.json:
        files = [str(path) for path in result.files]
        print_json({"study": options.name, "status": result.status, "files": files, **result.data})
        return 0
    print(result.table)
    print(result.status)
    print("\n".join(f"  {path}" for path in result.files))
    return 0


def _list(folder: Path, names: list[str], as_json: bool) -> int:
    sentences = {name: _sentence(folder / f"{name}.py") for name in names}
    if as_json:
        print_json(sentences)
        return 0
    for name, sentence in sentences.items():
        print(f"{name:20} {sentence}")
    return 0


def _sentence(path: Path) -> str:
    """The first line of a study's docstring, read and not imported: the list needs none of what the studies need."""
    return (ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").splitlines()[0]


def _load(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"painleve_study_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module
