"""Figures say what their axes are, show the side of every bound, cover no data, and come out the same twice."""

from __future__ import annotations

import io
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from painleve.asymptotics.sample import SampleOptions
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.plotting import draw, save_figure
from painleve.plotting.style import LAW_MARKS, THEOREM_MARKS
from painleve.sweep import map_gamma, map_regimes, sweep_distances, sweep_members

ROD, WORN = load_scene("slender_rod"), load_scene("worn_tip_rod")
FEW = SampleOptions(samples=2048)
EPS = (1e-1, 1e-2, 1e-3)


@pytest.fixture(scope="module")
def datasets() -> dict[str, xr.Dataset]:
    """One dataset for every drawing."""
    states = ["sliding", "approached", "isolated"]
    axes = {"theta": np.linspace(0.2, 1.5, 30), "omega": np.linspace(0.0, 6.0, 30)}
    return {
        "distances": sweep_distances(WORN, eps=EPS, states=states, options=FEW),
        "over": sweep_distances(ROD, eps=EPS[:2], states=["paradox"], over={"mu": ["1", "2", "-1"]}, options=FEW),
        "members": sweep_members(WORN, eps=EPS[:2], states=states, options=FEW),
        "gamma_map": map_gamma(WORN, states=states, points=(31, 21)),
        "regimes": map_regimes(ROD, axes=axes, parameters={"mu": 2}),
    }


@pytest.fixture(scope="module")
def figures(datasets: dict[str, xr.Dataset]) -> dict[str, Figure]:
    return {name: draw(dataset) for name, dataset in datasets.items()}


KINDS = ("distances", "over", "members", "gamma_map", "regimes")


def panels(figure: Figure) -> Iterator[Axes]:
    return (axis for axis in figure.axes if axis.get_label() != "<colorbar>")


@pytest.mark.parametrize("kind", KINDS)
def test_every_label_of_an_axis_names_a_quantity_with_its_unit(kind: str, figures: dict[str, Figure]) -> None:
    figure = figures[kind]
    said = " ".join(text for a in panels(figure) for text in (a.get_xlabel(), a.get_ylabel())) + figure.get_suptitle()
    assert any(axis.get_xlabel() for axis in panels(figure))
    assert any(axis.get_ylabel() for axis in panels(figure))
    assert "rad" in said
    assert "None" not in said


@pytest.mark.parametrize("kind", KINDS)
def test_the_legend_explains_the_marks_and_covers_no_panel(kind: str, figures: dict[str, Figure]) -> None:
    figure = figures[kind]
    figure.draw_without_rendering()
    (legend,) = figure.legends
    box = legend.get_window_extent()
    assert len(legend.get_texts()) >= 3
    labels = [text.get_text() for text in legend.get_texts()]
    assert len(set(labels)) == len(labels)
    for axis in figure.axes:
        assert not box.overlaps(axis.get_tightbbox())


def test_lower_bounds_point_up_and_upper_bounds_point_down(figures: dict[str, Figure]) -> None:
    seen = set()
    for axis in panels(figures["distances"]):
        for line in axis.get_lines():
            name, marker = str(line.get_label()), line.get_marker()
            if "bound" in name:
                assert marker == ("^" if "lower bound" in name else "v")
                seen.add(marker)
    assert seen == {"^", "v"}


def test_every_known_bound_is_drawn_at_its_value(datasets: dict[str, xr.Dataset], figures: dict[str, Figure]) -> None:
    for i, axis in enumerate(panels(figures["distances"])):
        drawn = {str(line.get_label()): line.get_ydata() for line in axis.get_lines()}
        one = datasets["distances"].isel(state=i)
        np.testing.assert_array_equal(drawn["$e(A_\\varepsilon, A)$, lower bound (sample)"], one["excess_Aeps_A_lower"])
        np.testing.assert_array_equal(drawn["$e(A, A_\\varepsilon)$, upper bound (sample)"], one["excess_A_Aeps_upper"])


