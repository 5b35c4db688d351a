"""The jam law tested: rods on slips into their Génot-Brogliato point, thousands of step sizes each.

The law is about a uniform phase of the last hops (or steps). One start does not give it, however many step sizes are
tried: hops far out last a few steps, whole numbers of them, and as h varies over a window the phases that arrive bunch.
So the starts vary too, and errors are judged by the scatter between starts: step sizes of one start are no independent
trials.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from painleve.core.jam_map import jam_fraction, limit_law
from painleve.core.motion_codes import MemberOutcome
from painleve.dynamics.ensemble import Ensemble, run_ensemble, wilson_interval
from painleve.dynamics.genot_brogliato import SingularPoint, find_friction, singular_point
from painleve.kernels.motion.compiled import make_motion
from painleve.mechanics.library import load_scene
from painleve.store import provenance
from painleve.sweep.variables import coded

__all__ = ["CONTACTS", "JamCase", "measure_jam_law"]

CONTACTS = ("strict", "kept")
KEPT_TOLERANCE = 1e-3  # m: far above what the tip rises on these short slips
PERIODS = 0.4  # how much the number of hops or steps varies over the window of step sizes, relative
STARTS = 100  # of a case
SPREAD = 0.2  # of the distances of these starts, relative, to either side
LONGEST = 8.0  # times the duration of the slip at its first rate: longer than the last hop
EXPECTED = (MemberOutcome.JUMP, MemberOutcome.LIFT_OFF, MemberOutcome.SLIDE)


@dataclass(frozen=True, kw_only=True)
class Fraction:
    """The fraction of `count` members that jam, worth as much as `effective` independent ones; `others`: see below."""

    value: float
    count: int
    effective: float
    others: int

    @staticmethod
    def of(ensembles: Sequence[Ensemble]) -> Fraction:
        """From ensembles of equal size, each with its start: the scatter between them over that of independent trials
        is the design effect (L. Kish, Survey Sampling, 1965) by which the count is divided."""
        each, n = np.array([e.fraction(MemberOutcome.JUMP) for e in ensembles]), ensembles[0].count
        value, count = float(each.mean()), n * len(each)
        binomial = value * (1.0 - value) / n
        effect = max(1.0, float(each.var(ddof=1)) / binomial) if binomial > 0.0 else 1.0
        others = sum(e.count - sum(e.counts[o] for o in EXPECTED) for e in ensembles)
        return Fraction(value=value, count=count, effective=count / effect, others=others)

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's 95 % interval with the effective number of trials."""
        return wilson_interval(self.value, self.effective)


