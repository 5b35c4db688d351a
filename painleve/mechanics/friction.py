"""The friction sections that there are, listed once.

Adding one costs a file in each room called `sections`, and a line in each of their lists: here, in
painleve.theory.sections, painleve.kernels.sections, painleve.asymptotics.sections and painleve.dynamics.sections. Each
asks its list once, when something is built for a contact; nothing else asks what kind a section is.
"""

from __future__ import annotations

from painleve.mechanics.sections.conic import Disc, Ellipse
from painleve.mechanics.sections.none import NoFriction
from painleve.mechanics.sections.polygon import Polygon
from painleve.mechanics.sections.section import Condition, Section
from painleve.mechanics.sections.segment import Segment

__all__ = ["SECTIONS", "Condition", "Disc", "Ellipse", "NoFriction", "Polygon", "Section", "Segment"]

SECTIONS: tuple[type[Section], ...] = (NoFriction, Segment, Disc, Ellipse, Polygon)
