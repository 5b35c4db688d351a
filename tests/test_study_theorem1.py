"""The study of Theorem 1, in its quick form: every state of every scene, told as exact arithmetic decides it."""

from __future__ import annotations

from pathlib import Path

import pytest

import studies.theorem1.claim as theorem1
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.store import load
from painleve.theory.classification import classify
from studies.study import StudyResult

pytestmark = pytest.mark.slow  # the study, run whole

SCENE_NAMES = theorem1.SCENES
UNMAPPED = {f"gamma_map_spatial_rod_ellipse.{suffix}" for suffix in ("h5", "pdf", "png")}  # no one coefficient
ROOTS = [
    ("spatial_rod", "critical_oblique"),
    ("spatial_rod", "double_zero"),
    ("spatial_rod_ellipse", "critical_oblique"),
    ("spatial_rod_ellipse", "tilted"),
]
STATES = [(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states]


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> tuple[StudyResult, Path]:
    folder = tmp_path_factory.mktemp("theorem1")
    return theorem1.run(folder, quick=True), folder


def rows(finished: tuple[StudyResult, Path]) -> dict[tuple[str, str], dict]:
    return {(row["scene"], row["state"]): row for row in finished[0].data["rows"]}


def test_a_quick_run_makes_every_file_and_names_them_all(finished: tuple[StudyResult, Path]) -> None:
    result, folder = finished
    kinds, suffixes = ("distances", "members", "gamma_map"), ("h5", "pdf", "png")
    expected = {f"{kind}_{scene}.{suffix}" for kind in kinds for scene in SCENE_NAMES for suffix in suffixes}
    expected -= UNMAPPED
    assert {path.name for path in folder.iterdir()} == expected
    assert {path.name for path in result.files} == expected
    for path in result.files:
        assert path.stat().st_size > 5000
        if path.suffix == ".h5":
            assert load(path).sizes["state"] == len(load_scene(path.stem.split("_", 1)[1].removeprefix("map_")).states)


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_the_table_tells_the_branch_that_exact_arithmetic_decides(
    scene: str, state: str, finished: tuple[StudyResult, Path]
) -> None:
    exact = classify(make_state(load_scene(scene), state)).branch.value
    assert rows(finished)[scene, state]["branch"] == exact
    (line,) = [line.split() for line in finished[0].table.splitlines() if line.split()[:2] == [scene, state]]
    assert line[2] == exact


@pytest.mark.parametrize(("scene", "state"), STATES)
def test_no_statement_is_contradicted_and_every_excess_falls_like_eps_or_its_root(
    scene: str, state: str, finished: tuple[StudyResult, Path]
) -> None:
    row = rows(finished)[scene, state]
    assert row["verdict"] in ("consistent", "proved")
    assert row["slope"] == pytest.approx(0.5 if (scene, state) in ROOTS else 1.0, abs=0.05)


@pytest.mark.parametrize(("scene", "length"), [("worn_tip_rod", 0.7**0.5), ("two_link_arm", 1.0)])
def test_in_the_isolated_branch_half_of_the_segment_stays_away(
    scene: str, length: float, finished: tuple[StudyResult, Path]
) -> None:
    # By hand at tan(theta) = 2: u_tilde - u- = (2/5, 3/10, 3/(2 sqrt(5))); the arm stops, and its u- has length 1.
    row = rows(finished)[scene, "isolated"]
    assert row["excess_A_Aeps"]["upper"] == pytest.approx(length / 2.0, rel=1e-4)
    assert row["witnessed_upper"] is None


def test_the_hard_state_shows_both_the_misleading_sample_and_the_witnesses(
    finished: tuple[StudyResult, Path],
) -> None:
    row = rows(finished)["slender_rod", "double_zero"]
    assert row["excess_A_Aeps"]["upper"] > 0.1
    assert row["witnessed_upper"] < 1e-8
    (line,) = [line for line in finished[0].table.splitlines() if line.split()[:2] == ["slender_rod", "double_zero"]]
    assert "*" in line
    assert "* The sample alone misleads" in finished[0].table
