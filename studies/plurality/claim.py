"""Do velocity jumps without collision survive h -> 0, and is the limit plural? Glocker's rod and the jam law.

Claims. The Contact Dynamics scheme (L. Paoli, IFIP AICT 494 (2016), section 2) follows a rod that slides into its
Génot-Brogliato point. A step size either jams there (a jump of the velocity without collision) or lifts off.
1. For the rod of C. Glocker, Dynamik von Starrkörpersystemen mit Reibung und Stössen (1995), 5.3.4, both happen in
   every decade of step sizes from 1e-2 to 1e-7, and the times of the jumps tend to that of the exact slip. A narrow
   window of step sizes holds a part of a period of the phase that decides: its fraction is no probability.
2. With r the ratio of the eigenvalues at the point, the fraction that jams tends to 1/(1 + r) under the paper's contact
   test g >= 0 for r < 1, to 1 - r where the tip is kept on the floor, and to 0 for r >= 1; nothing else of the slip
   matters. Derived in painleve.core.jam_map (first order in h near the point), measured here.
3. At finite h the fraction, over step sizes and starts, is that of a local map with one number
   d ~ h^((1-r)/(1+r)). Over the step sizes of one start alone it scatters about that by some hundredths.
4. At states with gamma < 0, known to eps, the fraction that jumps within 1.6 sqrt(h) s is a function of eps/h as
   h -> 0. Where the free normal acceleration beta is negative (inconsistent) everything jumps that comes to the floor,
   all of it in that time up to eps/h = 1.6^2 |beta|/2 = 12.5/s; where beta is positive (indeterminate) nothing jumps
   up to eps/h = 3/s; for larger eps/h both ends of A are approached. Measured.
5. Which limit other schemes and the compliant contact choose there. Measured.

Command:  painleve study plurality [--quick]
Expected: fractions of both outcomes in each decade; fractions that agree with the map (chi-square about one a degree
          of freedom, under both contact tests), and tend to the law.
Time:     about five minutes, with --quick half a minute.
Files:    outcomes over the step size and the jam law: HDF5, PDF and PNG.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.stats import chi2
from tqdm import tqdm

from painleve.dynamics.genot_brogliato import find_friction, singular_point
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw, save_figure
from painleve.plotting.style import labels_of
from painleve.store import check_writable, save
from studies.plurality.figures import DRAWINGS
from studies.plurality.initial_layer import sweep_initial_layer
from studies.plurality.jam_law import JamCase, measure_jam_law
from studies.plurality.scheme_choice import SchemeRun, sweep_schemes
from studies.plurality.step_sizes import StepWindow, sweep_step_sizes
from studies.study import StudyResult

PARADOX = {"inconsistent": "0", "indeterminate": "6"}  # omega (rad/s) of the state `paradox`: beta < 0, beta > 0
SCHEMES = ("contact_dynamics", "moreau_jean", "stewart_trinkle", "anitescu_potra", "schatzman_paoli")
LAYER = 0.05  # s: how long the schemes are followed at these states
AFTER = 0.86  # s: and on Glocker's rod
UNTIL = 1.0  # s: Glocker's rod reaches the point at 0.81 s
COUNTS = {1e-3: 4000, 1e-4: 4000, 1e-5: 1200, 1e-6: 400, 1e-7: 200}  # step sizes in the decade from the key on
NARROW = np.linspace(0.95e-3, 1.05e-3, 12)  # where narrow windows begin
NARROW_DECADES = 0.003
RATIOS = (0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.2, 1.6)
DRIFTS = (0.03, 0.1, 0.3, 1.0)
FEW = 3000  # step sizes where the map is drawn over d or h


def run(output: Path, *, quick: bool = False, seed: int = 0) -> StudyResult:
    """Measure, draw and tabulate; `output` is an existing folder."""
    check_writable(output / "jam_law.h5")
    windows, cases = list(_windows(quick=quick)), list(_cases(quick=quick))
    state = make_state(load_scene("slender_rod"), "stoss")
    paradoxes = {
        label: make_state(load_scene("slender_rod"), "paradox", keys={"omega": omega})
        for label, omega in PARADOX.items()
    }
    runs = list(_runs(quick=quick))
    layer = {
        "steps": (1e-3, 1e-5) if quick else (1e-3, 1e-4, 1e-5),
        "ratios": np.logspace(-1, 3, 5 if quick else 9),
        "count": 100 if quick else 400,
    }
    followed = [(label, s, LAYER) for label, s in paradoxes.items()] + [("stoss", state, AFTER)]
    total = 2 * len(windows) + len(cases) + 2 * len(layer["steps"]) * len(layer["ratios"]) + 3 * len(runs)
    with tqdm(total=total, leave=False, disable=None, file=sys.stderr, unit="ensemble") as bar:
        step_sizes = sweep_step_sizes(state, windows, until=UNTIL, seed=seed, progress=bar.update)
        jam_law = measure_jam_law(cases, seed=seed, progress=bar.update)
        layers = sweep_initial_layer(paradoxes, **layer, seed=seed, progress=bar.update)
        choices = sweep_schemes(followed, runs, progress=bar.update)
    drawn = {"step_sizes": step_sizes, "jam_law": jam_law, "initial_layer": layers}
    files = [path for stem, dataset in drawn.items() for path in _keep(dataset, output, stem)]
    files.append(save(choices, output / "scheme_choice.h5"))
    decades, laws, fits = list(_decade_rows(step_sizes)), list(_law_rows(jam_law)), _fits(jam_law)
    table = "\n\n".join(
        [
            _glocker_table(step_sizes, decades),
            _law_table(laws),
            _fit_text(fits),
            _layer_table(layers),
            _choice_table(choices),
        ]
    )
    data = {
        "choices": _choice_rows(choices),
        "layer": _layer_rows(layers),
        "instant": float(step_sizes["instant"]),
        "decades": decades,
        "cases": laws,
        "fits": fits,
    }
    return StudyResult(table=table, files=tuple(files), data=data, status=_status(decades, fits))


def _windows(*, quick: bool) -> Iterator[StepWindow]:
    for step, count in COUNTS.items():
        if not quick or step >= 1e-5:
            yield StepWindow(step=step, decades=1.0, count=count // 10 if quick else count)
    for step in NARROW[:: 6 if quick else 1]:
        yield StepWindow(step=float(step), decades=NARROW_DECADES, count=100 if quick else 1000)


def _cases(*, quick: bool) -> Iterator[JamCase]:
    """Five groups: the law over r, the map over d, other rods and starts, one slip as h falls, for r < 1 and r > 1."""
    least, many, few = (1e-6, 1500, 500) if quick else (1e-7, 10_000, FEW)
    for r in RATIOS[:: 3 if quick else 1]:
        yield _strict("ratio", r, least, 0.01, count=many)
        # For r > 1 the slip must not start where beta exceeds gravity; d is then no longer small, and does not matter.
        yield _kept("ratio", r, least, *((0.005, 300.0) if r < 1.0 else (0.1, 50.0)), count=many)
    for r in (0.2, 0.5, 0.8, 1.2):
        for d in DRIFTS[:: 2 if quick else 1]:
            if r < 1.0 or d < 1.0:  # at r = 1.2, d = 1 the slip lifts off thousands of x_* before the edge
                yield _strict("drift", r, 1e-6, d, count=few)
    for alpha, slip, length in ((1.0, -30.0, 40.0), (6.0, -30.0, 40.0), (3.0, -3.0, 40.0), (3.0, -30.0, 80.0)):
        yield _strict("invariance", 0.5, 1e-6, 0.1, alpha=alpha, slip=slip, length=length, count=many)
        yield _kept("invariance", 0.5, least, 0.005, 5.0 * length, alpha=alpha, slip=slip, count=many)
    for contact, steps in (("strict", (1e-5, 3e-6, 1e-6, 3e-7, 1e-7)), ("kept", (1e-4, 1e-5, 1e-6, 1e-7))):
        build = _strict if contact == "strict" else _kept
        amplitude = build("approach", 0.5, 1e-7, 0.01).amplitude
        for h in steps[: 3 if quick else None]:
            yield JamCase(group="approach", contact=contact, ratio=0.5, step=h, amplitude=amplitude, count=many)
    for r in (1.4, 2.0):
        amplitude = _strict("vanishing", r, 1e-7, 0.5).amplitude
        for h in (1e-5, 3e-6, 1e-6, 3e-7, 1e-7)[: 3 if quick else None]:
            yield JamCase(group="vanishing", contact="strict", ratio=r, step=h, amplitude=amplitude, count=few)


def _strict(group: str, ratio: float, step: float, drift: float, *, alpha: float = 3.0, **rest: float) -> JamCase:
    """The case of the strict test with this drift d at this step."""
    amplitude = singular_point(find_friction(ratio, alpha=alpha), alpha=alpha).amplitude_of(step, drift)
    return JamCase(
        group=group,
        contact="strict",
        ratio=ratio,
        step=step,
        amplitude=amplitude,
        alpha=alpha,
        **rest,  # type: ignore[arg-type]
    )


def _kept(
    group: str, ratio: float, step: float, drift: float, length: float = 100.0, *, alpha: float = 3.0, **rest: float
) -> JamCase:
    """The case with the tip kept on the floor that has this drift d at this step."""
    point = singular_point(find_friction(ratio, alpha=alpha), alpha=alpha)
    return JamCase(
        group=group,
        contact="kept",
        ratio=ratio,
        step=step,
        amplitude=point.kept_drift(step, 1.0) / drift,
        alpha=alpha,
        length=length,
        **rest,  # type: ignore[arg-type]
    )


def _runs(*, quick: bool) -> Iterator[SchemeRun]:
    """Each scheme at several steps, event-driven integration, and compliant contact with growing stiffness."""
    for scheme in SCHEMES:
        for h in (1e-3, 1e-4) if quick else (1e-3, 7e-4, 1e-4, 7e-5, 1e-5, 7e-6):
            yield SchemeRun(scheme=scheme, step=h)
    yield SchemeRun(scheme="event_driven", step=1e-3)
    for stiffness in (1e4, 1e6) if quick else (1e4, 1e6, 1e8, 1e10):
        yield SchemeRun(scheme="compliant", step=1e-3, stiffness=stiffness)


def _layer_rows(dataset: xr.Dataset) -> list[dict[str, object]]:
    """Every point of the initial layer."""
    rows = []
    for i, j, k in np.ndindex(*dataset["fraction"].shape):
        one = dataset.isel(state=i, step=j, ratio=k)
        names = ("step", "ratio", "fraction", "lower", "upper", "excess_from_A", "excess_of_A")
        rows.append({"state": str(one["state"].item()), **{name: float(one[name]) for name in names}})
    return rows


def _layer_table(dataset: xr.Dataset) -> str:
    """Fraction that jumps, over eps/h, at the least h."""
    h = float(dataset["step"].min())
    lines = [("state", "eps/h", "jump (95 % interval)", "e(right velocities, A) >=", "e(A, right velocities) <=")]
    for row in _layer_rows(dataset):
        if row["step"] == h:
            lines.append(
                (
                    str(row["state"]),
                    f"{row['ratio']:.3g}",
                    f"{row['fraction']:.3f} ({row['lower']:.3f}-{row['upper']:.3f})",
                    f"{row['excess_from_A']:.2e}",
                    f"{row['excess_of_A']:.2e}",
                )
            )
    return f"States with gamma < 0 known to eps, h = {h:g}, right velocity after 1.6 sqrt(h) s:\n" + _aligned(lines)


def _choice_rows(dataset: xr.Dataset) -> list[dict[str, object]]:
    """Every run of every scheme."""
    labels = labels_of(dataset["choice"])
    return [
        {
            "state": str(state),
            "run": str(run),
            "choice": str(labels[i, j]),
            "time": float(dataset["time"].values[i, j]),
        }
        for i, state in enumerate(dataset["state"].values)
        for j, run in enumerate(dataset["run"].values)
    ]


def _choice_table(dataset: xr.Dataset) -> str:
    """A row for each run, a column for each state."""
    labels, times = labels_of(dataset["choice"]), dataset["time"].values
    lines = [("scheme", *map(str, dataset["state"].values))]
    for j, run in enumerate(dataset["run"].values):
        lines.append((str(run), *(f"{labels[i, j]} {times[i, j]:.5f}" for i in range(len(labels)))))
    return "What happens first, and when (s):\n" + _aligned(lines)


def _keep(dataset: xr.Dataset, output: Path, stem: str) -> list[Path]:
    figure = draw(dataset, DRAWINGS)
    return [save(dataset, output / f"{stem}.h5")] + [
        save_figure(figure, output / f"{stem}.{s}") for s in ("pdf", "png")
    ]


def _decade_rows(dataset: xr.Dataset) -> Iterator[dict[str, object]]:
    """Each window and contact test: what the table of Glocker's rod says."""
    for i, contact in enumerate(labels_of(dataset["contact"])):
        for j, step in enumerate(dataset["first_step"].values):
            one = dataset.isel(contact=i, window=j)
            lateness = max(abs(float(one[name]) - float(one["instant"])) for name in ("first", "last"))
            yield {
                "contact": str(contact),
                "step": float(step),
                "decades": float(one["decades"]),
                "count": int(one["count"]),
                "fraction": float(one["fraction"]),
                "interval": [float(one["lower"]), float(one["upper"])],
                "map": float(one["local_map"]),
                "median_delay": float(one["median"]) - float(one["instant"]),
                "largest_delay": lateness,
            }


