"""Every published fact, found again by its route."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import xarray as xr

from studies.parts import Progress
from studies.reference.dataset import as_dataset
from studies.reference.facts import load_facts
from studies.reference.routes import reproduce

__all__ = ["FACTS", "measure"]

FACTS = Path(__file__).parents[2] / "data" / "reference" / "facts.toml"


def measure(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
    """One dataset, `reference`: the facts with what was found, and what a picture of them needs."""
    facts = load_facts(FACTS)
    progress.expect(len(facts))
    yield "reference", as_dataset(reproduce(facts, quick=quick, seed=seed, progress=progress), seed=seed)
