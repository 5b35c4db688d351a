"""Signs of leading minors: by elimination in balls, and exactly where that leaves them open."""

from __future__ import annotations

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from painleve.exact.definite import least_minor_sign
from painleve.exact.signs import Sign

entries = st.fractions(min_value=-2, max_value=2, max_denominator=3)


def symmetric(numbers: list) -> sp.Matrix:
    a, b, c, d, e, f = (sp.Rational(x.numerator, x.denominator) for x in numbers)
    return sp.Matrix([[a, b, c], [b, d, e], [c, e, f]])


@given(st.lists(entries, min_size=6, max_size=6))
def test_the_sign_is_that_of_the_first_minor_that_is_not_positive(numbers):
    M = symmetric(numbers)
    minors = [M[:k, :k].det() for k in (1, 2, 3)]
    first = next((m for m in minors if m <= 0), None)
    expected = Sign.POSITIVE if first is None else Sign.NEGATIVE if first < 0 else Sign.ZERO
    assert least_minor_sign(M) is expected


@pytest.mark.parametrize("distance", [sp.Integer(0), sp.Rational(1, 10**200), -sp.Rational(1, 10**200)])
def test_what_no_ball_sees_is_decided_exactly(distance):
    """[[1, sqrt(2)], [sqrt(2), 2 + distance]]: singular, or away from it by less than 512 bits tell."""
    M = sp.Matrix([[1, sp.sqrt(2)], [sp.sqrt(2), 2 + distance]])
    expected = Sign.ZERO if distance == 0 else Sign.POSITIVE if distance > 0 else Sign.NEGATIVE
    assert least_minor_sign(M) is expected


def test_a_matrix_of_transcendental_entries_needs_no_determinant(monkeypatch):
    monkeypatch.setattr(sp.MutableDenseMatrix, "det", None)
    q = sp.Rational(3, 10)
    M = sp.Matrix([[sp.exp(q), sp.sin(q)], [sp.sin(q), sp.cos(q)]])
    assert least_minor_sign(M) is Sign.POSITIVE
    assert least_minor_sign(M - 2 * sp.eye(2)) is Sign.NEGATIVE
    a, b, c = sp.exp(q), sp.cos(q), sp.sin(q)
    larger = sp.Matrix([[a, b, c], [b, 2 * a, b], [c, b, a]])
    assert least_minor_sign(larger) is Sign.POSITIVE
    assert least_minor_sign(larger - sp.diag(0, 0, 2)) is Sign.NEGATIVE
