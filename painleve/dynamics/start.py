"""Where a trajectory starts: floats, from an exact state or from values of the coordinates and velocities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from painleve.errors import InputError, nearest
from painleve.exact.parse import exact_number
from painleve.kernels.motion.compiled import Motion, make_motion
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number, State, resolve_parameters

__all__ = ["Start", "as_start", "make_start"]

ROUNDING = 1e-13  # of g, relative to 1 + sum |q_j dg/dq_j|: what rounding q to floats may do to a contact


@dataclass(frozen=True, kw_only=True, eq=False)
class Start:
    """Scene, parameters and (t, q, u) as floats; `rounding` is how far from zero g may be at a contact."""

    scene: Scene
    label: str
    p: tuple[float, ...]
    t: float
    q: tuple[float, ...]
    u: tuple[float, ...]
    rounding: float

    @property
    def motion(self) -> Motion:
        return make_motion(self.scene)

    @property
    def rows(self) -> tuple[float, ...]:
        """The scene's rows at the start (painleve.core.rows)."""
        return self.motion.rows_at(self.q, self.p)

    @property
    def g(self) -> float:
        """g(q) at the start."""
        return self.rows[self.motion.rows.parts.g]

    def tabulate(self, t: np.ndarray, q: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rows (n, rows), M (n, d, d) and f (n, d) at many instants: t (n,), q, u (n, d)."""
        n, d = q.shape
        rows, M, f = np.empty((n, len(self.motion.rows.names))), np.empty((n, d * d)), np.empty((n, d))
        self.motion.tabulate(t, np.ascontiguousarray(q), np.ascontiguousarray(u), self.p, rows, M, f)
        return rows, M.reshape(n, d, d), f


def make_start(
    scene: Scene,
    *,
    q: Mapping[str, Number],
    u: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
    t: float = 0.0,
) -> Start:
    """A start from values of the coordinates (all of them) and of the velocities (0 unless given), by name.

    Values are numbers or exact text such as "pi/4". Raises InputError for unknown or missing names, for values out of
    range, for g(q) > 0, and where M is not positive definite.
    """
    names = [c.name for c in scene.coordinates]
    for what, given in (("q", q), ("u", u or {})):
        for name in given:
            if name not in names:
                hint = nearest(name, names)
                raise InputError(
                    f"scene {scene.name}: no coordinate {name!r} for {what}{hint}; it has {', '.join(names)}"
                )
    missing = [name for name in names if name not in q]
    if missing:
        raise InputError(f"scene {scene.name}: the start needs q of {', '.join(missing)}; give name=EXPRESSION")
    table = resolve_parameters(scene, dict(parameters or {}))
    numbers = {
        what: tuple(float(exact_number(given.get(name, 0), where=f"{what} of {name}")) for name in names)
        for what, given in (("q", q), ("u", u or {}))
    }
    p = tuple(float(table[s.name]) for s in scene.parameters)
    label = " ".join(f"{k}={v}" for k, v in {**q, **{f"u_{k}": v for k, v in (u or {}).items()}}.items())
    return _checked(scene, label, p, float(t), numbers["q"], numbers["u"])


def as_start(start: Start | State) -> Start:
    """The start itself, or an exact state rounded to floats at t = 0. Raises InputError as make_start."""
    if isinstance(start, Start):
        return start
    state = start
    p = tuple(state.number(state.parameters[s.name]) for s in state.scene.parameters)
    q, u = (tuple(state.number(x) for x in values) for values in (state.q, state.u))
    return _checked(state.scene, state.label, p, 0.0, q, u)


def _checked(
    scene: Scene, label: str, p: tuple[float, ...], t: float, q: tuple[float, ...], u: tuple[float, ...]
) -> Start:
    where = f"scene {scene.name}, start {label or 'given'}"
    if not np.isfinite([t, *p, *q, *u]).all():
        raise InputError(f"{where}: the start and the parameters must be finite numbers")
    motion, d = make_motion(scene), scene.dimension
    M = np.array(motion.inertia_at(q, p)).reshape(d, d)
    if not (np.isfinite(M).all() and np.linalg.eigvalsh(M)[0] > 0.0):
        raise InputError(f"{where}: M is not positive definite there; choose another configuration")
    rows = motion.rows_at(q, p)
    rounding = ROUNDING * (1.0 + sum(abs(x * w) for x, w in zip(q, rows[motion.rows.parts.w_n], strict=True)))
    g = rows[motion.rows.parts.g]
    if g > rounding:
        raise InputError(f"{where}: not admissible: g(q) = {g:.6g} must not be positive; move the body out")
    return Start(scene=scene, label=label, p=p, t=t, q=q, u=u, rounding=rounding)
