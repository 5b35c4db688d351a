"""The sections that the dynamics know, listed once (painleve.mechanics.friction says what a section costs)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any

from painleve.dynamics.sections.conic import ConicDynamics
from painleve.dynamics.sections.none import NoFrictionDynamics
from painleve.dynamics.sections.polygon import PolygonDynamics
from painleve.dynamics.sections.section import SectionDynamics
from painleve.dynamics.sections.segment import SegmentDynamics
from painleve.mechanics.contact import Contact
from painleve.mechanics.friction import Disc, Ellipse, NoFriction, Polygon, Segment

__all__ = ["dynamics_of"]

_ROOMS: Mapping[type, Callable[[Any], SectionDynamics]] = MappingProxyType(
    {
        NoFriction: NoFrictionDynamics,
        Segment: SegmentDynamics,
        Disc: ConicDynamics,
        Ellipse: ConicDynamics,
        Polygon: PolygonDynamics,
    }
)


@lru_cache(maxsize=256)
def dynamics_of(contact: Contact) -> SectionDynamics:
    """The dynamics of a contact's section."""
    return _ROOMS[type(contact.section)](contact.section)
