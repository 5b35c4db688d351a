"""A scene from a user's own TOML file: read as data within limits, never run."""

from __future__ import annotations

import shlex
from importlib.resources import files
from pathlib import Path

from painleve.errors import InputError
from painleve.mechanics.scene import Scene
from painleve.mechanics.scene_file.build import scene_of_text
from painleve.mechanics.scene_file.document import shown_file, text_of_file
from painleve.mechanics.scene_file.names import why_no_name

__all__ = ["read_scene", "template_text"]


def read_scene(path: str | Path) -> Scene:
    """The scene that a TOML file describes; one that has not changed since is the same object.

    Raises InputError, in one line that names file, line and field, for a file that is not a scene within the limits.
    """
    return scene_of_text(shown_file(path), text_of_file(path))


def template_text(name: str, file: str) -> str:
    """A commented scene file to start from: a working scene of that name, whose comments call its file `file`.

    Raises InputError for a name that a scene cannot have.
    """
    why = why_no_name(name)
    if why is not None:
        raise InputError(f"the name of the scene: {why}")
    text = files(__name__).joinpath("template.toml").read_text(encoding="utf-8")
    shown = shlex.quote(file) if file.isprintable() else "FILE.toml"
    return text.replace("my_scene.toml", shown).replace('"my_scene"', f'"{name}"')
