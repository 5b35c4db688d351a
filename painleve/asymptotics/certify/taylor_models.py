"""Functions of the configuration over a whole ball |q_eps - q| <= eps: Taylor polynomials with a rigorous remainder.

With q_eps = q + eps xi, what a method divides by eps is expanded first and divided coefficient by coefficient, so that
nothing cancels however small eps is. Analytic rows get Lagrange's remainder, with derivatives enclosed over the ball;
sums, products and reciprocals carry remainders along (K. Makino and M. Berz, Int. J. Pure Appl. Math. 4 (2003) 379).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import flint
import numpy as np
import sympy as sp

from painleve.asymptotics.ball_arithmetic import BITS
from painleve.asymptotics.local import LocalProblem
from painleve.asymptotics.member import base_balls
from painleve.errors import InputError
from painleve.exact.jets import Jet, jets, monomials

__all__ = ["Models", "TaylorModel", "expand", "make_models", "taylor_order"]

NEGLIGIBLE = 1e-11  # remainders below this, relative to eps, do not show in an enclosure
OUTWARD = 1.0 + 2.0**-40  # more than the relative rounding of a sum of as many terms as a polynomial has
HIGHEST_ORDER = {0: 1, 1: 14, 2: 10}


@dataclass(frozen=True, kw_only=True)
class TaylorModel:
    """f(q + x) = near(x) + r(x) with |r(x)| <= remainder for all |x| <= radius."""

    near: Jet
    remainder: flint.arb
    radius: flint.arb

    def __add__(self, other: TaylorModel) -> TaylorModel:
        return replace(self, near=self.near + other.near, remainder=self.remainder + other.remainder)

    def __sub__(self, other: TaylorModel) -> TaylorModel:
        return self + other.scale(flint.arb(-1))

    def __mul__(self, other: TaylorModel) -> TaylorModel:
        mine, theirs = self._degrees, other._degrees
        dropped = flint.arb(0)
        for i, x in enumerate(mine):
            for y in theirs[max(0, self.near.order + 1 - i) :]:
                dropped += x * y
        rest = self.remainder * (other.size + other.remainder) + other.remainder * self.size
        return replace(self, near=self.near * other.near, remainder=dropped + rest)

    def scale(self, factor: flint.arb) -> TaylorModel:
        return replace(self, near=self.near.scale(factor), remainder=self.remainder * abs(factor).abs_upper())

    def shift(self, value: flint.arb) -> TaylorModel:
        zero = (0,) * self.near.variables
        return replace(self, near=self.near.with_terms(dict(self.near.terms) | {zero: self.near.constant() + value}))

    def vanishing(self) -> TaylorModel:
        """The same function, known to be exactly zero at the base point. Raises ArithmeticError if it is not."""
        constant = self.near.constant()
        if not constant.contains(flint.arb(0)):
            raise ArithmeticError(f"a function that should vanish at the base point has the value {constant}")
        zero = (0,) * self.near.variables
        return replace(self, near=self.near.with_terms({k: v for k, v in self.near.terms.items() if k != zero}))

    def reciprocal(self) -> TaylorModel:
        """1/f: with T its Taylor polynomial and |f T - 1| <= delta < 1, |1/f - T| <= |T| delta/(1 - delta).

        Raises InputError where that does not show f to be nonzero on the ball.
        """
        inverse = self._inverse_jet()
        trial = replace(self, near=inverse, remainder=flint.arb(0))
        product = self * trial
        delta = product.shift(flint.arb(-1)).size + product.remainder
        if not delta < 1:
            raise InputError(
                f"certify: eps = {float(self.radius.mid()):g} is too large at this state: no expansion "
                "converges on the ball; use sample"
            )
        return replace(trial, remainder=(trial.size * delta / (1 - delta)).abs_upper())

    def _inverse_jet(self) -> Jet:
        """1/(c + h) = (1/c) sum (-h/c)^k, by Horner's rule."""
        c = self.near.constant()
        zero = (0,) * self.near.variables
        ratio = self.near.with_terms({k: -v / c for k, v in self.near.terms.items() if k != zero})
        one = self.near.with_terms({zero: flint.arb(1)})
        result = one
        for _ in range(self.near.order):
            result = result * ratio + one
        return result.scale(1 / c)

    @cached_property
    def _degrees(self) -> list[flint.arb]:
        """Bounds on the homogeneous parts on the ball."""
        sums = [flint.arb(0)] * (self.near.order + 1)
        for powers, value in self.near.terms.items():
            sums[sum(powers)] += value.abs_upper()
        return [(s * self.radius**k).abs_upper() for k, s in enumerate(sums)]

    @property
    def size(self) -> flint.arb:
        """Bound on the polynomial."""
        return sum(self._degrees, flint.arb(0))

    @property
    def bounds(self) -> tuple[float, float]:
        """Of the function on the ball, as floats rounded outwards."""
        centre = self.near.constant()
        away = sum(self._degrees[1:], flint.arb(0)) + self.remainder
        low, high = (centre - away).lower(), (centre + away).upper()
        return float(np.nextafter(float(low), -np.inf)), float(np.nextafter(float(high), np.inf))


