"""Scenes and states of the tests of friction in space; the conditions of least energy at many digits."""

from __future__ import annotations

from functools import cache

import mpmath
import sympy as sp
from reference_law import dot, to_mp

from painleve.mechanics.friction import Polygon
from painleve.mechanics.library import load_scene
from painleve.mechanics.library.slender_rod import MU
from painleve.mechanics.library.spatial_rod import make_spatial_rod
from painleve.mechanics.scene import NamedState, Scene
from painleve.mechanics.state import State, make_state
from painleve.theory.limit_set import LimitSet, limit_set

CRITICAL = "atan(3 - sqrt(5))"  # with mu = 2 along the rod gamma = 0


def polygon_rod(name: str, vertices: list[tuple[sp.Expr, sp.Expr]], states: tuple[NamedState, ...] = ()) -> Scene:
    """The spatial rod on a polygon; vertices in units of mu."""
    corners = tuple((MU.symbol * x, MU.symbol * y) for x, y in vertices)
    return make_spatial_rod(
        name=name,
        sentence="rod in space with a polygon",
        friction=Polygon(vertices=corners),
        friction_parameters=(MU,),
        states=states,
    )


SQUARE = polygon_rod(
    "square_rod",
    [(1, 0), (0, 1), (-1, 0), (0, -1)],
    tuple(
        NamedState(name=name, sentence=name, keys=keys, parameters={"mu": mu})
        for name, keys, mu in (
            ("sliding", {"theta": "atan(2)"}, "1/2"),
            ("paradox", {"theta": "atan(2)"}, "2"),
            ("oblique", {"theta": "atan(2)", "heading": "2*pi/3"}, "3/2"),
            ("critical", {"theta": CRITICAL}, "2"),
            ("critical_oblique", {"theta": CRITICAL, "heading": "3*pi/4"}, "2"),
        )
    ),
)
SCENES = {scene.name: scene for scene in (load_scene("spatial_rod"), load_scene("spatial_rod_ellipse"), SQUARE)}
STATES = [(scene.name, state.name) for scene in SCENES.values() for state in scene.states]


@cache
def limit_of(scene: str, name: str) -> LimitSet:
    return limit_set(make_state(SCENES[scene], name))


@cache
def _function(scene: Scene):
    normal = [-sp.diff(scene.contact.constraint, x) for x in scene.q]
    friction = scene.contact.section
    section = list(friction.map) if hasattr(friction, "map") else [x for v in friction.vertices for x in v]
    parts = [[*scene.inertia], normal, [*scene.contact.tangents], section]
    return sp.lambdify([*scene.q, *scene.p], parts, modules="mpmath")


class Impulse:
    """What takes v to S at q + dq, straight from the scene's symbols: r of M (S - v) = W r, and what it leaves."""

    def __init__(self, state: State, dq: list, v: list, S: list) -> None:
        scene, d = state.scene, state.scene.dimension
        q = [to_mp(x) + to_mp(y) for x, y in zip(state.q, dq, strict=True)]
        p = [to_mp(state.parameters[s.name]) for s in scene.parameters]
        inertia, normal, tangents, self.section = _function(scene)(*q, *p)
        M, w_n = mpmath.matrix(d, d), mpmath.matrix(normal)
        H = [mpmath.matrix(tangents[k::2]) for k in range(2)]
        for i in range(d):
            for j in range(d):
                M[i, j] = inertia[i * d + j]
        change = M * (mpmath.matrix(S) - mpmath.matrix(v))
        W = mpmath.matrix(d, 3)
        for i in range(d):
            W[i, 0], W[i, 1], W[i, 2] = w_n[i], H[0][i], H[1][i]
        self.r = mpmath.lu_solve(W.T * W, W.T * change)
        self.residual = mpmath.norm(change - W * self.r)
        self.normal_velocity = dot(w_n, mpmath.matrix(S))
        self.velocity = mpmath.matrix([dot(H[0], mpmath.matrix(S)), dot(H[1], mpmath.matrix(S))])
        response = [mpmath.lu_solve(M, x) for x in (w_n, *H)]
        self.a, self.b = dot(w_n, response[0]), mpmath.matrix([dot(w_n, response[1]), dot(w_n, response[2])])

    def lift(self, s) -> mpmath.mpf:
        return self.a + self.b[0] * s[0] + self.b[1] * s[1]

    def is_least_on_conic(self, tolerance: mpmath.mpf) -> bool:
        """|E^-1 r_t| = r_n, and E^T (velocity) is -factor * (a E^-1 r_t/r_n + E^T b), factor > 0."""
        E = mpmath.matrix([self.section[:2], self.section[2:]])
        sigma, turned, b = mpmath.lu_solve(E, self.r[1:]) / self.r[0], E.T * self.velocity, E.T * self.b
        normal = self.a * sigma + b
        on_edge = abs(mpmath.norm(sigma) - 1) < tolerance
        crossed = abs(turned[0] * normal[1] - turned[1] * normal[0]) < tolerance * mpmath.norm(normal)
        return on_edge and crossed and mpmath.fdot(turned, normal) < 0

    def is_least_on_polygon(self, tolerance: mpmath.mpf) -> bool:
        """On the boundary, and the energy does not fall towards any vertex ray: velocity . (nu/p_j s_j - r_t) >= 0."""
        corners = [self.section[i : i + 2] for i in range(0, len(self.section), 2)]
        nu = self.a * self.r[0] + self.b[0] * self.r[1] + self.b[1] * self.r[2]
        for s in corners:
            lift = self.lift(s)
            along = [nu * x - lift * y for x, y in zip(s, self.r[1:], strict=True)]
            if lift <= 0:  # a direction in which the region has no end, with a vertex that lifts
                along = None
                for z in corners:
                    if self.lift(z) > 0:
                        ray = [x * self.lift(z) - y * lift for x, y in zip(s, z, strict=True)]
                        if mpmath.fdot(self.velocity, ray) < -tolerance:
                            return False
            if along is not None and mpmath.fdot(self.velocity, along) < -tolerance:
                return False
        return True
