"""The law with planar friction (docs/theory.md, section 2): a segment for the section.

With G = [[a, b], [b, C]] and the contact velocity (v_n, v_t), v_n < 0, the feasible impulses (1, s) lambda that
cancel the normal velocity form an interval of the line a r_n + b r_t = -v_n. The kinetic energy restricted to that
line is a parabola with its least value at the sticking impulse, so S is a clamp: this holds for every sign of gamma.

Relative to the limit set every impulse is split as r = tau r_jump + e, where r_jump is the impulse of the jump
u- -> u_tilde at the base state (zero if there is none), so that S = u- + tau (u_tilde - u-) + z with z of the size of
the offsets: differences are formed without cancellation. The sticking impulse differs from the one at the base state by
e = -G^-1 (dv_c + dG r_base), because G_base r_base = -v_base.

The farthest members over one configuration: on a slipping branch S = u- + dv + lam Y(1, s) and v_n = -lam p, where
p = a + s b may be as small as one likes; lam is therefore given, and dv runs over the section of the ball on which
v_n = -lam p. Where p -> 0+ this is the closure.
"""

import math
from typing import NamedTuple

import numpy as np

from painleve._jit import jit
from painleve.core.codes import ContactMode
from painleve.core.excess import REACH, excess, half_space, no_half_spaces
from painleve.core.farthest import complete_frame, dot
from painleve.core.motion_codes import Change
from painleve.core.rows import row_layout
from painleve.core.steps import is_jump, is_tangential

__all__ = [
    "SegmentBase",
    "SegmentChange",
    "SegmentContact",
    "SegmentRows",
    "branch_excesses",
    "contact_velocity",
    "impulse",
    "kind_of_change",
    "law_from_rows",
    "segment_impulse",
    "segment_rows",
    "solutions",
    "split",
    "stick_impulse",
    "undivided_stop",
]

FREE, STICK = int(ContactMode.FREE), int(ContactMode.STICK)
SLIP_PLUS, SLIP_MINUS = int(ContactMode.SLIP_PLUS), int(ContactMode.SLIP_MINUS)
ORDINARY, FRICTIONAL_IMPACT = int(Change.ORDINARY), int(Change.FRICTIONAL_IMPACT)
JUMP_WITHOUT_COLLISION = int(Change.JUMP_WITHOUT_COLLISION)


class SegmentRows(NamedTuple):
    """Where the rows are that a segment adds: the compliance on the edge s = -mu_minus, and both ends."""

    edge_minus: int
    mu_plus: int
    mu_minus: int


class SegmentContact(NamedTuple):
    """W^T M^-1 W, the compliances a + b s on the edges of the cone, and the section [-mu_minus, mu_plus]."""

    a: float
    b: float
    C: float
    edge_plus: float
    edge_minus: float
    mu_plus: float
    mu_minus: float


class SegmentChange(NamedTuple):
    """How these differ from the base state's."""

    a: float
    b: float
    C: float
    mu_plus: float
    mu_minus: float


class SegmentBase(NamedTuple):
    """The sticking impulse at the base state, whether or not it is in the cone; each number correctly rounded."""

    stick_n: float
    stick_t: float


@jit
def segment_rows(layout):
    """Where a segment's rows are."""
    return SegmentRows(layout.section, layout.section + 1, layout.section + 2)


@jit
def contact_at(rows, d):
    """The contact that the rows describe."""
    at = row_layout(d, 1)
    own = segment_rows(at)
    return SegmentContact(
        rows[at.a],
        rows[at.b],
        rows[at.C],
        rows[at.edge_plus],
        rows[own.edge_minus],
        rows[own.mu_plus],
        rows[own.mu_minus],
    )


@jit
def contact_velocity(rows, d, v):
    """(v_n, v_t)."""
    at, v_n, v_t = row_layout(d, 1), 0.0, 0.0
    for j in range(d):
        v_n += rows[at.w_n + j] * v[j]
        v_t += rows[at.H + j] * v[j]
    return v_n, v_t


def undivided_stop(a, b, C, v_n, v_t):
    """det(G) times the impulse -G^-1 (v_n, v_t) that stops the tip, in any arithmetic."""
    return b * v_t - C * v_n, b * v_n - a * v_t


_undivided_stop = jit(undivided_stop)


@jit
def stick_impulse(a, b, C, v_n, v_t):
    """The impulse -G^-1 v_c that stops the tip."""
    determinant = a * C - b * b
    r_n, r_t = _undivided_stop(a, b, C, v_n, v_t)
    return r_n / determinant, r_t / determinant


