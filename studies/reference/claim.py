"""Published facts about Painlevé's paradox, each found again by a route of its own: found against published.

Claim: what the literature says of the sliding rod holds in this package. That is the least critical friction and the
bands of paradoxes of rods of any alpha = m l^2/I; the four regimes of a slipping contact; Jean's condition for a step
of one contact; the Génot-Brogliato point, its eigenvalues and mu_C; contact forces below and above mu_C; Glocker's rod;
how an impact without collision ends and when it must follow; Stewart's rod. The facts, their sources and how much of
each could be read are in data/reference/facts.toml. No route uses the published formula: minima, edges and
eigenvalues come from the scene by exact algebra, forces and slips from Newton's equations alone, regimes and uniqueness
from trying every mode.

Command:  painleve study reference [--quick]
Expected: every fact `reproduced` (exactly, or to every printed digit) but one: `stewart_rest` is `not reproducible`,
          for the published rod meets the floor with both ends and a scene here has one contact.
Time:     about 25 s of one core, with --quick about 15 s, a third of it imports; the first run after a change of the
          sources compiles the rod.
Files:    reference.h5 with the facts and what the figure shows; the figure as PDF and PNG.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from tqdm import tqdm

from painleve.plotting import draw, save_figure
from painleve.store import check_writable, save
from studies.reference.compare import FactStatus, Reproduction
from studies.reference.dataset import as_dataset
from studies.reference.facts import load_facts
from studies.reference.figures import DRAWINGS
from studies.reference.routes import reproduce
from studies.study import StudyResult
from studies.text_table import text_table

FACTS = Path(__file__).parents[2] / "data" / "reference" / "facts.toml"
COLUMNS = ("fact", "published", "found", "difference", "status", "basis")


def run(output: Path, *, quick: bool = False, seed: int = 0) -> StudyResult:
    """Reproduce, draw and tabulate; `output` is an existing folder."""
    check_writable(output / "reference.h5")
    facts = load_facts(FACTS)
    with tqdm(total=len(facts), leave=False, disable=None, file=sys.stderr, unit="fact") as bar:
        found = reproduce(facts, quick=quick, seed=seed, progress=lambda name: bar.update())
    dataset = as_dataset(found, seed=seed)
    figure = draw(dataset, DRAWINGS)
    files = [save(dataset, output / "reference.h5")]
    files += [save_figure(figure, output / f"reference.{suffix}") for suffix in ("pdf", "png")]
    table = "\n\n".join([_table(found), _routes(found), _sources(found)])
    return StudyResult(table=table, files=tuple(files), data={"facts": [_row(r) for r in found]}, status=_status(found))


def _table(found: Sequence[Reproduction]) -> str:
    lines = [
        (r.fact.statement, r.fact.value, _found(r), r.difference or "-", r.status.value, r.fact.basis.value)
        for r in found
    ]
    notes = (
        "basis: where the published value was seen: in the abstract, in the source text of a test, or named there and\n"
        "recomputed for this project. Differences are found minus published value; labels are compared as words."
    )
    return f"{text_table(COLUMNS, lines)}\n\n{notes}"


def _found(r: Reproduction) -> str:
    """The found value; of a formula that equals the published one, in whatever form, that it does."""
    if r.status is FactStatus.REPRODUCED and r.fact.symbols:
        return "the same expression"
    return f"{r.found.value:.12g}" if isinstance(r.found.value, float) else str(r.found.value)


def _routes(found: Iterable[Reproduction]) -> str:
    lines = ["How:"]
    for r in found:
        lines.append(f"  {r.fact.id}: {r.found.route}")
        if r.found.gap is not None:
            lines.append(f"    second route: within {r.found.gap:.0e}, relative")
        if r.found.obstacle:
            lines.append(f"    {r.status.value}: {r.found.obstacle}")
    return "\n".join(lines)


def _sources(found: Iterable[Reproduction]) -> str:
    by_source: dict[str, list[Reproduction]] = {}
    for r in found:
        by_source.setdefault(r.fact.source.citation, []).append(r)
    lines = ["Sources:"]
    for citation, entries in by_source.items():
        lines.append(f"  {citation} [read: {entries[0].fact.source.read}]")
        lines.append(f"    {', '.join(r.fact.id for r in entries)}")
    return "\n".join(lines)


def _row(r: Reproduction) -> dict[str, object]:
    return {
        "id": r.fact.id,
        "statement": r.fact.statement,
        "published": r.fact.value,
        "found": str(r.found.value),
        "difference": r.difference or None,
        "gap": r.found.gap,
        "status": r.status.value,
        "route": r.found.route,
        "obstacle": r.found.obstacle or None,
        "basis": r.fact.basis.value,
        "source": r.fact.source.citation,
        "says": r.fact.says,
    }


def _status(found: Sequence[Reproduction]) -> str:
    counts = {status: sum(r.status is status for r in found) for status in FactStatus}
    said = ", ".join(f"{number} {status.value}" for status, number in counts.items() if number)
    return f"{len(found)} published facts: {said}."
