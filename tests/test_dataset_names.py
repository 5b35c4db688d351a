"""The register of the names that datasets keep for themselves: all of them, no others, and no scene can take one."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest
import sympy as sp
import xarray as xr

import painleve
from painleve.dataset_names import EXACT, IN_FRICTION_MAPS, IN_REGIMES, IN_SWEEPS, IN_TRAJECTORIES, hold_to
from painleve.dynamics.record import TANGENTIAL
from painleve.errors import InputError
from painleve.mechanics.scene import Coordinate, make_scene
from painleve.mechanics.scene_file.names import why_no_symbol
from painleve.sweep.distance_table import DistanceTable
from painleve.sweep.friction_map import map_friction
from painleve.sweep.grid import make_grid
from painleve.sweep.regimes import map_regimes


def names_in(dataset: xr.Dataset) -> set[str]:
    return {str(name) for name in (*dataset.variables, *dataset.dims)}


def rod() -> painleve.Scene:
    return painleve.load_scene("slender_rod")


def trajectory_names() -> set[str]:
    """Of the rod's; in space the tangential components have two names more each."""
    fall = painleve.simulate(painleve.make_state(rod(), "sliding"), step=1e-2, until=2e-2)
    own = {name for c in rod().coordinates for name in (c.name, f"u_{c.name}")}
    return (names_in(fall.to_xarray()) - own) | {f"{letter}_{side}" for letter in "vr" for side in TANGENTIAL}


def map_names() -> set[str]:
    return names_in(map_friction(rod(), {"theta": np.array([1.0, 1.2])}, state="paradox")) - {"theta"}


def sweep_names() -> set[str]:
    grid = make_grid(rod(), states=["paradox"], over={"mu": [1, 2]})
    return names_in(DistanceTable(grid, np.array([1e-3])).dataset({})) - {"mu", f"mu{EXACT}"}


def regime_names() -> set[str]:
    axes = {"theta": np.array([0.5, 1.0]), "omega": np.array([0.0, 1.0])}
    return names_in(map_regimes(rod(), axes=axes)) - set(axes)


@pytest.mark.parametrize(
    ("register", "written"),
    [
        (IN_TRAJECTORIES, trajectory_names),
        (IN_SWEEPS, sweep_names),
        (IN_REGIMES, regime_names),
        (IN_FRICTION_MAPS, map_names),
    ],
    ids=["trajectory", "sweep", "regimes", "friction map"],
)
def test_the_register_lists_what_a_dataset_writes_and_nothing_else(register: Iterable[str], written) -> None:
    assert written() == set(register)


@pytest.mark.parametrize("name", sorted(IN_TRAJECTORIES | IN_SWEEPS | IN_REGIMES | IN_FRICTION_MAPS))
def test_a_scene_file_can_give_a_registered_name_to_nothing_that_would_stand_beside_it(name: str) -> None:
    assert why_no_symbol(name, coordinate=True) is not None
    if name in IN_SWEEPS | IN_REGIMES | IN_FRICTION_MAPS:
        assert why_no_symbol(name, coordinate=False) is not None
    if not name.startswith("u_"):  # a velocity
        assert why_no_symbol(f"{name}_0", coordinate=True) is None


def test_a_name_that_ends_like_the_exact_values_of_a_sweep_is_refused() -> None:
    assert why_no_symbol(f"mu{EXACT}", coordinate=False) is not None


def test_a_variable_that_is_not_in_the_register_does_not_pass() -> None:
    hold_to(IN_REGIMES, ["regime", "theta"], ["theta"])
    with pytest.raises(ValueError, match="does not list shear; a scene file could take that name"):
        hold_to(IN_REGIMES, ["regime", "theta", "shear"], ["theta"])


def test_a_scene_made_in_python_whose_coordinate_is_called_gamma_has_no_dataset_that_confuses_the_two() -> None:
    height = Coordinate(name="gamma", unit="m", sentence="height")
    scene = make_scene(
        name="falling",
        sentence="a mass over a floor",
        source="a test",
        coordinates=[height],
        parameters=[],
        inertia=sp.Matrix([[1]]),
        force=sp.Matrix([-10]),
        constraint=-height.symbol,
    )
    fall = painleve.simulate(painleve.make_start(scene, q={"gamma": 1}), step=1e-2, until=2e-2)
    with pytest.raises(InputError, match="the scene's gamma is what datasets call something else; rename it"):
        fall.to_xarray()