def taylor_order(variables: int, eps: float) -> int:
    """The degree of polynomials whose remainder does not show, or the highest one that is affordable."""
    if variables not in HIGHEST_ORDER:
        raise InputError(
            f"certify: the law depends on {variables} coordinates of this scene, and at most "
            f"{max(HIGHEST_ORDER)} can be enclosed; use sample"
        )
    wanted = 1 + math.ceil(math.log(NEGLIGIBLE) / math.log(min(eps, 0.1)))
    return max(1, min(wanted, HIGHEST_ORDER[variables]))


def expand(problem: LocalProblem, eps: float, expressions: Sequence[sp.Expr], order: int) -> list[TaylorModel]:
    """Expressions in q and the parameters, in the shape coordinates. Raises InputError where one is not analytic."""
    scene = problem.kernels.scene
    q, p, _ = base_balls(problem)
    variables = [scene.q[i] for i in problem.shape]
    point = dict(zip(scene.q, q, strict=True)) | dict(zip([s.symbol for s in scene.parameters], p, strict=True))
    with flint.ctx.workprec(BITS):
        radius = flint.arb(float(eps))
        wide_point = point | {x: point[x] + flint.arb(0, float(eps)) for x in variables}
        near = jets(expressions, variables, point, order, bits=BITS)
        if not all(jet.is_finite() for jet in near):
            raise InputError("certify: the scene is not analytic at this state, so nothing can be expanded; use sample")
        try:
            wide = jets(expressions, variables, wide_point, order + 1, bits=BITS)
        except InputError as error:
            raise InputError(f"certify: eps = {eps:g} is too large at this state ({error}); use sample") from None
        if not all(jet.is_finite() for jet in wide):
            raise InputError(
                f"certify: eps = {eps:g} is too large at this state: the scene is not shown to be analytic on the "
                "ball; use sample"
            )
        pairs = zip(near, wide, strict=True)
        return [TaylorModel(near=x, remainder=_lagrange(y, radius), radius=radius) for x, y in pairs]


def _lagrange(wide: Jet, radius: flint.arb) -> flint.arb:
    """sum over |m| = n of |f^(m)/m!| radius^n, the derivatives anywhere in the ball."""
    highest = sum((v.abs_upper() for m, v in wide.terms.items() if sum(m) == wide.order), flint.arb(0))
    return (highest * radius**wide.order).abs_upper() if wide.variables else flint.arb(0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Models:
    """f_j(q + eps xi) = sum_m coefficients[m, j] xi^powers[m] +- remainder[j] for |xi| <= 1, in floats.

    bend: bounds the second derivative of the polynomial in any direction; size: bounds its value.
    """

    powers: np.ndarray
    coefficients: np.ndarray
    remainder: np.ndarray
    bend: np.ndarray
    size: np.ndarray

    def at(self, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values (n, j) and gradients (n, variables, j) of the polynomials at xi (n, variables)."""
        n, variables = xi.shape
        highest = int(self.powers.max(initial=0))
        table = np.ones((n, variables, highest + 1))
        for k in range(1, highest + 1):
            table[:, :, k] = table[:, :, k - 1] * xi
        factors = [table[:, s, self.powers[:, s]] for s in range(variables)]
        value = np.prod(factors, axis=0) if factors else np.ones((n, len(self.powers)))
        gradient = np.empty((n, variables, self.coefficients.shape[1]))
        for s in range(variables):
            power = self.powers[:, s]
            slope = table[:, s, np.maximum(power - 1, 0)] * power
            others = [f for i, f in enumerate(factors) if i != s]
            gradient[:, s] = np.prod([slope, *others], axis=0) @ self.coefficients
        return value @ self.coefficients, gradient


def make_models(functions: Sequence[TaylorModel]) -> Models:
    """Polynomials in xi = x/radius with float coefficients; what rounding them loses joins the remainder."""
    first = functions[0]
    powers = monomials(first.near.variables, first.near.order)
    table, remainder = np.empty((len(powers), len(functions))), np.empty(len(functions))
    for j, f in enumerate(functions):
        balls = [f.near.terms.get(m, flint.arb(0)) * first.radius ** sum(m) for m in powers]
        table[:, j] = [float(x.mid()) for x in balls]
        lost = sum(((x - flint.arb(y)).abs_upper() for x, y in zip(balls, table[:, j], strict=True)), flint.arb(0))
        remainder[j] = np.nextafter(float((lost + f.remainder).abs_upper()), np.inf)
    degree, size = np.array([sum(m) for m in powers]), np.abs(table)
    return Models(
        powers=np.array(powers, dtype=int).reshape(len(powers), first.near.variables),
        coefficients=table,
        remainder=remainder,
        bend=(degree * (degree - 1)) @ size * OUTWARD,
        size=size.sum(axis=0) * OUTWARD,
    )
