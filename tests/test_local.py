"""The expansions about a state leave out no more than they say."""

import flint
import numpy as np
import pytest

from painleve.asymptotics.ball_arithmetic import BITS
from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.member import row_balls
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import limit_set

STATES = [("slender_rod", "double_zero"), ("worn_tip_rod", "isolated"), ("two_link_arm", "approached")]


@pytest.mark.parametrize("eps", [0.1, 1e-2, 5e-3, 1e-3, 5e-5, 1e-5, 1e-12])
@pytest.mark.parametrize(("scene", "state"), STATES)
def test_the_remainder_bounds_what_is_left_out_of_the_polynomials_that_are_evaluated(scene, state, eps):
    """Asked for, polynomials are bounded even where they are not accurate enough to be trusted. Rows have orders of
    their own: at most of these eps some do without terms that others have."""
    problem = make_local_problem(limit_set(make_state(load_scene(scene), state)))
    found = problem.expansion(eps, "taylor")
    assert found is not None
    varying = list(problem.kernels.rows.varying)
    terms = np.abs(problem.table) * eps**problem.degrees
    greatest = terms.max(axis=1)
    # Doubles: each coefficient is rounded, then each product and sum. A mistake of truncation is larger than that.
    rounding = 2.0**-53 * (2 * found.order + 2) * terms.sum(axis=1)
    x = places(len(problem.shape))
    evaluated = problem.differences(eps, found, x)[varying]
    at_base = row_balls(problem, [flint.arb(0)] * problem.dimension)
    for place, shape in enumerate((eps * x).T):
        dq = [flint.arb(0)] * problem.dimension
        for axis, step in zip(problem.shape, shape, strict=True):
            dq[axis] = flint.arb(float(step))
        with flint.ctx.workprec(BITS):
            exact = [x - y for x, y in zip(row_balls(problem, dq), at_base, strict=True)]
            for k, row in enumerate(varying):
                error = abs(exact[row] - flint.arb(float(evaluated[k, place])))
                assert error <= found.remainder[k] * greatest[k] + rounding[k]


def places(variables: int) -> np.ndarray:
    """(variables, n): most of them near the boundary of the unit ball, where what is left out is largest."""
    random = np.random.default_rng(0)
    x = random.normal(size=(variables, 24))
    x *= random.uniform(size=24) ** 0.05 / np.linalg.norm(x, axis=0)
    x[:, :2] /= np.linalg.norm(x[:, :2], axis=0)
    return x * (1.0 - 2.0**-50)


def test_a_ball_on_which_no_bound_is_small_is_evaluated_plainly():
    problem = make_local_problem(limit_set(make_state(load_scene("two_link_arm"), "approached")))
    assert problem.expansion(0.1) is None
    assert problem.expansion(0.1, "taylor") is not None
