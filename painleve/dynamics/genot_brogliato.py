"""The Génot-Brogliato point of the slender rod, and starts on slips that run into it.

With alpha = m l^2/I and t = tan(theta): gamma = 0 at t^2 - mu alpha t + 1 + alpha = 0 (lower edge), the normal
acceleration of the tip without contact force, beta = l omega^2 sin(theta) - gravity, vanishes at the same time,
and the eigenvalues of the slip in the time dt/p have the ratio r = 2 t^2/(1 + alpha - t^2) (docs/theory.md,
section 6; F. Génot and B. Brogliato, Eur. J. Mech. A Solids 18 (1999) 653-677). K, D, c: see painleve.core.jam_map.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from painleve.dynamics.start import Start, make_start
from painleve.errors import InputError
from painleve.mechanics.library import load_scene

__all__ = ["SingularPoint", "find_friction", "singular_point"]

CLOSE = 0.02  # of the distance: where the amplitude of a slip is read off


@dataclass(frozen=True, kw_only=True)
class SingularPoint:
    """Angle (rad), rate omega (rad/s), ratio r of the eigenvalues, D (m/s^2 a radian) and c (m/s^2) at the point.

    mass m (kg) and length l (m, half of the rod's) scale the motion of the tip; the angles and r depend on alpha alone.
    """

    mu: float
    alpha: float
    gravity: float
    mass: float
    length: float
    theta: float
    omega: float
    ratio: float
    drift: float
    curvature: float

    def strict_scale(self, step: float, amplitude: float) -> float:
        """x_* (rad), the distance from the edge at which the strict test decides."""
        return float((step * self.omega * self.curvature / amplitude) ** (1.0 / (1.0 + self.ratio)))

    def strict_drift(self, step: float, amplitude: float) -> float:
        """d of the strict map."""
        return self.drift * self.strict_scale(step, amplitude) ** 2 / (step * self.omega * self.curvature)

    def kept_drift(self, step: float, amplitude: float) -> float:
        """d of the map with the tip kept on the floor."""
        return float(self.drift * (step * self.omega) ** (1.0 - self.ratio) / amplitude)

    def amplitude_of(self, step: float, strict_drift: float) -> float:
        """K for which the strict map has this drift d at this step."""
        unit = step * self.omega * self.curvature
        return float(unit / (strict_drift * unit / self.drift) ** ((1.0 + self.ratio) / 2.0))

    def acceleration(self, distance: float, amplitude: float) -> float:
        """beta (m/s^2) on the slip K = amplitude at the distance (rad) from the point, to first order."""
        return -amplitude * distance**self.ratio - self.drift * distance / (1.0 - self.ratio)

    def hops(self, distance: float, amplitude: float, step: float) -> float:
        """How many times the tip comes back to the floor under the strict test, to first order."""
        first = amplitude * distance ** (1.0 + self.ratio) / (1.0 + self.ratio)
        second = self.drift * distance**2 / (2.0 * (1.0 - self.ratio))
        return (first + second) / (step * self.omega * self.curvature)

    def amplitude_at_point(self, distance: float, amplitude: float) -> float:
        """K with which the slip of that start arrives: `amplitude` corrected for the terms of higher order in x.

        Integrates domega/dx = beta kappa/(p omega) towards the point, or as far as the slip keeps contact (r > 1).
        """
        lift_off = 0.0
        if self.ratio > 1.0:
            lift_off = (self.drift / ((self.ratio - 1.0) * amplitude)) ** (1.0 / (self.ratio - 1.0))
        end = max(CLOSE * distance, 1.3 * lift_off)
        first = self._rate_of(self.theta - distance, self.acceleration(distance, amplitude))
        solution = solve_ivp(self._rate, (distance, end), [first], method="DOP853", rtol=1e-11, atol=0.0)
        beta = self.length * solution.y[0, -1] ** 2 * math.sin(self.theta - end) - self.gravity
        return float((-beta - self.drift * end / (1.0 - self.ratio)) / end**self.ratio)

    def _rate_of(self, theta: float, beta: float) -> float:
        """omega of a slip with this beta."""
        return math.sqrt((self.gravity + beta) / (self.length * math.sin(theta)))

    def _rate(self, x: float, y: np.ndarray) -> list[float]:
        """domega/dx of the slip."""
        s, c, omega = math.sin(self.theta - x), math.cos(self.theta - x), float(y[0])
        p = 1.0 + self.alpha * c * c - self.mu * self.alpha * s * c  # times 1/m
        beta = self.length * omega**2 * s - self.gravity
        return [beta * self.alpha * (self.mu * s - c) / (self.length * p * omega)]

    def start(self, *, distance: float, amplitude: float, slip: float) -> Start:
        """The rod in contact at the distance (rad) before the point on the slip K = amplitude, slip < 0 (m/s).

        Raises InputError where there is no such contact: beta >= 0, or faster than gravity.
        """
        theta, beta = self.theta - distance, self.acceleration(distance, amplitude)
        if not (-self.gravity < beta < 0.0 < distance < self.theta and slip < 0.0):
            raise InputError(f"start: no slip towards the point at distance {distance:g} with K = {amplitude:g}")
        omega, length = self._rate_of(theta, beta), self.length
        return make_start(
            load_scene("slender_rod"),
            q={"x": 0, "y": length * math.sin(theta), "theta": theta},
            u={"x": slip - length * omega * math.sin(theta), "y": length * omega * math.cos(theta), "theta": omega},
            parameters={
                "mu": self.mu,
                "gravity": self.gravity,
                "m": self.mass,
                "l": length,
                "I": self.mass * length**2 / self.alpha,
            },
        )


def singular_point(
    mu: float, *, alpha: float = 3.0, gravity: float = 10.0, mass: float = 1.0, length: float = 1.0
) -> SingularPoint:
    """The point on the lower edge of the band of paradoxes. Raises InputError below the critical friction mu_P."""
    discriminant = (mu * alpha) ** 2 - 4.0 * (1.0 + alpha)
    if not min(mass, length) > 0.0:
        raise InputError(f"singular point: mass and length must be positive, not {mass:g} and {length:g}")
    if not (alpha > 0.0 and gravity > 0.0 and discriminant > 0.0):
        raise InputError(f"singular point: none for mu = {mu:g}, alpha = {alpha:g}; mu must exceed mu_P")
    t = 2.0 * (1.0 + alpha) / (mu * alpha + math.sqrt(discriminant))
    theta = math.atan(t)
    return SingularPoint(
        mu=mu,
        alpha=alpha,
        gravity=gravity,
        mass=mass,
        length=length,
        theta=theta,
        omega=math.sqrt(gravity / (length * math.sin(theta))),
        ratio=2.0 * t**2 / (1.0 + alpha - t**2),
        drift=gravity / t,
        curvature=gravity,
    )


def find_friction(ratio: float, *, alpha: float = 3.0) -> float:
    """The mu for which the point has this ratio of eigenvalues. Raises InputError unless both are positive."""
    if not (ratio > 0.0 and alpha > 0.0):
        raise InputError(f"ratio, alpha: {ratio:g}, {alpha:g} must be positive")
    t = math.sqrt((1.0 + alpha) * ratio / (2.0 + ratio))
    return (1.0 + alpha + t**2) / (alpha * t)
