"""Bounds: what each side says, that printing keeps it true, and what several of them say about a maximum."""

import dataclasses
import json
import math
import re
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from painleve.sets import Bounds, largest

distances = st.floats(min_value=0.0, max_value=1e300, allow_subnormal=False)
positive = st.floats(min_value=1e-300, max_value=1e300)


@st.composite
def known_numbers(draw):
    """A number and a true statement about it."""
    number = draw(distances)
    lower = draw(st.none() | st.floats(min_value=0.0, max_value=number))
    upper = draw(st.none() | st.floats(min_value=number, max_value=1e300))
    return number, Bounds(lower=lower, upper=upper)


@pytest.mark.parametrize(
    ("bounds", "side", "as_dict", "text"),
    [
        (Bounds.exactly(0), "exact", {"lower": 0.0, "upper": 0.0}, "= 0 (exact)"),
        (Bounds.exactly(0.5), "exact", {"lower": 0.5, "upper": 0.5}, "= 5.0000e-01 (exact)"),
        (
            Bounds.at_least(1.23456e-3),
            "lower bound",
            {"lower": 1.23456e-3, "upper": None},
            "≥ 1.2345e-03 (lower bound)",
        ),
        (Bounds.at_most(1.23451e-3), "upper bound", {"lower": None, "upper": 1.23451e-3}, "≤ 1.2346e-03 (upper bound)"),
        (
            Bounds.between(0.9997, 1.0),
            "enclosure",
            {"lower": 0.9997, "upper": 1.0},
            "in [9.9970e-01, 1.0000e+00] (enclosure, relative width 3e-04)",
        ),
        (Bounds.unknown(), "unknown", {"lower": None, "upper": None}, "unknown"),
    ],
)
def test_each_kind_of_bound_names_its_side_in_words_and_in_json(bounds, side, as_dict, text):
    assert bounds.side == side
    assert json.loads(json.dumps(bounds.as_dict())) == as_dict
    assert str(bounds) == text


def test_the_relative_width_is_the_part_of_the_upper_bound_that_is_in_doubt():
    assert Bounds.between(3.0, 4.0).relative_width == 0.25
    assert Bounds.between(0.0, 4.0).relative_width == 1.0
    assert Bounds.exactly(0.0).relative_width == 0.0
    for one_sided in (Bounds.at_least(1.0), Bounds.at_most(1.0), Bounds.unknown()):
        assert one_sided.relative_width is None


def test_an_upper_bound_of_zero_leaves_only_zero():
    assert Bounds.at_most(0.0) == Bounds.exactly(0.0)
    assert Bounds.at_most(math.ulp(0.0)).side == "upper bound"


def test_a_negative_zero_is_kept_as_zero():
    assert math.copysign(1.0, Bounds.exactly(-0.0).upper) == 1.0


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, -1e-300])
@pytest.mark.parametrize("make", [Bounds.exactly, Bounds.at_least, Bounds.at_most])
def test_what_is_not_a_finite_distance_is_refused(make, value):
    with pytest.raises(ValueError, match="finite number >= 0"):
        make(value)


def test_a_lower_bound_above_the_upper_one_is_refused():
    with pytest.raises(ValueError, match="exceeds the upper bound"):
        Bounds.between(math.nextafter(1.0, 2.0), 1.0)


def test_bounds_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Bounds.exactly(1.0).lower = 2.0


@given(positive)
def test_a_printed_bound_is_still_a_bound_and_loses_less_than_one_part_in_ten_thousand(value):
    def printed(bounds):
        return Fraction(re.search(r"[\d.]+e[+-]\d+", str(bounds)).group())

    lower, exact, upper = (printed(make(value)) for make in (Bounds.at_least, Bounds.exactly, Bounds.at_most))
    assert lower <= Fraction(value) <= upper
    assert lower <= exact <= upper
    assert upper - lower <= Fraction(value) / 10**4


@given(st.lists(known_numbers(), min_size=1, max_size=5))
def test_the_largest_of_true_statements_is_a_true_statement_about_the_maximum(known):
    maximum, bounds = max(number for number, _ in known), largest(*(b for _, b in known))
    assert bounds.lower is None or bounds.lower <= maximum
    assert bounds.upper is None or maximum <= bounds.upper


@given(st.lists(distances, min_size=1, max_size=5))
def test_the_largest_of_exact_numbers_is_exact(numbers):
    assert largest(*map(Bounds.exactly, numbers)) == Bounds.exactly(max(numbers))


def test_one_lower_bound_serves_for_a_maximum_and_one_missing_upper_bound_spoils_it():
    assert largest(Bounds.at_least(2.0), Bounds.at_most(3.0)) == Bounds.at_least(2.0)
    assert largest(Bounds.at_most(1.0), Bounds.at_most(3.0)) == Bounds.at_most(3.0)
    assert largest(Bounds.exactly(2.0), Bounds.at_most(3.0)) == Bounds.between(2.0, 3.0)
    assert largest(Bounds.exactly(2.0), Bounds.unknown()) == Bounds.at_least(2.0)


def test_the_largest_of_nothing_is_refused():
    with pytest.raises(ValueError, match="at least one"):
        largest()
