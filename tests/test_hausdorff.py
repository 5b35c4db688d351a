"""Excesses and Hausdorff distances, each by a second route: exact fractions, 50 digits, grids, scipy, closed forms."""

import itertools
import math
import sys
import tracemalloc
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist, directed_hausdorff

from painleve.errors import InputError
from painleve.sets import Cloud, LineSegment, Points, excess, excess_of_segment_from_profile, hausdorff

ULP = sys.float_info.epsilon

eighths = st.integers(-64, 64).map(
    lambda k: k / 8
)  # exact in binary, and full of ties, duplicates and collinear points
quick = settings(deadline=None, max_examples=60)  # the first call compiles


def vectors(d):
    return st.lists(eighths, min_size=d, max_size=d)


def members(d, max_size=8):
    return st.lists(vectors(d), min_size=1, max_size=max_size)


def segments(d):
    return st.builds(LineSegment, vectors(d), vectors(d))


def point_sets(d):
    return st.builds(Points, members(d)) | segments(d)


def exact_excess_of_segment_squared(t, rho_squared, length):
    """Any field: the supremum lies at an end or where two of the parabolas cross, so look at every pair."""
    crossings = [
        (t[i] + t[j]) / 2 + (rho_squared[j] - rho_squared[i]) / (2 * (t[j] - t[i]))
        for i, j in itertools.combinations(range(len(t)), 2)
        if t[i] != t[j]
    ]
    places = [0 * length, length] + [s for s in crossings if 0 <= s <= length]
    return max(min((s - ti) ** 2 + r for ti, r in zip(t, rho_squared, strict=True)) for s in places)


def exact_distance_to_segment(x, segment):
    """With the working precision of mpmath; start and end are taken as the floats that they are."""
    start, end, x = (mpmath.matrix(list(map(float, v))) for v in (segment.start, segment.end, x))
    along, offset = end - start, x - start
    share = (offset.T * along)[0] / (along.T * along)[0]
    return mpmath.norm(offset - min(max(share, 0), 1) * along)


def exact_profile(y, segment):
    start, end = (mpmath.matrix(list(map(float, v))) for v in (segment.start, segment.end))
    length = mpmath.norm(end - start)
    offsets = [mpmath.matrix(list(map(float, row))) - start for row in y]
    t = [(offset.T * (end - start))[0] / length for offset in offsets]
    return t, [(o.T * o)[0] - ti**2 for o, ti in zip(offsets, t, strict=True)], length


def value(bounds):
    assert bounds.side == "exact"
    return bounds.upper


# --- one dimension: the envelope -----------------------------------------------------------------------------------


@quick
@given(st.lists(st.tuples(eighths, eighths.map(abs)), min_size=1, max_size=12), eighths.map(abs))
def test_the_envelope_gives_the_supremum_that_exact_fractions_find_among_all_crossings(profile, length):
    t, rho = map(list, zip(*profile, strict=True))
    sup, place, index = excess_of_segment_from_profile(t, rho, length)
    squared = exact_excess_of_segment_squared(list(map(Fraction, t)), [Fraction(r) ** 2 for r in rho], Fraction(length))
    assert sup == pytest.approx(math.sqrt(squared), rel=4 * ULP)
    assert 0.0 <= place <= length
    nearest = min(math.hypot(place - ti, ri) for ti, ri in profile)
    assert math.hypot(place - t[index], rho[index]) == pytest.approx(nearest, abs=64 * ULP)  # |t|, rho <= 8


@pytest.mark.parametrize("seed", range(3))
def test_the_envelope_agrees_with_exact_fractions_where_few_points_hide_many(seed):
    """A level row, slightly perturbed, above two points on the segment: too few are hidden at a time for rounds."""
    rng = np.random.default_rng(seed)
    t, rho = np.linspace(0.0, 1.0, 48), 0.25 + 1e-4 * rng.random(48)
    rho[rng.choice(48, size=2, replace=False)] = 0.0
    sup, _, _ = excess_of_segment_from_profile(t, rho, 1.0)
    squared = exact_excess_of_segment_squared(list(map(Fraction, t)), [Fraction(r) ** 2 for r in rho], Fraction(1))
    assert sup == pytest.approx(math.sqrt(squared), rel=4 * len(t) * ULP)


