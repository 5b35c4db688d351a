"""Scene files for tests: scenes as a user would write them, a writer with one field a line, and a reader on watch."""

from __future__ import annotations

import json
import sys
import tomllib
from collections.abc import Iterator
from typing import Any

from painleve.mechanics.scene import Scene
from painleve.mechanics.scene_file import template_text
from painleve.mechanics.scene_file.build import scene_of_text

TEMPLATE = template_text("my_rod", "rod.toml")

SPATIAL = """
name = "rod_in_space"
sentence = "rod in space whose tip slides on a floor"

[coordinates]
x = { unit = "m", sentence = "position of the centre" }
y = { unit = "m", sentence = "position of the centre, across x" }
z = { unit = "m", sentence = "height of the centre" }
theta = { unit = "rad", sentence = "inclination" }
phi = { unit = "rad", sentence = "azimuth" }

[parameters]
m = { unit = "kg", sentence = "mass", default = 1 }
l = { unit = "m", sentence = "half length", default = 1 }
I = { unit = "kg m^2", sentence = "moment of inertia", default = "m*l**2/3" }
mu = { unit = "1", sentence = "coefficient of friction", default = "1/2", range = "nonnegative" }
gravity = { unit = "m/s^2", sentence = "gravity", default = 9.81, range = "real" }

[mechanics]
kinetic_energy = '''
    m*(u_x**2 + u_y**2 + u_z**2)/2
    + I*(u_theta**2 + (u_phi*cos(theta))**2)/2'''
potential = "m*gravity*z"

[contact]
g = "l*sin(theta) - z"
tangential_displacements = ["x - l*cos(theta)*cos(phi)", "y - l*cos(theta)*sin(phi)"]

[friction]
FRICTION

[keys]
theta = { unit = "rad", sentence = "inclination" }
slip = { unit = "m/s", sentence = "speed of the tip, away from the centre", default = 1 }

[placement]
z = "l*sin(theta)"

[velocity]
x = "-slip"
"""

Path = tuple[str | int, ...]


def spatial(friction: str) -> str:
    return SPATIAL.replace("FRICTION", friction)


def leaves(value: Any, path: Path = ()) -> Iterator[Path]:
    """Paths of all fields, tables and elements."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for name, part in inside:
        yield (*path, name)
        yield from leaves(part, (*path, name))


def changed(path: Path, value: str | None) -> str:
    """The template with the value at that path replaced by TOML text, or taken away; one field a line."""
    table: dict[str, Any] = tomllib.loads(TEMPLATE)
    inner: Any = table
    for part in path[:-1]:
        inner = inner[part]
    if value is None:
        del inner[path[-1]]
    else:
        inner[path[-1]] = _Raw(value)
    plain = {name: part for name, part in table.items() if not isinstance(part, dict)}
    tables = {name: part for name, part in table.items() if isinstance(part, dict)}
    lines = [f"{name} = {_text(part)}" for name, part in plain.items()]
    for name, part in tables.items():
        lines += [f"[{name}]", *(f"{key} = {_text(inside)}" for key, inside in part.items())]
    return "\n".join(lines) + "\n"


class _Raw:
    """TOML text that is written as it is."""

    def __init__(self, text: str) -> None:
        self.text = text


def _text(value: Any) -> str:
    if isinstance(value, _Raw):
        return value.text
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(k)} = {_text(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_text(v) for v in value) + "]"
    return json.dumps(value, ensure_ascii=False)


FORBIDDEN = (
    "exec",
    "os.system",
    "os.exec",
    "os.fork",
    "os.posix_spawn",
    "os.spawn",
    "subprocess.Popen",
    "socket.connect",
    "pickle.find_class",
    "shutil.",
    "ctypes.",
    "os.remove",
    "os.rename",
    "os.mkdir",
    "open",
)


class _Watch:
    """What happens in this process while somebody reads a scene."""

    def __init__(self) -> None:
        self.on = False
        self.seen: list[str] = []
        sys.addaudithook(self.note)

    def note(self, event: str, arguments: tuple) -> None:
        if self.on and event.startswith(FORBIDDEN):
            self.seen.append(f"{event} {arguments!r:.200}")


WATCH = _Watch()


def read(text: str) -> Scene:
    """The scene of a text; no code is executed, no process started and no file opened meanwhile."""
    WATCH.on, WATCH.seen = True, []
    try:
        return scene_of_text("rod.toml", text)
    finally:
        WATCH.on = False
        assert WATCH.seen == []


for whole in (TEMPLATE, spatial('kind = "disc"\nmu = "mu"')):
    scene_of_text("rod.toml", whole)  # whatever is imported late is imported now
