"""The sampler's points: streams and sequences addressed by index, and their maps into closed balls."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from itertools import product
from pathlib import Path

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.stats import qmc

from painleve.core.ball_maps import cube_to_ball, uniform_ball, uniforms_needed
from painleve.core.lattice import kronecker_block, kronecker_generators, kronecker_shifts
from painleve.core.streams import splitmix64, uniform_block

SIGNIFICANCE = 1e-3  # of each test against a distribution; seeds are fixed, so a passing test passes always
SAMPLES = 20_000
BALLS = [(m, d) for d in range(1, 8) for m in range(1, d + 1)]


def splitmix64_outputs(seed: int, count: int) -> list[int]:
    """SplitMix64 as its authors state it, a state that moves, in Python's integers."""
    mask, state, outputs = (1 << 64) - 1, seed, []
    for _ in range(count):
        state = (state + 0x9E3779B97F4A7C15) & mask
        z = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        outputs.append(z ^ (z >> 31))
    return outputs


def uniforms(seed: int, rows: int, samples: int = SAMPLES) -> np.ndarray:
    u = np.empty((rows, samples))
    uniform_block(seed, 0, u)
    return u


def ball_points(m: int, dimension: int, seed: int = 11, samples: int = SAMPLES) -> np.ndarray:
    x = np.empty((m, samples))
    uniform_ball(uniforms(seed, uniforms_needed(m, dimension), samples), x, 1.0, dimension)
    return x


def excess_of_squared_norm(column: np.ndarray, radius: float) -> Fraction:
    return sum(Fraction(float(c)) ** 2 for c in column) - Fraction(radius) ** 2


# --- streams ---------------------------------------------------------------------------------------------------------


def test_splitmix64_gives_the_published_outputs():
    published = [6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431]
    assert [splitmix64(1234567, k) for k in range(4)] == published == splitmix64_outputs(1234567, 4)


def test_uniform_numbers_are_the_outputs_of_one_splitmix64_for_each_coordinate():
    start, x = 1000, np.empty((3, 40))
    uniform_block(7, start, x)
    for row, seed in zip(x, splitmix64_outputs(7, 3), strict=True):
        expected = [Fraction(out >> 12, 2**52) for out in splitmix64_outputs(seed, start + 40)[start:]]
        assert [Fraction(value) for value in row] == expected


def test_uniform_numbers_are_uniform_and_their_coordinates_uncorrelated():
    u = uniforms(3, 6)
    assert u.min() >= 0.0
    assert u.max() < 1.0
    assert min(stats.kstest(row, "uniform").pvalue for row in u) > SIGNIFICANCE
    with_their_successors = np.vstack([u[:, 1:], u[:, :-1]])
    correlation = np.corrcoef(with_their_successors)[np.triu_indices(12, 1)]
    quantile = stats.norm.isf(SIGNIFICANCE / (2 * correlation.size))  # Bonferroni
    assert np.abs(correlation).max() < quantile / np.sqrt(SAMPLES)


# --- Kronecker sequence ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dimension", range(1, 13))
def test_generators_are_the_powers_of_the_generalised_golden_ratio_to_64_bits(dimension):
    with mpmath.workdps(60):
        phi = mpmath.findroot(lambda t: t ** (dimension + 1) - t - 1, 1.2)
        expected = [int(mpmath.floor(phi**-j * mpmath.mpf(2) ** 64)) for j in range(1, dimension + 1)]
    assert kronecker_generators(dimension).tolist() == expected


def test_shifts_are_the_outputs_of_splitmix64():
    assert kronecker_shifts(99, 4).tolist() == splitmix64_outputs(99, 4)


@pytest.mark.parametrize("start", [0, 1, 12345, 2**31 - 3, 2**53 - 5, 2**60, 2**62 - 17])
def test_kronecker_points_are_exact_to_52_bits_at_any_index(start):
    alphas, shifts, x = kronecker_generators(5), kronecker_shifts(4, 5), np.empty((5, 19))
    kronecker_block(start, alphas, shifts, x)
    for j, row in enumerate(x):
        for i, value in enumerate(row):
            fraction = (Fraction(int(shifts[j]), 2**64) + (start + i) * Fraction(int(alphas[j]), 2**64)) % 1
            assert Fraction(value) == 2 * Fraction(int(fraction * 2**52), 2**52) - 1


@pytest.mark.parametrize("dimension", [2, 3, 4, 5])
def test_kronecker_points_have_a_lower_discrepancy_than_random_points(dimension):
    count, x = 4096, np.empty((dimension, 4096))
    kronecker_block(0, kronecker_generators(dimension), kronecker_shifts(1, dimension), x)
    of_random = [qmc.discrepancy(np.random.default_rng(seed).random((count, dimension))) for seed in range(5)]
    assert qmc.discrepancy((x.T + 1) / 2) < min(of_random)


# --- addressing ------------------------------------------------------------------------------------------------------


