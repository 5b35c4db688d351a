"""What a study is made of: what measures it, what it reports, and how far it has come."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol

import xarray as xr
from tqdm import tqdm

__all__ = ["Measure", "Progress", "Report"]


class Progress:
    """How far a study has come, on stderr: a bar on a terminal, else a line for each dataset that is kept."""

    def __init__(self, unit: str = "run", *, quiet: bool = False) -> None:
        self.watched = not quiet and sys.stderr.isatty()
        self.quiet = quiet
        self.bar = tqdm(disable=not self.watched, leave=False, file=sys.stderr, unit=unit)

    def expect(self, count: int) -> None:
        """So many steps are to come in all."""
        self.bar.reset(total=count)

    def __call__(self, label: object = "") -> None:
        """One step is done; the label says what it belonged to."""
        self.bar.set_description(str(label), refresh=False)
        self.bar.update()

    def kept(self, stem: str) -> None:
        if not (self.watched or self.quiet):
            print(f"{stem}: measured, drawn and kept", file=sys.stderr)


class Measure(Protocol):
    """The datasets of a study, each with the stem of its file's name, as they are ready."""

    def __call__(self, *, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]: ...


@dataclass(frozen=True, kw_only=True)
class Report:
    """What a study says of its datasets: a table for people, the same facts for machines, and one sentence."""

    table: str
    data: Mapping[str, object]
    status: str