@dataclass(frozen=True, kw_only=True)
class JamCase:
    """A slip and a step size: ratio r, alpha = m l^2/I, slip speed (m/s, < 0), h (s), amplitude K, contact test.

    `length` is how far out the slips start, in hops (strict) or steps (kept), in the middle; `count` members are run.
    """

    group: str
    contact: str
    ratio: float
    step: float
    amplitude: float
    alpha: float = 3.0
    slip: float = -30.0
    length: float = 40.0
    count: int = 10_000

    @property
    def strict(self) -> bool:
        return self.contact == "strict"

    @property
    def point(self) -> SingularPoint:
        return singular_point(find_friction(self.ratio, alpha=self.alpha), alpha=self.alpha)

    @property
    def drift(self) -> float:
        """d of the local map on the slip as it arrives at the point."""
        point = self.point
        chosen = point.strict_drift if self.strict else point.kept_drift
        return chosen(self.step, point.amplitude_at_point(self.distance, self.amplitude))

    @property
    def neglected(self) -> float:
        """|beta|/c at the last contacts: the size of what the local map leaves out."""
        point = self.point
        x = point.strict_scale(self.step, self.amplitude) if self.strict else self.step * point.omega
        return self.amplitude * x**self.ratio / point.curvature

    @property
    def distance(self) -> float:
        """Where the slips start (rad before the edge), in the middle."""
        point = self.point
        if not self.strict:
            return self.length * self.step * point.omega
        least = 1.0
        if self.ratio > 1.0:
            drift = point.strict_drift(self.step, self.amplitude)
            least = max(1.0, 2.0 * (drift / (self.ratio - 1.0)) ** (1.0 / (self.ratio - 1.0)))
        x = least * point.strict_scale(self.step, self.amplitude)
        while point.hops(x, self.amplitude, self.step) < self.length:
            x *= 1.02
        return x

    @property
    def window(self) -> float:
        """Relative half width of the step sizes: the phase at the edge then runs over a whole number of periods."""
        n = self.point.hops(self.distance, self.amplitude, self.step) if self.strict else self.length
        m = max(1.0, round(PERIODS * n))
        return (math.sqrt(n * n + m * m) - n) / m  # n/(1 - w) - n/(1 + w) = m

    def run(self, seed: int) -> Fraction:
        """How often this case jams. Raises InputError where there is no such slip."""
        point, middle, window = self.point, self.distance, self.window
        within = np.random.default_rng(seed).random(STARTS)
        ensembles = []
        for j, distance in enumerate(middle * (1.0 + SPREAD * (2.0 * (np.arange(STARTS) + within) / STARTS - 1.0))):
            start = point.start(distance=float(distance), amplitude=self.amplitude, slip=self.slip)
            ensembles.append(
                run_ensemble(
                    start,
                    step=self.step,
                    count=-(-self.count // STARTS),
                    until=LONGEST * distance / point.omega,
                    seed=STARTS * seed + j,
                    window=window,
                    contact_tolerance=0.0 if self.strict else KEPT_TOLERANCE,
                )
            )
        return Fraction.of(ensembles)


def measure_jam_law(
    cases: Sequence[JamCase],
    *,
    seed: int = 0,
    progress: Callable[[int], None] | None = None,
    command: str | None = None,
) -> xr.Dataset:
    """Fractions that jam over step sizes and starts, with 95 % intervals, beside the limit law and the map; (case,).

    A jam is a jump at a tangential contact. A member that has not jammed long after the edge has opened (beta > 0 from
    there on), whether or not the tip has left fast enough to be called lift-off. What else happens counts as `others`.
    """
    fractions = []
    for i, case in enumerate(cases):
        fractions.append(case.run(seed + i))
        if progress is not None:
            progress(1)
    intervals = np.array([f.interval for f in fractions])
    predictions = [jam_fraction(c.ratio, c.drift, strict=c.strict) for c in cases]
    values = {
        "ratio": ([c.ratio for c in cases], "ratio r of the eigenvalues at the singular point", "1"),
        "alpha": ([c.alpha for c in cases], "shape of the rod, m l^2/I", "1"),
        "mu": ([c.point.mu for c in cases], "coefficient of friction", "1"),
        "slip": ([c.slip for c in cases], "slip velocity at the start", "m/s"),
        "step": ([c.step for c in cases], "middle of the window of step sizes", "s"),
        "window": ([c.window for c in cases], "relative half width of the window of step sizes", "1"),
        "amplitude": (
            [c.amplitude for c in cases],
            "amplitude K of the slip, beta = -K x^r - D x/(1 - r)",
            "m/(s^2 rad^r)",
        ),
        "distance": ([c.distance for c in cases], "distance of the starts from the edge, in the middle", "rad"),
        "drift": ([c.drift for c in cases], "drift d of the local map at this step size", "1"),
        "neglected": ([c.neglected for c in cases], "what the map leaves out: beta/c at the last contacts", "1"),
        "law": ([limit_law(c.ratio, strict=c.strict) for c in cases], "limit of the fraction as h tends to 0", "1"),
        "local_map": (predictions, "the local map's fraction", "1"),
        "fraction": ([f.value for f in fractions], "measured fraction of step sizes and starts that jam", "1"),
        "lower": (intervals[:, 0], "lower end of the 95 % interval for the fraction", "1"),
        "upper": (intervals[:, 1], "upper end of the 95 % interval for the fraction", "1"),
        "count": ([f.count for f in fractions], "number of members, each with its step size", "1"),
        "effective_count": ([f.effective for f in fractions], "independent members worth as much", "1"),
        "others": ([f.others for f in fractions], "members that neither jam nor open the contact", "1"),
    }
    variables: dict[str, xr.Variable] = {
        name: xr.Variable(("case",), np.asarray(column), {"long_name": sentence, "units": unit})
        for name, (column, sentence, unit) in values.items()
    }
    codes = np.array([1 + CONTACTS.index(c.contact) for c in cases])
    variables["contact"] = coded(["case"], codes, CONTACTS, "contact test: strict g >= 0, or tip kept on the floor")
    groups = np.array([c.group for c in cases], dtype=object)
    variables["group"] = xr.Variable(("case",), groups, {"long_name": "what the case tests", "units": "1"})
    scene = load_scene("slender_rod")
    source = provenance(scene=scene, scene_digest=make_motion(scene).digest, seed=seed, command=command)
    title = "The jam law: which step sizes jam at a Génot-Brogliato point"
    return xr.Dataset(variables, attrs={"title": title, "kind": "jam_law", **source})
