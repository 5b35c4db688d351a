"""Every study says its claim, keeps and draws what it measures, and is found in a checkout and nowhere else."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from painleve.cli import main, studies
from painleve.errors import InputError
from painleve.plotting.draw import DRAWINGS
from painleve.store import load, provenance
from studies.parts import Progress, Report
from studies.study import Study
from studies.text_table import text_table

ROOT = Path(__file__).parents[1]
NAMES = ["convergence", "laws", "plurality", "reference", "speed_accuracy", "theorem1", "where_methods_fail"]


def claim(name: str) -> str:
    return ast.get_docstring(ast.parse((ROOT / "studies" / name / "claim.py").read_text(encoding="utf-8"))) or ""


def test_the_studies_are_those_with_a_claim() -> None:
    assert studies.study_names() == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_a_study_says_what_it_claims_how_it_is_run_what_comes_out_and_how_long_it_takes(name: str) -> None:
    text = claim(name)
    assert text.splitlines()[0] == studies.title_of(name)
    assert "Claim" in text
    assert f"painleve study {name} [--quick]" in text
    for word in ("Command:", "Expected:", "Time:", "Files:"):
        assert f"\n{word}" in text


@pytest.mark.parametrize("name", NAMES)
def test_a_study_has_its_parts_and_its_kinds_are_drawn_by_no_other(name: str) -> None:
    study = studies.claim_of(name).STUDY
    assert callable(study.measure)
    assert callable(study.report)
    assert set(study.drawings)
    for kind in study.drawings:
        assert kind not in DRAWINGS
        assert studies.drawings_of(kind) is study.drawings


def test_a_kind_that_no_study_draws_has_no_drawings() -> None:
    assert studies.drawings_of("poem") == {}


def test_a_measurer_and_a_report_load_no_matplotlib() -> None:
    modules = ", ".join(f"studies.{name}.{part}" for name in NAMES for part in ("measure", "report"))
    code = f"import sys, {modules}; print('matplotlib' in sys.modules)"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert answer.stdout.strip() == "False"


def test_without_a_checkout_one_line_says_where_the_studies_are(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(studies, "CHECKOUT", tmp_path)
    with pytest.raises(InputError, match="the studies come with the source tree"):
        studies.study_names()
    assert main(["study", "theorem1"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert "come with the source tree" in said.err


def tiny(kind: str, values: list[float]) -> xr.Dataset:
    source = provenance(scene="none", scene_digest="none", seed=0, command="test")
    numbers = xr.Variable(("n",), np.array(values), {"units": "m", "long_name": "some numbers to keep"})
    return xr.Dataset({"x": numbers}, attrs={"title": "numbers", "kind": kind, **source})


def two_datasets(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
    yield "first", tiny("drawn", [1.0, float(seed)])
    yield "second", tiny("undrawn", [2.0 if quick else 3.0])


def summed(datasets: object) -> Report:
    assert isinstance(datasets, dict)
    total = {stem: float(dataset["x"].sum()) for stem, dataset in datasets.items()}
    return Report(table="a table", data=total, status="done")


def test_a_study_keeps_every_dataset_draws_those_that_have_a_drawing_and_names_the_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = Study(measure=two_datasets, report=summed, drawings={"drawn": lambda dataset: Figure()})
    result = study.run(tmp_path, quick=True, seed=5)
    assert [path.name for path in result.files] == ["first.h5", "first.pdf", "first.png", "second.h5"]
    assert sorted(tmp_path.iterdir()) == sorted(result.files)
    assert (result.table, result.status, dict(result.data)) == ("a table", "done", {"first": 6.0, "second": 2.0})
    assert summed({path.stem: load(path) for path in result.files if path.suffix == ".h5"}).data == result.data
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.splitlines() == ["first: measured, drawn and kept", "second: measured, drawn and kept"]


def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_measured(tmp_path: Path) -> None:
    def never(*, quick: bool, seed: int, progress: Progress) -> Iterator[tuple[str, xr.Dataset]]:
        raise AssertionError("measured")

    with pytest.raises(InputError, match="there is no folder"):
        Study(measure=never, report=summed).run(tmp_path / "nowhere")


def test_a_table_aligns_its_columns_and_refuses_ragged_rows() -> None:
    assert text_table(("a", "b"), [("long", "1")]) == "a     b\n----  -\nlong  1"
    with pytest.raises(ValueError, match="zip"):
        text_table(("a", "b"), [("1",)])
