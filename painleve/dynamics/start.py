"""Where a trajectory starts: floats, from an exact state or from values of the coordinates and velocities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from painleve.errors import InputError, nearest
from painleve.exact.parse import exact_number
from painleve.kernels.motion.compiled import Motion, make_motion
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number, State, resolve_parameters

__all__ = ["Start", "as_start", "make_start"]

ROUNDING = 1e-13  # of g, relative to 1 + sum |q_j dg/dq_j|: what rounding q to floats may do to a contact
PROJECTED = 1e-2  # of g and of the normal velocity, relative to the sizes of their terms: more is no rounding
ITERATIONS = 50


@dataclass(frozen=True, kw_only=True, eq=False)
class Start:
    """Scene, parameters and (t, q, u) as floats; `rounding` is how far from zero g may be at a contact.

    `projected` says what was changed to put it on the contact, where that was asked for.
    """

    scene: Scene
    label: str
    p: tuple[float, ...]
    t: float
    q: tuple[float, ...]
    u: tuple[float, ...]
    rounding: float
    projected: str = ""

    def __repr__(self) -> str:
        return f"Start({self.scene.name!r}, {self.label!r})"

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
    project: bool = False,
) -> Start:
    """A start from values of the coordinates (all of them) and of the velocities (0 unless given), by name.

    Values are numbers or exact text such as "pi/4". With `project` they are rounded values of a tangential contact, and
    the start is that contact: the nearest configuration with g(q) = 0 and there the nearest tangential velocity, both
    in the metric of M at the given q; `Start.projected` says by how much it was off. Raises InputError for unknown or
    missing names, for values out of range, for g(q) > 0, where M is not positive definite, and for a projection of more
    than a hundredth.
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
    where, q_given, u_given = _place(scene, label), numbers["q"], numbers["u"]
    if not project:
        return _checked(scene, label, p, float(t), q_given, u_given)
    _check_inertia(scene, where, p, float(t), q_given, u_given)
    q_on, u_on, projected = _onto_contact(scene, where, p, np.array(q_given), np.array(u_given))
    return replace(_checked(scene, label, p, float(t), q_on, u_on), projected=projected)


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
    where = _place(scene, label)
    _check_inertia(scene, where, p, t, q, u)
    motion = make_motion(scene)
    rows, at = motion.rows_at(q, p), motion.rows.parts
    rounding, g = _rounding(rows[at.w_n], q), rows[at.g]
    if g > rounding:
        raise InputError(
            f"{where}: not admissible: g(q) = {g:.6g} is positive beyond rounding ({rounding:.2g}, which a "
            "contact tolerance does not change); move the body out, or put it on the contact (--project)"
        )
    return Start(scene=scene, label=label, p=p, t=t, q=q, u=u, rounding=rounding)


def _place(scene: Scene, label: str) -> str:
    return f"scene {scene.name}, start {label or 'given'}"


def _check_inertia(
    scene: Scene, where: str, p: tuple[float, ...], t: float, q: tuple[float, ...], u: tuple[float, ...]
) -> None:
    if not np.isfinite([t, *p, *q, *u]).all():
        raise InputError(f"{where}: the start and the parameters must be finite numbers")
    M = np.array(make_motion(scene).inertia_at(q, p)).reshape(scene.dimension, scene.dimension)
    if not (np.isfinite(M).all() and np.linalg.eigvalsh(M)[0] > 0.0):
        raise InputError(f"{where}: M is not positive definite there; choose another configuration")


def _rounding(w_n: Sequence[float], q: Sequence[float] | np.ndarray) -> float:
    """How far from zero rounding of q may leave g."""
    return ROUNDING * (1.0 + _terms(w_n, q))


def _terms(w_n: Sequence[float] | np.ndarray, x: Sequence[float] | np.ndarray) -> float:
    """The sum of |x_j dg/dq_j|."""
    return float(np.abs(np.array(x) * np.array(w_n)).sum())


def _onto_contact(
    scene: Scene, where: str, p: tuple[float, ...], q: np.ndarray, u: np.ndarray
) -> tuple[tuple[float, ...], tuple[float, ...], str]:
    """The contact that (q, u) stands for, and by how much it was off.

    The nearest point of g = 0 has q - q_given = M^-1 w_n times a number, w_n at q: g is linearised until it vanishes.
    """
    motion, d, given = make_motion(scene), len(q), q
    inverse = np.linalg.inv(np.array(motion.inertia_at(tuple(q), p)).reshape(d, d))
    rows, at = motion.rows_at(tuple(q), p), motion.rows.parts
    g, small = rows[at.g], _rounding(rows[at.w_n], q)
    if not abs(g) <= PROJECTED * (1.0 + _terms(rows[at.w_n], q)):
        raise InputError(f"{where}: g(q) = {g:.6g} is no rounding of a contact; --project moves a start no further")
    for _ in range(ITERATIONS):
        w = np.array(rows[at.w_n])
        q = given + inverse @ w * ((rows[at.g] + w @ (q - given)) / (w @ inverse @ w))
        rows = motion.rows_at(tuple(q), p)
        if abs(rows[at.g]) <= small:
            break
    else:
        raise InputError(f"{where}: found no configuration with g(q) = 0 near it; give one closer to the contact")
    w = np.array(rows[at.w_n])
    v_n = float(w @ u)
    if not abs(v_n) <= PROJECTED * (1.0 + _terms(w, u)):
        raise InputError(
            f"{where}: its normal velocity {v_n:.6g} is no rounding of a tangential one; --project takes no more away"
        )
    u = u - inverse @ w * (v_n / (w @ inverse @ w))
    moved = ", ".join(f"{c.name} by {x:.2g}" for c, x in zip(scene.coordinates, q - given, strict=True) if x != 0.0)
    off = f"g was {g:.3g} and the normal velocity {v_n:.3g}; moved {moved or 'nothing'}"
    return tuple(map(float, q)), tuple(map(float, u)), off
