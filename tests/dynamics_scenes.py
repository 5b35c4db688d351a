"""Small scenes of which the motion is known, and a slow reference of the paper's scheme."""

from __future__ import annotations

from functools import cache

import numpy as np
import sympy as sp

from painleve.mechanics.friction import Ellipse, Polygon, Segment
from painleve.mechanics.scene import Coordinate, Parameter, Scene, make_scene

X, Y, Z, T = (sp.Symbol(name, real=True) for name in ("x", "y", "z", "t"))
U_X, U_Y = sp.symbols("u_x u_y", real=True)


@cache
def block(*, frictional: bool = True) -> Scene:
    """A point over the floor y = 0 with M^-1 = [[1, B], [B, 2]], B = beta + bend sin(x), |B| < sqrt(2), and a force.

    With beta = bend = 0 it is a mass 1 in x and 1/2 in y that falls and slides.
    """
    names = ("beta", "bend", "mu", "weight", "drag", "beat")
    parameters = [
        Parameter(name=n, unit="1", sentence=n, default="0", range="nonnegative" if n == "mu" else "real")
        for n in names
    ]
    beta, bend, mu, weight, drag, beat = (p.symbol for p in parameters)
    B = beta + bend * sp.sin(X)
    inverse = sp.Matrix([[1, B], [B, 2]])
    return make_scene(
        name="block" if frictional else "smooth_block",
        sentence="a point with coupled inertia above a floor",
        source="docs/theory.md, section 6, minimal scene",
        coordinates=[Coordinate(name=n, unit="m", sentence=n) for n in ("x", "y")],
        parameters=parameters,
        inertia=inverse.inv().applyfunc(sp.simplify),
        force=sp.Matrix([-drag * U_X + beat * sp.sin(3 * T), -weight / 2]),
        constraint=-Y,
        tangential_displacements=[X] if frictional else [],
        friction=Segment(minus=mu, plus=mu) if frictional else None,
    )


@cache
def hinged_rod() -> Scene:
    """A rod (m = L = 1) that hangs from a hinge and rests with its end on a board of mass M_b, which moves freely.

    The board's height is such that the rod is at 30 degrees from the vertical. det G = 3 sin(phi)^2/M_b.
    """
    phi, s = sp.symbols("phi s", real=True)
    parameters = [
        Parameter(name="M_b", unit="kg", sentence="mass of the board", default="1"),
        Parameter(name="mu", unit="1", sentence="friction", default="1/2", range="nonnegative"),
    ]
    board, mu = (p.symbol for p in parameters)
    return make_scene(
        name="hinged_rod",
        sentence="a rod hinged above a board that moves",
        source="docs/theory.md, section 5",
        coordinates=[
            Coordinate(name="phi", unit="rad", sentence="angle"),
            Coordinate(name="s", unit="m", sentence="s"),
        ],
        parameters=parameters,
        inertia=sp.diag(sp.Rational(1, 3), board),
        potential=-sp.Rational(981, 200) * sp.cos(phi),
        constraint=sp.cos(phi) - sp.sqrt(3) / 2,
        tangential_displacements=[sp.sin(phi) - s],
        friction=Segment(minus=mu, plus=mu),
    )


@cache
def slope() -> Scene:
    """A point of mass m on a plane at the angle alpha, x along it upwards and y off it, drawn by F along it."""
    names = ("m", "alpha", "mu", "F")
    parameters = [Parameter(name=n, unit="1", sentence=n, default="1", range="real") for n in names]
    m, alpha, mu, F = (p.symbol for p in parameters)
    gravity = sp.Rational(981, 100)
    return make_scene(
        name="slope",
        sentence="a point on a slope",
        source="Coulomb",
        coordinates=[Coordinate(name=n, unit="m", sentence=n) for n in ("x", "y")],
        parameters=parameters,
        inertia=sp.diag(m, m),
        force=sp.Matrix([F - m * gravity * sp.sin(alpha), -m * gravity * sp.cos(alpha)]),
        constraint=-Y,
        tangential_displacements=[X],
        friction=Segment(minus=mu, plus=mu),
    )


