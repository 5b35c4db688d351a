"""The schemes, one file each, listed once: tests, charts and the command line loop over this list."""

from __future__ import annotations

from importlib import import_module

from painleve.dynamics.scheme import Scheme
from painleve.errors import InputError

__all__ = ["SCHEME_NAMES", "load_scheme"]

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
        raise InputError(f"scheme: no {name!r}; choose one of {', '.join(SCHEME_NAMES)}")
    return import_module(f"painleve.dynamics.schemes.{name}").SCHEME
