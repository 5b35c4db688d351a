"""A trajectory and what can be read off it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr

from painleve.core.codes import Branch
from painleve.core.motion_codes import Change, Ending
from painleve.dynamics.proposition1 import Proposition1
from painleve.dynamics.start import Start

__all__ = ["Jump", "Trajectory"]

PER_STATE = {
    "g": ("constraint g(q), admissible where negative", "1"),
    "gamma": ("gamma(q): negative where the law is discontinuous at a tangential contact", "1"),
    "v_n": ("normal velocity of the contact point, w_n . u", "1"),
    "v_t": ("tangential velocity of the contact point, H . u", "1"),
    "kinetic_energy": ("kinetic energy u . M u / 2", "J"),
}


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

    Row i of the impulses r (n, 2), (r_n, r_t), of `branch` and of `change` belongs to the step that ends at t[i]; row 0
    is the start and holds zeros. `lag`: the law is taken at q[i] - lag (t[i] - t[i-1]) u[i]. `ending` says how the
    trajectory ended, `detail` what is particular to this one; `proposition1` holds margins where they were asked for.
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
        d, planar = self.start.scene.dimension, motion.planar
        found = []
        for i in np.flatnonzero(self.change):
            at = self.q[i] - self.lag * (self.t[i] - self.t[i - 1]) * self.u[i]
            rows = motion.rows_at(tuple(at), p)
            response = self.r[i, 0] * np.array(rows[1 + d : 1 + 2 * d])
            if planar:
                response += self.r[i, 1] * np.array(rows[3 + 3 * d : 3 + 4 * d])
            found.append(Jump(
                index=int(i), time=float(self.t[i]), kind=Change(self.change[i]), gamma=gamma_of(rows, d, planar),
                u_minus=self.u[i] - response, u_plus=self.u[i].copy(),
            ))  # fmt: skip
        return tuple(found)

    def contact_quantities(self) -> dict[str, np.ndarray]:
        """g, gamma, v_n, v_t and the kinetic energy at every instant."""
        d, planar = self.start.scene.dimension, self.start.motion.planar
        rows, M, _ = self.start.tabulate(self.t, self.q, self.u)
        normal = rows[:, 1 : 1 + d]
        edge = np.minimum(rows[:, 2 + 2 * d], rows[:, 5 + 4 * d]) if planar else rows[:, 1 + 2 * d]
        tangent = rows[:, 3 + 2 * d : 3 + 3 * d] if planar else np.zeros_like(normal)
        energy = np.einsum("ni,nij,nj->n", self.u, M, self.u) / 2.0
        values = (rows[:, 0], edge / (normal**2).sum(axis=1), (normal * self.u).sum(axis=1),
                  (tangent * self.u).sum(axis=1), energy)  # fmt: skip
        return dict(zip(PER_STATE, values, strict=True))

    def as_dict(self) -> dict[str, object]:
        names = [c.name for c in self.start.scene.coordinates]
        return {
            "status": self.ending.label,
            "ending": self.sentence,
            "steps": self.steps,
            "jumps": [jump.as_dict() for jump in self.jumps],
            "final": {
                "t": float(self.t[-1]),
                "q": dict(zip(names, map(float, self.q[-1]), strict=True)),
                "u": dict(zip(names, map(float, self.u[-1]), strict=True)),
            },
            "proposition1": None if self.proposition1 is None else self.proposition1.as_dict(),
            "statistics": dict(self.statistics),
            "settings": dict(self.settings),
        }

    def to_xarray(self) -> xr.Dataset:
        """The trajectory with units and sentences; one variable a coordinate, since their units differ."""
        scene = self.start.scene
        data: dict[str, tuple[str, np.ndarray, dict[str, object]]] = {}
        for j, c in enumerate(scene.coordinates):
            rate = "1/s" if c.unit == "1" else f"{c.unit}/s"
            data[c.name] = ("time", self.q[:, j], {"units": c.unit, "long_name": c.sentence})
            data[f"u_{c.name}"] = ("time", self.u[:, j], {"units": rate, "long_name": f"velocity of: {c.sentence}"})
        for j, side in enumerate(("normal", "tangential")):
            sentence = f"{side} contact impulse of the step that ends here"
            data[f"r_{side[0]}"] = ("time", self.r[:, j], {"units": "N s", "long_name": sentence})
        data["branch"] = ("time", self.branch, _flags("branch of the contact law", Branch))
        data["change"] = ("time", self.change, _flags("change of the velocity at the contact", Change))
        for name, values in self.contact_quantities().items():
            sentence, unit = PER_STATE[name]
            data[name] = ("time", values, {"units": unit, "long_name": sentence})
        time = ("time", self.t, {"units": "s", "long_name": "time"})
        attributes = {"scene": scene.name, "start": self.start.label, "scheme": self.scheme, "ending": self.sentence}
        return xr.Dataset(data, coords={"time": time}, attrs=attributes)


def gamma_of(rows: tuple[float, ...], d: int, planar: bool) -> float:
    """gamma from the rows at a configuration (the project's notes, section 1)."""
    edge = min(rows[2 + 2 * d], rows[5 + 4 * d]) if planar else rows[1 + 2 * d]
    return float(edge / sum(w * w for w in rows[1 : 1 + d]))


def _flags(sentence: str, codes: type[Branch] | type[Change]) -> dict[str, object]:
    """CF attributes of a coded variable."""
    return {
        "long_name": sentence,
        "flag_values": np.array([int(c) for c in codes], np.int8),
        "flag_meanings": " ".join(c.label for c in codes),
    }
