"""A trajectory and what can be read off it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from painleve.core.motion_codes import Change, Ending
from painleve.dynamics.contact_rows import directions, gamma_along, responses, tangential_names
from painleve.dynamics.hops import HOPS, force_over_hops, free_steps_of_hops
from painleve.dynamics.outline import start_notes
from painleve.dynamics.proposition1 import Proposition1
from painleve.dynamics.record import record
from painleve.dynamics.start import Start
from painleve.figures import figure_of

__all__ = ["Jump", "Trajectory"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Jump:
    """A jump of the velocity at a contact: when, of which kind, u- and u+ (d,), and gamma there.

    For a stepping scheme u- is the free velocity v of the step, from which the law started.
    """

    index: int
    time: float
    kind: Change
    gamma: float
    u_minus: np.ndarray
    u_plus: np.ndarray

    def __repr__(self) -> str:
        return f"Jump({self.kind.label} at t = {self.time:.6g} s, gamma = {self.gamma:.3g})"

    def as_dict(self) -> dict[str, object]:
        return {"time": self.time, "kind": self.kind.label, "gamma": self.gamma}


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectory:
    """Instants t (n,), coordinates q and velocities u (n, d), and what the contact did up to each instant.

    Row i of the impulses r (n, 1 + k), (r_n, r_t) or in space (r_n, r_t1, r_t2), of `branch` and of `change` belongs to
    the step that ends at t[i]; row 0 is the start and holds zeros. r multiplies -grad g and the scene's own tangents H,
    so that the momentum changes by W r (without friction r_t = 0). `lag`: the law is taken at
    q[i] - lag (t[i] - t[i-1]) u[i]. `integrated`: by an adaptive integrator, whose contact forces last over the
    recorded intervals; an impulse has two rows at one instant. `ending` says how the trajectory ended, `detail` what is
    particular to this one; `proposition1` holds margins where they were asked for.
    """

    scheme: str
    start: Start
    settings: Mapping[str, object]
    t: np.ndarray
    q: np.ndarray
    u: np.ndarray
    r: np.ndarray
    branch: np.ndarray
    change: np.ndarray
    lag: float
    ending: Ending
    detail: str = ""
    statistics: Mapping[str, int]
    integrated: bool = False
    proposition1: Proposition1 | None = None

    def __repr__(self) -> str:
        jumps = int((self.change != Change.ORDINARY).sum())
        what = f"{self.steps} steps to t = {self.t[-1]:.6g} s, {jumps} jump{'' if jumps == 1 else 's'}"
        name = f"{self.start.scene.name!r}, {self.start.label!r}, {self.scheme}"
        return f"Trajectory({name}: {what}; {self.ending.label})"

    @property
    def steps(self) -> int:
        return len(self.t) - 1

    @property
    def sentence(self) -> str:
        """How the trajectory ended."""
        return self.ending.sentence + (f" ({self.detail})" if self.detail else "")

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """Every jump of the velocity, in order."""
        motion, p = self.start.motion, self.start.p
        found = []
        for i in np.flatnonzero(self.change):
            at = self.q[i] - self.lag * (self.t[i] - self.t[i - 1]) * self.u[i]
            rows = np.array([motion.rows_at(tuple(at), p)])
            response = _combined(self.r[i : i + 1], responses(motion, rows))[0]
            found.append(
                Jump(
                    index=int(i),
                    time=float(self.t[i]),
                    kind=Change(self.change[i]),
                    gamma=float(gamma_along(motion, rows)[0]),
                    u_minus=self.u[i] - response,
                    u_plus=self.u[i].copy(),
                )
            )
        return tuple(found)

    def contact_quantities(self) -> dict[str, np.ndarray]:
        """g, gamma, v_n, v_t (in space v_t1 and v_t2; 0 without friction) and the kinetic energy at every instant."""
        motion = self.start.motion
        rows, M, _ = self.start.tabulate(self.t, self.q, self.u)
        velocities = [(column * self.u).sum(axis=1) for column in directions(motion, rows)]
        tangential = velocities[1:] or [np.zeros(len(self.t))]
        return {
            "g": rows[:, 0],
            "gamma": gamma_along(motion, rows),
            "v_n": velocities[0],
            **{f"v_{side}": v for side, v in zip(tangential_names(motion), tangential, strict=True)},
            "kinetic_energy": np.einsum("ni,nij,nj->n", self.u, M, self.u) / 2.0,
        }

    def contact_work(self) -> np.ndarray:
        """Work of the contact since the start (n,), negative where it takes energy: the law's own dissipation.

        A jump has r . W^T (u- + u+)/2, the change of the kinetic energy. A force that lasts over a step has r . W^T u+,
        which is <u_{i+1}, r> of Proposition 1: zero where the tip sticks, and friction times slip else. Of an
        integrator's forces it is the trapezoidal rule over the recorded intervals.
        """
        return self._works[0]

    def splitting_loss(self) -> np.ndarray:
        """What the scheme loses at the contact since the start (n,): minus r . G r/2 of every force that lasts.

        A step first gives the force's velocity to the body, and the law then takes from it what the contact does not
        admit: with the work of the contact this is the change of the kinetic energy by the law, u+ for u-. Where the
        motion is smooth it vanishes like h (docs/theory.md, section 7.7): an error of the scheme, and no work.
        """
        return self._works[1]

    @cached_property
    def _works(self) -> tuple[np.ndarray, np.ndarray]:
        motion, h = self.start.motion, np.diff(self.t, prepend=self.t[:1])
        rows, _, _ = self.start.tabulate(self.t, self.q - self.lag * h[:, None] * self.u, self.u)
        columns, moved = directions(motion, rows), _combined(self.r, responses(motion, rows))
        velocities = np.stack([(column * self.u).sum(axis=1) for column in columns], axis=1)
        r = self.r[:, : len(columns)]
        if self.integrated:
            before = np.vstack([velocities[:1], velocities[:-1]])
            return np.cumsum((r * (before + velocities)).sum(axis=1) / 2.0), np.zeros(len(self.t))
        half, jumps = (_combined(self.r, columns) * moved).sum(axis=1) / 2.0, self.change != Change.ORDINARY
        work = (r * velocities).sum(axis=1) - np.where(jumps, half, 0.0)
        return np.cumsum(work), np.cumsum(np.where(jumps, 0.0, -half))

    def contact_force(self) -> np.ndarray:
        """The normal contact force (n,), averaged over the time since the contact before (painleve.dynamics.hops)."""
        if self.integrated:
            lasts = (self.change == Change.ORDINARY) & (np.diff(self.t, prepend=self.t[0]) > 0.0)
            force = np.full(len(self.t), np.nan)
            return np.divide(self.r[:, 0], np.diff(self.t, prepend=self.t[0]), out=force, where=lasts)
        touches = bool(self.start.rows[0] >= -self.start.rounding)
        return force_over_hops(self.t, self.r[:, 0], self.branch, self.change, touches)

    @property
    def notes(self) -> tuple[str, ...]:
        """What to know when these numbers are read: the start, the outline, and impulses that come in hops."""
        hopping = [HOPS.format(free=self.hops, steps=self.steps)] if self.hops else []
        return (*start_notes(self.start), *hopping)

    @property
    def hops(self) -> int:
        """Steps that a scheme spends off the floor between two contacts (painleve.dynamics.hops)."""
        return 0 if self.integrated else free_steps_of_hops(self.branch, self.change)

    def as_dict(self) -> dict[str, object]:
        """Facts for machines; q and u are in the order of `coordinates`."""
        margins = self.proposition1
        return {
            "status": self.ending.label,
            "ending": self.sentence,
            "notes": list(self.notes),
            "steps": self.steps,
            "jumps": [jump.as_dict() for jump in self.jumps],
            "coordinates": [c.name for c in self.start.scene.coordinates],
            "final": {"t": float(self.t[-1]), "q": self.q[-1].tolist(), "u": self.u[-1].tolist()},
            "proposition1": margins and margins.as_dict(),
            "proposition1_steps": margins and margins.steps(),
            "statistics": dict(self.statistics),
            "settings": dict(self.settings),
        }

    def to_xarray(self) -> xr.Dataset:
        """The trajectory with units and sentences, and the outline of the body where the scene has one."""
        arrays = {name: getattr(self, name) for name in ("t", "q", "u", "r", "branch", "change")}
        with np.errstate(over="ignore", invalid="ignore"):  # energies of a motion that all but leaves the numbers
            effort = {name: getattr(self, name)() for name in ("contact_work", "splitting_loss", "contact_force")}
            columns = {**arrays, **self.contact_quantities(), **effort}
            facts = {"scheme": self.scheme, "status": self.ending.label, "ending": self.sentence}
            facts |= {"notes": "; ".join(self.notes)} if self.notes else {}
            numbers: dict[str, str | float] = self.proposition1.attributes() if self.proposition1 else {}
            numbers |= {"steps_in_hops": self.hops}
            return record(self.start, columns, facts | numbers)

    def plot(self) -> Any:
        """The figure (matplotlib) of the trajectory; a notebook shows it, `painleve.save_figure` keeps it."""
        return figure_of(self)


def _combined(r: np.ndarray, columns: list[np.ndarray]) -> np.ndarray:
    """The sum of r[:, k] columns[k] (n, d); without friction r has a column of zeros more."""
    total = r[:, :1] * columns[0]
    for k, column in enumerate(columns[1:], 1):
        total += r[:, k : k + 1] * column
    return total