class Reference:
    """The paper's scheme in plain NumPy: M, f and g as the scene gives them, S as the least energy on a segment."""

    def __init__(self, scene: Scene, values: dict[str, float]) -> None:
        numbers = {p.symbol: values[p.name] for p in scene.parameters}
        self.scene = scene
        arguments = (T, *scene.q, *scene.u)
        normal = sp.Matrix([-sp.diff(scene.contact.constraint, x) for x in scene.q])
        self.frictional = scene.contact.section.dimension > 0
        friction = scene.contact.section if self.frictional else Segment(minus=sp.Integer(0), plus=sp.Integer(0))
        H = scene.contact.tangents if self.frictional else sp.zeros(scene.dimension, 1)
        quantities = (scene.inertia, scene.force, scene.contact.constraint, normal, H, friction.minus, friction.plus)
        self.functions = [sp.lambdify(arguments, sp.sympify(e).xreplace(numbers)) for e in quantities]

    def at(self, t: float, q: np.ndarray, u: np.ndarray) -> list[np.ndarray]:
        return [np.asarray(f(t, *q, *u), float) for f in self.functions]

    def step(self, t: float, h: float, q: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        q = q + h * u
        M, f, g, w, H, minus, plus = self.at(t + h, q, u)
        w, H = w.ravel(), H.ravel()
        v = u + h * np.linalg.solve(M, f.ravel())
        if g < 0.0 or w @ v >= 0.0:
            return q, v
        Yn, Yt = np.linalg.solve(M, w), np.linalg.solve(M, H)
        # All admissible right velocities lie on v + Yn r_n + Yt r_t with w . u = 0: one parameter r_t.
        a, b = w @ Yn, w @ Yt
        base, slope = v - Yn * (w @ v) / a, Yt - Yn * b / a
        low, high = -np.inf, np.inf
        # -minus r_n <= r_t <= plus r_n and r_n >= 0, r_n = -(w . v + b r_t)/a, each as alpha r_t <= bound
        for alpha, bound in (
            (1 + plus * b / a, -plus * (w @ v) / a),
            (-1 + minus * b / a, -minus * (w @ v) / a),
            (b / a, -(w @ v) / a),
        ):
            if alpha > 0:
                high = min(high, bound / alpha)
            elif alpha < 0:
                low = max(low, bound / alpha)
        if not self.frictional:
            return q, base
        best = -(base @ M @ slope) / (slope @ M @ slope)
        return q, base + slope * min(max(best, low), high)

    def run(self, q: np.ndarray, u: np.ndarray, steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        t, path = 0.0, [(q, u)]
        for h in steps:
            path.append(self.step(t, h, *path[-1]))
            t += h
        return np.array([x for x, _ in path]), np.array([x for _, x in path])


@cache
def space_block(section: str) -> Scene:
    """A point above the floor z = 0 with M^-1 = [[1, 0, B], [0, 1, c], [B, c, 1]], B = beta + bend sin(x), and a force.

    Friction in space; `section`: "ellipse" with the axes mu and nu turned by `angle`, or "kite" with the vertices
    mu (1, 0), nu (0, 1), -2 mu (1, 0) and -nu (0, 1).
    """
    names = ("beta", "c", "bend", "mu", "nu", "angle", "weight", "drag", "beat")
    parameters = [
        Parameter(name=n, unit="1", sentence=n, default="0", range="nonnegative" if n in ("mu", "nu") else "real")
        for n in names
    ]
    beta, c, bend, mu, nu, angle, weight, drag, beat = (p.symbol for p in parameters)
    B = beta + bend * sp.sin(X)
    inverse = sp.Matrix([[1, 0, B], [0, 1, c], [B, c, 1]])
    friction = {
        "ellipse": Ellipse(mu_1=mu, mu_2=nu, angle=angle),
        "kite": Polygon(vertices=((mu, 0), (0, nu), (-2 * mu, 0), (0, -nu))),
    }[section]
    return make_scene(
        name=f"block_on_{section}",
        sentence="a point with coupled inertia above a floor",
        source="docs/theory.md, section 6, minimal scene",
        coordinates=[Coordinate(name=n, unit="m", sentence=n) for n in ("x", "y", "z")],
        parameters=parameters,
        inertia=inverse.inv().applyfunc(sp.simplify),
        force=sp.Matrix([-drag * U_X + beat * sp.sin(3 * T), beat * sp.cos(2 * T), -weight]),
        constraint=-Z,
        tangential_displacements=[X, Y],
        friction=friction,
    )
