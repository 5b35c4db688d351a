"""The expansions about a state leave out no more than they say."""

import flint
import numpy as np
import pytest

from painleve.asymptotics.local import BITS, make_local_problem
from painleve.asymptotics.member import row_balls
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import limit_set

STATES = [("slender_rod", "double_zero"), ("worn_tip_rod", "isolated"), ("two_link_arm", "approached")]


@pytest.mark.parametrize("eps", [1e-2, 1e-5, 1e-12])
@pytest.mark.parametrize(("scene", "state"), STATES)
def test_the_remainder_bounds_what_an_expansion_leaves_out_on_the_ball(scene, state, eps):
    problem = make_local_problem(limit_set(make_state(load_scene(scene), state)))
    found = problem.expansion(eps)
    assert found is not None
    greatest = (np.abs(problem.table) * eps**problem.degrees).max(axis=1)
    at_base = row_balls(problem, [flint.arb(0)] * problem.dimension)
    random = np.random.default_rng(0)
    for _ in range(20):
        shape = random.normal(size=len(problem.shape))
        shape *= eps * random.uniform() ** 0.1 / np.linalg.norm(shape)
        dq = [flint.arb(0)] * problem.dimension
        for axis, x in zip(problem.shape, shape, strict=True):
            dq[axis] = flint.arb(float(x))
        with flint.ctx.workprec(BITS):
            exact = [(x - y) for x, y in zip(row_balls(problem, dq), at_base, strict=True)]
            kept = [powers for powers in problem.powers if sum(powers) <= found.order]
            for place, row in enumerate(problem.kernels.rows.varying):
                total = flint.arb(0)
                for powers, c in zip(kept, problem.table[place], strict=False):
                    term = flint.arb(float(c))
                    for x, power in zip(shape, powers, strict=True):
                        term *= flint.arb(float(x)) ** power
                    total += term
                # Each coefficient is rounded to a double: that, and not the truncation, is the second term.
                allowed = (found.remainder[place] + 2.0**-52 * len(kept)) * greatest[place]
                assert abs(total - exact[row]) <= allowed


def test_a_ball_on_which_no_bound_is_small_is_evaluated_plainly():
    problem = make_local_problem(limit_set(make_state(load_scene("two_link_arm"), "approached")))
    assert problem.expansion(0.1) is None
    assert problem.expansion(0.1, "taylor") is not None
