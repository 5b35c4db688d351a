"""Facts about the rod that have closed forms, found by exact algebra from its derivation and again in 40 digits.

mu_c comes from the scene's derivation (a Delassus matrix), the singular point from Newton's equations
(studies.reference.slip); with t = tan(theta) > 0 both are rational functions.
"""

from __future__ import annotations

import math
from functools import lru_cache

import mpmath as mp
import sympy as sp

from painleve.exact.signs import Sign
from painleve.mechanics.derive import derive
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.classification import classify
from studies.reference.compare import FoundValue
from studies.reference.slip import derive_slip

__all__ = [
    "ALPHA",
    "ALPHAS",
    "MU",
    "T",
    "critical_friction",
    "eigenvalue_ratio",
    "find_band_edge",
    "find_eigenvalue_ratio",
    "find_force_at_rest",
    "find_least_friction",
    "find_mu_C",
    "find_mu_P",
    "find_singular_rate",
    "find_sixty_degrees_friction",
    "on_tangent",
]

DIGITS = 40
ALPHAS = (sp.Rational(1, 2), sp.Integer(1), sp.Integer(2), sp.Integer(3), sp.Integer(6))
FRICTIONS = (sp.Rational(7, 5), sp.Rational(5, 3), sp.Integer(2), sp.Integer(10))
ALPHA, MU, T = (sp.Symbol(name, positive=True) for name in ("alpha", "mu", "t"))
M, L, GRAVITY, THETA, OMEGA = (sp.Symbol(name, positive=True) for name in ("m", "l", "gravity", "theta", "omega"))


@lru_cache(maxsize=1)
def critical_friction() -> sp.Expr:
    """mu_c of the slender rod as the scene's derivation gives it, over alpha and t = tan(theta) > 0."""
    scene = load_scene("slender_rod")
    inertia = {scene.parameter("I").symbol: scene.parameter("m").symbol * scene.parameter("l").symbol ** 2 / ALPHA}
    mu_c = _critical_friction(inertia | {scene.q[2]: sp.atan(T)})
    return sp.cancel(sp.simplify(mu_c))


