"""Mutation testing of the rooms that the word `proved` rests on; `make mutants` runs it.

mutmut changes one thing in one function at a time and runs the tests that are meant to protect that file and that call
that function. A mutant that no test notices survives: either a test is missing, or the change makes no difference that
anybody could see, and then tests/mutants.toml says why. A survivor that is not explained there is a failure.

Each file gives a sample of its mutants, the same one until its functions change; `--sample 0` tries them all. What
mutmut changes is narrowed to what is a mistake in mathematics: names, texts and missing arguments, which break a call
at once, are left alone; forgotten summands, skipped exits and the other extreme are added.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
SANDBOX = ROOT / "build" / "mutants"
EXPLAINED = ROOT / "tests" / "mutants.toml"
SAMPLE = 60  # mutants of a file, of those that a stable order puts first
CHANGES = (
    "operator_number",
    "operator_name",
    "operator_augmented_assignment",
    "operator_remove_unary_ops",
    "operator_keywords",
    "operator_swap_op",
    "operator_match",
    "operator_if_exp",
)
OPPOSITES = {
    "max": "min",
    "maximum": "minimum",
    "any": "all",
    "upper": "lower",
    "abs_upper": "abs_lower",
    "floor": "ceil",
}
CONFIGURATION = """
[tool.mutmut]
source_paths = ["painleve"]
only_mutate = {files}
pytest_add_cli_args = ["-p", "no:cacheprovider", "-p", "no:xdist", "-p", "forget_caches"]
pytest_add_cli_args_test_selection = {tests}
process_isolation = "forkserver"
timeout_constant = 15.0
timeout_multiplier = 4.0
use_git_change_detection = false
use_setproctitle = false
"""


@dataclass(frozen=True)
class Room:
    """Files and the tests that protect them, as arguments of pytest; quick ones, since survivors meet them all."""

    name: str
    files: tuple[str, ...]
    tests: tuple[str, ...]


@dataclass(frozen=True)
class Mutant:
    """One change, named by what it changes and not by its number, which moves with every edit."""

    file: str
    function: str
    was: str
    now: str
    status: str


def rooms() -> list[Room]:
    table = tomllib.loads(EXPLAINED.read_text(encoding="utf-8"))["room"]
    return [Room(x["name"], tuple(x["files"]), tuple(x["tests"])) for x in table]


def main() -> int:
    parser = argparse.ArgumentParser(description="mutation testing of exact, certify and the theorem")
    parser.add_argument("rooms", nargs="*", help="names of rooms, all by default")
    parser.add_argument("--sample", type=int, default=SAMPLE, help=f"mutants of each file, {SAMPLE} by default; 0: all")
    parser.add_argument("--children", type=int, default=os.cpu_count() or 1, help="mutants that are tried at once")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.worker:
        run_mutmut(given.children, given.sample or None)
        return 0
    chosen = [room for room in rooms() if not given.rooms or room.name in given.rooms]
    if not chosen:
        parser.error(f"rooms: {', '.join(room.name for room in rooms())}")
    words = ("--sample", str(given.sample), "--children", str(given.children))
    return report([mutant for room in chosen for mutant in tried(room, words)])


# --- one room, in a process and a folder of its own ------------------------------------------------------------------


def tried(room: Room, words: Sequence[str]) -> list[Mutant]:
    start = time.monotonic()
    folder = SANDBOX / room.name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in ("painleve", "tests"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    settings = CONFIGURATION.format(files=json.dumps(room.files), tests=json.dumps(room.tests))
    (folder / "pyproject.toml").write_text((ROOT / "pyproject.toml").read_text(encoding="utf-8") + settings)
    command = [sys.executable, str(Path(__file__)), "--worker", *words]
    with (folder / "log.txt").open("w") as log:
        run = subprocess.run(command, check=False, cwd=folder, stdout=log, stderr=log, env=environment())
    if run.returncode:
        raise SystemExit(f"mutmut failed in room {room.name}: see {folder / 'log.txt'}")
    found = [Mutant(**x) for x in json.loads((folder / "mutants.json").read_text(encoding="utf-8"))]
    print(f"{room.name}: {len(found)} mutants in {time.monotonic() - start:.0f} s", flush=True)
    return found


def environment() -> dict[str, str]:
    """This one, but for this checkout on the path: what is imported has to be the mutated copy."""
    places = [p for p in os.environ.get("PYTHONPATH", "").split(os.pathsep) if p and Path(p).resolve() != ROOT]
    return {**os.environ, "PYTHONPATH": os.pathsep.join([*places, str(ROOT / "tests")])}


def run_mutmut(children: int, sample: int | None) -> None:
    """In the sandbox: make the mutants, choose some, try them, and leave what became of them in mutants.json."""
    choose_changes()
    from mutmut import __main__ as mutmut
    from mutmut.utils.file_utils import copy_also_copy_files, copy_src_dir, setup_source_paths

    Path("mutants").mkdir()
    copy_src_dir()
    copy_also_copy_files()
    setup_source_paths()
    mutmut.create_mutants(children)
    data = mutmut.collect_source_file_mutation_data(mutant_names=())[0]
    by_file: dict[str, dict[str, Mutant]] = {}
    for file, name, _ in data:
        by_file.setdefault(str(file.path), {})[name] = described(name, str(file.path))
    names = [name for mutants in by_file.values() for name in chosen(mutants, sample)]
    mutmut._run(names, children)
    results = {name: status(code) for _, name, code in mutmut.collect_source_file_mutation_data(mutant_names=())[0]}
    found = [vars(m) | {"status": results[n]} for mutants in by_file.values() for n, m in mutants.items() if n in names]
    Path("mutants.json").write_text(json.dumps(found, indent=1), encoding="utf-8")


def status(code: int | None) -> str:
    from mutmut.stats import status_by_exit_code

    return str(status_by_exit_code[code])


def described(name: str, path: str) -> Mutant:
    from mutmut.mutation.diff_apply import get_diff_for_mutant
    from mutmut.utils.format_utils import orig_function_and_class_names_from_key

    function, owner = orig_function_and_class_names_from_key(name)
    lines = get_diff_for_mutant(name, path=path).splitlines()[2:]
    was, now = (" ".join(line[1:].strip() for line in lines if line.startswith(sign)) for sign in "-+")
    return Mutant(path, f"{owner}.{function}" if owner else function, was, now, "")


def chosen(mutants: dict[str, Mutant], sample: int | None) -> list[str]:
    def mark(name: str) -> str:
        m = mutants[name]
        return hashlib.sha256(f"{m.file}|{m.function}|{m.was}|{m.now}".encode()).hexdigest()

    return sorted(mutants, key=mark)[:sample]


# --- what is changed -------------------------------------------------------------------------------------------------


def choose_changes() -> None:
    import libcst as cst
    from mutmut.mutation import mutators

    def forgotten_summands(node: cst.BinaryOperation) -> Iterator[cst.BaseExpression]:
        both = isinstance(node.operator, cst.Add)
        for kept in (node.left, node.right) if both else (node.left,) * isinstance(node.operator, cst.Subtract):
            yield kept.with_changes(lpar=[*node.lpar, *kept.lpar], rpar=[*kept.rpar, *node.rpar])

    def skipped_exits(node: cst.If) -> Iterator[cst.If]:
        last = node.body.body[-1]
        if isinstance(last, cst.SimpleStatementLine) and isinstance(
            last.body[-1], cst.Return | cst.Raise | cst.Continue | cst.Break
        ):
            skipped = last.with_changes(body=[cst.Pass()])
            yield node.with_changes(body=node.body.with_changes(body=[*node.body.body[:-1], skipped]))

    def other_extremes(node: cst.Call) -> Iterator[cst.Call]:
        name = node.func.attr if isinstance(node.func, cst.Attribute) else node.func
        both_ways = OPPOSITES | {y: x for x, y in OPPOSITES.items()}
        if isinstance(name, cst.Name) and name.value in both_ways:
            yield node.with_deep_changes(name, value=both_ways[name.value])

    own = [(cst.BinaryOperation, forgotten_summands), (cst.If, skipped_exits), (cst.Call, other_extremes)]
    mutators.mutation_operators[:] = [x for x in mutators.mutation_operators if x[1].__name__ in CHANGES] + own


# --- the report ------------------------------------------------------------------------------------------------------


def report(mutants: Sequence[Mutant]) -> int:
    explained = tomllib.loads(EXPLAINED.read_text(encoding="utf-8")).get("survivor", [])
    survivors = [m for m in mutants if m.status not in ("killed", "timeout", "segfault")]
    strange = [m for m in survivors if not any(explains(entry, m) for entry in explained)]
    print(f"\n{'file':52s} tried killed explained survived  score")
    for file in dict.fromkeys(m.file for m in mutants):
        here = [m for m in mutants if m.file == file]
        lived, new = ([m for m in some if m.file == file] for some in (survivors, strange))
        killed = len(here) - len(lived)
        print(
            f"{file:52s} {len(here):5d} {killed:6d} {len(lived) - len(new):9d} {len(new):8d} {killed / len(here):6.1%}"
        )
    for m in strange:
        print(f"\nsurvived ({m.status}): {m.file}, {m.function}\n  - {m.was}\n  + {m.now}")
    print(f"\n{len(mutants)} mutants, {len(survivors)} survived, {len(strange)} of them unexplained")
    return 1 if strange else 0


def explains(entry: dict[str, str], mutant: Mutant) -> bool:
    """By file and function, and if the entry has them by the lines before and after the change."""
    wanted = {key: entry[key] for key in ("file", "function", "was", "now") if key in entry}
    return all(getattr(mutant, key) == value for key, value in wanted.items())


if __name__ == "__main__":
    sys.exit(main())
