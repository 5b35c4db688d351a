"""The jump of law (7) at a tangential contact, exactly: the impulse of least energy (docs/theory.md, section 3.1).

With g = 0 and <u-, n> = 0 an impulse (r_n, r_t) keeps the velocity tangential where a r_n + b.r_t = 0. In the plane
and where gamma = 0 these are the multiples of one ray rho = (1, s), the energy least at r_n = max(0, -v_t.s/s.Q s).
In space with gamma < 0 they fill a wedge: r_t between the rays r_n s_1 and r_n s_2 with a + b.s_i = 0 on the boundary
of the section. The energy there is (r_t - r*).Q (r_t - r*)/2, Q = C - b b^T/a, r* = -Q^-1 v_t: the sticking impulse if
it is in the wedge, else the best point of one of the two rays, where the tip slips on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import sympy as sp

from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import State

__all__ = [
    "LeastEnergy",
    "contact_slip",
    "edge_indicator",
    "in_wedge",
    "inverse_of_two",
    "lowest_edge",
    "on_ray",
    "sticking_impulse",
]


@dataclass(frozen=True, kw_only=True, eq=False)
class LeastEnergy:
    """The impulse (r_n, r_t) of the jump, None where u_tilde = u-; how the tip goes on; or why it is undecided."""

    impulse: tuple[sp.Expr, ...] | None = None
    after: str = ""
    undecided: str = ""


def contact_slip(state: State) -> sp.MatrixBase:
    """H^T u-, (k x 1): numbers from here on, for of matrices of formulas a determinant may take minutes."""
    return state.exact(state.scene.contact.tangents).T * sp.Matrix(state.u)


def lowest_edge(state: State, edges: Iterable[int]) -> tuple[int, Signed]:
    """Of these edges of the cone that of the least sign of its compliance."""
    d = derive(state.scene)
    signs = {edge: exact_sign(state.exact(d.edge_compliance[edge])) for edge in edges}
    order = (Sign.NEGATIVE, Sign.UNDECIDED, Sign.ZERO, Sign.POSITIVE)
    edge = min(signs, key=lambda e: order.index(signs[e].sign))
    return edge, signs[edge]


def edge_indicator(scene: Scene, edge: int) -> sp.Expr:
    """The compliance on an edge of the cone that has a direction of its own, times det(M)."""
    d, adjugate = derive(scene), scene.inertia.adjugate()
    along = scene.contact.tangents * d.edge_direction(edge)
    return (d.normal.T * adjugate * (d.normal + along))[0, 0]


def on_ray(state: State, slip: sp.MatrixBase, s: sp.MatrixBase) -> LeastEnergy:
    """In space: the best of the impulses lambda (1, s), a + b.s = 0."""
    drive = exact_sign(-(slip.T * s)[0, 0])
    if drive.sign is Sign.UNDECIDED:
        return LeastEnergy(undecided=f"the sense of the slip is undecided: {drive.reason}")
    if drive.sign is not Sign.POSITIVE:
        return LeastEnergy()
    size = -(slip.T * s)[0, 0] / (s.T * _reduced(state) * s)[0, 0]
    return LeastEnergy(impulse=(size, *(size * x for x in s)), after=_after(state, slip, size * s))


def _reduced(state: State) -> sp.MatrixBase:
    """Q = C - b b^T/a."""
    d = derive(state.scene)
    b = state.exact(d.couplings)
    return state.exact(d.compliance) - b * b.T / state.exact(d.a)


def _after(state: State, slip: sp.MatrixBase, r_t: sp.MatrixBase) -> str:
    """What the tip does after an impulse that keeps its normal velocity zero."""
    left = slip + _reduced(state) * r_t
    stays = all(exact_sign(x).sign is Sign.ZERO for x in left)
    return "sticks" if stays else "slips on in another direction"


def in_wedge(
    state: State, slip: sp.MatrixBase, wedge: Callable[[], tuple[sp.MatrixBase, sp.MatrixBase] | None]
) -> LeastEnergy:
    """gamma < 0 in space. `wedge` gives the two directions (s_1, s_2) on the boundary of the section with a + b.s = 0,
    s_2 counterclockwise of s_1 by less than a half turn; None where a sign is undecided."""
    if all(exact_sign(x).sign is Sign.ZERO for x in slip):
        return LeastEnergy()
    impulse = sticking_impulse(state, slip)
    inside = _in_cone(state, impulse)
    if inside is Sign.UNDECIDED:
        return LeastEnergy(undecided="whether the sticking impulse is in the friction cone is undecided")
    if inside is Sign.POSITIVE:
        return LeastEnergy(impulse=impulse, after="sticks")
    rays = wedge()
    if rays is None:
        return LeastEnergy(undecided="the sign of the normal compliance at a vertex of the polygon is undecided")
    return _better(slip, [on_ray(state, slip, s) for s in rays])


def sticking_impulse(state: State, slip: sp.MatrixBase) -> tuple[sp.Expr, ...]:
    """-G^-1 (0, slip), exactly: what stops a tip in space, whether or not it is in the cone."""
    d, stick = derive(state.scene), -inverse_of_two(_reduced(state)) * slip
    return -(state.exact(d.couplings).T * stick)[0, 0] / state.exact(d.a), *stick


def inverse_of_two(A: sp.MatrixBase) -> sp.MatrixBase:
    """The inverse of a 2 x 2 matrix, without the simplifications of sympy's own, which take minutes."""
    return sp.Matrix([[A[1, 1], -A[0, 1]], [-A[1, 0], A[0, 0]]]) / (A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0])


def _in_cone(state: State, impulse: tuple[sp.Expr, ...]) -> Sign:
    """POSITIVE if an impulse that is not zero is in the friction cone, NEGATIVE if not."""
    normal, r_t = impulse[0], sp.Matrix(impulse[1:])
    lifts = exact_sign(normal).sign
    if lifts in (Sign.NEGATIVE, Sign.ZERO):
        return Sign.NEGATIVE
    inside = state.scene.contact.section.membership(r_t / normal)
    sides = [exact_sign(state.exact(x)).sign for x in inside]
    if Sign.NEGATIVE in sides:
        return Sign.NEGATIVE
    return Sign.UNDECIDED if Sign.UNDECIDED in (lifts, *sides) else Sign.POSITIVE


def _better(slip: sp.MatrixBase, found: list[LeastEnergy]) -> LeastEnergy:
    """Of the best points of the two rays the one of less energy: 2 x the energy it takes is -slip.r_t."""
    undecided = next((f for f in found if f.undecided), None)
    if undecided is not None:
        return undecided
    jumps = [f for f in found if f.impulse is not None]
    if len(jumps) < 2:
        return jumps[0] if jumps else LeastEnergy()
    first, second = (-(slip.T * sp.Matrix(f.impulse[1:]))[0, 0] for f in jumps)  # type: ignore[index]
    difference = exact_sign(first - second)
    if difference.sign in (Sign.UNDECIDED, Sign.ZERO):
        return LeastEnergy(undecided="which of the two edges of the wedge is nearer is undecided")
    return jumps[0] if difference.sign is Sign.POSITIVE else jumps[1]
