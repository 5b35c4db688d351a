"""How the datasets of this room name, scale and explain their variables; the codes that they share."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from painleve.asymptotics.theorem import VerdictStatus
from painleve.core.codes import ContactMode as LawBranch
from painleve.store import flags
from painleve.theory.classification import Branch

__all__ = [
    "BRANCHES",
    "LAW_BRANCHES",
    "LIMIT_SETS",
    "OUTCOMES",
    "STATUSES",
    "code",
    "coded",
    "text",
]

OUTCOMES = ("done", "failed")
BRANCHES = tuple(b.value for b in Branch)
STATUSES = tuple(s.value for s in VerdictStatus)
LAW_BRANCHES = tuple(b.label for b in LawBranch)
LIMIT_SETS = ("point", "pair", "segment", "undecided")


def code(label: str, labels: tuple[str, ...]) -> int:
    """The code of a label; 0 is kept for points that were not run."""
    return labels.index(label) + 1


def coded(dims: Iterable[str], values: np.ndarray, labels: tuple[str, ...], sentence: str) -> xr.Variable:
    """A variable of codes, with the meanings of its flags."""
    return xr.Variable(tuple(dims), values.astype(np.int8), {"long_name": sentence, **flags(labels)})


def text(dims: Iterable[str], values: np.ndarray | list[str], sentence: str) -> xr.Variable:
    """A variable of text; text has no unit, which is written 1."""
    return xr.Variable(tuple(dims), np.asarray(values, dtype=object), {"long_name": sentence, "units": "1"})
