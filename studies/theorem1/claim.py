"""Theorem 1, branch by branch, on every named state of every scene of the library.

Claim (L. Paoli, IFIP AICT 494 (2016), Theorem 1; the value in the isolated branch is the project's own): at a
tangential contact with u_tilde != u-, the values S(q_eps, v_eps) of the contact law over balls of radius eps fill, in
the limit,
- {u-, u_tilde} where gamma < 0;
- the segment [u-, u_tilde] where gamma = 0 and touching or penetrating configurations with gamma > 0 accumulate at q;
- its two ends alone where gamma = 0 and there are no such configurations: then d_H([u-, u_tilde], A_eps) tends to half
  the length of the segment.
Where gamma > 0 nothing is indeterminate, and A_eps tends to {u-}.

Command:  painleve study theorem1 [--quick]
Expected: the exact branch of each state, every verdict `consistent`, every slope of e(A_eps, A) within 0.05 of 1, or of
          1/2 on the rods in space where gamma = 0 and the jump ends in slip (see painleve.asymptotics.space.rates);
          e(A, A_eps) near 0.418 (worn tip) and 0.5 (arm) in the isolated branch. At `double_zero` and at both states
          `approached` a sample hardly ever slips, its upper bound on e(A, A_eps) stays large, and only the witnesses
          show that the excess vanishes.
Time:     about a minute on two cores, with --quick somewhat less; drawing takes half of it, and the first run after a
          change of the sources compiles the five scenes.
Files:    for each scene the distances over eps, members of A_eps, and the map of gamma: HDF5, PDF and PNG.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import xarray as xr
from tqdm import tqdm

from painleve.asymptotics.sample import SampleOptions
from painleve.asymptotics.theorem import VerdictStatus
from painleve.mechanics.derive import derive
from painleve.mechanics.library import load_scene
from painleve.plotting import draw, save_figure
from painleve.sets import Bounds
from painleve.store import check_writable, save
from painleve.sweep import map_gamma, sweep_distances, sweep_members
from painleve.sweep.variables import BRANCHES, STATUSES
from studies.study import StudyResult

EPS = np.logspace(-1, -6, 16)
SCENES = ("slender_rod", "worn_tip_rod", "two_link_arm", "spatial_rod", "spatial_rod_ellipse")
QUICK_EPS = np.logspace(-1, -6, 6)
PICTURE_EPS = (1e-1, 1e-2)
COLUMNS = ("scene", "state", "branch", "slope", "verdict", "e(A_eps, A)", "e(A, A_eps) sampled", "witnessed", "seconds")


def run(output: Path, *, quick: bool = False, seed: int = 0) -> StudyResult:
    """Sweep, draw and tabulate all states; `output` is an existing folder."""
    check_writable(output / "distances.h5")
    eps = QUICK_EPS if quick else EPS
    total = sum(len(load_scene(name).states) * len(eps) for name in SCENES)
    rows, files = [], []
    with tqdm(total=total, leave=False, disable=None, file=sys.stderr, unit="point") as bar:
        for name in SCENES:
            bar.set_description(name)
            datasets = _measure(name, eps, quick=quick, seed=seed, progress=lambda label: bar.update())
            rows += list(_rows(name, datasets["distances"]))
            for kind, dataset in datasets.items():
                files += _keep(dataset, output, f"{kind}_{name}")
    table = _table(rows, float(eps.min()))
    return StudyResult(table=table, files=tuple(files), data={"eps": eps.tolist(), "rows": rows}, status=_status(rows))


def _measure(
    name: str, eps: np.ndarray, *, quick: bool, seed: int, progress: Callable[[str], None]
) -> dict[str, xr.Dataset]:
    scene = load_scene(name)
    states = [state.name for state in scene.states]
    options = SampleOptions(samples=20_000 if quick else 1_000_000, seed=seed)
    cloud = SampleOptions(samples=4096, seed=seed, sampler="uniform")
    measured = {
        "distances": sweep_distances(scene, eps=eps, states=states, options=options, progress=progress),
        "members": sweep_members(scene, eps=PICTURE_EPS, states=states, options=cloud),
    }
    # without a single coefficient of friction there is no map of gamma over it
    return measured | ({"gamma_map": map_gamma(scene, states=states)} if derive(scene).critical_friction else {})


def _keep(dataset: xr.Dataset, output: Path, stem: str) -> list[Path]:
    figure = draw(dataset)
    return [save(dataset, output / f"{stem}.h5")] + [
        save_figure(figure, output / f"{stem}.{s}") for s in ("pdf", "png")
    ]


def _rows(name: str, distances: xr.Dataset) -> Iterator[dict[str, object]]:
    """What the table says of each state: bounds at the smallest eps, null where a side is unknown."""
    for i, state in enumerate(distances["state"].values):
        one = distances.isel(state=i)
        last = one.isel(eps=int(np.argmin(one["eps"].values)))
        yield {
            "scene": name,
            "state": str(state),
            "branch": _label(one["theorem_branch"], BRANCHES),
            "slope": _known(one["slope"]),
            "verdict": _label(one["verdict"], STATUSES),
            "reason": str(one["verdict_reason"].item()),
            "excess_Aeps_A": _bounds(last, "excess_Aeps_A").as_dict(),
            "excess_A_Aeps": _bounds(last, "excess_A_Aeps").as_dict(),
            "witnessed_upper": _known(last["witnessed_upper"]),
            "half_jump": float(one["half_jump"]),
            "seconds": float(one["seconds"].sum()),
        }


def _label(code: xr.DataArray, labels: tuple[str, ...]) -> str:
    return ("not_run", *labels)[int(code)]


def _known(value: xr.DataArray) -> float | None:
    return None if np.isnan(value) else float(value)


def _bounds(point: xr.Dataset, name: str) -> Bounds:
    return Bounds(lower=_known(point[f"{name}_lower"]), upper=_known(point[f"{name}_upper"]))


def _table(rows: list[dict[str, object]], eps: float) -> str:
    lines = [COLUMNS]
    for row in rows:
        forward, backward = Bounds(**row["excess_Aeps_A"]), Bounds(**row["excess_A_Aeps"])
        witnessed = Bounds.unknown() if row["witnessed_upper"] is None else Bounds.at_most(row["witnessed_upper"])
        slope = "-" if row["slope"] is None else f"{row['slope']:.3f}"
        found = "none" if witnessed.upper is None else _short(witnessed)
        lines.append(
            (
                row["scene"],
                row["state"],
                row["branch"],
                slope,
                row["verdict"],
                _short(forward),
                _short(backward) + (" *" if _misleading(row) else ""),
                found,
                f"{row['seconds']:.1f}",
            )
        )
    widths = [max(len(line[j]) for line in lines) for j in range(len(COLUMNS))]
    text = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]
    text.insert(1, "  ".join("-" * width for width in widths))
    notes = [
        f"Distances at eps = {eps:g}: >= is a lower bound, <= an upper bound. Slopes are those of log e(A_eps, A)",
        "against log eps; in the isolated branch A is replaced by its ends, and e(A, A_eps) tends to half its length.",
    ]
    if any(_misleading(row) for row in rows):
        notes.append("* The sample alone misleads: too few members are near. Witnesses show that this excess vanishes.")
    return "\n".join([*text, "", *notes])


def _short(bounds: Bounds) -> str:
    return str(bounds).split(" (")[0].replace("≥", ">=").replace("≤", "<=")


def _misleading(row: dict[str, object]) -> bool:
    """The sampled upper bound on e(A, A_eps) is larger than e(A_eps, A), although witnesses shadow all of A."""
    sampled, forward, witnessed = row["excess_A_Aeps"]["upper"], row["excess_Aeps_A"]["lower"], row["witnessed_upper"]
    return None not in (sampled, forward, witnessed) and sampled > forward


def _status(rows: list[dict[str, object]]) -> str:
    counts = {status.value: sum(row["verdict"] == status.value for row in rows) for status in VerdictStatus}
    said = ", ".join(f"{number} {label}" for label, number in counts.items() if number)
    return f"Theorem 1 at {len(rows)} states: {said}."
