"""Trajectories as files: the dataset explains itself, its numbers obey mechanics, and it can be drawn and animated."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
import xarray as xr
from dynamics_scenes import block
from matplotlib.animation import PillowWriter
from matplotlib.figure import Figure
from PIL import Image
from planar_scenes import SCENE_NAMES

import painleve
from painleve.core.motion_codes import Change
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import make_start
from painleve.dynamics.trajectory import Trajectory
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Outline, make_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw, save_figure
from painleve.plotting.animation import FRAMES, animate
from painleve.plotting.trajectory import JUMPS, spaced
from painleve.store import labels_of, load, save
from painleve.sweep.trajectories import trajectory_dataset

ROD, ARM = load_scene("slender_rod"), load_scene("two_link_arm")


@pytest.fixture(scope="module")
def trajectories() -> dict[str, Trajectory]:
    return {
        "stoss": simulate(make_state(ROD, "stoss"), step=1e-3, until=0.9),
        "arm": simulate(make_state(ARM, "paradox"), step=1e-3, until=0.05),
        "still": simulate(make_state(ROD, "sliding"), step=1e-3, until=0.0),
        "drop": simulate(make_start(ROD, q={"x": 0, "y": "3/2", "theta": 1}, u={"x": 2}), step=1e-3, until=1.0),
        "event_driven": simulate(make_state(ROD, "sliding"), scheme="event_driven", step=1e-2, until=0.3),
    }


@pytest.fixture(scope="module")
def datasets(trajectories: dict[str, Trajectory]) -> dict[str, xr.Dataset]:
    return {name: trajectory_dataset(found) for name, found in trajectories.items()}


NAMES = ("stoss", "arm", "still", "drop", "event_driven")


@pytest.mark.parametrize("name", NAMES)
def test_a_trajectory_is_the_same_after_its_file_is_read_by_xarray_alone(
    name: str, datasets: dict[str, xr.Dataset], trajectories: dict[str, Trajectory], tmp_path: Path
) -> None:
    path = save(datasets[name], tmp_path / "x.h5")
    with xr.open_dataset(path, engine="h5netcdf") as found:
        xr.testing.assert_identical(found.load(), datasets[name])
        for j, c in enumerate(trajectories[name].start.scene.coordinates):
            np.testing.assert_array_equal(found[c.name], trajectories[name].q[:, j])
            np.testing.assert_array_equal(found[f"u_{c.name}"], trajectories[name].u[:, j])
            assert found[c.name].attrs["units"] == c.unit


def test_the_codes_of_the_file_name_the_kinds_of_the_jumps(
    datasets: dict[str, xr.Dataset], trajectories: dict[str, Trajectory]
) -> None:
    change = datasets["stoss"]["change"]
    (jump,) = trajectories["stoss"].jumps
    meanings = change.attrs["flag_meanings"].split()
    assert meanings[int(change[jump.index])] == jump.kind.label == "jump_without_collision"
    assert meanings[int(change[0])] == "not_run"
    assert np.unique(change[1:]).size == 2


def test_a_file_says_the_margins_of_proposition_1_and_what_they_are_relative_to(
    datasets: dict[str, xr.Dataset], trajectories: dict[str, Trajectory]
) -> None:
    attributes = datasets["stoss"].attrs
    for name, margin in trajectories["stoss"].proposition1.as_dict().items():
        assert attributes[f"proposition1_{name}"] == margin
    assert "relative to the velocities, forces and impulses that enter its step" in attributes["proposition1_margins"]
    assert not [name for name in datasets["event_driven"].attrs if name.startswith("proposition1")]


def test_the_outline_keeps_the_lengths_of_its_links_and_its_tip_at_the_gap(datasets: dict[str, xr.Dataset]) -> None:
    for name, links, tip in (("stoss", [2.0], 0), ("drop", [2.0], 0), ("arm", [1.0, 1.0], 2)):
        found = datasets[name]
        lengths = np.hypot(np.diff(found.outline_x), np.diff(found.outline_y))
        np.testing.assert_allclose(lengths, np.broadcast_to(links, lengths.shape), rtol=1e-13)
        np.testing.assert_allclose(found.outline_y[:, tip] - found.floor, -found.g, atol=1e-13)


@pytest.mark.parametrize("name", ["stoss", "drop"])
def test_kinetic_energy_changes_by_the_work_of_gravity_and_of_the_contact(
    name: str, datasets: dict[str, xr.Dataset], trajectories: dict[str, Trajectory]
) -> None:
    found, start = datasets[name], trajectories[name].start
    gravity = start.p[[p.name for p in ROD.parameters].index("gravity")]
    h = float(found.time[1] - found.time[0])
    # M is constant: in each step gravity works along the mean of the old and the free velocity, exactly
    weight = -gravity * h * (found.u_y.values[:-1] - gravity * h / 2)
    gained = found.kinetic_energy.values - found.kinetic_energy.values[0]
    rounding = 4.0 * gained.size * np.finfo(float).eps * float(found.kinetic_energy.max())
    contact = found.contact_work.values + found.splitting_loss.values
    np.testing.assert_allclose(gained[1:], np.cumsum(weight) + contact[1:], atol=rounding)
    assert np.diff(found.contact_work).max() <= 1e-14
    assert np.diff(found.splitting_loss).max() <= 0.0
    assert found.contact_work[-1] < -1.0


def test_the_work_of_a_lasting_contact_force_is_known_to_second_order_in_the_recorded_step() -> None:
    errors = []
    for step in (1e-2, 1e-3):
        found = simulate(
            make_state(ROD, "sliding", keys={"omega": 2, "slip": -3}), scheme="event_driven", step=step, until=0.1
        )
        energy = found.contact_quantities()["kinetic_energy"] + 9.81 * found.q[:, 1]
        errors.append(abs(found.contact_work()[-1] - (energy[-1] - energy[0])))
    assert abs(energy[-1] - energy[0]) > 50 * errors[1]
    assert errors[0] / errors[1] == pytest.approx(100, rel=0.1)


@pytest.mark.parametrize("name", NAMES)
def test_the_figure_names_its_quantities_and_hides_no_data(name: str, datasets: dict[str, xr.Dataset]) -> None:
    figure = draw(datasets[name])
    body, *over_time = figure.axes
    assert (body.get_xlabel(), body.get_ylabel()) == ("$x$ (m)", "height (m)")
    gamma, *others = [a.get_ylabel() for a in over_time]
    assert others == ["velocity (m/s)", "contact force (N)", "energy (J)"]
    # the norm of grad g sums squares of m/m and of m/rad, so its inverse mixes these; the arm has angles only
    assert gamma == ("$\\gamma$ (rad²/(kg m²))" if name == "arm" else "$\\gamma$ (1/kg,\nrad²/(kg m²))")
    assert over_time[-1].get_xlabel() == "time $t$ (s)"
    (legend,) = figure.legends
    figure.draw_without_rendering()
    box = legend.get_window_extent()
    assert not any(box.overlaps(axis.get_tightbbox()) for axis in figure.axes)


def labels(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_every_kind_of_jump_has_a_mark_and_only_those_that_occur_are_in_the_legend(
    datasets: dict[str, xr.Dataset],
) -> None:
    assert set(JUMPS) == {c.label for c in Change} - {"ordinary"}
    assert "jump without collision" in labels(draw(datasets["stoss"]))
    assert "frictional impact" not in labels(draw(datasets["stoss"]))
    assert "frictional impact" in labels(draw(datasets["drop"]))
    assert "jump without collision" not in labels(draw(datasets["still"]))


def test_a_scene_without_an_outline_is_drawn_without_its_body_and_not_animated(tmp_path: Path) -> None:
    start = make_start(block(), q={"x": 0, "y": 1}, parameters={"weight": 10})
    found = trajectory_dataset(simulate(start, step=1e-2, until=1.0))
    loaded = load(save(found, tmp_path / "x.h5"))
    assert loaded.v_n.attrs["units"] == "SI"
    assert len(draw(loaded).axes) == 4
    with pytest.raises(InputError, match="it needs a trajectory of a scene that has an outline"):
        animate(loaded, tmp_path / "x.gif")


def test_an_animation_has_a_frame_for_each_even_instant_and_reports_each(
    datasets: dict[str, xr.Dataset], tmp_path: Path
) -> None:
    for name, frames in (("stoss", FRAMES), ("arm", 51), ("still", 1)):
        told: list[int] = []
        path = animate(datasets[name], tmp_path / f"{name}.gif", told.append)
        with Image.open(path) as image:
            assert image.format == "GIF"
            assert image.n_frames == frames == sum(told)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["arm.gif", "still.gif", "stoss.gif"]


def test_an_animation_says_how_slow_it_is_and_marks_the_jump_from_then_on(
    datasets: dict[str, xr.Dataset], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[tuple[str, str]] = []

    def look(writer: PillowWriter) -> None:
        (axis,) = writer.fig.axes
        said.append((axis.get_title("left"), axis.get_title("right")))
        PillowWriter.grab_frame(writer)

    monkeypatch.setattr("painleve.plotting.animation.PillowWriter", type("Seen", (PillowWriter,), {"grab_frame": look}))
    animate(datasets["stoss"], tmp_path / "x.gif")
    times, kinds = datasets["stoss"]["time"].values, labels_of(datasets["stoss"]["change"])
    (jump,) = times[kinds == "jump_without_collision"]
    slower = FRAMES / 20 / (times[-1] - times[0])  # 20 frames a second
    for (left, right), index in zip(said, spaced(times, FRAMES), strict=True):
        assert left == f"$t$ = {times[index]:.4g} s, shown {slower:.3g} times slower"
        assert right == (f"jump without collision at $t$ = {jump:.4g} s" if times[index] >= jump else "")


def test_an_animation_that_is_stopped_leaves_no_file(datasets: dict[str, xr.Dataset], tmp_path: Path) -> None:
    def stop(frames: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(datasets["stoss"], tmp_path / "x.gif", stop)
    with pytest.raises(InputError, match=r"an animation is a \.gif"):
        animate(datasets["stoss"], tmp_path / "x.mp4")
    assert list(tmp_path.iterdir()) == []


def test_spaced_instants_hold_both_ends_and_repeat_none() -> None:
    assert spaced(np.array([0.0]), 5).tolist() == [0]
    assert spaced(np.arange(101.0), 5).tolist() == [0, 25, 50, 75, 100]
    assert spaced(np.array([0.0, 1.0, 1.0, 1.0]), 9).tolist() == [0, 1, 3]


def test_a_trajectory_plots_itself_as_its_dataset_is_drawn(tmp_path: Path) -> None:
    found = simulate(make_state(ROD, "stoss"), step=1e-3, until=0.9)
    figures = (found.plot(), painleve.draw(found), draw(trajectory_dataset(found)))
    first, *others = (save_figure(f, tmp_path / f"{i}.png").read_bytes() for i, f in enumerate(figures))
    assert others == [first, first]


def test_a_trajectory_needs_no_plotting_to_be_computed() -> None:
    code = "import sys, painleve; painleve.simulate; print('matplotlib' in sys.modules)"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "False"


def test_the_same_trajectory_gives_the_same_picture(datasets: dict[str, xr.Dataset], tmp_path: Path) -> None:
    one, two = (save_figure(draw(datasets["drop"]), tmp_path / f"{k}.pdf").read_bytes() for k in (1, 2))
    assert one == two


@pytest.mark.parametrize("scene", SCENE_NAMES)
def test_every_scene_of_the_library_has_an_outline_that_touches_the_floor_at_g_0(scene: str) -> None:
    found = load_scene(scene)
    assert found.outline is not None
    tips = [sp.simplify(y - found.outline.floor + found.contact.constraint) for _, y in found.outline.points]
    assert 0 in tips


def test_an_outline_of_undeclared_symbols_is_refused() -> None:
    point = block()
    for outline in (
        Outline(points=((sp.Symbol("z"), sp.Integer(0)),), floor=sp.Integer(0)),
        Outline(points=(), floor=point.q[0]),
    ):
        with pytest.raises(InputError, match=r"undeclared symbol \w in the (outline|floor of the outline)"):
            make_scene(
                name="block",
                sentence="",
                source="",
                coordinates=point.coordinates,
                parameters=point.parameters,
                inertia=point.inertia,
                constraint=point.contact.constraint,
                outline=outline,
            )