def _glocker_table(dataset: xr.Dataset, rows: list[dict[str, object]]) -> str:
    lines = [("contact", "steps from", "to", "count", "jump (95 % interval)", "local map", "largest |t - t*|")]
    for row in rows:
        if row["decades"] != 1.0:
            continue
        low, high = row["interval"]
        lines.append(
            (
                str(row["contact"]),
                f"{row['step']:.0e}",
                f"{10 * row['step']:.0e}",
                str(row["count"]),
                f"{row['fraction']:.3f} ({low:.3f}-{high:.3f})",
                f"{row['map']:.3f}",
                f"{row['largest_delay']:.1e}",
            )
        )
    narrow = [r for r in rows if r["decades"] != 1.0 and r["contact"] == "strict"]
    span = [min(r["fraction"] for r in narrow), max(r["fraction"] for r in narrow)]
    head = (
        f"Glocker's rod: r = {float(dataset['ratio']):.4f}; the exact slip reaches the point at t* = "
        f"{float(dataset['instant']):.8f} s (event-driven).\n"
        f"In {len(narrow)} narrow windows near h = 1e-3 the fraction runs from {span[0]:.2f} to {span[1]:.2f}."
    )
    return head + "\n" + _aligned(lines)


def _law_rows(dataset: xr.Dataset) -> Iterator[dict[str, object]]:
    contacts = labels_of(dataset["contact"])
    for i in range(dataset.sizes["case"]):
        one = dataset.isel(case=i)
        names = (
            "ratio",
            "alpha",
            "slip",
            "step",
            "drift",
            "neglected",
            "law",
            "local_map",
            "fraction",
            "lower",
            "upper",
            "count",
            "others",
        )
        yield {"group": str(one["group"].item()), "contact": str(contacts[i]), **{n: float(one[n]) for n in names}}