def kronecker_sample(start: int, columns: int) -> np.ndarray:
    x = np.empty((4, columns))
    kronecker_block(start, kronecker_generators(4), kronecker_shifts(5, 4), x)
    cube_to_ball(x[:1], 0.01, 1)
    cube_to_ball(x[1:], 0.01, 0)
    return x


def uniform_sample(start: int, columns: int) -> np.ndarray:
    u, x = np.empty((9, columns)), np.empty((5, columns))
    uniform_block(5, start, u)
    uniform_ball(u, x, 0.01, 6)
    return x


@pytest.mark.parametrize("sample", [kronecker_sample, uniform_sample])
@pytest.mark.parametrize("columns", [512, 64, 7])
def test_a_point_does_not_depend_on_the_block_that_holds_it(sample, columns):
    whole = sample(2**40, 7 * 512)
    blocks = [sample(2**40 + at, columns) for at in range(0, whole.shape[1], columns)]
    assert np.hstack(blocks).tobytes() == whole.tobytes()


@pytest.mark.parametrize("sample", [kronecker_sample, uniform_sample])
def test_points_are_the_same_bits_on_any_number_of_threads(sample):
    starts = [512 * k for k in range(64)]
    in_sequence = [sample(start, 512).tobytes() for start in starts]
    for threads in (1, 2, 5):
        with ThreadPoolExecutor(threads) as pool:
            backwards = list(pool.map(lambda start: sample(start, 512).tobytes(), starts[::-1]))
        assert backwards[::-1] == in_sequence


def test_points_without_the_compiler_equal_the_compiled_ones():
    script = (
        "import sys, numpy as np, test_points as t\n"
        "with np.errstate(over='ignore'):\n"
        "    for s in (t.kronecker_sample, t.uniform_sample): sys.stdout.write(s(2**40, 33).tobytes().hex() + '\\n')\n"
    )
    paths = os.pathsep.join([str(Path(__file__).parent), *sys.path])
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": paths}
    run = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)
    assert run.stdout.split() == [s(2**40, 33).tobytes().hex() for s in (kronecker_sample, uniform_sample)]


# --- closed balls, in exact arithmetic -------------------------------------------------------------------------------

radii = st.sampled_from([1.0, 0.1, 3.7, 1e-6, 1e-12, 1e-300]) | st.floats(1e-300, 1e3)


@given(radius=radii, weight=st.integers(0, 3), columns=st.data(), rows=st.integers(1, 7))
@settings(max_examples=150, deadline=None)
def test_cube_points_land_in_the_closed_ball_in_exact_arithmetic(radius, weight, columns, rows):
    coordinate = st.floats(-1.0, 1.0) | st.sampled_from([-1.0, 0.0, 1.0, 1 - 2**-52, 5e-324, 1e-150])
    x = np.array(columns.draw(st.lists(st.lists(coordinate, min_size=4, max_size=4), min_size=rows, max_size=rows)))
    cube_to_ball(x, radius, weight)
    assert max(excess_of_squared_norm(column, radius) for column in x.T) <= 0


@pytest.mark.parametrize("weight", [0, 2])
@pytest.mark.parametrize("radius", [1.0, 0.3, 1e-300])
@pytest.mark.parametrize("rows", [1, 2, 3, 6])
def test_the_faces_and_corners_of_the_cube_land_on_the_sphere_to_rounding(rows, radius, weight):
    corners = np.array([c for c in product([-1.0, -0.4, 0.0, 1.0], repeat=rows) if 1.0 in map(abs, c)]).T.copy()
    cube_to_ball(corners, radius, weight)
    lost = 2 * (2 * rows + 26) * Fraction(1, 2**53)  # the margin and the roundings, in the squared norm
    for column in corners.T:
        assert -lost * Fraction(radius) ** 2 <= excess_of_squared_norm(column, radius) <= 0


@pytest.mark.parametrize(("m", "dimension"), BALLS)
def test_uniform_points_are_in_the_closed_ball_in_exact_arithmetic_and_reach_its_sphere(m, dimension):
    needed = uniforms_needed(m, dimension)
    extremes = np.array(list(product([0.0, 0.25, 1 - 2**-52], repeat=min(needed, 6)))).T
    u = np.vstack([uniforms(2, needed, extremes.shape[1])[: needed - extremes.shape[0]], extremes])
    u = np.hstack([u, uniforms(2, needed, 300), np.zeros((needed, 1))])
    for radius in (0.1, 1e-300):
        x = np.empty((m, u.shape[1]))
        uniform_ball(u, x, radius, dimension)
        assert max(excess_of_squared_norm(column, radius) for column in x.T) <= 0
        if m > 1 or dimension == 1:
            assert np.linalg.norm(x[:, -1] / radius) > 1 - 1e-14  # all uniform numbers 0: on the sphere


