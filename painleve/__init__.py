"""painleve: what Moreau's Contact Dynamics scheme makes of Coulomb's law where it has several solutions.

The names below are the whole public interface; they are imported when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from painleve.figures import announce

if TYPE_CHECKING:
    from painleve.asymptotics.certify.method import CertifyOptions
    from painleve.asymptotics.methods import distance
    from painleve.asymptotics.optimise import OptimiseOptions
    from painleve.asymptotics.rates import rate
    from painleve.asymptotics.sample import SampleOptions
    from painleve.asymptotics.theorem import collect, judge
    from painleve.asymptotics.witness import find_family, find_witness
    from painleve.dynamics.ensemble import run_ensemble
    from painleve.dynamics.simulate import simulate
    from painleve.dynamics.start import make_start
    from painleve.errors import InputError
    from painleve.mechanics.derive import derive
    from painleve.mechanics.friction import Disc, Ellipse, Polygon, Segment
    from painleve.mechanics.library import SCENE_NAMES, load_scene
    from painleve.mechanics.scene import Coordinate, NamedState, Outline, Parameter, StateKey, make_scene
    from painleve.mechanics.state import make_state
    from painleve.mechanics.units.check import check_units
    from painleve.plotting.draw import draw, save_figure
    from painleve.store import load, save
    from painleve.sweep.distances import sweep_distances
    from painleve.sweep.trajectories import trajectory_dataset
    from painleve.theory.classification import classify
    from painleve.theory.coulomb.one_step import coulomb_solutions
    from painleve.theory.critical import critical_states
    from painleve.theory.hypotheses.check import check_hypotheses
    from painleve.theory.limit_set import limit_set

_HOMES = {
    "CertifyOptions": "painleve.asymptotics.certify.method",
    "Coordinate": "painleve.mechanics.scene",
    "Disc": "painleve.mechanics.friction",
    "Ellipse": "painleve.mechanics.friction",
    "InputError": "painleve.errors",
    "NamedState": "painleve.mechanics.scene",
    "OptimiseOptions": "painleve.asymptotics.optimise",
    "Outline": "painleve.mechanics.scene",
    "Parameter": "painleve.mechanics.scene",
    "Polygon": "painleve.mechanics.friction",
    "SCENE_NAMES": "painleve.mechanics.library",
    "SampleOptions": "painleve.asymptotics.sample",
    "Segment": "painleve.mechanics.friction",
    "StateKey": "painleve.mechanics.scene",
    "check_hypotheses": "painleve.theory.hypotheses.check",
    "check_units": "painleve.mechanics.units.check",
    "classify": "painleve.theory.classification",
    "collect": "painleve.asymptotics.theorem",
    "coulomb_solutions": "painleve.theory.coulomb.one_step",
    "critical_states": "painleve.theory.critical",
    "derive": "painleve.mechanics.derive",
    "distance": "painleve.asymptotics.methods",
    "draw": "painleve.plotting.draw",
    "find_family": "painleve.asymptotics.witness",
    "find_witness": "painleve.asymptotics.witness",
    "judge": "painleve.asymptotics.theorem",
    "limit_set": "painleve.theory.limit_set",
    "load": "painleve.store",
    "load_scene": "painleve.mechanics.library",
    "make_scene": "painleve.mechanics.scene",
    "make_start": "painleve.dynamics.start",
    "make_state": "painleve.mechanics.state",
    "rate": "painleve.asymptotics.rates",
    "run_ensemble": "painleve.dynamics.ensemble",
    "save": "painleve.store",
    "save_figure": "painleve.plotting.draw",
    "simulate": "painleve.dynamics.simulate",
    "sweep_distances": "painleve.sweep.distances",
    "trajectory_dataset": "painleve.sweep.trajectories",
}

__all__ = [
    "SCENE_NAMES",
    "CertifyOptions",
    "Coordinate",
    "Disc",
    "Ellipse",
    "InputError",
    "NamedState",
    "OptimiseOptions",
    "Outline",
    "Parameter",
    "Polygon",
    "SampleOptions",
    "Segment",
    "StateKey",
    "check_hypotheses",
    "check_units",
    "classify",
    "collect",
    "coulomb_solutions",
    "critical_states",
    "derive",
    "distance",
    "draw",
    "find_family",
    "find_witness",
    "judge",
    "limit_set",
    "load",
    "load_scene",
    "make_scene",
    "make_start",
    "make_state",
    "rate",
    "run_ensemble",
    "save",
    "save_figure",
    "simulate",
    "sweep_distances",
    "trajectory_dataset",
]


def _draw(result: Any) -> Any:
    return __getattr__("draw")(result)


announce(_draw)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'painleve' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
