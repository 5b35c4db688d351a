"""Facts about impacts without collision: with compliant contact, and of Stewart's rod in time stepping."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change
from painleve.dynamics.modes import ContactPoint
from painleve.dynamics.schemes.compliant import spring_force
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import Start, make_start
from painleve.dynamics.trajectory import Trajectory
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from studies.reference.compare import FoundValue
from studies.reference.contact import stewart_state

__all__ = ["find_impact_ends_in_stick", "find_impact_must_follow", "find_stewart_rest"]

BEFORE = 0.8  # s: when the contact of Glocker's rod is made compliant, soon before its smooth slip ends
STIFFNESSES, QUICK_STIFFNESSES = (1e6, 1e8, 1e10), (1e6, 1e8)  # N/m
SLIP_SPEEDS = (1e-4, 1e-6)  # m/s
REMAINS = 0.01  # of the slip: less than this is left when an impact without collision is over, all of it after lift-off


def find_impact_ends_in_stick(*, quick: bool) -> FoundValue:
    """The tip's tangential velocity when compliant contact opens after an impact without collision."""
    state = make_state(load_scene("slender_rod"), "paradox")
    words, largest = [], 0.0
    for stiffness in QUICK_STIFFNESSES if quick else STIFFNESSES:
        duration = 12.0 / math.sqrt(stiffness)
        for slip_speed in SLIP_SPEEDS:
            run = simulate(
                state,
                scheme="compliant",
                step=duration / 300.0,
                until=duration,
                options={"stiffness": stiffness, "slip_speed": slip_speed},
            )
            v_t = abs(_velocity_at_opening(run))
            largest = max(largest, v_t / slip_speed)
            words.append(f"{v_t:.0e} m/s ({stiffness:g} N/m, {slip_speed:g} m/s)")
    route = (
        f"compliant contact from slip -1 at tan(theta) = 2, mu = 2 (stiffness, speed over which friction is "
        f"regularised): |v_t| = {', '.join(words)}; at most {largest:.2f} of that speed"
    )
    return FoundValue(value="zero" if largest < 1.0 else "not zero", route=route)


def _velocity_at_opening(run: Trajectory) -> float:
    """v_t at the last recorded instant at which the spring still pushes; infinite if the contact stays closed."""
    points = [ContactPoint.at(run.start, t, q, u) for t, q, u in zip(run.t, run.q, run.u, strict=True)]
    closed = [p.rows[0] > 0.0 and spring_force(p, run.settings) > 0.0 for p in points]  # type: ignore[arg-type]
    opened = [i for i in range(1, len(closed)) if closed[i - 1] and not closed[i]]
    return points[opened[0] - 1].v_t if opened else math.inf


def find_impact_must_follow(*, quick: bool) -> FoundValue:
    """What compliant contact makes of Glocker's rod as it slips into the point, where r = 2/3 and F is infinite."""
    start, words, follows = _before_the_point(), [], True
    for stiffness in QUICK_STIFFNESSES if quick else STIFFNESSES:
        run = simulate(start, scheme="compliant", step=1e-4, until=0.035, options={"stiffness": stiffness})
        v_t = run.contact_quantities()["v_t"]
        first = int(np.argmax(run.branch != ContactMode.FREE))
        opened = first + np.flatnonzero(run.branch[first:] == ContactMode.FREE)
        left = abs(v_t[opened[0]] / v_t[0]) if len(opened) else math.inf
        follows &= left < REMAINS
        when = f"open again at t = {BEFORE + run.t[opened[0]]:.4f} s" if len(opened) else "never open again"
        words.append(f"{when} with {left:.2%} of the slip at {stiffness:g} N/m")
    route = f"compliant contact from t = {BEFORE:g} s on the smooth slip: {'; '.join(words)}"
    return FoundValue(value="impact without collision" if follows else "another end", route=route)


@lru_cache(maxsize=1)
def _before_the_point() -> Start:
    """Glocker's rod on its smooth slip at t = 0.8 s, by event-driven integration."""
    run = simulate(make_state(load_scene("slender_rod"), "stoss"), scheme="event_driven", step=0.1, until=BEFORE)
    (x, _, theta), (u_x, _, omega) = run.q[-1].tolist(), run.u[-1].tolist()
    # the tip is put back on the floor, which the integration left by its rounding
    return make_start(
        run.start.scene,
        q={"x": x, "y": math.sin(theta), "theta": theta},
        u={"x": u_x, "y": omega * math.cos(theta), "theta": omega},
        parameters={"mu": "5/3", "gravity": "10"},
    )


def find_stewart_rest() -> FoundValue:
    """What one contact can show of Stewart's rod in time stepping: the jam, and the fall until it is flat."""
    run = simulate(stewart_state("3*pi/4", "1"), step=0.01, until=1.0, monitor=False)
    jams = [jump.index for jump in run.jumps if jump.kind is Change.JUMP_WITHOUT_COLLISION]
    flat = np.flatnonzero(run.q[:, 2] >= math.pi)
    words = [f"jams in step {jams[0]} (v_t = {abs(run.contact_quantities()['v_t'][jams[0]]):.0e} m/s)"] if jams else []
    words += [f"is flat at t = {run.t[flat[0]]:.2f} s, turning at {run.u[flat[0], 2]:.2f} rad/s"] if len(flat) else []
    value = ", ".join((["jams"] if jams else []) + (["falls flat"] if len(flat) else []))
    obstacle = "both ends of the published rod meet the floor; a scene here has one contact, and the other end falls on"
    route = f"the paper's scheme: the rod {' and '.join(words)}"
    return FoundValue(value=value, route=route, obstacle=obstacle)