@pytest.mark.parametrize("rho_scale", [0.0, 1e-6, 1e-3, 1.0])
def test_the_supremum_lies_between_that_of_a_fine_grid_and_that_plus_its_radius(rho_scale):
    rng = np.random.default_rng(1)
    t, rho, length = rng.uniform(-0.2, 1.2, 300), rho_scale * rng.random(300), 1.0
    grid = np.linspace(0.0, length, 20_001)
    on_grid = np.sqrt((grid[:, None] - t) ** 2 + rho**2).min(axis=1).max()
    sup, _, _ = excess_of_segment_from_profile(t, rho, length)
    assert on_grid <= sup * (1 + 4 * ULP)
    assert sup <= on_grid + 0.5 * (grid[1] - grid[0])  # a distance to a set is 1-Lipschitz


def test_points_evenly_spread_on_the_segment_leave_half_their_spacing():
    t = np.linspace(0.0, 1.0, 100_001)
    sup, _, _ = excess_of_segment_from_profile(t, np.zeros_like(t), 1.0)
    assert sup == pytest.approx(0.5e-5, rel=4 * len(t) * ULP)


def test_a_point_on_the_segment_hides_a_long_row_of_points_above_it():
    """All are kept until the last one hides half: removing hidden neighbours round by round would be quadratic."""
    t = np.linspace(0.0, 1.0, 100_001)
    rho = np.where(t == 1.0, 0.0, 0.5)
    sup, place, _ = excess_of_segment_from_profile(t, rho, 1.0)
    assert sup == pytest.approx(math.hypot(0.5, 0.5e-5), rel=1e-12)
    assert place < 0.5 + 1e-5


def test_a_point_off_its_own_place_can_be_nearest_elsewhere():
    """At s = 1 the point (t, rho) = (1, 1.25) is farther than (0, 0); from s = 1.28125 on it is the nearer one."""
    sup, place, index = excess_of_segment_from_profile([0.0, 1.0], [0.0, 1.25], 4.0)
    assert (sup, place, index) == (pytest.approx(math.hypot(3.0, 1.25), rel=ULP), 4.0, 1)


# --- every pair of sets --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1.0])
def test_distances_to_a_segment_are_good_to_a_few_ulps_of_the_distance_to_its_nearer_end(scale):
    rng = np.random.default_rng(2)
    segment = LineSegment([-1.0, 0.25, 0.0], [-0.4, 1.05, 0.1])
    for _ in range(200):
        end = segment.start if rng.random() < 0.5 else segment.end
        x = end + scale * rng.normal(size=3)
        measured = value(excess(Points([x]), segment).bounds)
        nearer = min(np.linalg.norm(x - segment.start), np.linalg.norm(x - segment.end))
        with mpmath.workdps(50):
            assert abs(measured - exact_distance_to_segment(x, segment)) <= 8 * ULP * nearer


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1.0])
def test_the_excess_of_a_segment_from_points_agrees_with_fifty_digits(scale):
    rng = np.random.default_rng(3)
    segment = LineSegment([-1.0, 0.25, 0.0], [-0.4, 1.05, 0.0])
    for _ in range(20):
        places = rng.choice([0.0, 0.3, 1.0], size=12)
        y = segment.start + places[:, None] * (segment.end - segment.start) + scale * rng.normal(size=(12, 3))
        measured = value(excess(segment, Points(y)).bounds)
        with mpmath.workdps(50):
            exact = mpmath.sqrt(exact_excess_of_segment_squared(*exact_profile(y, segment)))
        assert measured == pytest.approx(float(exact), rel=4 * len(y) * ULP)


def test_a_cloud_against_a_segment_agrees_with_a_plain_projection_of_every_member():
    rng = np.random.default_rng(4)
    x, segment = rng.normal(size=(50_000, 3)), LineSegment([-1.0, 0.0, 0.5], [1.0, 0.3, 0.2])
    along = segment.end - segment.start
    share = np.clip((x - segment.start) @ along / (along @ along), 0.0, 1.0)
    distances = np.linalg.norm(x - segment.start - share[:, None] * along, axis=1)
    found = excess(Cloud(x), segment)
    assert found.bounds.lower == pytest.approx(distances.max(), rel=8 * ULP)
    assert np.array_equal(found.attained_at, x[distances.argmax()])


@pytest.mark.parametrize("n", [40, 4000])  # scipy's scan serves the few pairs, a tree the many
def test_finite_sets_agree_with_scipys_directed_hausdorff_and_with_all_distances(n):
    rng = np.random.default_rng(5)
    x, y = rng.normal(size=(n, 3)), rng.normal(size=(n, 3))
    found = excess(Points(x), Points(y))
    assert value(found.bounds) == pytest.approx(directed_hausdorff(x, y)[0], rel=4 * ULP)
    i = cdist(x, y).min(axis=1).argmax()
    assert np.array_equal(found.attained_at, x[i])
    assert np.array_equal(found.nearest, y[cdist(x[i : i + 1], y).argmin()])


