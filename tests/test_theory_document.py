"""docs/theory.md: whatever cites it finds there what it names, and its formulas are well formed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
THEORY = (ROOT / "docs/theory.md").read_text(encoding="utf-8")
HEADINGS = re.findall(r"^#{2,3} (\d+(?:\.\d+)?)\.? ", THEORY, flags=re.MULTILINE)
CITING = [path for folder in ("painleve", "studies", "tests", "notebooks") for path in (ROOT / folder).rglob("*.py")]
# "docs/theory.md, section 2", "docs/theory.md, sections 2 and 3.1", over the end of a line too
NUMBERS = r"\d+(?:\.\d+)?(?:(?:, | and )\d+(?:\.\d+)?)*"
CITATION = re.compile(
    rf"docs/theory\.md,?\s+sections?\s+({NUMBERS})|\bsection\s+({NUMBERS})\s+of\s+docs/theory\.md", re.I
)


def citations(text: str) -> list[str]:
    """The numbers of all sections that a text cites."""
    flat = re.sub(r"\s+(?:#\s+)?", " ", text)
    return [number for match in CITATION.finditer(flat) for number in re.findall(r"\d+(?:\.\d+)?", match[0])]


def mentions(path: Path) -> int:
    return path.read_text(encoding="utf-8").count("docs/theory.md")


def test_its_sections_are_numbered_one_to_ten_without_a_gap() -> None:
    chapters = [h for h in HEADINGS if "." not in h]
    assert chapters == [str(n) for n in range(1, 11)]
    for chapter in chapters:
        inside = [h for h in HEADINGS if h.startswith(f"{chapter}.")]
        assert inside == [f"{chapter}.{n}" for n in range(1, len(inside) + 1)]


@pytest.mark.parametrize("path", [p for p in CITING if mentions(p) and p.name != Path(__file__).name], ids=str)
def test_every_citation_names_a_section_that_is_there(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert set(citations(text)) <= set(HEADINGS)
    flat = re.sub(r"\s+(?:#\s+)?", " ", text)
    assert len(CITATION.findall(flat)) == mentions(path), "a mention of docs/theory.md that names no section"


def test_nothing_cites_notes_that_are_not_here() -> None:
    stray = {
        str(p.relative_to(ROOT)) for p in CITING if re.search(r"\bnotes, section|project's notes", p.read_text("utf-8"))
    }
    assert stray - {f"tests/{Path(__file__).name}"} == set()


def test_its_own_references_have_a_target() -> None:
    tags = re.findall(r"\\tag\{([\d.]+)\}", THEORY)
    assert len(tags) == len(set(tags))
    referred = re.findall(r"\((\d+\.\d+)\)", re.sub(r"\\tag\{[\d.]+\}", "", THEORY))
    referred += re.findall(r"\bsections? (\d+(?:\.\d+)?)", re.sub(r"\[paper[^\]]*\]", "", THEORY))
    assert set(referred) <= {*tags, *HEADINGS}
    assert len(referred) > 20


def test_the_files_that_it_names_are_there() -> None:
    named = set(re.findall(r"`((?:[a-z_]+/)+(?:[a-z_0-9]+\.py)?)`", THEORY))
    assert len(named) > 20
    assert {name for name in named if not (ROOT / "painleve" / name).exists()} == set()


def test_its_formulas_are_closed() -> None:
    prose = re.sub(r"`[^`]*`", "", THEORY)
    displayed = re.findall(r"\$\$(.*?)\$\$", prose, flags=re.DOTALL)
    inline = re.findall(r"\$([^$]+)\$", re.sub(r"\$\$.*?\$\$", "", prose, flags=re.DOTALL))
    assert re.sub(r"\$\$.*?\$\$", "", prose, flags=re.DOTALL).count("$") == 2 * len(inline)
    assert len(displayed) > 30
    for formula in (*displayed, *inline):
        bare = formula.replace(r"\{", "").replace(r"\}", "")
        assert bare.count("{") == bare.count("}"), formula
        assert formula.count(r"\begin") == formula.count(r"\end"), formula
        for size in ("big", "Big"):
            assert formula.count(rf"\{size}l") == formula.count(rf"\{size}r"), formula
    assert not [formula for formula in inline if "\n" in formula], "a formula over the end of a line may not be shown"
    tables = [line for line in prose.splitlines() if line.startswith("|")]
    cells = [formula for line in tables for formula in re.findall(r"\$([^$]+)\$", line)]
    assert not [formula for formula in cells if "|" in formula], "in a table | ends a cell, in a formula too"
