"""Smooth slip of the rod, from Newton's equations alone: no Delassus matrix, no contact law of this package.

M du/dt = f + (w_n + mu H) F with d^2 g/dt^2 = 0 are linear equations for the accelerations and the contact force F. The
tip is below and to the left of the centre and slips to the left, so friction is +mu F. F = push/edge, and in the time
d tau = dt/edge the flow of (theta, omega) is smooth through the singular point, where push = edge = 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from painleve.mechanics.library import load_scene

__all__ = ["Arc", "ArcEnd", "SlipFlow", "SlipMotion", "derive_slip", "make_flow"]

RTOL, ATOL = 1e-13, 1e-15
LONGEST = 1e6  # in tau: an arc decays like exp(-tau) into the point, so this is never reached


@dataclass(frozen=True, kw_only=True, eq=False)
class SlipMotion:
    """push and edge of F = push/edge (edge > 0 without friction), and d omega/d tau, in positive symbols."""

    push: sp.Expr
    edge: sp.Expr
    turn: sp.Expr

    @property
    def flow(self) -> sp.Matrix:
        """d(theta, omega)/d tau."""
        return sp.Matrix([sp.Symbol("omega", positive=True) * self.edge, self.turn])


@lru_cache(maxsize=1)
def derive_slip() -> SlipMotion:
    """The slip of the slender rod with I = m l^2/alpha; symbols m, l, alpha, mu, gravity, theta, omega."""
    scene = load_scene("slender_rod")
    m, length, alpha, mu, gravity, theta, omega = sp.symbols("m l alpha mu gravity theta omega", positive=True)
    values = {"m": m, "l": length, "I": m * length**2 / alpha, "mu": mu, "gravity": gravity}
    names = {p.symbol: values[p.name] for p in scene.parameters}
    names |= {scene.q[2]: theta, scene.u[2]: omega}
    accelerations, force = sp.symbols("a_0:3"), sp.Symbol("F")
    g = sp.Matrix([scene.contact.constraint])
    w_n, u, du = -g.jacobian(scene.q).T, sp.Matrix(scene.u), sp.Matrix(accelerations)
    balance = scene.inertia * du - scene.force - (w_n + scene.contact.tangents * scene.parameter("mu").symbol) * force
    closed = (w_n.T * du + u.T * w_n.jacobian(scene.q) * u)[0, 0]
    (solution,) = sp.solve([e.xreplace(names) for e in (*balance, closed)], [*accelerations, force], dict=True)
    push, edge = sp.fraction(sp.factor(solution[force]))
    if edge.xreplace({mu: sp.Integer(0), theta: sp.pi / 4, alpha: sp.Integer(1)}) < 0:
        push, edge = -push, -edge
    return SlipMotion(push=push, edge=edge, turn=sp.cancel(solution[accelerations[2]] * edge))


class ArcEnd(Enum):
    """Where a smooth slip ends."""

    LIFT_OFF = "lift-off"
    EDGE = "the edge of the band"
    TURNS_BACK = "rest, and back"


@dataclass(frozen=True, kw_only=True)
class Arc:
    """A smooth slip: theta (rad), omega (rad/s), t (s), distance to the edge (rad), beta and F/(m gravity), all (n,).

    beta is the normal acceleration without contact force over gravity, negative until the slip lifts off.
    """

    theta: np.ndarray
    omega: np.ndarray
    t: np.ndarray
    distance: np.ndarray
    beta: np.ndarray
    force: np.ndarray
    end: ArcEnd


@dataclass(frozen=True, kw_only=True, eq=False)
class SlipFlow:
    """The slip of one rod (m = l = 1) as functions of floats; `edges` are the ends of its band of paradoxes (rad)."""

    gravity: float
    edges: tuple[float, float]
    edge: Callable[[float], float]
    push: Callable[[float, float], float]
    turn: Callable[[float, float], float]

    def rate_for(self, theta: float, share: float) -> float:
        """omega > 0 at which push is this share of its value at rest: 1 at rest, 0 at lift-off."""
        rest, slope = self.push(theta, 0.0), self.push(theta, 1.0) - self.push(theta, 0.0)
        return math.sqrt((share - 1.0) * rest / slope)

    def arc(self, theta: float, omega: float, *, nearest: float = 1e-10) -> Arc:
        """Follow a slip towards the band until it lifts off, turns back, or is `nearest` (rad) to the edge."""
        lower, upper = self.edges
        edge, sense = (lower, 1.0) if theta < lower else (upper, -1.0)
        events = [
            _falling(lambda tau, y: self.push(y[0], y[1])),
            _falling(lambda tau, y: sense * (edge - float(y[0])) - nearest),
            _falling(lambda tau, y: sense * float(y[1])),
        ]
        found = solve_ivp(
            self._rate, (0.0, LONGEST), [theta, omega, 0.0], method="DOP853", events=events, rtol=RTOL, atol=ATOL
        )
        if found.status != 1:
            raise ArithmeticError(f"the slip from theta = {theta:g}, omega = {omega:g} does not end")
        ends = zip((ArcEnd.LIFT_OFF, ArcEnd.EDGE, ArcEnd.TURNS_BACK), found.t_events, strict=True)
        angle, rate, t = found.y
        beta = -np.array([self.push(x, w) for x, w in zip(angle, rate, strict=True)]) / self.gravity
        return Arc(
            theta=angle,
            omega=rate,
            t=t,
            distance=sense * (edge - angle),
            beta=beta,
            force=-beta / np.array([self.edge(x) for x in angle]),
            end=next(end for end, times in ends if len(times)),
        )

    def _rate(self, tau: float, y: np.ndarray) -> list[float]:
        theta, omega, _ = map(float, y)
        edge = self.edge(theta)
        return [omega * edge, self.turn(theta, omega), edge]


def _falling(function: Callable[[float, np.ndarray], float]) -> Callable[[float, np.ndarray], float]:
    """An event that ends the slip where the function falls through zero."""
    function.terminal, function.direction = True, -1  # type: ignore[attr-defined]
    return function


def make_flow(mu: float, *, alpha: float = 3.0, gravity: float = 9.81) -> SlipFlow:
    """The flow of a rod whose friction exceeds mu_P; the edges of its band are found by bracketing."""
    slip = derive_slip()
    theta, omega = sp.symbols("theta omega", positive=True)
    values = {"m": 1.0, "l": 1.0, "alpha": alpha, "mu": mu, "gravity": gravity}
    numbers = {sp.Symbol(name, positive=True): value for name, value in values.items()}
    push, edge, turn = (e.xreplace(numbers) for e in (slip.push, slip.edge, slip.turn))
    compliance = sp.lambdify([theta], edge, "math")
    bottom = brentq(sp.lambdify([theta], sp.diff(edge, theta), "math"), 0.1, math.pi / 2)
    brackets = ((0.0, bottom), (bottom, math.pi / 2))
    return SlipFlow(
        gravity=gravity,
        edges=tuple(brentq(compliance, *ends, xtol=1e-16) for ends in brackets),
        edge=compliance,
        push=sp.lambdify([theta, omega], push, "math"),
        turn=sp.lambdify([theta, omega], turn, "math"),
    )