@quick
@given(segments(2), segments(2))
def test_the_excess_between_segments_is_that_of_a_fine_grid_up_to_its_radius(X, Y):
    shares = np.linspace(0.0, 1.0, 101)[:, None]
    grid = Points(X.start + shares * (X.end - X.start))
    on_grid, whole = value(excess(grid, Y).bounds), value(excess(X, Y).bounds)
    assert on_grid <= whole + 64 * ULP
    assert whole <= on_grid + X.length / 200 + 64 * ULP


@quick
@given(vectors(3), point_sets(3))
def test_a_degenerate_segment_measures_as_the_point_that_it_is(point, other):
    as_segment, as_points = hausdorff(LineSegment(point, point), other), hausdorff(Points([point]), other)
    assert value(as_segment.forward.bounds) == pytest.approx(value(as_points.forward.bounds), rel=8 * ULP)
    assert value(as_segment.backward.bounds) == pytest.approx(value(as_points.backward.bounds), rel=8 * ULP)


@quick
@given(point_sets(3), point_sets(3))
def test_the_excess_is_the_distance_between_the_points_that_are_reported(X, Y):
    found = excess(X, Y)
    assert np.linalg.norm(found.attained_at - found.nearest) == pytest.approx(value(found.bounds), abs=128 * ULP)
    for point, one in ((found.attained_at, X), (found.nearest, Y)):
        assert value(excess(Points([point]), one).bounds) <= 64 * ULP
    assert value(excess(Points([found.attained_at]), Y).bounds) == pytest.approx(value(found.bounds), abs=128 * ULP)


def test_an_excess_attained_at_an_end_reports_that_very_end():
    rng = np.random.default_rng(7)
    for d in (1, 2, 3, 6):
        segment = LineSegment(rng.normal(size=d), rng.normal(size=d))
        away = segment.end - segment.start
        for near, far in ((segment.start - away, segment.end), (segment.end + away, segment.start)):
            assert np.array_equal(excess(segment, Points([near])).attained_at, far)
            assert np.array_equal(excess(Points([far + 2 * (far - near)]), segment).nearest, far)


def test_the_pair_of_ends_is_half_a_length_from_its_segment():
    """The value to which the paper's isolated critical case tends."""
    start, end = [-1.0, 0.0], [0.0, 0.0]
    both = hausdorff(LineSegment(start, end), Points([start, end]))
    assert value(both.bounds) == value(both.forward.bounds) == 0.5
    assert value(both.backward.bounds) == 0.0
    assert np.array_equal(both.forward.attained_at, [-0.5, 0.0])


# --- properties of the Hausdorff distance --------------------------------------------------------------------------


@quick
@given(point_sets(2), point_sets(2), point_sets(2))
def test_the_hausdorff_distance_obeys_the_triangle_inequality(X, Y, Z):
    direct, first, second = (value(hausdorff(*pair).bounds) for pair in ((X, Z), (X, Y), (Y, Z)))
    assert direct <= first + second + 128 * ULP


@quick
@given(point_sets(2), point_sets(2))
def test_the_hausdorff_distance_is_symmetric_and_the_larger_excess(X, Y):
    there, back = hausdorff(X, Y), hausdorff(Y, X)
    assert value(there.bounds) == value(back.bounds)
    assert value(there.bounds) == max(value(excess(X, Y).bounds), value(excess(Y, X).bounds))


@quick
@given(point_sets(3), point_sets(3), st.integers(0, 2**32 - 1))
def test_excesses_do_not_change_under_rotation_and_translation(X, Y, seed):
    rng = np.random.default_rng(seed)
    rotation, shift = np.linalg.qr(rng.normal(size=(3, 3)))[0], rng.uniform(-8.0, 8.0, 3)

    def moved(one):
        if isinstance(one, LineSegment):
            return LineSegment(one.start @ rotation.T + shift, one.end @ rotation.T + shift)
        return Points(one.members @ rotation.T + shift)

    # coordinates below 24 move by a few of their ulps, and so does every distance (1-Lipschitz)
    assert value(excess(moved(X), moved(Y)).bounds) == pytest.approx(value(excess(X, Y).bounds), abs=24 * 16 * ULP)


