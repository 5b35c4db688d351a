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

    def as_dict(self) -> dict[str, object]:
        return {"time": self.time, "kind": self.kind.label, "gamma": self.gamma}


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectory:
    """Instants t (n,), coordinates q and velocities u (n, d), and what the contact did up to each instant.

    Row i of the impulses r (n, 1 + k), (r_n, r_t) or in space (r_n, r_t1, r_t2), of `branch` and of `change` belongs to
    the step that ends at t[i]; row 0 is the start and holds zeros. r multiplies -grad g and the scene's own tangents H,
    so that the momentum changes by W r (without friction r_t = 0). `lag`: the law is taken at
    q[i] - lag (t[i] - t[i-1]) u[i]. `ending` says how the trajectory ended, `detail` what is particular to this one;
    `proposition1` holds margins where they were asked for.
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
    proposition1: Proposition1 | None = None

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
        """Work of the contact impulses since the start (n,): r . (u- + u+)/2, summed over the steps, u+ - u- = M^-1 r.

        Of a jump it is the change of the kinetic energy; of a force that lasts over a recorded step it is an estimate
        of first order in that step. It is negative where the contact takes energy.
        """
        motion, h = self.start.motion, np.diff(self.t, prepend=self.t[:1])
        rows, _, _ = self.start.tabulate(self.t, self.q - self.lag * h[:, None] * self.u, self.u)
        impulse, response = (_combined(self.r, columns(motion, rows)) for columns in (directions, responses))
        return np.cumsum((impulse * (self.u - response / 2.0)).sum(axis=1))

    def as_dict(self) -> dict[str, object]:
        """Facts for machines; q and u are in the order of `coordinates`."""
        margins = self.proposition1
        return {
            "status": self.ending.label,
            "ending": self.sentence,
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
            columns = {**arrays, **self.contact_quantities(), "contact_work": self.contact_work()}
            facts = {"scheme": self.scheme, "status": self.ending.label, "ending": self.sentence}
            margins = self.proposition1.attributes() if self.proposition1 else {}
            return record(self.start, columns, facts | margins)

    def plot(self) -> Any:
        """The figure (matplotlib) of the trajectory; a notebook shows it, `painleve.save_figure` keeps it."""
        return figure_of(self)


def _combined(r: np.ndarray, columns: list[np.ndarray]) -> np.ndarray:
    """The sum of r[:, k] columns[k] (n, d); without friction r has a column of zeros more."""
    total = r[:, :1] * columns[0]
    for k, column in enumerate(columns[1:], 1):
        total += r[:, k : k + 1] * column
    return total
