"""The library of scenes, one file each, listed once; a scene of the user's own is named by its file."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path

from painleve.errors import InputError, nearest
from painleve.mechanics.scene import Scene
from painleve.mechanics.scene_file import read_scene

__all__ = ["SCENE_NAMES", "load_scene"]

ROBOTS = (".xml", ".urdf", ".mjcf")
NOT_READ = (*ROBOTS, ".sdf", ".json", ".yaml", ".yml", ".usd", ".py", ".h5", ".nc")
SCENE_NAMES = (
    "slender_rod",
    "worn_tip_rod",
    "two_link_arm",
    "spatial_rod",
    "spatial_rod_ellipse",
    "general_rod",
    "planar_body",
    "ellipse",
    "rod_on_obstacle",
    "general_arm",
    "minimal",
    "bead",
)


def load_scene(name: str | Path) -> Scene:
    """The library scene of that name, or the scene in a TOML file where a path is given: NAME.toml or FOLDER/NAME.

    Raises InputError for an unknown name, and for a file that does not describe a scene (file, line and field).
    """
    if name in SCENE_NAMES:
        scene: Scene = import_module(f"painleve.mechanics.library.{name}").SCENE
        return scene
    if Path(name).suffix in NOT_READ or (Path(name).suffix not in ("", ".toml") and os.sep not in str(name)):
        robot = "; `painleve import` writes one from a robot's file" if Path(name).suffix in ROBOTS else ""
        raise InputError(f"no scene {str(name)!r}: of files, those in TOML are read, such as my_scene.toml{robot}")
    if isinstance(name, Path) or name.endswith(".toml") or os.sep in name:
        return read_scene(name)
    raise InputError(
        f"no scene {name!r}{nearest(name, SCENE_NAMES)}; the library has {', '.join(SCENE_NAMES)}, and a scene of your "
        "own is given by its file, such as my_scene.toml; `painleve new-scene` writes one"
    )
