"""The theory of friction in space with a disc or an ellipse."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import sympy as sp

from painleve.errors import InputError
from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.mechanics.sections.conic import Disc, Ellipse
from painleve.mechanics.sections.section import norm
from painleve.mechanics.state import State
from painleve.theory.least_energy import LeastEnergy, contact_slip, in_wedge, on_ray, sticking_impulse
from painleve.theory.sections.section import POSITIVE, Exact, Points

__all__ = ["ConicTheory"]


@dataclass(frozen=True)
class ConicTheory:
    """See painleve.theory.sections.section."""

    section: Disc | Ellipse
    positive: str = POSITIVE
    flat_sides: str = ""

    @property
    def image(self) -> str:
        return {"disc": "a disc", "ellipse": "an ellipse"}[self.section.kind]

    def least_edge(self, state: State) -> tuple[int, Signed]:
        """The sign of a - |E^T b|, by the square, which has no root in it."""
        d = derive(state.scene)
        opposed = self.section.map.T * d.couplings
        return 1, exact_sign(state.exact(d.a**2 - (opposed.T * opposed)[0, 0]))

    def jump(self, state: State, edge: int, gamma: Sign) -> LeastEnergy:
        slip = contact_slip(state)
        if gamma is Sign.ZERO:  # the section touches the line a + b.s = 0 in one point
            return on_ray(state, slip, state.exact(derive(state.scene).edge_direction(edge)))
        return in_wedge(state, slip, partial(self._wedge, state))

    def _wedge(self, state: State) -> tuple[sp.MatrixBase, sp.MatrixBase]:
        """sigma = (-a c +- sqrt(|c|^2 - a^2) c_perp)/|c|^2 with c = E^T b on the unit circle; E keeps the
        orientation."""
        d = derive(state.scene)
        a, E = state.exact(d.a), state.exact(self.section.map)
        c = E.T * state.exact(d.couplings)
        across = sp.Matrix([-c[1], c[0]])
        squared = (c.T * c)[0, 0]
        half = sp.sqrt(squared - a**2)
        # -c is the wedge's middle; c_perp is clockwise of it
        first, second = (E * (-a * c + sign * half * across) / squared for sign in (1, -1))
        return first, second

    def sticking_impulse(self, state: State) -> tuple[sp.Expr, ...]:
        return sticking_impulse(state, contact_slip(state))

    def indicator(self, scene: Scene, edge: int) -> sp.Expr:
        """a^2 - |E^T b|^2 times det(M)^2, which has no root in it."""
        d, adjugate, E = derive(scene), scene.inertia.adjugate(), self.section.map
        a = (d.normal.T * adjugate * d.normal)[0, 0]
        return a**2 - norm(E.T * scene.contact.tangents.T * adjugate * d.normal) ** 2

    def exact_section(self, where: str, exact: Exact) -> tuple[Points, sp.ImmutableMatrix | None]:
        section_map = exact(self.section.map)
        if section_map.is_zero_matrix:
            return (), None
        if exact_sign(section_map.det()).sign is not Sign.POSITIVE:
            raise InputError(
                f"{where}: the ellipse of friction has a semi-axis of length zero at this q; "
                "give friction along a line as a segment"
            )
        return (), section_map

    def spanning(self) -> sp.MatrixBase:
        return sp.Matrix(self.section.map)

    def soundness(self) -> tuple[str, str]:
        several = len({c.expression for c in self.section.conditions}) > 1
        mu = "every coefficient of friction" if several else "the coefficient of friction"
        return f"{mu} is nonnegative", "a coefficient of friction is negative"

    def settled(self, hypothesis: str) -> None:
        return None
