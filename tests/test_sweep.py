"""Sweeps say what the methods say, keep what failed, and map what hand-derived formulas give."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
import xarray as xr

from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.errors import InputError
from painleve.mechanics.derive import derive
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.store import check_schema, load, save
from painleve.sweep import map_gamma, map_regimes, sweep_distances, sweep_members
from painleve.theory.limit_set import limit_set

ROD, ARM = load_scene("slender_rod"), load_scene("two_link_arm")
FEW = SampleOptions(samples=4096)
EPS = (1e-1, 1e-2, 1e-3)


def labels(code: xr.DataArray) -> list[str]:
    return [code.attrs["flag_meanings"].split()[value] for value in code.values.ravel()]


@pytest.fixture(scope="module")
def swept() -> xr.Dataset:
    """Two states over exact values of mu, one of which no scene allows."""
    return sweep_distances(
        ROD, eps=EPS, states=["paradox", "critical"], over={"mu": ["4/3", "2", "-1"]}, options=FEW, command="test"
    )


@pytest.fixture(scope="module")
def pictured() -> xr.Dataset:
    return sweep_members(ARM, eps=[1e-2], states=["paradox", "approached", "isolated"], command="test")


@pytest.fixture(scope="module")
def arm_map() -> xr.Dataset:
    return map_gamma(ARM, states=["sliding", "approached", "isolated"], command="test")


def test_a_point_of_a_sweep_is_what_the_method_says_there(swept: xr.Dataset) -> None:
    point = swept.sel(state="paradox", mu=2.0, eps=1e-2)
    direct = sample_distance(limit_set(make_state(ROD, "paradox")), 1e-2, FEW)
    for name, bounds in (
        ("excess_Aeps_A", direct.excess_Aeps_A.bounds),
        ("excess_A_Aeps", direct.excess_A_Aeps.bounds),
        ("hausdorff", direct.hausdorff),
    ):
        for side, value in bounds.as_dict().items():
            np.testing.assert_equal(float(point[f"{name}_{side}"]), math.nan if value is None else value)
    member = direct.excess_Aeps_A.member
    assert member is not None
    np.testing.assert_array_equal(point["farthest_dq"], member.dq)
    np.testing.assert_array_equal(point["farthest_offset"], member.offset)
    assert labels(point["farthest_branch"]) == [member.branch.label]
    assert {str(b): int(point["counts"].sel(law_branch=b)) for b in direct.counts} == dict(direct.counts)


def test_a_point_that_fails_is_kept_with_its_reason(swept: xr.Dataset) -> None:
    failed = swept.sel(mu=-1.0)
    assert set(labels(failed["outcome"])) == {"failed"}
    assert all("mu = -1 must be zero or positive" in reason for reason in failed["outcome_reason"].values.ravel())
    assert np.isnan(failed["hausdorff_lower"]).all()
    assert (failed["counts"] == -1).all()
    assert set(labels(failed["verdict"])) == {"not_run"}
    assert set(labels(swept.sel(mu=2.0)["outcome"])) == {"done"}


def test_a_sweep_in_which_everything_fails_says_why_in_one_line() -> None:
    with pytest.raises(InputError, match="mu = -1 must be zero or positive"):
        sweep_distances(ROD, eps=[1e-2], states=["paradox"], over={"mu": ["-1"]}, options=FEW)


def test_a_repeated_eps_is_measured_once() -> None:
    found = sweep_distances(ROD, eps=[1e-2, 1e-3, 1e-2], states=["paradox"], options=FEW)
    assert found.eps.values.tolist() == [1e-2, 1e-3]


def test_swept_values_are_exact_and_not_the_floats_beside_them() -> None:
    # Both round to the same float, but only 4/3 is the least critical friction.
    values = ["4/3", "1.3333333333333333"]
    dataset = sweep_distances(ROD, eps=[1e-2], states=["double_zero"], over={"mu": values}, options=FEW)
    assert dataset["mu_exact"].values.tolist() == values
    assert dataset["mu"][0] == dataset["mu"][1]
    assert labels(dataset["theorem_branch"]) == ["critical_approached", "none"]


def test_a_state_key_can_be_swept_through_the_band_of_paradoxes() -> None:
    tangents = [sp.Rational(1, 2), sp.Rational(3, 2), 3 - sp.sqrt(5), 3 + sp.sqrt(5), sp.Integer(6)]
    dataset = sweep_distances(
        ROD, eps=[1e-2], states=["paradox"], over={"theta": [sp.atan(t) for t in tangents]}, options=FEW
    )
    critical = [(t + 4 / t) / 3 for t in tangents]
    signs = [sp.sign(sp.nsimplify(sp.simplify(c - 2))) for c in critical]
    expected = {1: "none", 0: "critical_approached", -1: "negative"}
    assert labels(dataset["theorem_branch"]) == [expected[int(s)] for s in signs]


def test_progress_is_told_of_every_point_even_where_it_fails() -> None:
    told: list[str] = []
    sweep_distances(
        ROD, eps=EPS, states=["paradox"], over={"mu": ["2", "-1"]}, options=FEW, progress=told.append, command="test"
    )
    assert told == ["paradox"] * 6


def test_the_fitted_line_has_the_slope_of_the_verdict(swept: xr.Dataset) -> None:
    one = swept.sel(state="paradox", mu=2.0)
    by_hand = np.polyfit(np.log(EPS), np.log(one["excess_Aeps_A_lower"]), 1)
    assert float(one["slope"]) == pytest.approx(by_hand[0], rel=1e-12)
    np.testing.assert_allclose(one["fit"], np.exp(np.polyval(by_hand, np.log(EPS))), rtol=1e-12)


def test_every_kind_of_dataset_explains_itself_and_survives_the_disk(
    swept: xr.Dataset, pictured: xr.Dataset, arm_map: xr.Dataset, tmp_path: Path
) -> None:
    axes = {"theta": np.linspace(0.3, 1.4, 5), "omega": np.linspace(0.0, 5.0, 4)}
    for dataset in (swept, pictured, arm_map, map_regimes(ROD, axes=axes, command="test")):
        check_schema(dataset)
        assert load(save(dataset, tmp_path / "a.h5")).identical(dataset)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"eps": []}, "no values"),
        ({"eps": [0.0]}, "positive"),
        ({"eps": [math.nan]}, "positive"),
        ({"states": ["nowhere"]}, "no state 'nowhere'"),
        ({"states": ["paradox", "paradox"]}, "named twice"),
        ({"over": {"nu": ["1"]}}, "no parameter and no state key 'nu'"),
        ({"over": {"mu": []}}, "no values"),
        ({"over": {"mu": ["__import__('os')"]}}, "mu"),
        ({"method": "guess"}, "no 'guess'"),
        ({"over": {"mu": ["1"]}, "parameters": {"mu": 1}}, "taken"),
    ],
)
def test_bad_arguments_are_refused_in_one_line_before_anything_runs(arguments: dict, says: str) -> None:
    told: list[str] = []
    with pytest.raises(InputError, match=says) as caught:
        sweep_distances(ROD, **({"eps": [1e-2], "states": ["paradox"], "progress": told.append} | arguments))
    assert "\n" not in str(caught.value)
    assert told == []


def test_projected_members_keep_their_length_in_the_plane_of_a_scene_with_two_coordinates(pictured: xr.Dataset) -> None:
    length = np.sqrt((pictured["offset"] ** 2).sum("coordinate"))
    np.testing.assert_allclose(np.hypot(pictured["along"], pictured["across"]), length, rtol=1e-12, atol=1e-15)


def test_members_that_stick_are_drawn_at_u_tilde(pictured: xr.Dataset) -> None:
    # The arm has two coordinates: if its tip sticks, it is at rest, and so is u_tilde.
    stick = pictured["law_branch"].attrs["flag_meanings"].split().index("stick")
    for state in ("paradox", "isolated"):
        one = pictured.sel(state=state, eps=1e-2)
        sticking = one["law_branch"].values == stick
        assert sticking.sum() > 100
        np.testing.assert_allclose(one["along"].values[sticking], float(one["jump_length"]), rtol=1e-12)
        np.testing.assert_allclose(one["across"].values[sticking], 0.0, atol=1e-12)


def test_witnesses_join_the_ends_of_the_segment_where_it_is_approached_and_not_where_it_is_isolated(
    pictured: xr.Dataset,
) -> None:
    approached, isolated = pictured.sel(state="approached", eps=1e-2), pictured.sel(state="isolated", eps=1e-2)
    np.testing.assert_allclose(approached["witness_along"], [0.0, float(approached["jump_length"])], atol=1e-4)
    np.testing.assert_allclose(approached["witness_across"], 0.0, atol=1e-4)
    assert np.isnan(isolated["witness_along"]).all()


def test_the_map_of_the_rod_is_the_hand_derived_gamma_and_critical_friction() -> None:
    dataset = map_gamma(ROD, states=["critical", "double_zero"], points=(41, 31), command="test")
    theta, mu = dataset["path"].values, dataset["friction"].values
    sine, cosine = np.sin(theta)[:, None], np.cos(theta)[:, None]
    by_hand = (1.0 + 3.0 * cosine**2 - 3.0 * mu * np.abs(sine * cosine)) / (1.0 + cosine**2)
    for state in range(2):
        np.testing.assert_allclose(dataset["gamma"][state], by_hand, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(dataset["critical_friction"][0], (np.tan(theta) + 4.0 / np.tan(theta)) / 3.0, rtol=1e-13)
    assert dataset["panel"].values.tolist() == [0, 0]


def test_the_map_of_the_arm_follows_the_table(arm_map: xr.Dataset) -> None:
    derivation = derive(ARM)
    for name in ("sliding", "approached", "isolated"):
        state, one = make_state(ARM, name), arm_map.sel(state=name)
        values = {p.symbol: state.number(state.parameters[p.name]) for p in ARM.parameters}
        critical = sp.lambdify(ARM.q, derivation.critical_friction.xreplace(values))
        depth = float(state.number(ARM.parameter("depth").symbol))
        reached = np.isfinite(one["critical_friction"].values)
        assert reached.sum() > 50
        first = one["path"].values[reached]
        second = np.arccos(depth - np.cos(first))  # both links have length 1, and the second angle is positive
        np.testing.assert_allclose(one["critical_friction"].values[reached], critical(first, second), rtol=1e-9)


def test_the_critical_states_of_the_arm_are_at_a_minimum_and_a_maximum_of_its_map(arm_map: xr.Dataset) -> None:
    for name, sense in (("approached", 1.0), ("isolated", -1.0)):
        one = arm_map.sel(state=name)
        near = np.abs(one["path"] - one["state_path"]) < 0.03
        above = sense * (one["critical_friction"] - one["state_friction"]).values[near.values]
        assert above.size >= 8
        assert (above > 0.0).all()


def test_coinciding_states_are_drawn_apart() -> None:
    dataset = map_gamma(load_scene("worn_tip_rod"), states=["paradox", "approached", "isolated"], points=(21, 11))
    assert dataset["panel"].values.tolist() == [0, 0, 1]


def test_the_regimes_of_the_rod_have_as_many_solutions_as_their_names_say() -> None:
    axes = {"theta": np.linspace(0.2, 1.5, 60), "omega": np.linspace(0.0, 6.0, 50)}
    dataset = map_regimes(ROD, axes=axes, parameters={"mu": 2})
    theta, omega = (x.ravel() for x in np.meshgrid(*axes.values(), indexing="ij"))
    p = 1.0 + 3.0 * np.cos(theta) ** 2 - 6.0 * np.sin(theta) * np.cos(theta)
    beta = omega**2 * np.sin(theta) - 9.81
    np.testing.assert_allclose(dataset["slip_compliance"].values.ravel(), p, atol=1e-13)
    np.testing.assert_allclose(dataset["free_acceleration"].values.ravel(), beta, atol=1e-13)
    names = np.array(dataset["regime"].attrs["flag_meanings"].split())[dataset["regime"].values.ravel()]
    solutions = (beta >= 0.0).astype(int) + (-beta / p > 0.0)  # F = 0; F > 0 with no normal acceleration
    expected = {"slip": 1, "lift_off": 1, "inconsistent": 0, "indeterminate": 2}
    assert set(names) == set(expected)
    assert [expected[name] for name in names] == solutions.tolist()
