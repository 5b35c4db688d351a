"""How the datasets of this room name, scale and explain their variables; the codes that they share."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from painleve.asymptotics.theorem import VerdictStatus
from painleve.core.codes import ContactMode as LawBranch
from painleve.mechanics.scene import Scene
from painleve.store import flags
from painleve.theory.classification import Branch

__all__ = [
    "BRANCHES",
    "LAW_BRANCHES",
    "LIMIT_SETS",
    "OUTCOMES",
    "STATUSES",
    "ball_unit",
    "code",
    "coded",
    "text",
    "velocity_unit",
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


def velocity_unit(scene: Scene) -> str:
    """The units that a Euclidean norm of the scene's velocities mixes, such as "m/s, rad/s"."""
    return ", ".join(dict.fromkeys(f"{c.unit}/s" for c in scene.coordinates))


def ball_unit(scene: Scene) -> str:
    """The units of a ball's radius eps: those of the coordinates and those of the velocities."""
    return ", ".join(dict.fromkeys(c.unit for c in scene.coordinates)) + "; " + velocity_unit(scene)