def _law_table(rows: list[dict[str, object]]) -> str:
    lines = [
        ("tests", "contact", "r", "alpha", "slip", "h", "d", "beta/c", "count", "jam (95 % interval)", "map", "law")
    ]
    for row in rows:
        lines.append(
            (
                str(row["group"]),
                str(row["contact"]),
                f"{row['ratio']:.2f}",
                f"{row['alpha']:g}",
                f"{row['slip']:g}",
                f"{row['step']:.0e}",
                f"{row['drift']:.3f}",
                f"{row['neglected']:.0e}",
                f"{row['count']:.0f}",
                f"{row['fraction']:.4f} ({row['lower']:.4f}-{row['upper']:.4f})",
                f"{row['local_map']:.4f}",
                f"{row['law']:.4f}",
            )
        )
    head = (
        "The jam law. Derived: `law` (limit h -> 0) and `map` (finite h, without terms of relative size beta/c).\n"
        "Measured: `jam`, over step sizes and starts, with a 95 % interval from the scatter between starts."
    )
    return head + "\n" + _aligned(lines)


def _fits(dataset: xr.Dataset) -> dict[str, dict[str, float]]:
    """How well the map fits: chi-square over all cases where it is neither 0 nor 1, by contact test."""
    found = {}
    for contact in ("strict", "kept"):
        one = dataset.isel(case=np.flatnonzero(labels_of(dataset["contact"]) == contact))
        p, n, f = (one[name].values for name in ("local_map", "effective_count", "fraction"))
        inside = (p > 0.0) & (p < 1.0)
        residual = (f - p)[inside]
        square = float((residual**2 * n[inside] / (p * (1.0 - p))[inside]).sum())
        found[contact] = {
            "chi_square": square,
            "degrees": int(inside.sum()),
            "p_value": float(chi2.sf(square, inside.sum())),
            "largest_residual": float(np.abs(residual).max()),
            "jams_where_the_map_has_none": int(np.round((f * one["count"].values)[p == 0.0]).sum()),
        }
    found["approach"] = {
        f"{c} {name}": _power(dataset, c, name) for c in ("strict", "kept") for name in ("fraction", "local_map")
    }
    return found