def test_a_radius_of_1e_300_gives_the_points_of_the_unit_ball_scaled():
    u, cube = uniforms(8, uniforms_needed(3, 3), 512), 2 * uniforms(9, 3, 512) - 1
    for fill in (lambda x, r: cube_to_ball(x, r, 1), lambda x, r: uniform_ball(u, x, r, 3)):
        unit, small = cube.copy(), cube.copy()
        fill(unit, 1.0)
        fill(small, 1e-300)
        # 1e-300 is 2^78 times the smallest subnormal number: 4e-24 is the most that a component can lose.
        np.testing.assert_allclose(small / 1e-300, unit, rtol=1e-15, atol=4e-24)


# --- the map from the cube -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("weight", [0, 1, 2])
@pytest.mark.parametrize("rows", [1, 2, 3])
def test_every_point_of_the_ball_is_the_image_of_a_point_of_the_cube(rows, weight):
    grid = np.array(list(product(np.linspace(-1, 1, 13), repeat=rows))).T
    ball = grid[:, (np.linalg.norm(grid, axis=0) <= 1) & np.any(grid != 0, axis=0)]
    norm = np.linalg.norm(ball, axis=0)
    r = 1 - (1 - np.minimum(norm, 1.0)) ** (0.5**weight)
    x = ball * (r / np.abs(ball).max(axis=0))
    assert np.abs(x).max() <= 1 + 1e-15
    cube_to_ball(x, 1.0, weight)
    np.testing.assert_allclose(x, ball, rtol=0, atol=1e-14)


def test_the_centre_of_the_cube_is_the_centre_of_the_ball():
    x = np.zeros((3, 5))
    cube_to_ball(x, 1.0, 2)
    assert not x.any()


def test_the_boundary_weight_raises_the_distance_to_the_sphere_to_a_power():
    x = np.random.default_rng(0).uniform(-1, 1, (3, 400))
    plain, pushed = x.copy(), x.copy()
    cube_to_ball(plain, 1.0, 0)
    cube_to_ball(pushed, 1.0, 2)
    gap, pushed_gap = (1 - np.linalg.norm(points, axis=0) for points in (plain, pushed))
    np.testing.assert_allclose(pushed_gap, gap**4, rtol=0, atol=1e-14)


# --- uniform points of the ball --------------------------------------------------------------------------------------


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_pair_of_coordinates_is_the_polar_form_with_library_functions(dimension):
    u, x = uniforms(6, 4)[: uniforms_needed(2, dimension)], np.empty((2, SAMPLES))
    uniform_ball(u, x, 1.0, dimension)
    outer = u[1] if dimension == 2 else np.maximum(u[1], u[2] ** 2)
    angle = 0.5 * np.pi * np.abs(np.abs(4 * u[0] - 2) - 1)
    expected = np.sqrt(1 - outer) * np.array([np.cos(angle), np.sin(angle)])
    np.testing.assert_allclose(np.abs(x), expected, rtol=0, atol=3e-15)
    assert set(zip(*np.sign(x), strict=True)) == {(1, 1), (1, -1), (-1, 1), (-1, -1)}


@pytest.mark.parametrize(("m", "dimension"), BALLS)
def test_the_squared_norm_of_some_coordinates_of_a_uniform_point_has_its_beta_distribution(m, dimension):
    squares = (ball_points(m, dimension) ** 2).sum(axis=0)
    law = stats.beta(m / 2, (dimension - m) / 2 + 1)
    assert stats.kstest(squares, law.cdf).pvalue > SIGNIFICANCE


@pytest.mark.parametrize("dimension", range(1, 8))
def test_the_norm_to_the_power_of_the_dimension_is_uniform(dimension):
    norm = np.linalg.norm(ball_points(dimension, dimension, seed=12), axis=0)
    assert stats.kstest(norm**dimension, "uniform").pvalue > SIGNIFICANCE


@pytest.mark.parametrize(("m", "dimension"), BALLS)
def test_each_coordinate_of_a_uniform_point_has_its_beta_distribution(m, dimension):
    law = stats.beta((dimension + 1) / 2, (dimension + 1) / 2)
    for row in ball_points(m, dimension, seed=13):
        assert stats.kstest((row + 1) / 2, law.cdf).pvalue > SIGNIFICANCE


@pytest.mark.parametrize("dimension", range(1, 8))
def test_projections_of_a_uniform_point_on_oblique_directions_have_the_law_of_a_coordinate(dimension):
    law = stats.beta((dimension + 1) / 2, (dimension + 1) / 2)
    x = ball_points(dimension, dimension, seed=14)
    for direction in np.random.default_rng(1).normal(size=(4, dimension)):
        projection = direction @ x / np.linalg.norm(direction)
        assert stats.kstest((projection + 1) / 2, law.cdf).pvalue > SIGNIFICANCE


@pytest.mark.parametrize("dimension", range(1, 8))
def test_the_mean_of_uniform_points_is_the_centre(dimension):
    mean = ball_points(dimension, dimension, seed=15).mean(axis=1)
    statistic = SAMPLES * (dimension + 2) * float(mean @ mean)  # a coordinate has variance 1/(dimension + 2)
    assert stats.chi2(dimension).sf(statistic) > SIGNIFICANCE
