"""Scenes that are not analytic at the state or near it: plain numbers stay right, expansions refuse in one line."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from test_domain import at, flat, x, y

from painleve.asymptotics.certify.method import certify_distance
from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.rates import rate
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.errors import InputError
from painleve.theory.limit_set import limit_set

R2 = x**2 + y**2


@pytest.mark.parametrize("power", ["1/2", "3/2", "5/4", "5/3"])
def test_rows_are_right_at_a_state_at_which_a_root_has_no_expansion(power):
    problem = make_local_problem(limit_set(at(flat(mu=2 + R2 ** sp.Rational(power)))))
    rows = problem.kernels.rows
    assert problem.base[rows.index("mu_plus")] == 2.0
    assert np.isfinite(problem.base).all()
    assert problem.expansion(1e-3) is None
    offset = np.array([[0.6], [-0.8]])  # of length 1
    change = problem.differences(1e-3, None, offset)[rows.index("mu_plus"), 0]
    assert change == pytest.approx(1e-6 ** float(sp.Rational(power)), rel=1e-6)


def test_what_needs_expansions_says_that_there_are_none():
    limit = limit_set(at(flat(mu=2 + sp.sqrt(R2))))
    for method in (certify_distance, lambda limit, _: rate(limit)):
        with pytest.raises(InputError, match="not analytic at this state"):
            method(limit, 1e-3)
    with pytest.raises(InputError, match="arithmetic: the scene is not analytic"):
        sample_distance(limit, 1e-3, SampleOptions(samples=10, arithmetic="taylor"))


@pytest.mark.parametrize(
    "mu",
    [
        sp.sqrt(x),
        x ** sp.Rational(3, 2),
        sp.log(x + sp.Rational(1, 2000)) + 20,
        sp.asin(1 + x),
        4000 + 1 / (x - sp.pi / 9999),
    ],
)
def test_formulas_that_end_near_the_state_are_refused_in_one_line_by_certify(mu):
    limit = limit_set(at(flat(mu=(1 + mu) if mu.is_Pow else mu)))
    with pytest.raises(InputError, match="too large"):
        certify_distance(limit, 1e-3)
