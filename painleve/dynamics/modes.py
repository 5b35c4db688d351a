"""Coulomb's law at the level of accelerations: every mode in which a closed, tangential contact can go on.

The complementarity problem of P. Lötstedt, ZAMM 61 (1981) 605-615, with one planar contact; all solutions are listed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from painleve.core.codes import ContactMode
from painleve.core.rows import RowParts
from painleve.core.sections import none, segment
from painleve.dynamics.start import Start

__all__ = ["ContactPoint", "Mode", "closed_modes"]

ROUNDING = 1e-13  # relative: an edge of the cone below this has no sign, and neither has a distance from it
Mode = ContactMode  # FREE: the contact opens; STICK, SLIP_PLUS, SLIP_MINUS, FRICTIONLESS: it stays closed


@dataclass(frozen=True, kw_only=True)
class ContactPoint:
    """The contact at one instant: rows of the scene, M^-1 f, velocities v and free accelerations beta of the tip."""

    rows: tuple[float, ...]
    parts: RowParts
    acceleration: tuple[float, ...]
    planar: bool
    v_n: float
    v_t: float
    beta_n: float
    beta_t: float

    @staticmethod
    def at(start: Start, t: float, q: np.ndarray, u: np.ndarray) -> ContactPoint:
        motion, at = start.motion, start.motion.rows.parts
        state = tuple(map(float, q)), tuple(map(float, u))
        rows, acceleration = motion.motion_at(float(t), *state, start.p)
        drift_n, drift_t = motion.drift_at(*state, start.p)
        normal = rows[at.w_n]
        tangent = rows[at.H[0]] if at.H else (0.0,) * len(q)
        return ContactPoint(
            rows=rows,
            parts=at,
            acceleration=acceleration,
            planar=bool(at.H),
            v_n=_dot(normal, state[1]),
            v_t=_dot(tangent, state[1]),
            beta_n=_dot(normal, acceleration) + drift_n,
            beta_t=_dot(tangent, acceleration) + drift_t,
        )

    @property
    def g(self) -> float:
        return self.rows[self.parts.g]

    @property
    def a(self) -> float:
        return self.rows[self.parts.a]

    @property
    def b(self) -> float:
        return self.rows[self.parts.b][0]

    @property
    def C(self) -> float:
        return self.rows[self.parts.C][0]

    def ratio(self, mode: Mode) -> float:
        """s = lambda_t/lambda_n of a slipping mode."""
        _, mu_plus, mu_minus = self.rows[self.parts.section]
        return mu_plus if mode is Mode.SLIP_PLUS else -mu_minus

    def edge(self, mode: Mode) -> float:
        """a + b s of a slipping mode."""
        edge_minus, _, _ = self.rows[self.parts.section]
        return self.rows[self.parts.edge_plus] if mode is Mode.SLIP_PLUS else edge_minus

    def presses(self, mode: Mode) -> bool:
        """Whether a slipping mode has a positive contact force: none is derived from an edge that rounding made."""
        known = abs(self.edge(mode)) > ROUNDING * (self.a + abs(self.b * self.ratio(mode)))
        return known and self.force(mode)[0] > 0.0

    def force(self, mode: Mode) -> tuple[float, float]:
        """(lambda_n, lambda_t) that keeps the contact in that mode."""
        if mode is Mode.FREE:
            return 0.0, 0.0
        if mode is Mode.FRICTIONLESS:
            return -self.beta_n / self.a, 0.0
        if mode is Mode.STICK:
            return segment.stick_impulse(self.a, self.b, self.C, self.beta_n, self.beta_t)
        edge = self.edge(mode)
        normal = -self.beta_n / edge if edge != 0.0 else math.copysign(math.inf, -self.beta_n)
        return normal, self.ratio(mode) * normal

    def reserve(self, side: Mode) -> float:
        """How far the sticking force is from an edge of the cone, positive inside: (a + b s)/det G times the
        acceleration that slip on that edge would have against its direction."""
        normal, tangential = self.force(Mode.STICK)
        bound = self.ratio(side) * normal
        return bound - tangential if side is Mode.SLIP_PLUS else tangential - bound

    def reserve_noise(self, side: Mode) -> float:
        """What rounding may do to `reserve`, from the sizes of the terms that it is made of."""
        size_n = _size(self.rows[self.parts.w_n], self.acceleration, self.beta_n)
        size_t = _size(self.rows[self.parts.H[0]], self.acceleration, self.beta_t)
        b, s = abs(self.b), abs(self.ratio(side))
        terms = b * size_n + self.a * size_t + s * (self.C * size_n + b * size_t)
        return ROUNDING * terms / (self.a * self.C - self.b * self.b)

    def impact(self) -> tuple[float, float, ContactMode]:
        """The impulse of S at a velocity that approaches, and its branch."""
        d = len(self.acceleration)
        if not self.planar:
            (normal,), code = none.impulse(self.rows, d, (self.v_n,), 0.0)
            return normal, 0.0, ContactMode(code)
        (normal, tangential), code = segment.impulse(self.rows, d, (self.v_n, self.v_t), 0.0)
        return normal, tangential, ContactMode(code)

    def stopping_impulse(self) -> tuple[float, float]:
        """The impulse that stops the tip."""
        return segment.stick_impulse(self.a, self.b, self.C, self.v_n, self.v_t)

    def response(self, normal: float, tangential: float) -> np.ndarray:
        """M^-1 W of an impulse or a force, (d,)."""
        change = normal * np.array(self.rows[self.parts.Y_n])
        if self.planar:
            change += tangential * np.array(self.rows[self.parts.Y_t[0]])
        return change


def closed_modes(point: ContactPoint, slip: int) -> list[Mode]:
    """All modes whose accelerations solve the contact problem; `slip` is the sign of v_t (0: at rest), v_n = 0."""
    found = [Mode.FREE] if point.beta_n >= 0.0 else []
    if not point.planar:
        return found or [Mode.FRICTIONLESS]
    if slip != 0:
        mode = Mode.SLIP_MINUS if slip > 0 else Mode.SLIP_PLUS
        return found + ([mode] if point.presses(mode) else [])
    sides = (Mode.SLIP_PLUS, Mode.SLIP_MINUS)
    reserves = [point.reserve(side) for side in sides]
    noises = [point.reserve_noise(side) for side in sides]
    inside = all(reserve >= -noise for reserve, noise in zip(reserves, noises, strict=True))
    if inside and point.force(Mode.STICK)[0] > 0.0:
        found.append(Mode.STICK)  # on an edge too, where slip without acceleration is the same motion
    for side, reserve, noise in zip(sides, reserves, noises, strict=True):
        if point.presses(side) and math.copysign(1.0, point.edge(side)) * reserve < -noise:
            found.append(side)
    return found


def _dot(x: tuple[float, ...], y: tuple[float, ...]) -> float:
    return float(sum(a * b for a, b in zip(x, y, strict=True)))


def _size(w: tuple[float, ...], acceleration: tuple[float, ...], beta: float) -> float:
    """The size of the terms of beta = w . acceleration + drift."""
    drift = beta - _dot(w, acceleration)
    return sum(abs(x * y) for x, y in zip(w, acceleration, strict=True)) + abs(drift)
