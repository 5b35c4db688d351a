"""A contact without friction: the impulse is normal."""

import math
from typing import NamedTuple

import numpy as np

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.excess import REACH, excess, half_space, no_half_spaces
from painleve.core.farthest import dot
from painleve.core.motion_codes import Change
from painleve.core.rows import row_layout
from painleve.core.steps import is_tangential

__all__ = [
    "NoFrictionBase",
    "branch_excesses",
    "contact_velocity",
    "impulse",
    "kind_of_change",
    "law_from_rows",
    "split",
]

FREE, FRICTIONLESS = int(ContactMode.FREE), int(ContactMode.FRICTIONLESS)
ORDINARY, IMPACT = int(Change.ORDINARY), int(Change.IMPACT)


class NoFrictionBase(NamedTuple):
    """The base state: u- is tangential, so that nothing need stop it."""

    stick_n: float


@jit
def contact_velocity(rows, d, v):
    """(v_n,)."""
    at, v_n = row_layout(d, 0), 0.0
    for j in range(d):
        v_n += rows[at.w_n + j] * v[j]
    return (v_n,)


@jit
def impulse(rows, d, velocity, bias):
    """((r_n,), branch) where there is contact."""
    gap_rate = velocity[0] + bias
    if gap_rate >= 0.0:
        return (0.0,), FREE
    return (-gap_rate / rows[row_layout(d, 0).a],), FRICTIONLESS


@jit
def law_from_rows(rows, d, v, result):
    """S(q, v) into `result` from the rows at q; returns the branch."""
    at, (v_n,) = row_layout(d, 0), contact_velocity(rows, d, v)
    for j in range(d):
        result[j] = v[j]
    if rows[at.g] < 0.0 or v_n >= 0.0:
        return FREE
    for j in range(d):
        result[j] -= rows[at.Y_n + j] * v_n / rows[at.a]
    return FRICTIONLESS


@jit
def split(hit, a, v_n):
    """(branch, e_n): without friction nothing jumps; `hit`: in contact with v_n < 0."""
    return FRICTIONLESS if hit else FREE, -v_n / a if hit else 0.0


@jit
def kind_of_change(rows, d, velocity, r, free):
    """free: the free change of the step."""
    return ORDINARY if is_tangential(velocity[0], rows[row_layout(d, 0).a], free) else IMPACT


@jit
def branch_excesses(branch, kind, state, differences, share, eps, values, places, impulses):
    """The farthest impacts, as painleve.core.sections.segment has the farthest members of its branches."""
    u, direction, length = state.u, state.direction, state.length
    d = u.size
    A, c = np.empty((d, d)), np.empty(d)
    cuts = no_half_spaces(d)
    for i in range(values.size):
        row, change = state.base + differences[:, i], differences[:, i] / eps
        values[i], impulses[i] = -1.0 if kind != REACH else -math.inf, 0.0
        count = _impact(row, change, u, A, c, cuts)
        if count >= 0:
            y = np.zeros(d)
            values[i] = excess(kind, A, c, (0.0, -length / eps), direction, cuts, count, d, 1.0, y)
            places[:, i] = y


@jit
def _impact(row, change, u, A, c, cuts):
    """S - u- = eps (A y + c); returns how many half-spaces."""
    d = u.size
    at = row_layout(d, 0)
    w, Y_n, a, k_n = row[at.w_n : at.Y_n], row[at.Y_n : at.a], row[at.a], dot(change[at.w_n : at.Y_n], u)
    for j in range(d):
        c[j] = -Y_n[j] * k_n / a
        for k in range(d):
            A[j, k] = (1.0 if j == k else 0.0) - Y_n[j] * w[k] / a
    return half_space(w, -k_n, cuts, 0)
