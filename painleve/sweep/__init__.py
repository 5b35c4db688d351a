"""Datasets: distances over eps and parameters, members of A_eps for pictures, maps of gamma and of the regimes."""

from painleve.sweep.distances import sweep_distances
from painleve.sweep.study import StudyResult

__all__ = ["StudyResult", "sweep_distances"]
