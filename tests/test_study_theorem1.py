"""The study of Theorem 1 on two scenes and few samples: told as exact arithmetic decides it, and drawn whole."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr
from study_runs import QUIET

from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw
from painleve.theory.classification import classify
from studies.parts import Report
from studies.theorem1.figures import DRAWINGS
from studies.theorem1.measure import measure_scene
from studies.theorem1.overview import overview
from studies.theorem1.report import report

SCENES = ("slender_rod", "worn_tip_rod")
STATES = [(scene, state.name) for scene in SCENES for state in load_scene(scene).states]
EPS = [1e-2, 1e-3, 1e-4]


@pytest.fixture(scope="module")
def datasets() -> dict[str, xr.Dataset]:
    return dict(
        pair for name in SCENES for pair in measure_scene(load_scene(name), EPS, samples=8192, seed=0, progress=QUIET)
    )


@pytest.fixture(scope="module")
def found(datasets: dict[str, xr.Dataset]) -> Report:
    return report(datasets)


def row_of(found: Report, scene: str, state: str) -> dict[str, Any]:
    rows = found.data["rows"]
    assert isinstance(rows, list)
    (row,) = [row for row in rows if (row["scene"], row["state"]) == (scene, state)]
    return row


def line_of(found: Report, scene: str, state: str) -> list[str]:
    (line,) = [line.split() for line in found.table.splitlines() if line.split()[:2] == [scene, state]]
    return line


def test_a_scene_has_its_distances_its_members_and_its_map(datasets: dict[str, xr.Dataset]) -> None:
    assert list(datasets) == [f"{kind}_{scene}" for scene in SCENES for kind in ("distances", "members", "gamma_map")]
    for stem, dataset in datasets.items():
        assert dataset.sizes["state"] == len(load_scene(stem.split("_", 1)[1].removeprefix("map_")).states)


def test_a_scene_without_one_coefficient_of_friction_has_no_map() -> None:
    stems = [stem for stem, _ in measure_scene(load_scene("bead"), EPS[:1], samples=64, seed=0, progress=QUIET)]
    assert stems == ["distances_bead", "members_bead"]


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_the_table_tells_the_branch_that_exact_arithmetic_decides(scene: str, state: str, found: Report) -> None:
    exact = classify(make_state(load_scene(scene), state)).branch.value
    assert row_of(found, scene, state)["branch"] == exact
    assert line_of(found, scene, state)[2] == exact


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_no_statement_is_contradicted_and_every_excess_falls_like_eps(scene: str, state: str, found: Report) -> None:
    row = row_of(found, scene, state)
    assert row["verdict"] == line_of(found, scene, state)[4] == "consistent"
    assert row["slope"] == pytest.approx(1.0, abs=0.05)


def test_in_the_isolated_branch_half_of_the_segment_stays_away(found: Report) -> None:
    # By hand at tan(theta) = 2: u_tilde - u- = (2/5, 3/10, 3/(2 sqrt(5))).
    row = row_of(found, "worn_tip_rod", "isolated")
    assert row["excess_A_Aeps"]["upper"] == pytest.approx(0.7**0.5 / 2.0, rel=1e-3)
    assert row["witnessed_upper"] is None


def test_the_hard_state_shows_both_the_misleading_sample_and_the_witnesses(found: Report) -> None:
    row = row_of(found, "slender_rod", "double_zero")
    assert row["excess_A_Aeps"]["upper"] > 0.1
    assert row["witnessed_upper"] < 1e-6
    assert "*" in line_of(found, "slender_rod", "double_zero")
    assert "* The sample alone misleads" in found.table
    assert found.status.startswith(f"Theorem 1 at {len(STATES)} states: {len(STATES)} consistent")


def test_the_overview_holds_for_every_state_what_the_theorem_is_about(datasets: dict[str, xr.Dataset]) -> None:
    distances = [d for d in datasets.values() if d.attrs["kind"] == "distances"]
    whole = overview(distances)
    assert whole["case"].values.tolist() == [f"{scene} {state}" for scene, state in STATES]
    isolated, hard = (STATES.index(pair) for pair in (("worn_tip_rod", "isolated"), ("slender_rod", "double_zero")))
    last = distances[1].isel(state=-1)
    np.testing.assert_array_equal(whole["to_limit"][isolated], last["ends_excess_Aeps_A_lower"])
    np.testing.assert_array_equal(whole["of_limit"][isolated], last["excess_A_Aeps_upper"])
    np.testing.assert_array_equal(whole["of_limit"][hard], distances[0].isel(state=3)["witnessed_upper"])


def test_the_figure_of_the_whole_theorem_has_a_line_for_every_state_in_the_column_of_its_branch(
    datasets: dict[str, xr.Dataset],
) -> None:
    whole = overview([d for d in datasets.values() if d.attrs["kind"] == "distances"])
    figure = draw(whole, DRAWINGS)
    counts = dict(zip(("none", "negative", "critical_approached", "critical_isolated"), figure.axes, strict=False))
    for branch, axis in counts.items():
        states = sum(classify(make_state(load_scene(s), name)).branch.value == branch for s, name in STATES)
        assert f"{states} state" in axis.get_title()
        assert sum(line.get_label() == "a state in the plane" for line in axis.get_lines()) == states