@quick
@given(members(3), members(3))
def test_a_subset_has_excess_exactly_zero(x, more):
    assert value(excess(Points(x), Points(x + more)).bounds) == 0.0
    assert excess(Points(x), Cloud(more + x)).bounds.side == "exact"  # at most 0 is 0


@quick
@given(members(2), members(2), st.builds(Points, members(2)) | segments(2))
def test_more_members_only_sharpen_the_one_sided_bounds(some, more, exact):
    few, many = Cloud(some), Cloud(some + more)
    assert excess(few, exact).bounds.lower <= excess(many, exact).bounds.lower
    # over a segment the supremum moves to another breakpoint, and with it the rounding
    assert excess(exact, many).bounds.upper <= excess(exact, few).bounds.upper * (1 + 16 * ULP)


# --- sides, and what is refused ------------------------------------------------------------------------------------


@pytest.mark.parametrize("exact", [Points([[0.0, 0.0]]), LineSegment([0.0, 0.0], [1.0, 0.0])])
def test_a_cloud_bounds_the_excess_of_its_set_from_below_and_the_excess_from_it_from_above(exact):
    cloud = Cloud([[0.0, 3.0], [2.0, 0.5]])
    both = hausdorff(cloud, exact)
    assert (both.forward.bounds.side, both.backward.bounds.side) == ("lower bound", "upper bound")
    assert both.bounds == both.forward.bounds  # the missing upper bound of one spoils that of the maximum


def test_the_one_sided_bounds_hold_for_the_set_that_the_cloud_was_drawn_from():
    """The unit disc against the segment between (-2, 0) and (2, 0): e(disc, segment) = 1 = e(segment, disc)."""
    rng = np.random.default_rng(6)
    angle, radius = rng.uniform(0.0, 2.0 * np.pi, 1000), np.sqrt(rng.random(1000))
    disc = Cloud(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    both = hausdorff(disc, LineSegment([-2.0, 0.0], [2.0, 0.0]))
    assert 0.9 < both.forward.bounds.lower < 1.0 < both.backward.bounds.upper < 1.1


def test_from_one_cloud_to_another_nothing_is_bounded_and_the_points_are_still_told():
    found = excess(Cloud([[0.0], [5.0]]), Cloud([[1.0]]))
    assert found.bounds.side == "unknown"
    assert (found.attained_at.tolist(), found.nearest.tolist()) == ([5.0], [1.0])


def test_measuring_a_cloud_from_a_segment_takes_no_memory_that_grows_with_the_cloud():
    cloud, segment = Cloud(np.zeros((400_000, 3))), LineSegment([0.0, 0.0, 0.0], [1.0, 0.0, 0.0])
    tracemalloc.start()
    excess(cloud, segment)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < cloud.members.nbytes / 2


def test_sets_neither_follow_nor_allow_later_changes_of_their_arrays():
    source = np.zeros((2, 2))
    points = Points(source)
    source[:] = 7.0
    assert np.array_equal(points.members, np.zeros((2, 2)))
    for array in (points.members, LineSegment([0.0], [1.0]).end, excess(points, points).nearest):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


@pytest.mark.parametrize(
    "make",
    [
        lambda: Points([[math.nan, 0.0]]),
        lambda: Cloud([[math.inf]]),
        lambda: Points([[1e160]]),
        lambda: Points([1.0, 2.0]),
        lambda: Cloud(np.empty((0, 3))),
        lambda: Points([[1.0], [1.0, 2.0]]),
        lambda: Points([[1.0j]]),
        lambda: Points([["one"]]),
        lambda: LineSegment([0.0, 0.0], [1.0]),
        lambda: LineSegment([[0.0]], [[1.0]]),
        lambda: LineSegment([math.nan], [1.0]),
        lambda: excess(Points([[0.0]]), LineSegment([0.0, 0.0], [1.0, 0.0])),
        lambda: excess_of_segment_from_profile([], [], 1.0),
        lambda: excess_of_segment_from_profile([0.0, 1.0], [0.0], 1.0),
        lambda: excess_of_segment_from_profile([0.0], [-1.0], 1.0),
        lambda: excess_of_segment_from_profile([0.0], [0.0], -1.0),
        lambda: excess_of_segment_from_profile([0.0], [math.inf], 1.0),
        lambda: excess_of_segment_from_profile([0.0], [0.0], math.nan),
    ],
)
def test_bad_input_is_refused_in_one_line(make):
    with pytest.raises(InputError) as refusal:
        make()
    assert "\n" not in str(refusal.value)
    assert "give" in str(refusal.value) or "remove" in str(refusal.value) or "leave out" in str(refusal.value)
