"""The baseline is a fair one, and the two studies of accuracy say what their datasets hold."""

import numpy as np
import pytest

import studies.speed_accuracy.claim as speed_accuracy
import studies.where_methods_fail.claim as where_methods_fail
from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.member import make_member
from painleve.asymptotics.methods import METHODS
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.sets import Cloud, excess
from painleve.store import load
from painleve.theory.limit_set import limit_set
from studies.benchmark.naive import naive_distance, naive_members, point_distances, uniform_ball
from studies.benchmark.work_precision import RUN_OUTCOMES
from studies.text_table import text_table
from studies.where_methods_fail.near_critical import NearCase


def limit(scene: str, state: str):
    return limit_set(make_state(load_scene(scene), state))


@pytest.fixture(scope="module")
def speed(tmp_path_factory):
    output = tmp_path_factory.mktemp("speed")
    return speed_accuracy.run(output, quick=True), load(output / "speed_accuracy.h5")


@pytest.fixture(scope="module")
def fail(tmp_path_factory):
    output = tmp_path_factory.mktemp("fail")
    return where_methods_fail.run(output, quick=True), output


@pytest.mark.parametrize(("scene", "state"), [("slender_rod", "critical"), ("worn_tip_rod", "paradox")])
def test_the_naive_law_is_the_law_wherever_doubles_suffice(scene, state):
    A, random = limit(scene, state), np.random.default_rng(1)
    problem = make_local_problem(A)
    dq, dv = (uniform_ball(random, 60, 3, 0.05) for _ in range(2))
    plain = naive_members(A, dq, dv)
    exact = [make_member(problem, q, v) for q, v in zip(dq, dv, strict=True)]
    assert len({m.branch for m in exact}) >= 2
    assert [m.branch for m in exact] == plain.branch.tolist()
    np.testing.assert_allclose(plain.values - A.u_minus, [m.offset for m in exact], rtol=0.0, atol=1e-11)
    assert point_distances(A, plain.values) == pytest.approx([sum(m.distance) / 2 for m in exact], rel=1e-9, abs=1e-13)


def test_the_naive_distances_are_those_of_the_sets_room_but_for_the_grid():
    A = limit("slender_rod", "critical")
    forward, backward = naive_distance(A, 0.1, samples=3000, seed=5)
    random = np.random.default_rng(5)
    dq, dv = (uniform_ball(random, 3000, 3, 0.1) for _ in range(2))
    cloud = Cloud(naive_members(A, dq, dv).values)
    assert forward == pytest.approx(excess(cloud, A.point_set).bounds.lower, rel=1e-12)
    exact = excess(A.point_set, cloud).bounds.upper
    assert exact - A.point_set.length / 2000 <= backward <= exact


def test_uniform_points_of_a_ball_have_the_moments_of_the_uniform_law():
    x = uniform_ball(np.random.default_rng(2), 200_000, 3, 2.0)
    assert np.linalg.norm(x, axis=1).max() <= 2.0 * (1 + 1e-15)
    # E |x|^2 = R^2 d/(d + 2), and the same for every coordinate
    np.testing.assert_allclose(np.mean(x**2, axis=0), 4.0 * 0.6 / 3.0, rtol=0.02)


def test_a_gap_is_put_exactly_on_both_sides_of_the_critical_value():
    case = NearCase(scene=load_scene("slender_rod"), keys={}, parameter="mu", critical="4/3", exponents=(2, 30))
    assert [gap for gap, _ in case.values()] == [-1e-30, -1e-2, 1e-30, 1e-2]
    branches = [
        limit_set(make_state(case.scene, keys={"theta": "atan(2)"}, parameters={"mu": exact})).kind
        for _, exact in case.values()
    ]
    assert branches == ["point", "point", "pair", "pair"]


def test_a_table_aligns_its_columns_and_refuses_ragged_rows():
    assert text_table(("a", "b"), [("long", "1")]) == "a     b\n----  -\nlong  1"
    with pytest.raises(ValueError, match="zip"):
        text_table(("a", "b"), [("1",)])


@pytest.mark.slow
def test_every_method_is_measured_and_every_run_is_in_the_table(speed):
    result, dataset = speed
    measured = {str(name).split(",")[0] for name in dataset["series"].values}
    assert measured == {*METHODS, "naive NumPy"}
    rows = dataset.sizes["state"] * dataset.sizes["run"]
    assert len(result.data["rows"]) == rows
    body = result.table.split("\n\n")[0].splitlines()[2:]
    assert [line.split()[-1] for line in body] == [row["outcome"] for row in result.data["rows"]]


