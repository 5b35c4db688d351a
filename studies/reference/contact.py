"""Facts about the contact problem at one instant, found by trying every mode on matrices that NumPy inverts."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import sympy as sp

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Ending
from painleve.dynamics.simulate import simulate
from painleve.mechanics.derive import derive
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import State, make_state
from studies.reference.compare import FoundValue

__all__ = ["find_jean_condition", "find_regime", "find_stewart_start", "regime", "step_solutions", "stewart_state"]

STATES, QUICK_STATES = 2000, 300
VELOCITIES = 200
SHORT = 1e-3  # s: the mode at the start shows after one instant


def regime(compliance: float, acceleration: float) -> str:
    """Which F solve 0 <= F, beta + p F >= 0, F (beta + p F) = 0 for p = compliance, beta = acceleration, neither 0."""
    slips = -acceleration / compliance > 0.0
    opens = acceleration > 0.0
    return {(True, False): "slip", (False, True): "lift-off", (False, False): "inconsistent"}.get(
        (slips, opens), "indeterminate"
    )


def step_solutions(G: np.ndarray, mu: float, v: np.ndarray) -> np.ndarray:
    """How many impulses solve the one-contact step for each free velocity (v_n, v_t); G (2, 2), v (n, 2) -> (n,).

    Moreau's step without restitution: 0 <= r_n, u_n >= 0, one of them 0; |r_t| <= mu r_n, opposing u_t; u = v + G r.
    """
    count = (v[:, 0] >= 0.0).astype(int)
    stick = -np.linalg.solve(G, v.T).T
    count += (stick[:, 0] > 0.0) & (np.abs(stick[:, 1]) <= mu * stick[:, 0])
    for s in (mu, -mu):
        r_n = -v[:, 0] / (G[0, 0] + s * G[0, 1])
        u_t = v[:, 1] + (G[0, 1] + s * G[1, 1]) * r_n
        count += (r_n > 0.0) & (u_t * s < 0.0)
    return count


@lru_cache(maxsize=1)
def _functions() -> tuple:
    """M, f, W = [-grad g, H] and the Hessian of g of the slender rod, of (theta, omega, I, mu); m = l = 1."""
    scene = load_scene("slender_rod")
    fixed = {scene.parameter(name).symbol: sp.Integer(1) for name in ("m", "l")}
    fixed |= {scene.parameter("gravity").symbol: sp.Rational(981, 100)}
    W = sp.Matrix.hstack(-sp.Matrix([scene.contact.constraint]).jacobian(scene.q).T, scene.contact.tangents)
    parts = (scene.inertia, scene.force, W, sp.hessian(scene.contact.constraint, scene.q), derive(scene).gamma)
    arguments = [scene.q[2], scene.u[2], scene.parameter("I").symbol, scene.parameter("mu").symbol]
    return tuple(sp.lambdify(arguments, part.xreplace(fixed), "numpy") for part in parts)


def _instant(theta: float, omega: float, inertia: float, mu: float) -> tuple[np.ndarray, float, float]:
    """(G, beta, gamma): the Delassus matrix and the free normal acceleration by NumPy, gamma by the derivation."""
    M, f, W, hessian, gamma = (function(theta, omega, inertia, mu) for function in _functions())
    G = W.T @ np.linalg.solve(M, W)
    beta = W[:, 0] @ np.linalg.solve(M, f).ravel() - hessian[2, 2] * omega**2
    return G, float(beta), float(gamma)


def find_regime(omega: str, mu: str, *, quick: bool, seed: int) -> FoundValue:
    """The regime of a rod at tan(theta) = 2 with slip -1, as simulated, and of random states with the same signs."""
    state = make_state(load_scene("slender_rod"), keys={"theta": "atan(2)", "omega": omega}, parameters={"mu": mu})
    simulated = _simulated_regime(state)
    _, beta, gamma = _instant(float(sp.atan(2)), float(omega), 1.0 / 3.0, float(mu))
    count, rng = QUICK_STATES if quick else STATES, np.random.default_rng(seed)
    labels, alike = set(), 0
    for theta, rate, friction in zip(
        rng.uniform(0.05, 1.52, count), rng.uniform(-6.0, 6.0, count), rng.uniform(0.0, 4.0, count), strict=True
    ):
        G, acceleration, sign = _instant(theta, rate, 1.0 / 3.0, friction)
        if sign * gamma > 0.0 and acceleration * beta > 0.0:
            labels.add(regime(G[0, 0] + friction * G[0, 1], acceleration))
            alike += 1
    route = f"`simulate --scheme event_driven`; and all F tried at {alike} random states of these signs"
    return FoundValue(value=_agreed(simulated, labels), route=route)


def _simulated_regime(state: State) -> str:
    """What event-driven integration does at once."""
    run = simulate(state, scheme="event_driven", step=SHORT, until=SHORT)
    if run.ending is Ending.REACHED_END:
        return "lift-off" if run.branch[-1] == ContactMode.FREE else "slip"
    return run.ending.label


def _agreed(simulated: str, labels: set[str]) -> str:
    if labels == {simulated}:
        return simulated
    return f"{simulated} simulated, {' or '.join(sorted(labels)) or 'nothing'} enumerated"


def find_jean_condition(*, quick: bool, seed: int) -> FoundValue:
    """Whether -1 < mu G_nt/G_nn < 1, gamma > 0, and one solution for every velocity tried, hold at the same rods."""
    rng, count = np.random.default_rng(seed), QUICK_STATES if quick else STATES
    exceptions, unique = 0, 0
    for theta, inertia, mu in zip(
        rng.uniform(0.0, np.pi, count), np.exp(rng.uniform(-3.0, 1.0, count)), rng.uniform(0.0, 3.0, count), strict=True
    ):
        G, _, gamma = _instant(theta, 0.0, inertia, mu)
        single = bool((step_solutions(G, mu, _velocities(G, mu, rng)) == 1).all())
        condition = abs(mu * G[0, 1] / G[0, 0]) < 1.0
        exceptions += not (single == condition == (gamma > 0.0))
        unique += single
    route = (
        f"every mode tried for {VELOCITIES + 2} velocities at {count} random rods: one solution at {unique}, "
        f"and these are the rods with gamma > 0; exceptions: {exceptions}"
    )
    return FoundValue(value="iff gamma > 0" if exceptions == 0 else f"{exceptions} exceptions", route=route)


def _velocities(G: np.ndarray, mu: float, rng: np.random.Generator) -> np.ndarray:
    """Random velocities, and the two from which a unit impulse on either edge of the cone makes the contact slip."""
    edges = [[-(G[0, 0] + s * G[0, 1]), -(G[0, 1] + s * G[1, 1]) - s] for s in (mu, -mu)]
    return np.vstack([rng.normal(size=(VELOCITIES, 2)), edges])


def stewart_state(angle: str, slip: str) -> State:
    """Stewart's rod as Drake tests it (examples/rod2d), in contact at its lower end."""
    values = {"m": "2", "I": "1", "l": "1", "mu": "1000", "gravity": "9.81"}
    return make_state(load_scene("slender_rod"), keys={"theta": angle, "slip": slip}, parameters=values)


def find_stewart_start(angle: str, slip: str) -> FoundValue:
    """The regime at the start, simulated and by trying all F."""
    state = stewart_state(angle, slip)
    theta = state.number(state.q[2])
    # Per unit of mass: I/m = 1/2, which scales the compliance and not its sign.
    G, beta, _ = _instant(theta, 0.0, 0.5, 1000.0)
    friction = -float(np.sign(float(slip))) * 1000.0
    labels = {regime(G[0, 0] + friction * G[0, 1], beta)}
    route = "`simulate --scheme event_driven`; and all F tried, with G inverted by NumPy"
    return FoundValue(value=_agreed(_simulated_regime(state), labels), route=route)
