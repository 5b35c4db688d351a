"""Where a result finds its figure: imports go upwards only, so plotting announces itself here instead of being asked.

The package's front door (painleve/__init__.py) names the drawing; nothing heavy is imported until it is used.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

__all__ = ["announce", "figure_of"]

_drawings: list[Callable[[Any], Any]] = []


def announce(drawing: Callable[[Any], Any]) -> None:
    """Make this the drawing of every result."""
    _drawings[:] = [drawing]


def figure_of(result: Any) -> Any:
    """The figure of a dataset, or of a result that makes one with `to_xarray()`."""
    return _drawings[0](result)
