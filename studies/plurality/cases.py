"""Which windows of step sizes, slips, rods and schemes the study runs."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from painleve.dynamics.genot_brogliato import find_friction, singular_point
from studies.plurality.jam_law import JamCase
from studies.plurality.scheme_choice import SchemeRun
from studies.plurality.step_sizes import StepWindow

__all__ = ["SCHEMES", "jam_cases", "scheme_runs", "windows"]

SCHEMES = ("contact_dynamics", "moreau_jean", "stewart_trinkle", "anitescu_potra", "schatzman_paoli")
COUNTS = {1e-3: 4000, 1e-4: 4000, 1e-5: 1200, 1e-6: 400, 1e-7: 200}  # step sizes in the decade from the key on
NARROW = np.linspace(0.95e-3, 1.05e-3, 12)  # where narrow windows begin
NARROW_DECADES = 0.003
RATIOS = (0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.2, 1.6)
DRIFTS = (0.03, 0.1, 0.3, 1.0)
FEW = 3000  # step sizes where the map is drawn over d or h


def windows(*, quick: bool) -> Iterator[StepWindow]:
    for step, count in COUNTS.items():
        if not quick or step >= 1e-5:
            yield StepWindow(step=step, decades=1.0, count=count // 10 if quick else count)
    for step in NARROW[:: 6 if quick else 1]:
        yield StepWindow(step=float(step), decades=NARROW_DECADES, count=100 if quick else 1000)


def jam_cases(*, quick: bool) -> Iterator[JamCase]:
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


def scheme_runs(*, quick: bool) -> Iterator[SchemeRun]:
    """Each scheme at several steps, event-driven integration, and compliant contact with growing stiffness."""
    for scheme in SCHEMES:
        for h in (1e-3, 1e-4) if quick else (1e-3, 7e-4, 1e-4, 7e-5, 1e-5, 7e-6):
            yield SchemeRun(scheme=scheme, step=h)
    yield SchemeRun(scheme="event_driven", step=1e-3)
    for stiffness in (1e4, 1e6) if quick else (1e4, 1e6, 1e8, 1e10):
        yield SchemeRun(scheme="compliant", step=1e-3, stiffness=stiffness)
