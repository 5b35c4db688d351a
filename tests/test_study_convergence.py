"""The distance of graphs, the references, and the study of convergence on little."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from figure_checks import assert_no_two_entries_share_a_mark
from scipy.integrate import solve_ivp

from painleve.dynamics.graph_distance import graph_distance, velocity_graph
from painleve.dynamics.schemes import SCHEME_NAMES, load_scheme
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import as_start
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw
from studies.convergence.dataset import sweep_convergence
from studies.convergence.figures import DRAWINGS, SCHEMES
from studies.convergence.measure import QUICK
from studies.convergence.motions import PROBLEMS, make_reference
from studies.convergence.report import report
from studies.convergence.runs import MotionEffort

BY_NAME = {p.name: p for p in PROBLEMS}
COLLISIONS = ("point_impact", "point_fall", "rod_impact", "arm_impact", "rod_fall")


LITTLE = replace(QUICK, tolerances=(1e-6,), instants=5000)


@pytest.fixture(scope="module")
def dataset() -> xr.Dataset:
    return sweep_convergence(effort=LITTLE, command="test")


@pytest.fixture(scope="module")
def rows(dataset: xr.Dataset) -> list[dict[str, Any]]:
    found: Any = report({"convergence": dataset}).data["rows"]
    return found


def test_a_jump_shifted_by_a_step_costs_the_step_and_not_its_height() -> None:
    jump, later = (velocity_graph([0, s, s, 2], [[0, 0], [0, 0], [3, 4], [3, 4]]) for s in (1.0, 1.01))
    assert graph_distance(jump, later).bounds.upper == pytest.approx(0.01, rel=1e-12)
    assert graph_distance(jump, jump).bounds.upper < 1e-14


def dense(graph: np.ndarray, pieces: int) -> np.ndarray:
    places = np.linspace(0.0, 1.0, pieces + 1)[None, :, None]
    return (graph[:-1, None] + places * np.diff(graph, axis=0)[:, None]).reshape(-1, graph.shape[1])


@pytest.mark.parametrize("seed", range(12))
def test_the_enclosure_holds_the_distance_found_between_dense_points(seed: int) -> None:
    random = np.random.default_rng(seed)
    graphs = []
    for n in (7, 12):
        t = np.sort(np.round(random.uniform(0, 2, n), 1))  # rounded: some instants stand twice
        graphs.append(velocity_graph(t, random.normal(size=(n, 2))))
    pieces = 200
    points = [dense(g, pieces) for g in graphs]
    gaps = np.linalg.norm(points[0][:, None] - points[1][None], axis=2)
    # dense points see a supremum too low and a distance too large, both by at most half their spacing
    spacing = max(np.linalg.norm(np.diff(g, axis=0), axis=1).max() for g in graphs) / pieces
    found = graph_distance(*graphs)
    for excess, brute in ((found.forward, gaps.min(axis=1).max()), (found.backward, gaps.min(axis=0).max())):
        assert excess.bounds.upper <= excess.bounds.lower * 1.001 + 1e-13
        assert excess.bounds.lower <= brute + spacing
        assert excess.bounds.upper >= brute - spacing
        assert np.linalg.norm(excess.attained_at - excess.nearest) == pytest.approx(excess.bounds.lower, rel=1e-9)


@pytest.mark.parametrize(
    ("t", "u", "words"),
    [
        ([0.0], [[1.0]], "n >= 2"),
        ([0.0, 1.0], [1.0, 2.0], "n >= 2"),
        ([1.0, 0.0], [[1.0], [2.0]], "decrease"),
        ([0.0, 1.0], [[math.nan], [2.0]], "NaN"),
    ],
)
def test_what_is_no_graph_is_refused_in_one_line(t: list, u: list, words: str) -> None:
    with pytest.raises(InputError, match=words):
        velocity_graph(t, u)


@pytest.mark.parametrize("name", ["point_impact", "point_stick", "point_fall"])
def test_the_closed_form_is_what_the_event_driven_method_finds(name: str) -> None:
    problem = BY_NAME[name]
    found = simulate(problem.start(), scheme="event_driven", step=problem.until / 7, until=problem.until)
    distance = graph_distance(velocity_graph(found.t, found.u), make_reference(problem, instants=10).graph)
    assert distance.bounds.upper < 1e-12


def test_the_reference_of_the_sliding_rod_is_its_reduced_equation() -> None:
    def reduced(t: float, z: np.ndarray) -> list[float]:
        theta, spin = z
        sine, cosine = math.sin(theta), math.cos(theta)
        force = (9.81 - spin**2 * sine) / (1 + 3 * cosine**2 - 0.9 * sine * cosine)
        return [spin, 3 * force * (0.3 * sine - cosine)]

    problem = BY_NAME["rod_slide"]
    slow = solve_ivp(reduced, (0, problem.until), [math.pi / 3, 1.0], method="LSODA", rtol=1e-12, atol=1e-13)
    assert make_reference(problem, instants=10).graph[-1, 3] == pytest.approx(slow.y[1, -1], rel=1e-9)


def test_a_reference_that_ends_early_is_refused() -> None:
    start = as_start(make_state(load_scene("slender_rod"), "paradox"))
    with pytest.raises(InputError, match=r"problem rod_slide: no reference, .* inconsistent"):
        make_reference(replace(BY_NAME["rod_slide"], start=lambda: start), instants=10)


def test_the_position_level_scheme_comes_to_rest_on_a_curved_constraint() -> None:
    problem = BY_NAME["arm_stick"]
    for steps in (300, 1369, 3001, 16323):  # of these, some once stopped at rest: rounding is no change of velocity
        found = simulate(
            problem.start(), scheme="schatzman_paoli", step=problem.until / steps, until=problem.until, monitor=False
        )
        assert found.ending.label == "reached_end"
        assert np.abs(found.u[-1]).max() < 1e-9


def test_a_method_that_cannot_go_on_is_kept_as_a_failed_run() -> None:
    start = as_start(make_state(load_scene("slender_rod"), "paradox"))
    u = [list(start.u), list(start.u)]
    problem = replace(
        BY_NAME["rod_slide"], start=lambda: start, until=0.1, closed_form=lambda: velocity_graph([0.0, 0.1], u)
    )
    effort = MotionEffort(
        most=200, levels=2, phases=1, tolerances=(1e-6,), stiffnesses=(1e3,), instants=10, patience=0.0
    )
    one = sweep_convergence([problem], effort=effort, command="test").isel(problem=0)
    (run,) = np.flatnonzero(one["run_scheme"].values == "event_driven")
    assert np.isnan(one["error_upper"].values[run])
    assert "inconsistent" in str(one["sentence"].values[run])
    assert one["seconds"].values[run] > 0.0


def test_every_run_is_kept_and_the_worst_of_a_level_is_marked(dataset: xr.Dataset, rows: list[dict[str, Any]]) -> None:
    assert len(rows) == len(PROBLEMS) * len(SCHEME_NAMES)
    assert sum(row["runs"] for row in rows) == dataset["error_upper"].size
    one = dataset.sel(problem="point_fall")
    own = one.isel(run=np.flatnonzero(one["run_scheme"].values == "moreau_jean"))
    for level in range(LITTLE.levels):
        here = own.isel(run=np.flatnonzero(own["level"].values == level))
        assert here["worst"].values.tolist() == (here["error_upper"] == here["error_upper"].max()).values.tolist()


def test_marks_of_schemes_that_coincide_can_all_be_seen_and_the_theorems_are_named(dataset: xr.Dataset) -> None:
    figure = draw(dataset, DRAWINGS)
    assert_no_two_entries_share_a_mark(figure)
    sizes = [mark.size for mark in SCHEMES.values()]
    assert len(set(sizes[:5])) == 5  # schemes of fixed step agree on the point mass
    assert all(number in figure.get_suptitle() for number in ("[5]", "[9]", "[15]"))


@pytest.mark.parametrize("problem", list(BY_NAME))
@pytest.mark.parametrize("scheme", [s for s in SCHEME_NAMES if s not in ("event_driven", "compliant")])
def test_every_fixed_step_scheme_is_of_order_one_where_contacts_change(
    problem: str, scheme: str, rows: list[dict[str, Any]]
) -> None:
    (row,) = [r for r in rows if (r["motion"], r["scheme"]) == (problem, scheme)]
    assert row["verdict"] == "as_expected"
    assert row["order"] == pytest.approx(1.0, abs=0.15)  # four levels: the standard errors reach 0.1
    assert row["stated_order"] == load_scheme(scheme).order


@pytest.mark.parametrize("problem", list(BY_NAME))
def test_a_compliant_contact_converges_unless_it_rebounds(problem: str, rows: list[dict[str, Any]]) -> None:
    (row,) = [r for r in rows if (r["motion"], r["scheme"]) == (problem, "compliant")]
    assert row["verdict"] == ("does_not_converge" if problem in COLLISIONS else "as_expected")


def test_the_rebound_of_the_compliant_contact_is_that_of_a_critically_damped_spring() -> None:
    problem = BY_NAME["point_impact"]
    speed = math.sqrt(10.0)
    found = simulate(problem.start(), scheme="compliant", step=5e-4, until=0.33, options={"stiffness": 1e6})
    assert found.u[:, 1].max() == pytest.approx(math.exp(-2.0) * speed, rel=1e-2)