def _power(dataset: xr.Dataset, contact: str, name: str) -> float:
    """The fitted power of h with which a fraction comes to the limit law on one slip; NaN where too few differ."""
    chosen = (dataset["group"].values == "approach") & (labels_of(dataset["contact"]) == contact)
    one = dataset.isel(case=np.flatnonzero(chosen))
    gap = np.abs(one["law"].values - one[name].values)
    seen = gap > (one["upper"].values - one["lower"].values)  # twice the interval's half width
    if seen.sum() < 2:
        return float("nan")
    return float(np.polyfit(np.log(one["step"].values[seen]), np.log(gap[seen]), 1)[0])


def _fit_text(fits: dict[str, dict[str, float]]) -> str:
    lines = ["Goodness of fit, measured fractions against the local map:"]
    for contact in ("strict", "kept"):
        fit = fits[contact]
        lines.append(
            f"  {contact}: chi-square {fit['chi_square']:.1f} on {fit['degrees']} degrees of freedom, "
            f"p = {fit['p_value']:.2g}; largest residual {fit['largest_residual']:.3f}; where the map has no jam, "
            f"{fit['jams_where_the_map_has_none']} were seen."
        )
    power = fits["approach"]
    lines.append(
        "Approach to the limit at r = 0.5, fitted powers of h, measured and (by the map): "
        f"strict {power['strict fraction']:.2f} ({power['strict local_map']:.2f}; 1/3 derived for h -> 0), "
        f"kept {power['kept fraction']:.2f} ({power['kept local_map']:.2f}; 1/2 derived for h -> 0)."
    )
    return "\n".join(lines)


def _aligned(lines: list[tuple[str, ...]]) -> str:
    widths = [max(len(line[j]) for line in lines) for j in range(len(lines[0]))]
    text = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]
    return "\n".join([text[0], "  ".join("-" * width for width in widths), *text[1:]])


def _status(decades: list[dict[str, object]], fits: dict[str, dict[str, float]]) -> str:
    wide = [row for row in decades if row["decades"] == 1.0 and row["contact"] == "strict"]
    plural = sum(0.0 < row["fraction"] < 1.0 for row in wide)
    return (
        f"Both outcomes in {plural} of {len(wide)} decades of step sizes; the map is within "
        f"{fits['strict']['largest_residual']:.3f} (strict) and {fits['kept']['largest_residual']:.3f} (kept)."
    )
