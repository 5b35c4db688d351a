"""The sections that the theory knows, listed once (painleve.mechanics.friction says what a section costs)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any

from painleve.mechanics.contact import Contact
from painleve.mechanics.friction import Disc, Ellipse, NoFriction, Polygon, Segment
from painleve.theory.sections.conic import ConicTheory
from painleve.theory.sections.none import NoFrictionTheory
from painleve.theory.sections.polygon import PolygonTheory
from painleve.theory.sections.section import SectionTheory
from painleve.theory.sections.segment import SegmentTheory

__all__ = ["theory_of"]

_ROOMS: Mapping[type, Callable[[Any], SectionTheory]] = MappingProxyType(
    {
        NoFriction: NoFrictionTheory,
        Segment: SegmentTheory,
        Disc: ConicTheory,
        Ellipse: ConicTheory,
        Polygon: PolygonTheory,
    }
)


@lru_cache(maxsize=256)
def theory_of(contact: Contact) -> SectionTheory:
    """The theory of a contact's section."""
    return _ROOMS[type(contact.section)](contact.section)
