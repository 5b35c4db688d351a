"""The sections that the asymptotics know, listed once (painleve.mechanics.friction says what a section costs)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any

from painleve.asymptotics.sections.conic import ConicAsymptotics
from painleve.asymptotics.sections.none import NoFrictionAsymptotics
from painleve.asymptotics.sections.polygon import PolygonAsymptotics
from painleve.asymptotics.sections.section import SectionAsymptotics
from painleve.asymptotics.sections.segment import SegmentAsymptotics
from painleve.mechanics.contact import Contact
from painleve.mechanics.friction import Disc, Ellipse, NoFriction, Polygon, Segment

__all__ = ["asymptotics_of"]

_ROOMS: Mapping[type, Callable[[Any], SectionAsymptotics]] = MappingProxyType(
    {
        NoFriction: NoFrictionAsymptotics,
        Segment: SegmentAsymptotics,
        Disc: ConicAsymptotics,
        Ellipse: ConicAsymptotics,
        Polygon: PolygonAsymptotics,
    }
)


@lru_cache(maxsize=256)
def asymptotics_of(contact: Contact) -> SectionAsymptotics:
    """The asymptotics of a contact's section."""
    return _ROOMS[type(contact.section)](contact.section)
