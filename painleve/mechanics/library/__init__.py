"""The library of scenes, one file each, listed once."""

from __future__ import annotations

from functools import cache
from importlib import import_module

from painleve.errors import InputError
from painleve.mechanics.scene import Scene

__all__ = ["SCENE_NAMES", "load_scene"]

SCENE_NAMES = ("slender_rod", "worn_tip_rod", "two_link_arm", "spatial_rod")


@cache
def load_scene(name: str) -> Scene:
    """The library scene of that name. Raises InputError for an unknown name."""
    if name not in SCENE_NAMES:
        raise InputError(f"no scene {name!r}; the library has {', '.join(SCENE_NAMES)}")
    return import_module(f"painleve.mechanics.library.{name}").SCENE