@jit
def which_branch(contact, v_n, stick_t):
    """Which branch S takes at a contact with v_n < 0: the sticking impulse is clamped to the cone."""
    # Written without 0 * inf: an edge that cannot lift never binds.
    if contact.edge_plus > 0.0 and stick_t * contact.edge_plus > -contact.mu_plus * v_n:
        return SLIP_PLUS
    if contact.edge_minus > 0.0 and -stick_t * contact.edge_minus > -contact.mu_minus * v_n:
        return SLIP_MINUS
    return STICK


@jit
def segment_impulse(contact, v_n, v_t):
    """(r_n, r_t, branch) of the law with the section [-mu_minus, mu_plus]; no impulse where v_n >= 0."""
    if v_n >= 0.0:
        return 0.0, 0.0, FREE
    stick_n, stick_t = stick_impulse(contact.a, contact.b, contact.C, v_n, v_t)
    branch = which_branch(contact, v_n, stick_t)
    if branch == SLIP_PLUS:
        r_n = -v_n / contact.edge_plus
        return r_n, contact.mu_plus * r_n, branch
    if branch == SLIP_MINUS:
        r_n = -v_n / contact.edge_minus
        return r_n, -contact.mu_minus * r_n, branch
    return stick_n, stick_t, branch


@jit
def impulse(rows, d, velocity, bias):
    """((r_n, r_t), branch) where there is contact."""
    r_n, r_t, branch = segment_impulse(contact_at(rows, d), velocity[0] + bias, velocity[1])
    return (r_n, r_t), branch


@jit
def law_from_rows(rows, d, v, result):
    """S(q, v) into `result` from the rows at q; returns the branch."""
    at, velocity = row_layout(d, 1), contact_velocity(rows, d, v)
    for j in range(d):
        result[j] = v[j]
    if rows[at.g] < 0.0 or velocity[0] >= 0.0:
        return FREE
    (r_n, r_t), branch = impulse(rows, d, velocity, 0.0)
    for j in range(d):
        result[j] += rows[at.Y_n + j] * r_n + rows[at.Y_t + j] * r_t
    return branch


@jit
def split(hit, contact, change, v_n, dv_t, base, multiplier, critical_edge):
    """(branch, tau, e_n, e_t) at an offset state, without branches, so that a loop over it vectorises.

    `hit`: in contact with v_n < 0; `multiplier`: the normal impulse of the jump, 0 if there is none; `critical_edge`:
    +1 or -1 if gamma = 0 on that edge of the cone at the base state and there is a jump, else 0. Every case is computed
    and one is selected. What is not selected may be infinite or NaN, so nothing is added up by weights.
    """
    a, b, C, edge_plus, edge_minus, mu_plus, mu_minus = contact
    base_n, base_t = base
    jumps, inverse = multiplier > 0.0, 1.0 / (a * C - b * b)
    n, t = v_n + change.a * base_n + change.b * base_t, dv_t + change.b * base_n + change.C * base_t
    stick_n, stick_t = _undivided_stop(a, b, C, n, t)
    stick_n, stick_t = stick_n * inverse, stick_t * inverse
    # Which edge binds: as in `which_branch`.
    r_t = base_t + stick_t
    plus = hit & (edge_plus > 0.0) & (r_t * edge_plus > -mu_plus * v_n)
    minus = hit & (edge_minus > 0.0) & (-r_t * edge_minus > -mu_minus * v_n) & (not plus)
    # On the critical edge the impulse is tau r_jump but for the change of the edge's own direction.
    normal = -v_n / (edge_plus if plus else edge_minus)
    s, ds = (mu_plus, change.mu_plus) if plus else (-mu_minus, -change.mu_minus)
    critical = (critical_edge == 1) if plus else (critical_edge == -1)
    slip_tau = normal * (1.0 / multiplier) if critical else 0.0
    slip_n, slip_t = 0.0 if critical else normal, normal * (ds if critical else s)
    stick_tau = 1.0 if jumps else 0.0
    stick_n = stick_n if jumps else base_n + stick_n
    stick_t = stick_t if jumps else r_t
    slips = plus | minus
    tau, e_n, e_t = (slip_tau, slip_n, slip_t) if slips else (stick_tau, stick_n, stick_t)
    slip_code = SLIP_PLUS if plus else SLIP_MINUS
    code = slip_code if slips else STICK
    return code if hit else FREE, tau if hit else 0.0, e_n if hit else 0.0, e_t if hit else 0.0