@pytest.mark.slow
def test_sampled_values_bound_d_H_from_their_side_and_mislead_at_the_hard_state_only_by_being_read(speed):
    """A misleading run is a true bound: at `double_zero` it lies above the enclosure, for it bounds e(A, A_eps)."""
    rows = [r for r in speed[0].data["rows"] if r["state"] == "slender_rod double_zero"]
    misleading = [r for r in rows if r["outcome"] == "misleading"]
    assert {r["method"].split(",")[0] for r in misleading} == {"naive NumPy", "sample"}
    reference = next(r for r in speed[0].data["references"] if r["state"] == "slender_rod double_zero")
    assert all(r["value"] > 2 * (reference["d_H"] + reference["half_width"]) for r in misleading)


@pytest.mark.slow
def test_optimise_and_certify_agree_within_what_certify_proves(speed):
    for row in speed[0].data["rows"]:
        reference = next(r for r in speed[0].data["references"] if r["state"] == row["state"])
        resolved = reference["half_width"] / reference["d_H"]
        if row["method"] == "certify":
            assert row["error"] <= row["proved"] + resolved
        if row["method"] == "optimise":
            assert row["error"] <= 1.01 * resolved + 1e-9


@pytest.mark.slow
def test_outcomes_are_the_codes_that_their_errors_deserve(speed):
    _, dataset = speed
    misleading = dataset["outcome"].values == 1 + RUN_OUTCOMES.index("misleading")
    value, reference = dataset["value"].values, dataset["reference"].values[:, None]
    np.testing.assert_array_equal(misleading, (value > 2 * reference) | (value < reference / 2))


@pytest.mark.slow
def test_the_sampled_bound_at_the_hard_state_grows_while_witnesses_shrink(fail):
    dataset = load(fail[1] / "sampled_bound.h5").sortby("eps", ascending=False)
    assert np.all(np.diff(dataset["sampled_upper"].values[-1]) > 0.0)
    assert np.all(np.diff(dataset["witnessed_upper"].values) < 0.0)
    # without a single slip the members near u- and u_tilde leave the middle of A uncovered
    assert dataset["sampled_upper"].values[0, -1] == pytest.approx(dataset["half_jump"].item(), rel=1e-6)


@pytest.mark.slow
def test_plain_doubles_lose_gamma_like_the_inverse_square_of_eps_and_the_toolkit_does_not(fail):
    dataset = load(fail[1] / "rounding.h5").sortby("eps", ascending=False)
    eps = dataset["eps"].values
    gamma = dataset["plain_error_median"].sel(quantity="gamma").values
    before = eps > 1e-7
    slopes = np.diff(np.log10(gamma[before])) / np.diff(np.log10(eps[before]))
    assert slopes == pytest.approx(-2.0, abs=0.4)
    assert np.all(dataset["wrong_sign"].values[eps < 2e-8] > 0.2)
    assert np.all(dataset["kept_error_farthest"].values < 1e-9)


@pytest.mark.slow
def test_d_H_is_that_of_the_wrong_side_until_eps_resolves_the_gap(fail):
    dataset = load(fail[1] / "near_critical.h5").isel(case=0)
    read = np.fmax(dataset["excess_Aeps_A_lower"], dataset["excess_A_Aeps_upper"])
    gap, eps = dataset["gap"].values, dataset["eps"].values
    below = read[gap < 0.0]
    for i, own in enumerate(-gap[gap < 0.0]):
        assert np.all(below[i][eps > 10 * own] > 0.5)  # as if gamma were 0: the whole jump
        assert np.all(below[i][eps < own / 10] < 0.5)
    above = read[gap > 0.0]
    for i, own in enumerate(gap[gap > 0.0]):
        assert np.all(above[i][eps < np.sqrt(own) / 10] < 3.0 * eps[eps < np.sqrt(own) / 10])


@pytest.mark.slow
def test_at_isolated_states_the_excess_of_A_is_proved_large_only_once_eps_resolves_the_gap(fail):
    dataset = load(fail[1] / "near_critical.h5").isel(case=1)
    gap, eps, half = dataset["gap"].values, dataset["eps"].values, dataset["half_jump"].values
    for i in np.flatnonzero(gap > 0.0):
        one = dataset.isel(value=i)
        lower, upper = one["excess_A_Aeps_lower"].values, one["excess_A_Aeps_upper"].values
        assert np.all(lower <= upper)
        assert np.all(lower[eps < 0.1 * gap[i]] > 0.9 * half[i])
        # the third derivative of mu_c, 75/2, makes gamma positive further than about 2 gap/3 from arctan 2
        assert np.all(lower[eps > 2.0 * gap[i]] < 0.9 * half[i])


@pytest.mark.slow
def test_advice_is_the_fastest_run_that_is_good_enough(fail):
    for row in fail[0].data["methods"]:
        assert row["number"]["error"] <= 1e-2
        assert row["proof"]["proved"] <= 1e-3
        assert row["number"]["method"] in fail[0].table
