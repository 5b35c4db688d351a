"""The sections that the kernels know, listed once (painleve.mechanics.friction says what a section costs)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any

from painleve.kernels.sections.conic import ConicKernels
from painleve.kernels.sections.none import NoFrictionKernels
from painleve.kernels.sections.polygon import PolygonKernels
from painleve.kernels.sections.section import SectionKernels
from painleve.kernels.sections.segment import SegmentKernels
from painleve.mechanics.contact import Contact
from painleve.mechanics.friction import Disc, Ellipse, NoFriction, Polygon, Segment

__all__ = ["kernels_of"]

_ROOMS: Mapping[type, Callable[[Any], SectionKernels]] = MappingProxyType(
    {
        NoFriction: NoFrictionKernels,
        Segment: SegmentKernels,
        Disc: ConicKernels,
        Ellipse: ConicKernels,
        Polygon: PolygonKernels,
    }
)


@lru_cache(maxsize=256)
def kernels_of(contact: Contact) -> SectionKernels:
    """The kernels of a contact's section."""
    return _ROOMS[type(contact.section)](contact.section)
