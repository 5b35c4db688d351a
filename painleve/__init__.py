"""painleve: what Moreau's Contact Dynamics scheme makes of Coulomb's law where it has several solutions.

The names below are the whole public interface; they are imported when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from painleve.asymptotics.limit_set import limit_set
    from painleve.asymptotics.methods import distance
    from painleve.asymptotics.sample import SampleOptions
    from painleve.asymptotics.theorem import classify
    from painleve.asymptotics.witness import find_family, find_witness
    from painleve.errors import InputError
    from painleve.mechanics.derive import derive
    from painleve.mechanics.library import SCENE_NAMES, load_scene
    from painleve.mechanics.state import make_state

_HOMES = {
    "InputError": "painleve.errors",
    "SCENE_NAMES": "painleve.mechanics.library",
    "SampleOptions": "painleve.asymptotics.sample",
    "classify": "painleve.asymptotics.theorem",
    "derive": "painleve.mechanics.derive",
    "distance": "painleve.asymptotics.methods",
    "find_family": "painleve.asymptotics.witness",
    "find_witness": "painleve.asymptotics.witness",
    "limit_set": "painleve.asymptotics.limit_set",
    "load_scene": "painleve.mechanics.library",
    "make_state": "painleve.mechanics.state",
}

__all__ = [
    "SCENE_NAMES",
    "InputError",
    "SampleOptions",
    "classify",
    "derive",
    "distance",
    "find_family",
    "find_witness",
    "limit_set",
    "load_scene",
    "make_state",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'painleve' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
