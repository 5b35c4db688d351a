"""Taylor models hold the truth on the whole ball: at low order, on large balls, where what is left out is large.

The truth is evaluated in ball arithmetic at points of the ball, its boundary among them. Sums of positive terms attain
their bounds at an end of an axis: a term that is dropped, or a power of the radius too many, is seen there.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import product

import flint
import numpy as np
import pytest
import sympy as sp
from flint import arb
from hypothesis import given, settings
from hypothesis import strategies as st

from painleve.asymptotics.ball_arithmetic import BITS
from painleve.asymptotics.certify.cover import Cover
from painleve.asymptotics.certify.taylor_models import TaylorModel, expand, make_models, taylor_order
from painleve.asymptotics.local import LocalProblem, make_local_problem
from painleve.asymptotics.member import base_balls
from painleve.errors import InputError
from painleve.exact.balls import ball
from painleve.exact.jets import Jet, monomials
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import limit_set

Point = tuple[float, ...]
Truth = Callable[[Point], arb]
Terms = dict[tuple[int, ...], int]

DEGREE = 4  # of the polynomials that stand for functions
RADII = (0.125, 0.5, 1.0, 1.5)  # on both sides of one, where a power of the radius makes a difference
TINY = arb(2) ** -200  # that much may be off by rounding at BITS


def points(variables: int, radius: float) -> list[Point]:
    """Of the closed ball: the ends of its axes, places between them near its boundary, and places well inside."""
    axes = [tuple(s * radius * float(i == j) for j in range(variables)) for i in range(variables) for s in (1, -1)]
    between = [tuple(0.7 * radius * s for s in signs) for signs in product((1, -1), repeat=variables)]
    return axes + between + [tuple(radius * s for s in (0.3, -0.5)[:variables]), (0.0,) * variables]


def value(terms: dict, x: Point) -> arb:
    total = arb(0)
    for powers, coefficient in terms.items():
        term = arb(coefficient)
        for step, power in zip(x, powers, strict=True):
            term *= arb(step) ** power
        total += term
    return total


def model(terms: Terms, variables: int, order: int, radius: float) -> TaylorModel:
    """Of a polynomial: its terms up to the order, and the sharpest remainder that its higher ones allow."""
    near = {powers: arb(c) for powers, c in terms.items() if sum(powers) <= order}
    rest = sum((abs(c) * arb(radius) ** sum(m) for m, c in terms.items() if sum(m) > order), arb(0))
    return TaylorModel(near=Jet(near, variables, order), remainder=rest, radius=arb(radius))


def assert_holds(f: TaylorModel, truth: Truth) -> None:
    radius, variables = float(f.radius.mid()), f.near.variables
    low, high = f.bounds
    for x in points(variables, radius):
        right = truth(x)
        assert abs(value(f.near.terms, x) - right) <= f.remainder + TINY, f"the remainder at {x}"
        assert arb(low) <= right.lower() + TINY, f"the lower bound at {x}"
        assert right.upper() <= arb(high) + TINY, f"the upper bound at {x}"


def polynomials(variables: int) -> st.SearchStrategy[Terms]:
    powers = monomials(variables, DEGREE)
    coefficients = st.lists(st.integers(-3, 3), min_size=len(powers), max_size=len(powers))
    return coefficients.map(lambda c: {m: n for m, n in zip(powers, c, strict=True) if n})


CASES = st.sampled_from([1, 2]).flatmap(
    lambda variables: st.tuples(
        st.just(variables),
        st.integers(1, 3),
        st.sampled_from(RADII),
        polynomials(variables),
        polynomials(variables),
    )
)


@given(CASES)
@settings(max_examples=60)
def test_sums_and_products_of_models_hold_the_sums_and_products_of_functions(case):
    variables, order, radius, first, second = case
    with flint.ctx.workprec(BITS):
        f, g = (model(terms, variables, order, radius) for terms in (first, second))

        def pair(x: Point) -> tuple[arb, arb]:
            return value(first, x), value(second, x)

        assert_holds(f, lambda x: pair(x)[0])
        assert_holds(f + g, lambda x: pair(x)[0] + pair(x)[1])
        assert_holds(f - g, lambda x: pair(x)[0] - pair(x)[1])
        assert_holds(f * g, lambda x: pair(x)[0] * pair(x)[1])
        assert_holds(f * g * f - g, lambda x: pair(x)[0] ** 2 * pair(x)[1] - pair(x)[1])
        assert_holds(f.scale(arb(-3)).shift(arb(2)) * g, lambda x: (2 - 3 * pair(x)[0]) * pair(x)[1])


@given(CASES, st.sampled_from([1, -1]))
@settings(max_examples=40)
def test_reciprocals_and_quotients_of_models_hold_those_of_functions(case, sign):
    """The constant term outweighs all others on the ball, by as little as makes the expansion converge."""
    variables, order, radius, first, second = case
    zero = (0,) * variables
    above = sum(abs(c) * radius ** sum(m) for m, c in first.items() if m != zero)
    first = first | {zero: sign * (1 + int(3 * above))}
    with flint.ctx.workprec(BITS):
        f, g = (model(terms, variables, order, radius) for terms in (first, second))
        try:
            inverse = f.reciprocal()
        except InputError:
            return
        assert_holds(inverse, lambda x: 1 / value(first, x))
        assert_holds(g * inverse, lambda x: value(second, x) / value(first, x))


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("order", [1, 2, 3])
def test_what_a_product_leaves_out_is_all_of_its_higher_terms_and_nothing_else(order, radius):
    """(1 + x + ... + x^order)^2: the remainder is attained at x = radius."""
    with flint.ctx.workprec(BITS):
        f = model({(k,): 1 for k in range(order + 1)}, 1, order, radius)
        left_out = sum(((2 * order + 1 - k) * arb(radius) ** k for k in range(order + 1, 2 * order + 1)), arb(0))
        assert abs((f * f).remainder - left_out) < TINY


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("order", [1, 2, 3])
def test_what_a_reciprocal_leaves_out_is_attained_by_the_geometric_series(order, radius):
    """1/(2 - x), largest at x = radius."""
    with flint.ctx.workprec(BITS):
        inverse = model({(0,): 2, (1,): -1}, 1, order, radius).reciprocal()
        left_out = 1 / (2 - arb(radius)) - value(inverse.near.terms, (radius,))
        assert abs(inverse.remainder - left_out) < TINY


def test_a_function_that_may_vanish_on_the_ball_has_no_reciprocal():
    for terms in ({(0,): 1, (1,): 2}, {(0,): 1, (3,): 1}, {(1,): 1}):
        with flint.ctx.workprec(BITS), pytest.raises(InputError, match="too large at this state"):
            model(terms, 1, 2, 1.5).reciprocal()


def test_only_a_function_that_may_be_zero_at_the_base_point_is_said_to_vanish_there():
    zero = model({(1,): 2, (2,): 1}, 1, 2, 0.5)
    hidden = zero.shift(arb(0, 1e-60))
    assert hidden.vanishing().near.terms == zero.near.terms
    with pytest.raises(ArithmeticError, match="should vanish"):
        zero.shift(arb(1e-60)).vanishing()


# --- expansions of a scene's functions -------------------------------------------------------------------------------

BASES = {1: ("slender_rod", "double_zero"), 2: ("two_link_arm", "approached")}


@cache
def problem_of(variables: int) -> LocalProblem:
    scene, state = BASES[variables]
    return make_local_problem(limit_set(make_state(load_scene(scene), state)))


def offsets(variables: int) -> list[sp.Expr]:
    """q - base, for the shape coordinates."""
    problem = problem_of(variables)
    return [problem.kernels.scene.q[i] - problem.limit.state.q[i] for i in problem.shape]


def truth_of(expression: sp.Expr, variables: int) -> Truth:
    problem = problem_of(variables)
    q = base_balls(problem)[0]
    symbols = [problem.kernels.scene.q[i] for i in problem.shape]
    return lambda x: ball(
        expression,
        {s: q[i] + arb(step) for s, i, step in zip(symbols, problem.shape, x, strict=True)},
        bits=BITS,
    )


@pytest.mark.parametrize("variables", [1, 2])
@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("radius", RADII)
def test_a_power_above_the_order_is_left_out_and_attains_the_remainder(variables, order, radius):
    power = offsets(variables)[-1] ** (order + 1)
    (f,) = expand(problem_of(variables), radius, [power], order)
    with flint.ctx.workprec(BITS):
        assert_holds(f, truth_of(power, variables))
        assert abs(f.remainder - arb(radius) ** (order + 1)) < TINY


ANALYTIC = {
    1: (lambda x: sp.sin(3 * x + 1), lambda x: sp.exp(-x), lambda x: 1 / (2 + x), lambda x: sp.sqrt(2 + x)),
    2: (lambda x, y: sp.sin(x - 2 * y), lambda x, y: sp.exp(x * y), lambda x, y: 1 / (5 + x + 2 * y)),
}


@pytest.mark.parametrize(("variables", "number"), [(1, 0), (1, 1), (1, 2), (1, 3), (2, 0), (2, 1), (2, 2)])
@pytest.mark.parametrize("order", [1, 2, 4])
def test_an_analytic_function_is_held_by_its_expansion(variables, number, order):
    expression = ANALYTIC[variables][number](*offsets(variables))
    for radius in (0.05, 0.4, 1.0):
        (f,) = expand(problem_of(variables), radius, [expression], order)
        with flint.ctx.workprec(BITS):
            assert_holds(f, truth_of(expression, variables))
            if radius == 0.05:
                assert f.remainder < 50 * arb(radius) ** (order + 1), "an enclosure of everything would prove nothing"


@pytest.mark.parametrize("eps", [1e-1, 1e-2, 1e-4, 1e-12])
@pytest.mark.parametrize("variables", [1, 2])
def test_the_order_that_is_chosen_is_the_least_whose_remainder_does_not_show_or_the_highest_affordable(variables, eps):
    """Of functions whose coefficients do not grow, divided by eps, relative to eps."""
    order, highest = taylor_order(variables, eps), {1: 14, 2: 10}[variables]
    assert order == highest or eps ** (order + 1) / eps <= 1e-11 * eps * (1 + 1e-9)
    assert eps**order / eps > 1e-11 * eps


def test_three_shape_coordinates_are_refused():
    with pytest.raises(InputError, match="depends on 3 coordinates"):
        taylor_order(3, 1e-2)


@given(CASES)
@settings(max_examples=40)
def test_polynomials_in_floats_hold_the_functions_with_what_rounding_loses(case):
    """Coefficients that no double holds: thirds. `size` and `bend` bound values and second derivatives."""
    variables, order, radius, first, second = case
    with flint.ctx.workprec(BITS):
        third = arb(1) / 3
        models = make_models([model(t, variables, order, radius).scale(third) for t in (first, second)])
        for j, terms in enumerate((first, second)):
            written = {tuple(m): arb(c) for m, c in zip(models.powers.tolist(), models.coefficients[:, j], strict=True)}
            for x in points(variables, 1.0):
                kept, right = value(written, x), third * value(terms, tuple(radius * s for s in x))
                assert abs(kept - right) <= arb(models.remainder[j]) + TINY
                assert abs(kept) <= arb(models.size[j])
                assert abs(second_derivative(written, x, x)) <= arb(models.bend[j]) * sum(s * s for s in x)


def second_derivative(terms: dict, x: Point, y: Point) -> arb:
    """At x along y."""
    total = arb(0)
    for powers, c in terms.items():
        for i, j in product(range(len(x)), repeat=2):
            once = [p - (k == i) for k, p in enumerate(powers)]
            twice = [p - (k == j) for k, p in enumerate(once)]
            if factor := powers[i] * once[j]:
                total += c * factor * arb(y[i]) * arb(y[j]) * value({tuple(twice): 1}, x)
    return total


@given(CASES)
@settings(max_examples=40)
def test_values_and_gradients_of_the_polynomials_in_floats_are_those_of_the_polynomials(case):
    variables, order, radius, first, second = case
    models = make_models([model(t, variables, order, radius) for t in (first, second)])
    places = np.array(points(variables, 0.9))
    values, gradients = models.at(places)
    symbols = sp.symbols("x:2")[:variables]
    for j in range(2):
        written = sum(
            (sp.Float(c, 30) * sp.Mul(*(s**k for s, k in zip(symbols, m, strict=True))))
            for m, c in zip(models.powers.tolist(), models.coefficients[:, j], strict=True)
        )
        for i, x in enumerate(places):
            at = dict(zip(symbols, x, strict=True))
            scale = 1e-14 * (1.0 + models.size[j]) * 20
            assert abs(values[i, j] - float(written.subs(at))) <= scale
            for s, symbol in enumerate(symbols):
                assert abs(gradients[i, s, j] - float(sp.diff(written, symbol).subs(at))) <= scale


@given(CASES)
@settings(max_examples=15)
def test_a_cover_has_every_point_of_the_ball_in_a_box_that_bounds_the_functions_there(case):
    variables, order, radius, first, second = case
    functions = [model(terms, variables, order, radius) for terms in (first, second)]
    cover = Cover(variables)
    low, high = cover.bounds(functions)
    random = np.random.default_rng(3)
    places = random.normal(size=(60, variables))
    places *= np.minimum(1.0, 1.3 * random.uniform(size=(60, 1))) / np.linalg.norm(places, axis=1)[:, None]
    for xi in places:
        (box,) = np.flatnonzero(np.all(np.abs(cover.xi - xi) <= cover.half * (1 + 1e-12), axis=1))[:1]
        assert cover.nearest[box] <= np.linalg.norm(xi)
        for j, terms in enumerate((first, second)):
            right = float(value(terms, tuple(radius * xi)).mid())
            assert low[box, j] <= right + 1e-12
            assert right <= high[box, j] + 1e-12


def test_a_cover_bounds_narrowly_and_leaves_out_what_is_not_wanted():
    """x over [-1, 1] in 256 boxes: each bound is within a cell of the value in its middle."""
    cover = Cover(1)
    assert len(cover.xi) == 256
    low, high = cover.bounds([model({(1,): 1}, 1, 2, 1.0)])
    assert np.all(np.abs(0.5 * (low + high) - cover.xi) < 1e-12)
    assert np.all(high - low < 2.0 * cover.half + 1e-12)
    cover.keep(high[:, 0] >= 0.5)
    assert 64 <= len(cover.xi) <= 66
    assert cover.xi.min() > 0.49
    assert np.all(Cover(2).nearest <= 1.0)
    assert len(Cover(0).xi) == 1
