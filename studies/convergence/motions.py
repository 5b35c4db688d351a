"""Motions with contact of which the solution is unique and known: what observed orders of convergence are measured on.

They fall into the three situations for which the scheme of Contact Dynamics is proved convergent (docs/theory.md,
section 7). The references are closed forms, or an event-driven integration at tight tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import cache

import sympy as sp

from painleve.core.motion_codes import Ending
from painleve.dynamics.graph_distance import graph_distance, velocity_graph
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import Start, as_start, make_start
from painleve.errors import InputError
from painleve.mechanics.friction import Segment
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Coordinate, Parameter, Scene, make_scene
from painleve.mechanics.state import make_state
from painleve.sets.point_sets import FloatArray

__all__ = ["PROBLEMS", "Problem", "Reference", "Situation", "make_reference"]

CLOSED_FORM = "closed form"
TIGHT = {"rtol": 1e-13, "atol": 1e-15}
LOOSER = {"rtol": 1e-12, "atol": 1e-14}
ROUNDING = 1e-13  # of any reference
GRAVITY = 10.0  # m/s^2, of the point mass


class Situation(Enum):
    """What is proved about M and mu: the paper's references, by their numbers there."""

    SCALAR_INERTIA = "M = m Id, mu >= 0: [9]"
    FRICTIONLESS = "any M, mu = 0: [5]"
    ANY_INERTIA = "any M, mu > 0: [15]"


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A start, how long it moves, and the vertices of its velocity where they are known in closed form."""

    name: str
    sentence: str
    situation: Situation
    until: float
    start: Callable[[], Start]
    closed_form: Callable[[], FloatArray] | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Reference:
    """The graph of the solution's velocity, where it comes from, and the distances below which it resolves nothing.

    Both are estimates. `resolution`, for a graph recorded at the same instants: how far the reference moves with its
    tolerance. `chords`, for any other: how far it moves when it is recorded at half as many instants.
    """

    graph: FloatArray
    origin: str
    resolution: float
    chords: float


def make_reference(problem: Problem, *, instants: int) -> Reference:
    """The closed form of the problem, or else its event-driven trajectory, recorded at that many instants.

    Raises InputError where the event-driven method does not reach the end: the solution is then not known to be unique.
    """
    if problem.closed_form is not None:
        return Reference(graph=problem.closed_form(), origin=CLOSED_FORM, resolution=ROUNDING, chords=ROUNDING)
    graph = _event_driven(problem, instants, TIGHT)
    resolution, chords = (
        graph_distance(graph, other).bounds.upper or 0.0
        for other in (_event_driven(problem, instants, LOOSER), _event_driven(problem, instants // 2, TIGHT))
    )
    origin = f"event-driven, rtol {TIGHT['rtol']:g}"
    return Reference(graph=graph, origin=origin, resolution=max(resolution, ROUNDING), chords=max(chords, ROUNDING))


def _event_driven(problem: Problem, instants: int, options: dict[str, float]) -> FloatArray:
    found = simulate(
        problem.start(), scheme="event_driven", step=problem.until / instants, until=problem.until, options=options
    )
    if found.ending is not Ending.REACHED_END:
        raise InputError(f"problem {problem.name}: no reference, the event-driven method ended early: {found.sentence}")
    return velocity_graph(found.t, found.u)


@cache
def point_mass() -> Scene:
    """A point over a floor, M = m Id with m = 2 kg."""
    x, y = (
        Coordinate(name="x", unit="m", sentence="place along the floor"),
        Coordinate(name="y", unit="m", sentence="height above the floor"),
    )
    m = Parameter(name="m", unit="kg", sentence="mass of the point", default="2")
    mu = Parameter(name="mu", unit="1", sentence="Coulomb's coefficient of friction", default="0", range="nonnegative")
    return make_scene(
        name="point_mass",
        sentence="a point mass over a horizontal floor",
        source="L. Paoli, IFIP AICT 494 (2016), section 2: the case M = m Id",
        coordinates=(x, y),
        parameters=(m, mu),
        inertia=m.symbol * sp.eye(2),
        potential=m.symbol * int(GRAVITY) * y.symbol,
        constraint=-y.symbol,
        tangential_displacements=(x.symbol,),
        friction=Segment(minus=mu.symbol, plus=mu.symbol),
    )


def _point(speed: str, height: str, mu: str) -> Start:
    return make_start(point_mass(), q={"x": 0, "y": height}, u={"x": speed}, parameters={"mu": mu})


def _point_vertices(speed: float, height: float, mu: float, until: float) -> FloatArray:
    """A fall, an impact without rebound that takes mu times the speed of arrival, a slide, a stop."""
    arrival = math.sqrt(2.0 * height / GRAVITY)
    slip = max(speed - mu * GRAVITY * arrival, 0.0)
    t, u = [0.0, arrival, arrival], [[speed, 0.0], [speed, -GRAVITY * arrival], [slip, 0.0]]
    stop = arrival + slip / (mu * GRAVITY) if mu > 0.0 else math.inf
    if stop < until:
        t.append(stop)
        u.append([0.0, 0.0])
    t.append(until)
    u.append([max(slip - mu * GRAVITY * (until - arrival), 0.0), 0.0])
    return velocity_graph(t, u)


def _rod_fall(angle: str, mu: str) -> Start:
    return make_start(
        load_scene("slender_rod"),
        q={"x": 0, "y": f"sin({angle}) + 1/4", "theta": angle},
        u={"x": -1},
        parameters={"mu": mu},
    )


def _rod_slide() -> Start:
    keys = {"theta": "pi/3", "slip": -3, "omega": 1}
    return as_start(make_state(load_scene("slender_rod"), keys=keys, parameters={"mu": "3/10"}))


def _arm_fall() -> Start:
    return make_start(load_scene("two_link_arm"), q={"phi1": "-1/2", "phi2": "3/5"}, parameters={"mu": 0})


def _arm_slide() -> Start:
    keys = {"phi1": "-1/2", "phi2": "3/5", "slip": "-1"}
    return as_start(make_state(load_scene("two_link_arm"), keys=keys, parameters={"mu": "2/5"}))


PROBLEMS = (
    Problem(
        name="point_impact",
        sentence="point mass: impact without friction or rebound",
        situation=Situation.SCALAR_INERTIA,
        until=0.5,
        start=lambda: _point("1", "1/2", "0"),
        closed_form=lambda: _point_vertices(1.0, 0.5, 0.0, 0.5),
    ),
    Problem(
        name="point_stick",
        sentence="point mass: slip to stick",
        situation=Situation.SCALAR_INERTIA,
        until=1.0,
        start=lambda: _point("2", "0", "1/4"),
        closed_form=lambda: _point_vertices(2.0, 0.0, 0.25, 1.0),
    ),
    Problem(
        name="point_fall",
        sentence="point mass: frictional impact, slip, stick",
        situation=Situation.SCALAR_INERTIA,
        until=0.8,
        start=lambda: _point("3", "1/4", "1/2"),
        closed_form=lambda: _point_vertices(3.0, 0.25, 0.5, 0.8),
    ),
    Problem(
        name="rod_impact",
        sentence="rod, mu = 0: impact, then sliding",
        situation=Situation.FRICTIONLESS,
        until=0.5,
        start=lambda: _rod_fall("pi/3", "0"),
    ),
    Problem(
        name="arm_impact",
        sentence="arm, M(q), mu = 0: impact, then sliding",
        situation=Situation.FRICTIONLESS,
        until=0.6,
        start=_arm_fall,
    ),
    Problem(
        name="rod_slide",
        sentence="rod, mu = 0.3: smooth sliding",
        situation=Situation.ANY_INERTIA,
        until=0.5,
        start=_rod_slide,
    ),
    Problem(
        name="rod_fall",
        sentence="rod, mu = 0.5: frictional impact, slip",
        situation=Situation.ANY_INERTIA,
        until=0.5,
        start=lambda: _rod_fall("pi/4", "1/2"),
    ),
    Problem(
        name="arm_stick",
        sentence="arm, M(q), mu = 0.4: slip to stick",
        situation=Situation.ANY_INERTIA,
        until=0.6,
        start=_arm_slide,
    ),
)