def test_bounds_are_labelled_by_the_method_that_found_them(datasets: dict[str, xr.Dataset]) -> None:
    axis = next(panels(draw(datasets["distances"].assign_attrs(method="certify"))))
    labels = [str(line.get_label()) for line in axis.get_lines()]
    assert "$e(A_\\varepsilon, A)$, lower bound (certify)" in labels
    assert not any("sample" in label or "METHOD" in label for label in labels)


@pytest.mark.parametrize("tiny", [0.0, 1e-93])
def test_a_bound_that_is_zero_but_for_rounding_does_not_flatten_the_others(
    tiny: float, datasets: dict[str, xr.Dataset]
) -> None:
    changed = datasets["distances"].copy(deep=True)
    changed["witnessed_upper"][0] = tiny
    axis = next(panels(draw(changed)))
    (foot,) = [line for line in axis.get_lines() if "< 10^{-20}" in str(line.get_label())]
    assert list(foot.get_xdata()) == list(EPS)
    assert axis.get_ylim()[0] > 1e-12


def test_a_failed_point_is_marked_where_it_was(figures: dict[str, Figure]) -> None:
    for axis in panels(figures["over"]):
        (failed,) = [line for line in axis.get_lines() if line.get_label() == "failed"]
        assert list(failed.get_xdata()) == [-1.0]


def test_half_the_length_of_the_segment_is_drawn_only_where_the_state_is_isolated(figures: dict[str, Figure]) -> None:
    has = [any("frac" in str(line.get_label()) for line in axis.get_lines()) for axis in panels(figures["distances"])]
    assert has == [False, False, True]


@pytest.mark.parametrize("marks", [LAW_MARKS, THEOREM_MARKS], ids=["law", "theorem"])
def test_no_two_marks_share_a_colour_or_a_shape(marks: dict) -> None:
    for one, other in combinations(marks.values(), 2):
        assert one.marker != other.marker
        assert np.linalg.norm(np.subtract(to_rgb(one.colour), to_rgb(other.colour))) > 0.3


@pytest.mark.parametrize("suffix", ["pdf", "png"])
def test_the_same_dataset_gives_the_same_bytes(suffix: str, datasets: dict[str, xr.Dataset], tmp_path: Path) -> None:
    once = save_figure(draw(datasets["distances"]), tmp_path / f"a.{suffix}").read_bytes()
    again = save_figure(draw(datasets["distances"]), tmp_path / f"b.{suffix}").read_bytes()
    assert len(once) > 5000
    assert once == again


def test_a_format_that_cannot_be_drawn_is_refused_and_leaves_nothing(
    figures: dict[str, Figure], tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"use \.pdf"):
        save_figure(figures["regimes"], tmp_path / "a.docx")
    assert list(tmp_path.iterdir()) == []


def test_a_failure_while_drawing_leaves_the_old_figure(
    figures: dict[str, Figure], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(b"old")

    def broken(self: Figure, target: io.BytesIO, **_: object) -> None:
        target.write(b"half")
        raise OSError("no space left")

    monkeypatch.setattr(Figure, "savefig", broken)
    with pytest.raises(InputError, match="no space left"):
        save_figure(figures["regimes"], path)
    assert [p.read_bytes() for p in tmp_path.iterdir()] == [b"old"]


def test_what_has_no_drawing_is_refused_in_one_line(datasets: dict[str, xr.Dataset]) -> None:
    with pytest.raises(InputError, match="no figure for a dataset of kind 'poem'"):
        draw(datasets["distances"].assign_attrs(kind="poem"))


def test_too_many_panels_are_refused_with_what_to_do(datasets: dict[str, xr.Dataset]) -> None:
    many = xr.concat([datasets["over"]] * 13, dim="state")
    with pytest.raises(InputError, match="select at most 24"):
        draw(many)