def _critical_friction(values: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    mu_c = derive(load_scene("slender_rod")).critical_friction
    assert mu_c is not None, "the rod has one coefficient of friction"
    return mu_c.xreplace(values)


def find_mu_P(slope: bool) -> FoundValue:
    """The least mu_c over the angle for symbolic alpha, or the tan(theta) where it is taken."""
    t = _stationary(critical_friction(), T)
    value = sp.simplify(critical_friction().xreplace({T: t}))
    chosen, place = (t, 0) if slope else (value, 1)
    gap = max(_gap(chosen.xreplace({ALPHA: a}), _numerical_least(a)[place]) for a in ALPHAS)
    route = "d mu_c/dt = 0 solved for symbolic alpha; the least mu_c in 40 digits at five alpha"
    return FoundValue(value=chosen, route=route, gap=gap)


def find_least_friction(slope: bool) -> FoundValue:
    """The same for the uniform rod, and the branch there by exact arithmetic."""
    t = _stationary(critical_friction().xreplace({ALPHA: sp.Integer(3)}), T)
    value = critical_friction().xreplace({ALPHA: sp.Integer(3), T: t})
    signs = [_sign_of_gamma(mu=value + shift, t=t) for shift in (sp.Rational(-1, 10**9), 0, sp.Rational(1, 10**9))]
    found = ", ".join(sign.value for sign in signs)
    decided = signs == [Sign.POSITIVE, Sign.ZERO, Sign.NEGATIVE]
    chosen, place = (t, 0) if slope else (value, 1)
    gap = _gap(chosen, _numerical_least(sp.Integer(3))[place]) if decided else math.inf
    route = f"d mu_c/dt = 0 solved, and in 40 digits; gamma there at mu - 1e-9, mu, mu + 1e-9 is {found} by `classify`"
    return FoundValue(value=chosen, route=route, gap=gap)


def find_band_edge(upper: bool) -> FoundValue:
    """tan(theta) where Newton's equations have no finite contact force, for symbolic mu."""
    edge = sp.numer(on_tangent(derive_slip().edge.xreplace({ALPHA: sp.Integer(3)})))
    roots = sorted(sp.roots(edge, T), key=lambda root: float(root.xreplace({MU: sp.Integer(2)})))
    chosen = roots[1 if upper else 0]
    signs = [_sign_of_gamma(mu=mu, t=chosen.xreplace({MU: mu})) for mu in FRICTIONS]
    found = ", ".join(sign.value for sign in signs)
    route = f"the slip's compliance = 0 solved; gamma there at four mu by `classify`: {found}"
    return FoundValue(value=chosen, route=route, gap=0.0 if set(signs) == {Sign.ZERO} else math.inf)


def find_sixty_degrees_friction() -> FoundValue:
    """mu_c at 60 degrees."""
    value = critical_friction().xreplace({ALPHA: sp.Integer(3), T: sp.sqrt(3)})
    return FoundValue(value=float(value), error=1e-15, route=f"mu_c of the scene's derivation: {value}")


def find_force_at_rest() -> FoundValue:
    """F/(m gravity) of the uniform rod's slip at omega = 0."""
    slip = derive_slip()
    force = (slip.push / slip.edge).xreplace({OMEGA: sp.Integer(0), ALPHA: sp.Integer(3)})
    route = "Newton's equations solved for the accelerations and the contact force"
    return FoundValue(value=force / (M * GRAVITY), route=route)


def find_singular_rate() -> FoundValue:
    """omega^2 where the free normal acceleration vanishes."""
    square = sp.Symbol("square", positive=True)
    (root,) = sp.solve(derive_slip().push.subs(OMEGA, sp.sqrt(square)), square)
    return FoundValue(value=root, route="Newton's equations solved; the numerator of the contact force = 0")


@lru_cache(maxsize=1)
def eigenvalue_ratio() -> sp.Expr:
    """The omega-eigenvalue over the theta-eigenvalue of the flow in tau at the singular point, over alpha and t."""
    jacobian = derive_slip().flow.jacobian([THETA, OMEGA]).xreplace(_singular_point())
    at_point = jacobian.applyfunc(lambda e: sp.simplify(on_tangent(e)))
    assert at_point[0, 1] == 0, "the edge of the band depends on the angle alone"
    return sp.factor(at_point[1, 1] / at_point[0, 0])


def find_eigenvalue_ratio() -> FoundValue:
    """The ratio r, again with the Jacobian and its eigenvalues in 40 digits."""
    points = [(a, t) for a in ALPHAS for t in (sp.Rational(1, 2), sp.Rational(9, 10))]
    gap = max(_gap(eigenvalue_ratio().xreplace({ALPHA: a, T: t}), _numerical_ratio(a, t)) for a, t in points)
    route = "eigenvalues of the slip's Jacobian in the time dt/p; the same in 40 digits by differences at ten points"
    return FoundValue(value=eigenvalue_ratio(), route=route, gap=gap)


def find_mu_C(uniform: bool) -> FoundValue:
    """The friction on the lower edge at which r = 1."""
    (t,) = sp.solve(eigenvalue_ratio() - 1, T)
    (mu,) = sp.solve(on_tangent(derive_slip().edge).xreplace({T: t}), MU)
    value = mu.xreplace({ALPHA: sp.Integer(3)}) if uniform else sp.simplify(mu)
    return FoundValue(value=value, route="r = 1 solved for tan(theta), and the edge of the band there for mu")


def on_tangent(expression: sp.Expr) -> sp.Expr:
    """An expression in theta over t = tan(theta)."""
    return sp.together(expression.xreplace({THETA: sp.atan(T)}))


def _singular_point() -> dict[sp.Symbol, sp.Expr]:
    """mu and omega where push = edge = 0, over theta."""
    (mu,) = sp.solve(derive_slip().edge, MU)
    return {MU: mu, OMEGA: sp.sqrt(find_singular_rate().value)}


def _stationary(function: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """The one positive point where a function that grows without bound at 0 and infinity is stationary: its minimum."""
    (root,) = sp.solve(sp.diff(function, variable), variable)
    return root


def _sign_of_gamma(*, mu: sp.Expr, t: sp.Expr) -> Sign:
    state = make_state(load_scene("slender_rod"), keys={"theta": sp.atan(t)}, parameters={"mu": mu})
    return classify(state).limit.gamma.sign


def _numerical_least(alpha: sp.Expr) -> tuple[mp.mpf, mp.mpf]:
    """tan(theta) and mu_c at its least value, by differences and Newton's method in 40 digits."""
    scene = load_scene("slender_rod")
    values = {"m": sp.Integer(1), "l": sp.Integer(1), "I": 1 / alpha}
    numbers = {scene.parameter(name).symbol: value for name, value in values.items()}
    function = sp.lambdify([scene.q[2]], _critical_friction(numbers), "mpmath")
    with mp.workdps(DIGITS):
        theta = mp.findroot(lambda x: mp.diff(function, x), mp.mpf("1.1"))
        return mp.tan(theta), function(theta)


def _numerical_ratio(alpha: sp.Expr, t: sp.Expr) -> mp.mpf:
    """The ratio r at tan(theta) = t from the eigenvectors of a Jacobian by differences, in 40 digits."""
    slip, numbers = derive_slip(), {ALPHA: alpha, M: sp.Integer(1), L: sp.Integer(1), GRAVITY: sp.Integer(10)}
    push, edge, turn = (
        sp.lambdify([THETA, OMEGA, MU], e.xreplace(numbers), "mpmath") for e in (slip.push, slip.edge, slip.turn)
    )
    with mp.workdps(DIGITS):
        theta = mp.atan(mp.mpf(t.p) / t.q)
        mu = mp.findroot(lambda x: edge(theta, 0, x), 1)
        omega = mp.findroot(lambda x: push(theta, x, mu), 4)
        flow = (lambda x, w: w * edge(x, w, mu), lambda x, w: turn(x, w, mu))
        jacobian = mp.matrix([[mp.diff(f, (theta, omega), n) for n in ((1, 0), (0, 1))] for f in flow])
        values, vectors = mp.eig(jacobian)
        along_omega = min((0, 1), key=lambda i: abs(vectors[0, i]))
        return values[along_omega] / values[1 - along_omega]


def _gap(value: sp.Expr, reference: mp.mpf) -> float:
    """The relative difference of an exact number from one in 40 digits."""
    with mp.workdps(DIGITS):
        exact = mp.mpf(str(sp.N(value, DIGITS)))
        return float(abs(mp.re(reference) - exact) / abs(exact))