@jit
def solutions(rows, d, gap_rate, v_t):
    """How many impulses solve the contact problem at that rate of the gap: free, sticking, and slip on either edge."""
    if gap_rate < 0.0:
        return 1
    a, b, C, edge_plus, edge_minus, mu_plus, mu_minus = contact_at(rows, d)
    count = 1
    stick_n, stick_t = stick_impulse(a, b, C, gap_rate, v_t)
    if stick_n > 0.0 and -mu_minus * stick_n <= stick_t <= mu_plus * stick_n:
        count += 1
    for side in range(2):
        s = mu_plus if side == 0 else -mu_minus
        edge = edge_plus if side == 0 else edge_minus
        if edge < 0.0 < gap_rate:
            r_n = -gap_rate / edge
            if (v_t + (b + C * s) * r_n) * s < 0.0:
                count += 1
    return count


@jit
def kind_of_change(rows, d, velocity, r, branch, free, since, speed):
    """free: the free change of the step; since: steps since the last contact, this one included.

    The edge that counts is the one on which friction opposes the slip.
    """
    contact = contact_at(rows, d)
    if not is_tangential(velocity[0], contact.a, free):
        return FRICTIONAL_IMPACT
    edge = contact.edge_plus if velocity[1] < 0.0 else contact.edge_minus
    size = _jump_size(contact, r[0], r[1])
    return JUMP_WITHOUT_COLLISION if is_jump(size, free * since, speed, edge, branch == STICK) else ORDINARY


@jit
def _jump_size(contact, r_n, r_t):
    """The kinetic norm of M^-1 W r: how far the contact moved the velocity."""
    return math.sqrt(max(0.0, contact.a * r_n * r_n + 2.0 * contact.b * r_n * r_t + contact.C * r_t * r_t))


@jit
def branch_excesses(branch, kind, state, differences, share, eps, values, places, impulses):
    """The farthest members of a branch (painleve.core.excess) around a painleve.core.lane.BaseState.

    For each column of `differences` (rows minus their base values) the largest distance/eps, -1 where the branch has no
    member; dv/eps into `places` (d, n) and the normal impulse of the slip into `impulses`. share: which impulse a slip
    has, from 0 to the largest that the ball allows. For REACH the value is -(S - u_tilde).direction/eps, which may have
    any sign; -inf where there is none.
    """
    base, u, direction, length = state.base, state.u, state.direction, state.length
    d, multiplier = u.size, state.multiplier
    A, c = np.empty((d, d)), np.empty(d)
    cuts = no_half_spaces(d)
    for i in range(values.size):
        row, change = base + differences[:, i], differences[:, i] / eps
        values[i], impulses[i] = -1.0 if kind != REACH else -math.inf, 0.0
        if branch == STICK:
            count = _stick(row, change, eps, state, A, c, cuts)
            if count >= 0:
                after = length / eps if multiplier > 0.0 else 0.0
                y = np.zeros(d)
                values[i] = excess(kind, A, c, (after, after - length / eps), direction, cuts, count, d, 1.0, y)
                places[:, i] = y
            continue
        sense = 1 if branch == SLIP_PLUS else -1
        start, basis, lam, more, count = _slip(sense, row, change, share[i], eps, state, c, cuts)
        left = 1.0 - dot(start, start)
        if count < 0 or left < 0.0:
            continue
        y = np.zeros(d - 1)
        after, beyond = 0.0, -length / eps
        if state.critical_edge == sense:
            after, beyond = lam / multiplier * (length / eps), more * (length / multiplier)
        values[i] = excess(kind, basis, c, (after, beyond), direction, cuts, count, d - 1, math.sqrt(left), y)
        for j in range(d):
            places[j, i] = start[j] + dot(basis[j], y)
        impulses[i] = lam


@jit
def _columns(row, at, d):
    """w_n, M^-1 w_n, H and M^-1 H, (d,) each."""
    return row[at.w_n : at.w_n + d], row[at.Y_n : at.Y_n + d], row[at.H : at.H + d], row[at.Y_t : at.Y_t + d]


