"""The least critical friction over a mechanism's range, where it is, and how much of the range is paradoxical.

(docs/theory.md, section 1.6.)
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from painleve.core.lattice import kronecker_block, kronecker_generators, kronecker_shifts
from painleve.errors import InputError
from painleve.exact.balls import ball
from painleve.exact.parse import exact_number
from painleve.kernels.contact_numbers import ContactNumbers, make_contact_numbers
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number
from painleve.sweep.configurations import Configurations, make_configurations
from painleve.sweep.friction_map import CHUNK, SENSES, frictions

__all__ = ["Least", "Scan", "Share", "scan_friction"]

STARTS = 48  # of the descent, the best of all points, for each sense of the slip
HALVINGS = 40  # of the steps, from a quarter of the range: the last ones are 1e-12 of it
MOST_STEPS = 400
TRIES = 4  # random directions beside the axes, each step
GROUPS = 16  # of points, whose scatter is the error of a share


@dataclass(frozen=True)
class Least:
    """An upper bound on the least critical friction of a sense of the slip: its value at a configuration."""

    upper: float
    at: Mapping[str, float]


@dataclass(frozen=True)
class Share:
    """Estimate of a share of the admitted range, and its standard error by the scatter of groups of points."""

    value: float
    error: float


@dataclass(frozen=True, eq=False)
class Scan:
    """What was found over the ranges; `least` by sense of the slip, None where no configuration has a critical one.

    `negative`: the share with gamma < 0 at the scene's own friction, by sense; `paradoxical`: in either. `admitted`:
    the share of the range that was looked at, without configurations in which another point is below the plane.
    """

    scene: Scene
    ranges: Mapping[str, tuple[float, float]]
    least: Mapping[str, Least | None]
    negative: Mapping[str, Share]
    paradoxical: Share
    admitted: Share
    points: int

    def __repr__(self) -> str:
        best, share = self.overall, self.paradoxical
        least = f"mu_c ≤ {best.upper:.6g}" if best else "no critical friction"
        found = f"{least}, paradoxical {share.value:.3g} ± {share.error:.1g}"
        return f"Scan({self.scene.name!r}, {self.points} points: {found})"

    @property
    def overall(self) -> Least | None:
        found = [x for x in self.least.values() if x is not None]
        return min(found, key=lambda x: x.upper, default=None)

    def as_dict(self) -> dict[str, object]:
        """For a program; a lower bound of the least critical friction is not computed, and null."""
        best = self.overall
        by_sense = {s: None if x is None else {"upper": x.upper, "at": dict(x.at)} for s, x in self.least.items()}
        return {
            "scene": self.scene.name,
            "mu_c": {"lower": None, "upper": best.upper if best else None},
            "at": dict(best.at) if best else None,
            "by_sense": by_sense,
            "share": {
                "gamma_negative": self.paradoxical.value,
                "error": self.paradoxical.error,
                "by_sense": {sense: {"value": x.value, "error": x.error} for sense, x in self.negative.items()},
            },
            "admitted": {"value": self.admitted.value, "error": self.admitted.error},
            "ranges": {name: list(ends) for name, ends in self.ranges.items()},
            "points": self.points,
        }


def scan_friction(
    scene: Scene,
    *,
    ranges: Mapping[str, tuple[Number, Number]] | None = None,
    state: str | None = None,
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
    points: int = 200_000,
    seed: int = 0,
    others_above: bool = True,
) -> Scan:
    """Search the ranges of the coordinates on which the critical friction depends.

    A mechanism's joints range between their limits, a joint without limits over a full turn; other scenes need their
    ranges given. The configuration is taken to be in contact: the plane is where the touching point is, so a height, or
    how far the base has got along the plane, does not enter. Points come from a Kronecker lattice by their index; the
    best ones are improved by a pattern search. So the value is an upper bound, attained at the configuration given. The
    shares are estimates, uniform in the coordinates.

    Raises InputError for a scene without friction, unknown names, empty ranges and ranges that are missing.
    """
    if not scene.contact.section.dimension:
        raise InputError(f"scene {scene.name}: a scan needs a scene with friction")
    if points < GROUPS:
        raise InputError(f"scan: {points} points are too few; take {GROUPS} at least")
    chosen = _ranges(scene, ranges or {}, keys or {})
    numbers = make_contact_numbers(scene)
    configurations = make_configurations(scene, list(chosen), state, keys=keys, parameters=parameters)
    search = _Descent(numbers, configurations, np.array(list(chosen.values())), others_above)
    sample = search.sample(points, seed)
    least = {sense: search.descend(sample, sense, seed, list(chosen)) for sense in SENSES}
    admitted = sample.admitted
    return Scan(
        scene=scene,
        ranges=chosen,
        least=least,
        negative={sense: _share(sample.negative[sense], admitted) for sense in SENSES},
        paradoxical=_share(sample.negative["plus"] | sample.negative["minus"], admitted),
        admitted=_share(admitted, np.ones_like(admitted)),
        points=points,
    )


def _ranges(
    scene: Scene, given: Mapping[str, tuple[Number, Number]], fixed: Mapping[str, Number]
) -> dict[str, tuple[float, float]]:
    """The names that vary and their ends; a mechanism's joints by their limits."""
    found: dict[str, tuple[float, float]] = {}
    if scene.tree is not None:
        free = {str(x) for x in scene.definitions.inputs([*scene.inertia, *scene.contact.tangents, *_normal(scene)])}
        for joint in scene.tree.mechanism.joints:
            if joint.name in free and joint.name not in fixed and joint.name not in given:
                found[joint.name] = _limits(scene, joint.name, joint.kind, joint.limits)
    for name, (low, high) in given.items():
        ends = [float(ball(exact_number(x, where=f"range of {name}"), bits=64).mid()) for x in (low, high)]
        found[name] = (ends[0], ends[1])
    if not found:
        known = ", ".join(k.name for k in scene.keys)
        raise InputError(f"scene {scene.name}: give the ranges of what varies, --range KEY=LOW,HIGH; keys: {known}")
    for name, (low, high) in found.items():
        if not low < high:
            raise InputError(f"scan: the range of {name}, {low:g} to {high:g}, is empty")
    return found


