"""The study of the two laws on coarse maps, and these against exact arithmetic and the rod's closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr
from figure_checks import assert_no_two_entries_share_a_mark
from study_runs import QUIET

from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import State, make_state
from painleve.plotting import draw
from painleve.theory.limit_set import limit_set
from studies.laws.figures import DRAWINGS
from studies.laws.measure import measure_laws
from studies.laws.report import report
from studies.laws.two_laws import map_laws
from studies.parts import Report


@pytest.fixture(scope="module")
def maps() -> xr.Dataset:
    return measure_laws(size=40, checks=1, seed=0, progress=QUIET)


@pytest.fixture(scope="module")
def found(maps: xr.Dataset) -> Report:
    return report({"laws": maps})


def rod(**keys: object) -> State:
    return make_state(load_scene("spatial_rod"), keys={"theta": "atan(2)", **keys})


def test_the_closed_forms_hold_on_the_whole_map_and_exact_counts_agree(found: Report) -> None:
    rows: Any = found.data["rows"]
    assert [row["edges_missed"] for row in rows] == [None, None, None, 0] * 2
    assert all(row["agree"] == row["checks"] > 0 for row in rows)
    assert "at all but 0 points" in found.status


@pytest.mark.parametrize(("row", "largest", "three"), [(3, 1.08, 0.064), (7, 1.66, 0.037)])
def test_the_tangential_figures_are_those_expected(row: int, largest: float, three: float, found: Report) -> None:
    told: Any = found.data["rows"][row]
    assert told["approach"] == 0.0
    assert told["largest"] == pytest.approx(largest, rel=0.03)
    assert told["shares"]["3"] == pytest.approx(three, abs=0.004)


def test_impacts_have_one_solution_or_three_and_nothing_else(maps: xr.Dataset) -> None:
    impacts = maps["solutions"].where(maps["approach"] < 0.0, 1)
    assert set(np.unique(impacts)) == {1.0, 3.0}


def test_a_rod_that_slips_along_b_has_one_law_and_a_mirrored_slip_mirrored_distances(maps: xr.Dataset) -> None:
    assert float(maps["nearest"].sel(direction=0.0, method="nearest").max()) < 1e-9
    np.testing.assert_allclose(maps["nearest"], maps["nearest"][..., ::-1], atol=1e-9)
    np.testing.assert_array_equal(maps["solutions"], maps["solutions"][..., ::-1])


def test_coulomb_s_jumps_end_where_sticking_leaves_the_cone_of_the_rod(maps: xr.Dataset) -> None:
    """By hand for the uniform rod: |tan psi| <= 4 sqrt(mu^2 - mu_c^2)/(mu_c C_11 - |b|), at tan theta = 2."""
    mu_c, C_11, coupling = 4.0 / 3.0, 1.0 + 3.0 * 4.0 / 5.0, 3.0 * 2.0 / 5.0
    tangential = maps.isel(state=1).sel(approach=0.0)
    angle, mu = np.meshgrid(tangential["direction"], tangential["friction"])
    inside = mu > mu_c
    reach = np.arctan(4.0 * np.sqrt(np.where(inside, mu**2 - mu_c**2, 0.0)) / (mu_c * C_11 - coupling))
    np.testing.assert_array_equal(tangential["solutions"] > 1, inside & (np.abs(angle) <= reach))


def test_the_bands_of_several_solutions_end_where_the_closed_forms_say(maps: xr.Dataset) -> None:
    """Tangential: two solutions up to arccos(mu_c/mu), three from there to where sticking leaves the cone, as above."""
    mu_c, C_11, coupling = 4.0 / 3.0, 1.0 + 3.0 * 4.0 / 5.0, 3.0 * 2.0 / 5.0
    tangential = maps.isel(state=1).sel(approach=0.0)
    mu = tangential["friction"].values
    critical = mu > mu_c
    reach = np.arctan(4.0 * np.sqrt(mu[critical] ** 2 - mu_c**2) / (mu_c * C_11 - coupling))
    two, three = (tangential["several"].sel(number=n).values[:, critical] for n in (2, 3))
    np.testing.assert_allclose(two, [np.zeros(critical.sum()), np.arccos(mu_c / mu[critical])], atol=1e-7)
    np.testing.assert_allclose(three, [np.arccos(mu_c / mu[critical]), reach], atol=1e-7)
    assert np.isnan(tangential["several"].values[..., ~critical]).all()


def test_the_picture_names_angles_by_hand_defines_b_and_has_whole_bands(maps: xr.Dataset) -> None:
    figure = draw(maps, DRAWINGS)
    assert_no_two_entries_share_a_mark(figure)
    said = figure.get_suptitle() + "".join(axis.get_title() for axis in figure.axes)
    assert "$b = H" in said
    assert "arctan(2)" in said
    assert "=atan" not in said
    impact = maps.isel(state=1).sel(approach=-0.01)
    low, high = impact["several"].sel(number=3).values
    rows = np.flatnonzero(np.isfinite(low))
    assert rows.size > 10
    assert np.array_equal(rows, np.arange(rows[0], rows[-1] + 1))  # no gap from the first row to the last
    assert (low[rows] < high[rows]).all()


@pytest.mark.parametrize(("heading", "mu"), [("pi", "2"), ("2*pi/3", "3/2"), ("3*pi/4", "3/2"), ("pi/2", "3")])
def test_a_map_is_as_far_from_the_projection_as_the_exact_limit_sets_are(heading: str, mu: str) -> None:
    state = make_state(load_scene("spatial_rod"), keys={"theta": "atan(2)", "heading": heading}, parameters={"mu": mu})
    angle = math.atan2(-state.number(state.u[1]), -state.number(state.u[0]))  # b points against the first axis
    mapped = map_laws([state], approaches=[0.0], frictions=[state.number(state.parameters["mu"])], directions=3601)
    point = mapped.isel(state=0, approach=0, friction=0).sel(direction=angle, method="nearest")
    coulomb, projected = limit_set(state, "coulomb"), limit_set(state)
    reached = np.array([[state.number(x) for x in jump.velocity] for jump in coulomb.jumps])
    expected = np.linalg.norm(reached - projected.u_plus, axis=1).min()
    assert len(coulomb.jumps) == int(point["solutions"])
    assert float(point["nearest"]) == pytest.approx(expected, abs=1e-10)


def test_a_map_of_other_scenes_or_of_departures_is_refused_in_one_line() -> None:
    planar = make_state(load_scene("slender_rod"), "paradox")
    with pytest.raises(InputError, match="section of friction is a disc"):
        map_laws([planar], approaches=[0.0], frictions=[1.0])
    with pytest.raises(InputError, match="approaches v_n <= 0"):
        map_laws([rod()], approaches=[0.1], frictions=[1.0])
