"""What a study hands back to whoever ran it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

__all__ = ["StudyResult"]


@dataclass(frozen=True, kw_only=True)
class StudyResult:
    """A study's outcome: the table to print, the files made, the same facts for machines, and one sentence."""

    table: str
    files: tuple[Path, ...]
    data: Mapping[str, object]
    status: str