def _normal(scene: Scene) -> Sequence:
    return scene.contact.normal if scene.contact.normal is not None else [scene.contact.constraint]


def _limits(scene: Scene, name: str, kind: str, limits: tuple | None) -> tuple[float, float]:
    if limits is not None:
        low, high = (float(ball(end, bits=64).mid()) for end in limits)
        return low, high
    if kind == "revolute":
        return -math.pi, math.pi
    raise InputError(f"scene {scene.name}: joint {name} has no limits; give its range, --range {name}=LOW,HIGH")


@dataclass(frozen=True, eq=False)
class _Sample:
    x: np.ndarray
    critical: dict[str, np.ndarray]
    negative: dict[str, np.ndarray]
    admitted: np.ndarray


class _Descent:
    """The box of the ranges, as the cube [-1, 1]^s."""

    def __init__(
        self, numbers: ContactNumbers, configurations: Configurations, ends: np.ndarray, others_above: bool
    ) -> None:
        self.numbers, self.configurations, self.others_above = numbers, configurations, others_above
        self.middle, self.half = ends.mean(axis=1), np.ptp(ends, axis=1) / 2.0

    def evaluate(self, x: np.ndarray) -> _Sample:
        """At points x (n, s) of the cube."""
        q, _, p = self.configurations(list((self.middle + self.half * x).T))
        found = frictions(self.numbers, q, p, others_above=self.others_above)
        return _Sample(x, found.critical, found.negative, found.admitted)

    def sample(self, points: int, seed: int) -> _Sample:
        s = len(self.half)
        alphas, shifts = kronecker_generators(s), kronecker_shifts(seed, s)
        parts = []
        for start in range(0, points, CHUNK):
            x = np.empty((s, min(CHUNK, points - start)))
            kronecker_block(start, alphas, shifts, x)
            parts.append(self.evaluate(np.ascontiguousarray(x.T)))
        return _Sample(
            np.concatenate([part.x for part in parts]),
            {sense: np.concatenate([part.critical[sense] for part in parts]) for sense in SENSES},
            {sense: np.concatenate([part.negative[sense] for part in parts]) for sense in SENSES},
            np.concatenate([part.admitted for part in parts]),
        )

    def descend(self, sample: _Sample, sense: str, seed: int, names: Sequence[str]) -> Least | None:
        """Pattern search from the best points: along axes and random directions, half the step where none helps."""
        value = np.where(np.isfinite(sample.critical[sense]), sample.critical[sense], np.inf)
        order = np.argsort(value, kind="stable")[:STARTS]
        order = order[np.isfinite(value[order])]
        if not len(order):
            return None
        x, best, step = sample.x[order].copy(), value[order].copy(), np.full(len(order), 0.25)
        rng, s = np.random.default_rng(seed), len(self.half)
        for _ in range(MOST_STEPS):
            if np.max(step) <= 0.25 * 0.5**HALVINGS:
                break
            directions = np.concatenate([np.eye(s), -np.eye(s), rng.standard_normal((TRIES, s))])
            trial = np.clip(x[:, None, :] + step[:, None, None] * directions, -1.0, 1.0)
            found = self.evaluate(trial.reshape(-1, s)).critical[sense].reshape(len(x), -1)
            found = np.where(np.isfinite(found), found, np.inf)
            k = found.argmin(axis=1)
            rows = np.arange(len(x))
            better = found[rows, k] < best
            x[better], best[better] = trial[rows, k][better], found[rows, k][better]
            step = np.where(better, step, step / 2.0)
        i = int(np.argmin(best))
        place = self.middle + self.half * x[i]
        return Least(float(best[i]), dict(zip(names, map(float, place), strict=True)))


def _share(inside: np.ndarray, among: np.ndarray) -> Share:
    """The share, and the standard error of its mean over groups of consecutive points, each a lattice of its own."""
    found = np.array([part.sum() for part in np.array_split(inside & among, GROUPS)])
    looked = np.array([part.sum() for part in np.array_split(among, GROUPS)])
    if not looked.any():
        return Share(math.nan, math.nan)
    shares = found[looked > 0] / looked[looked > 0]
    error = shares.std(ddof=1) / math.sqrt(len(shares)) if len(shares) > 1 else math.nan
    return Share(float(found.sum() / looked.sum()), float(error))
