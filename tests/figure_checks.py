"""What tests of figures share: what the entries of a legend look like."""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D


def legends(figure: Figure) -> list[tuple[Legend, list[Axes]]]:
    """Those of the figure and of its panels, with the panels that they explain."""
    own = [(axis.get_legend(), [axis]) for axis in figure.axes if axis.get_legend() is not None]
    return [*((legend, figure.axes) for legend in figure.legends), *own]


def looks(legend: Legend, axes: list[Axes]) -> dict[str, tuple[str, ...]]:
    """By label all by which a reader can tell a mark from another."""
    pairs = [pair for axis in axes for pair in zip(*axis.get_legend_handles_labels(), strict=True)]
    pairs += list(zip(legend.legend_handles, (text.get_text() for text in legend.get_texts()), strict=True))
    found: dict[str, tuple[str, ...]] = {}
    for handle, label in pairs:
        found.setdefault(label, _look(handle.lines[0] if isinstance(handle, ErrorbarContainer) else handle))
    return found


def _look(handle: Artist) -> tuple[str, ...]:
    if not isinstance(handle, Line2D):
        return type(handle).__name__, str(handle.properties().get("facecolor"))
    shape = (handle.get_marker(), handle.get_markersize(), handle.get_linestyle(), handle._dash_pattern)
    return to_hex(handle.get_color()), str(handle.get_markerfacecolor()), *(str(part) for part in shape)


def assert_no_two_entries_share_a_mark(figure: Figure) -> None:
    assert legends(figure)
    for legend, axes in legends(figure):
        known, labels = looks(legend, axes), [text.get_text() for text in legend.get_texts()]
        assert len(set(labels)) == len(labels) > 0
        assert len({known[label] for label in labels}) == len(labels)