@jit
def _stick(row, change, eps, state, A, c, cuts):
    """S - (u- or, after a jump, u_tilde) = eps (A y + c) where the tip sticks; returns how many half-spaces."""
    u, d = state.u, state.u.size
    at = row_layout(d, 1)
    own = segment_rows(at)
    w, Y_n, H, Y_t = _columns(row, at, d)
    a, b, C, plus, minus = row[at.a], row[at.b], row[at.C], row[at.edge_plus], row[own.edge_minus]
    det, (base_n, base_t) = a * C - b * b, state.impulse
    dw, dY_n, dH, dY_t = _columns(change, at, d)
    k_n = dot(dw, u)
    lack_n = k_n + change[at.a] * base_n + change[at.b] * base_t
    lack_t = dot(dH, u) + change[at.b] * base_n + change[at.C] * base_t
    e_n, e_t = _undivided_stop(a, b, C, lack_n, lack_t)
    E_n, E_t = _undivided_stop(a, b, C, w, H)
    e_n, e_t, E_n, E_t = e_n / det, e_t / det, E_n / det, E_t / det
    jumps = state.multiplier > 0.0
    for j in range(d):
        c[j] = Y_n[j] * e_n + Y_t[j] * e_t
        if jumps:
            c[j] += dY_n[j] * base_n + dY_t[j] * base_t
        else:
            c[j] += (Y_n[j] * base_n + Y_t[j] * base_t) / eps
        for k in range(d):
            A[j, k] = Y_n[j] * E_n[k] + Y_t[j] * E_t[k] + (1.0 if j == k else 0.0)
    count = half_space(w, -k_n, cuts, 0)
    for sense, edge, s in ((1.0, plus, row[own.mu_plus]), (-1.0, minus, -row[own.mu_minus])):
        if edge > 0.0 and count >= 0:
            least = sense * (base_t * (edge / eps) + edge * e_t + s * k_n)
            count = half_space(sense * (edge * E_t + s * w), -least, cuts, count)
    return count


@jit
def _slip(sense, row, change, share, eps, state, c, cuts):
    """dv/eps = start + basis y on the section, and S - u- (less tau jump on the critical edge) = eps (basis y + c).

    Returns start, basis, the impulse lam, more = (lam - multiplier)/eps, formed without cancellation on the critical
    edge, and how many half-spaces; -1 where the edge cannot lift the tip or always sticks.
    """
    u, d = state.u, state.u.size
    (base_n, base_t), multiplier, critical = state.impulse, state.multiplier, state.critical_edge == sense
    at = row_layout(d, 1)
    own = segment_rows(at)
    w, Y_n, H, Y_t = _columns(row, at, d)
    dw, dY_n, dH, dY_t = _columns(change, at, d)
    a, b, C = row[at.a], row[at.b], row[at.C]
    edge = row[at.edge_plus] if sense == 1 else row[own.edge_minus]
    s, ds = (row[own.mu_plus], change[own.mu_plus]) if sense == 1 else (-row[own.mu_minus], -change[own.mu_minus])
    det, size = a * C - b * b, math.sqrt(dot(w, w))
    frame = np.zeros((d, d))
    frame[0] = w / size
    start, basis = np.zeros(d), np.zeros((d, d - 1))
    k_n = dot(dw, u)
    lack_n = k_n + change[at.a] * base_n + change[at.b] * base_t
    lack_t = dot(dH, u) + change[at.b] * base_n + change[at.C] * base_t
    e_t, E_t = _undivided_stop(a, b, C, lack_n, lack_t)[1] / det, _undivided_stop(a, b, C, w, H)[1] / det
    # It slips while |s| lam < sense * (the sticking impulse's friction). On the critical edge both are |s| multiplier
    # at the base, and `drive` is what is left of the difference; elsewhere lam itself is compared.
    drive = sense * (e_t - ds * multiplier) if critical else sense * (base_t / eps + e_t)
    most, least = drive + math.sqrt(dot(E_t, E_t)), -multiplier / eps if critical else 0.0
    if edge < 0.0 or most < abs(s) * least or size < k_n:
        return start, basis, 0.0, 0.0, -1
    highest = math.inf if s == 0.0 else most / abs(s)
    if edge > 0.0:
        highest = min(highest, (size - k_n) / (edge / eps) / eps + least)
    if highest == math.inf:
        return start, basis, 0.0, 0.0, -1
    above = (1.0 - share) * least + share * highest
    lam, more = (eps * (above - least), above) if critical else (eps * above, above - multiplier / eps)
    start[:] = -(k_n + lam * (edge / eps)) / size * frame[0]
    complete_frame(frame, 1)
    basis[:] = frame[1:].T
    for j in range(d):
        c[j] = start[j]
        if critical:  # Y (1, s) at the base points along the jump
            c[j] += lam * (dY_n[j] + s * dY_t[j] + ds * (Y_t[j] - eps * dY_t[j]))
        else:
            c[j] += lam / eps * (Y_n[j] + s * Y_t[j])
    normal = np.empty(d - 1)
    for k in range(d - 1):
        normal[k] = -sense * dot(E_t, frame[k + 1])
    count = half_space(normal, drive - abs(s) * above + sense * dot(E_t, start), cuts, 0)
    return start, basis, lam, more, count
