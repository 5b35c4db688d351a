"""Datasets: distances over eps and parameters, members of A_eps for pictures, maps of gamma and of the regimes."""

from painleve.sweep.distances import sweep_distances
from painleve.sweep.gamma_map import has_gamma_map, map_gamma
from painleve.sweep.members import sweep_members
from painleve.sweep.regimes import map_regimes

__all__ = ["has_gamma_map", "map_gamma", "map_regimes", "sweep_distances", "sweep_members"]
