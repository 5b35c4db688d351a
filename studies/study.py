"""A study: datasets that are measured, a report on them, drawings of them; and how it is run and kept."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import xarray as xr

from painleve.plotting.draw import DRAWINGS, Drawing, draw, save_figure
from painleve.store import check_writable, save
from studies.parts import Measure, Progress, Report

__all__ = ["Study", "StudyResult"]


@dataclass(frozen=True, kw_only=True)
class StudyResult(Report):
    """A report, and the files made."""

    files: tuple[Path, ...]


@dataclass(frozen=True, kw_only=True)
class Study:
    """The parts of a study. `report` needs the datasets alone, so that it can be had again from the files.

    `drawings`: by kind of dataset, beside those of painleve.plotting; a dataset of another kind is kept undrawn.
    """

    measure: Measure
    report: Callable[[Mapping[str, xr.Dataset]], Report]
    drawings: Mapping[str, Drawing] = field(default_factory=dict)

    def run(self, output: Path, *, quick: bool = False, seed: int = 0) -> StudyResult:
        """Measure, draw, keep and report; `output` is an existing folder. Raises InputError if it cannot be used."""
        check_writable(output / "study.h5")
        datasets, files, progress = {}, [], Progress()
        with progress.bar:
            for stem, dataset in self.measure(quick=quick, seed=seed, progress=progress):
                datasets[stem] = dataset
                files += self._keep(dataset, output, stem)
                progress.kept(stem)
        return StudyResult(**vars(self.report(datasets)), files=tuple(files))

    def _keep(self, dataset: xr.Dataset, output: Path, stem: str) -> list[Path]:
        files = [save(dataset, output / f"{stem}.h5")]
        if dataset.attrs["kind"] in {**DRAWINGS, **self.drawings}:
            figure = draw(dataset, self.drawings)
            files += [save_figure(figure, output / f"{stem}.{suffix}") for suffix in ("pdf", "png")]
        return files
