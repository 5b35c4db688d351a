"""Points, segments and clouds; excess and Hausdorff distance, with bounds that know their side."""

from painleve.sets.bounds import Bounds, Side, largest
from painleve.sets.hausdorff import Excess, Hausdorff, excess, excess_of_segment_from_profile, hausdorff
from painleve.sets.point_sets import Cloud, LineSegment, Points, PointSet

__all__ = [
    "Bounds",
    "Cloud",
    "Excess",
    "Hausdorff",
    "LineSegment",
    "PointSet",
    "Points",
    "Side",
    "excess",
    "excess_of_segment_from_profile",
    "hausdorff",
    "largest",
]
