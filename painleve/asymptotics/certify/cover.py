"""Bounds of functions of xi over the configurations that matter: a cover of the ball |xi| <= 1 by small boxes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from painleve.asymptotics.certify.taylor_models import TaylorModel, make_models

__all__ = ["Cover"]

CELLS = {0: 1, 1: 256, 2: 48}  # along each axis


class Cover:
    """Cubes that cover the ball of `variables` dimensions; `keep` leaves out what does not matter."""

    def __init__(self, variables: int) -> None:
        cells = CELLS[variables]
        self.half = 1.0 / cells
        centres = np.linspace(-1.0 + self.half, 1.0 - self.half, cells)
        grid = np.meshgrid(*([centres] * variables), indexing="ij")
        self.xi = np.stack([x.ravel() for x in grid], axis=1) if variables else np.zeros((1, 0))
        self.keep(self.nearest <= 1.0)

    @property
    def nearest(self) -> np.ndarray:
        """A lower bound on |xi| in each box."""
        return np.linalg.norm(np.maximum(np.abs(self.xi) - self.half, 0.0), axis=1) * (1.0 - 1e-15)

    def bounds(self, functions: Sequence[TaylorModel]) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds (boxes, functions)."""
        models = make_models(functions)
        value, slope = models.at(self.xi)
        reach = self.half**2 * self.xi.shape[1]
        away = np.abs(slope).sum(axis=1) * self.half + models.bend * reach / 2.0 + models.remainder
        away = away + 1e-13 * (models.size + away)  # rounding: a few dozen operations
        return value - away, value + away

    def keep(self, wanted: np.ndarray) -> None:
        self.xi = self.xi[wanted]
