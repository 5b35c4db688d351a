"""The theory of friction in space with a polygon."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import sympy as sp

from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.mechanics.sections.polygon import Polygon
from painleve.mechanics.state import State
from painleve.theory.least_energy import (
    LeastEnergy,
    contact_slip,
    edge_indicator,
    in_wedge,
    lowest_edge,
    on_ray,
    sticking_impulse,
)
from painleve.theory.sections.section import POSITIVE, Exact, Points

__all__ = ["PolygonTheory"]

NEAR = 1e-9  # relative: what floats cannot tell from the least


@dataclass(frozen=True)
class PolygonTheory:
    """See painleve.theory.sections.section."""

    section: Polygon
    positive: str = POSITIVE
    image: str = "a segment"  # where it is flat
    flat_sides: str = "D_1 is a polygon, with edges in its boundary,"

    def least_edge(self, state: State) -> tuple[int, Signed]:
        return lowest_edge(state, self._extreme_vertices(state))

    def _extreme_vertices(self, state: State) -> list[int]:
        """The vertices with the least compliance: what floats cannot tell from the least."""
        d = derive(state.scene)
        values = {edge: state.number(d.edge_compliance[edge]) for edge in self.section.edges}
        near = NEAR * max(abs(state.number(d.a)), *(abs(value) for value in values.values()))
        return [edge for edge, value in values.items() if value <= min(values.values()) + near]

    def jump(self, state: State, edge: int, gamma: Sign) -> LeastEnergy:
        d, slip = derive(state.scene), contact_slip(state)
        if gamma is not Sign.ZERO:
            return in_wedge(state, slip, partial(self._wedge, state))
        others = [i for i in self._extreme_vertices(state) if i != edge]
        if any(exact_sign(state.exact(d.edge_compliance[i])).sign is not Sign.POSITIVE for i in others):
            return LeastEnergy(
                undecided="gamma = 0 on a whole edge of the friction polygon (neither H4 nor "
                "H'4 holds): the ray of impulses is not unique, and nothing is claimed"
            )
        return on_ray(state, slip, state.exact(d.edge_direction(edge)))

    def _wedge(self, state: State) -> tuple[sp.MatrixBase, sp.MatrixBase] | None:
        """None where a sign at a vertex is undecided."""
        n, d = len(self.section.vertices), derive(state.scene)
        corners = [state.exact(sp.Matrix(v)) for v in self.section.vertices]
        compliances = [state.exact(d.edge_compliance[i + 1]) for i in range(n)]
        signs = [exact_sign(p).sign for p in compliances]
        if Sign.UNDECIDED in signs:
            return None
        inside = [sign is Sign.NEGATIVE for sign in signs]
        enters = next(i for i in range(n) if not inside[i] and inside[(i + 1) % n])
        leaves = next(i for i in range(n) if inside[i] and not inside[(i + 1) % n])
        return _crossing(corners, compliances, enters), _crossing(corners, compliances, leaves)

    def sticking_impulse(self, state: State) -> tuple[sp.Expr, ...]:
        return sticking_impulse(state, contact_slip(state))

    def indicator(self, scene: Scene, edge: int) -> sp.Expr:
        return edge_indicator(scene, edge)

    def exact_section(self, where: str, exact: Exact) -> tuple[Points, None]:
        corners = exact(sp.Matrix(self.section.vertices))
        return () if corners.is_zero_matrix else tuple(corners[i, :].T for i in range(corners.rows)), None

    def spanning(self) -> sp.MatrixBase:
        return sp.Matrix(self.section.vertices).T

    def soundness(self) -> tuple[str, str]:
        return (
            "the vertices of the friction polygon go around 0 with nothing but left turns",
            "the friction polygon is not convex, or does not hold 0,",
        )

    def settled(self, hypothesis: str) -> None:
        return None


def _crossing(corners: list[sp.MatrixBase], compliances: list[sp.Expr], i: int) -> sp.MatrixBase:
    """Where a + b.s vanishes on the edge from vertex i to the next."""
    j = (i + 1) % len(compliances)
    first, second, p, q = corners[i], corners[j], compliances[i], compliances[j]
    return (first * q - second * p) / (q - p)
