"""A friction section costs a file a floor and a line a list: nothing but the lists asks what kind a section is."""

from __future__ import annotations

import ast
import importlib
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from painleve.mechanics.friction import SECTIONS

PACKAGE = Path(__file__).parent.parent / "painleve"
KINDS = {section.__name__ for section in SECTIONS} | {"Conic"}
FLOORS = ("theory", "kernels", "asymptotics", "dynamics")
ROOMS = {"none.py", "segment.py", "conic.py", "polygon.py"}


def modules() -> Iterator[tuple[str, ast.Module]]:
    for path in sorted(PACKAGE.rglob("*.py")):
        yield path.relative_to(PACKAGE).as_posix(), ast.parse(path.read_text(encoding="utf-8"))


def named(node: ast.AST) -> set[str]:
    names = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
    return names | {n.attr for n in ast.walk(node) if isinstance(n, ast.Attribute)}


def asks_the_kind(node: ast.AST) -> bool:
    """isinstance(x, Kind), issubclass, `case Kind(...)`, and comparisons with a kind or with its name."""
    match node:
        case ast.Call(ast.Name("isinstance" | "issubclass"), [_, kinds]):
            return bool(named(kinds) & KINDS)
        case ast.MatchClass(kind):
            return bool(named(kind) & KINDS)
        case ast.Compare(left, _, others):
            sides = [left, *others]
            return any(named(side) & (KINDS | {"kind"}) and "section" in ast.unparse(node) for side in sides)
    return False


def test_nothing_asks_what_kind_a_section_is():
    found = [f"{name}:{n.lineno}" for name, tree in modules() for n in ast.walk(tree) if asks_the_kind(n)]
    assert found == []


def test_the_test_before_this_one_sees_each_way_of_asking():
    ways = (
        "isinstance(scene.contact.section, Segment)",
        "isinstance(x, Disc | Ellipse)",
        "issubclass(type(x), friction.Polygon)",
        "type(section) is NoFriction",
        "scene.contact.section.kind == 'disc'",
    )
    assert all(any(asks_the_kind(n) for n in ast.walk(ast.parse(way))) for way in ways)
    matched = ast.parse("match section:\n    case Polygon():\n        pass")
    assert any(asks_the_kind(n) for n in ast.walk(matched))
    assert not any(asks_the_kind(n) for n in ast.walk(ast.parse("isinstance(x, LineSegment)")))


def test_no_floor_with_a_list_compares_the_dimension_of_a_section_with_a_number():
    """Where k decides what is done the section's room decides it; where k is a number it is one."""
    found = set()
    for name, tree in modules():
        for node in ast.walk(tree):
            if isinstance(node, ast.Compare) and "section.dimension" in ast.unparse(node):
                constants = [x for x in (node.left, *node.comparators) if isinstance(x, ast.Constant)]
                found |= {name} if constants else set()
    assert {name for name in found if name.startswith((*FLOORS, "core"))} == set()
    assert found  # what the command line says of a scene in space, say: the test sees such questions


@pytest.mark.parametrize("floor", FLOORS)
def test_each_floor_has_a_file_for_each_section_and_lists_them_all(floor):
    room = PACKAGE / floor / "sections"
    assert ROOMS | {"__init__.py", "listed.py", "section.py"} <= {path.name for path in room.glob("*.py")}
    listed = importlib.import_module(f"painleve.{floor}.sections.listed")
    assert set(listed._ROOMS) == set(SECTIONS)


@pytest.mark.parametrize("room", ["mechanics/sections", "core/sections", "kernels/motion/sections"])
def test_the_rooms_without_a_list_of_their_own_rhyme_with_the_others(room):
    assert {path.name for path in (PACKAGE / room).glob("*.py")} >= ROOMS


def test_section_classes_are_imported_by_rooms_lists_and_scenes_alone():
    allowed = re.compile(r"(.*/)?sections/.*|mechanics/friction\.py|mechanics/library/.*|__init__\.py")
    found = {
        name
        for name, tree in modules()
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and {alias.name for alias in node.names} & (KINDS - {"NoFriction"})
    }
    assert {name for name in found if not allowed.fullmatch(name)} == set()


def test_nobody_counts_rows_by_hand():
    """The offsets of painleve.core.rows, such as 3 + 2 d, are derived there and nowhere else."""
    by_hand = re.compile(r"\b\d+ \+ \d+ \* \(?(self\.)?(d|dimension|D|k)\b")
    counted = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        if any(by_hand.search(line) for line in path.read_text(encoding="utf-8").splitlines())
    }
    assert counted - OTHER_TABLES == set()


# Tables of their own: functions of Taylor models, and the columns of a branch-and-bound piece.
OTHER_TABLES = {"asymptotics/certify/pieces.py", "asymptotics/certify/branch_and_bound.py"}
