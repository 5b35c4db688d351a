"""The schemes, one file each, listed once: tests, charts and the command line loop over this list."""

from __future__ import annotations

from importlib import import_module

from painleve.dynamics.scheme import Scheme
from painleve.errors import InputError, nearest
from painleve.mechanics.scene import Scene

__all__ = ["SCHEME_NAMES", "load_scheme", "scheme_for"]

SCHEME_NAMES = (
    "contact_dynamics",
    "moreau_jean",
    "stewart_trinkle",
    "anitescu_potra",
    "schatzman_paoli",
    "event_driven",
    "compliant",
)


def load_scheme(name: str) -> Scheme:
    """The scheme of that name. Raises InputError for an unknown one."""
    if name not in SCHEME_NAMES:
        raise InputError(f"scheme: no {name!r}{nearest(name, SCHEME_NAMES)}; choose one of {', '.join(SCHEME_NAMES)}")
    return import_module(f"painleve.dynamics.schemes.{name}").SCHEME


def scheme_for(scene: Scene, name: str) -> Scheme:
    """The scheme of that name for a scene. Raises InputError for an unknown one and one that cannot step the scene."""
    scheme = load_scheme(name)
    k = scene.contact.section.dimension
    if k > scheme.friction_dimension:
        able = [n for n in SCHEME_NAMES if load_scheme(n).friction_dimension >= k]
        raise InputError(
            f"scheme: {name} does not step friction in space, which scene {scene.name} has; "
            f"use one of {', '.join(able)}"
        )
    return scheme
