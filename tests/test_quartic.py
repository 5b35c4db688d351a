"""Roots of quartics: those that were chosen are found, each to rounding relative to itself."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from painleve.core.space.quartic import roots_of_quartic


def quartic(*roots, leading=1.0, rest=()):
    """Coefficients, constant first, of leading times the factors of the roots and of x^2 + 2 Re(z) x + |z|^2."""
    with mpmath.workdps(400):
        c = [mpmath.mpf(leading)]
        for root in roots:
            c = [a - mpmath.mpf(root) * b for a, b in zip([0, *c], [*c, 0], strict=True)]
        for z in rest:
            x, size = 2 * mpmath.mpf(z.real), mpmath.mpf(abs(z)) ** 2
            c = [a + x * b + size * d for a, b, d in zip([0, 0, *c], [0, *c, 0], [*c, 0, 0], strict=True)]
        return np.array([float(a) for a in c])


def found(c):
    roots = np.empty(4)
    return roots[: roots_of_quartic(c, roots)].copy()


@pytest.mark.parametrize("seed", range(20))
def test_separated_roots_are_found_whatever_their_number_and_the_sign_of_the_leading_coefficient(seed):
    rng = np.random.default_rng(seed)
    places = np.sort(rng.choice(np.linspace(-0.95, 0.95, 39), size=4, replace=False))
    leading = (-1.0) ** seed * 10.0 ** rng.integers(-20, 20)
    np.testing.assert_allclose(found(quartic(*places, leading=leading)), places, rtol=1e-9, atol=1e-11)
    two = found(quartic(*places[1:3], leading=leading, rest=[complex(rng.normal(), 0.5)]))
    np.testing.assert_allclose(two, places[1:3], rtol=1e-9, atol=1e-11)
    outside = found(quartic(places[0], 3.0, -2.0, 7.0, leading=leading))
    np.testing.assert_allclose(outside, places[:1], rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("tiny", [1e-8, -1e-40, 1e-100, -1e-140])
def test_a_tiny_root_beside_others_is_right_to_rounding_relative_to_itself(tiny):
    mine = found(quartic(-0.5, tiny, 0.75, 4.0))
    np.testing.assert_allclose(mine, [-0.5, tiny, 0.75], rtol=1e-14)


def test_a_root_at_zero_is_zero_and_a_quartic_without_roots_has_none():
    np.testing.assert_array_equal(found(quartic(0.0, 0.5, rest=[1 + 1j])), [0.0, 0.5])
    assert found(quartic(rest=[1 + 1j, 0.2 + 0.1j])).size == 0
