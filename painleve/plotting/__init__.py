"""Figures from datasets; nothing is computed here that a reader of the dataset would miss."""

from painleve.plotting.draw import draw, save_figure

__all__ = ["draw", "save_figure"]
