"""The jump of law (7) at a tangential contact, exactly: the impulse of least energy (docs/theory.md, section 3.1).

With g = 0 and <u-, n> = 0 an impulse (r_n, r_t) keeps the velocity tangential where a r_n + b.r_t = 0. In the plane
and where gamma = 0 these are the multiples of one ray rho = (1, s), the energy least at r_n = max(0, -v_t.s/s.Q s).
In space with gamma < 0 they fill a wedge: r_t between the rays r_n s_1 and r_n s_2 with a + b.s_i = 0 on the boundary
of the section. The energy there is (r_t - r*).Q (r_t - r*)/2, Q = C - b b^T/a, r* = -Q^-1 v_t: the sticking impulse if
it is in the wedge, else the best point of one of the two rays, where the tip slips on.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.derive import Derivation, derive
from painleve.mechanics.friction import Polygon, Segment
from painleve.mechanics.state import State
from painleve.theory.wedge import wedge

__all__ = ["LeastEnergy", "inverse_of_two", "least_edge", "least_energy", "sticking_impulse"]


@dataclass(frozen=True, kw_only=True, eq=False)
class LeastEnergy:
    """The impulse (r_n, r_t) of the jump, None where u_tilde = u-; how the tip goes on; or why it is undecided."""

    impulse: tuple[sp.Expr, ...] | None = None
    after: str = ""
    undecided: str = ""


def least_edge(state: State) -> tuple[int, Signed]:
    """The edge of the cone on which gamma is attained, and the sign of gamma, which is that of its compliance."""
    d, friction = derive(state.scene), state.scene.contact.section
    if isinstance(friction, Segment):
        edges = [1, -1]
    elif isinstance(friction, Polygon):
        edges = _extreme_vertices(state, d, friction)
    else:
        return 1, _conic_sign(state, d)
    signs = {edge: exact_sign(state.exact(d.edge_compliance[edge])) for edge in edges}
    order = (Sign.NEGATIVE, Sign.UNDECIDED, Sign.ZERO, Sign.POSITIVE)
    edge = min(signs, key=lambda e: order.index(signs[e].sign))
    return edge, signs[edge]


def _extreme_vertices(state: State, d: Derivation, friction: Polygon) -> list[int]:
    """The vertices with the least compliance: what floats cannot tell from the least."""
    values = [state.number(d.edge_compliance[i + 1]) for i in range(len(friction.vertices))]
    near = 1e-9 * max(abs(state.number(d.a)), *(abs(value) for value in values))
    return [i + 1 for i, value in enumerate(values) if value <= min(values) + near]


def _conic_sign(state: State, d: Derivation) -> Signed:
    """Of a - |E^T b|, by the square, which has no root in it."""
    opposed = d.scene.contact.section.map.T * d.couplings  # type: ignore[attr-defined]
    return exact_sign(state.exact(d.a**2 - (opposed.T * opposed)[0, 0]))


def least_energy(state: State, edge: int, gamma: Sign) -> LeastEnergy:
    """The jump at a state with gamma(q) <= 0 attained on that edge."""
    d = derive(state.scene)
    # Numbers from here on: of matrices of formulas a determinant may take minutes.
    slip = state.exact(state.scene.contact.tangents).T * sp.Matrix(state.u)
    if state.scene.contact.section.dimension == 1:
        return _planar(state, d, slip[0])
    if gamma is Sign.ZERO:
        return _along_ray(state, d, slip, edge)
    return _in_wedge(state, d, slip)


def _planar(state: State, d: Derivation, slip: sp.Expr) -> LeastEnergy:
    """The ray has s = -a/b: the jump ends where the tip sticks, if the slip is in the destabilising sense."""
    a, b, C = (state.exact(x) for x in (d.a, d.couplings[0], d.compliance[0]))
    drive = exact_sign(slip * b)
    if drive.sign is Sign.UNDECIDED:
        return LeastEnergy(undecided=f"the sense of the slip is undecided: {drive.reason}")
    if drive.sign is not Sign.POSITIVE:
        return LeastEnergy()
    determinant = a * C - b**2
    return LeastEnergy(impulse=(slip * b / determinant, -slip * a / determinant), after="sticks")


def _along_ray(state: State, d: Derivation, slip: sp.MatrixBase, edge: int) -> LeastEnergy:
    """gamma = 0 in space: one ray, if the section touches the line a + b.s = 0 in one point."""
    if isinstance(state.scene.contact.section, Polygon):
        others = [i for i in _extreme_vertices(state, d, state.scene.contact.section) if i != edge]
        if any(exact_sign(state.exact(d.edge_compliance[i])).sign is not Sign.POSITIVE for i in others):
            return LeastEnergy(
                undecided="gamma = 0 on a whole edge of the friction polygon (neither H4 nor "
                "H'4 holds): the ray of impulses is not unique, and nothing is claimed"
            )
    return _on_ray(state, d, slip, state.exact(d.edge_direction(edge)))


def _on_ray(state: State, d: Derivation, slip: sp.MatrixBase, s: sp.MatrixBase) -> LeastEnergy:
    drive = exact_sign(-(slip.T * s)[0, 0])
    if drive.sign is Sign.UNDECIDED:
        return LeastEnergy(undecided=f"the sense of the slip is undecided: {drive.reason}")
    if drive.sign is not Sign.POSITIVE:
        return LeastEnergy()
    size = -(slip.T * s)[0, 0] / (s.T * _reduced(state, d) * s)[0, 0]
    return LeastEnergy(impulse=(size, *(size * x for x in s)), after=_after(state, d, slip, size * s))


def _reduced(state: State, d: Derivation) -> sp.MatrixBase:
    """Q = C - b b^T/a."""
    b = state.exact(d.couplings)
    return state.exact(d.compliance) - b * b.T / state.exact(d.a)


def _after(state: State, d: Derivation, slip: sp.MatrixBase, r_t: sp.MatrixBase) -> str:
    """What the tip does after an impulse that keeps its normal velocity zero."""
    left = slip + _reduced(state, d) * r_t
    stays = all(exact_sign(x).sign is Sign.ZERO for x in left)
    return "sticks" if stays else "slips on in another direction"


def _in_wedge(state: State, d: Derivation, slip: sp.MatrixBase) -> LeastEnergy:
    """gamma < 0 in space."""
    if all(exact_sign(x).sign is Sign.ZERO for x in slip):
        return LeastEnergy()
    normal, stick = sticking_impulse(state, d, slip)
    inside = _in_cone(state, d, normal, stick)
    if inside is Sign.UNDECIDED:
        return LeastEnergy(undecided="whether the sticking impulse is in the friction cone is undecided")
    if inside is Sign.POSITIVE:
        return LeastEnergy(impulse=(normal, *stick), after="sticks")
    rays = wedge(state, d)
    if rays is None:
        return LeastEnergy(undecided="the sign of the normal compliance at a vertex of the polygon is undecided")
    return _better(state, d, slip, [_on_ray(state, d, slip, s) for s in rays])


def sticking_impulse(state: State, d: Derivation, slip: sp.MatrixBase) -> tuple[sp.Expr, sp.MatrixBase]:
    """-G^-1 (0, slip), exactly: what stops a tip in space, whether or not it is in the cone."""
    stick = -inverse_of_two(_reduced(state, d)) * slip
    return -(state.exact(d.couplings).T * stick)[0, 0] / state.exact(d.a), stick


def inverse_of_two(A: sp.MatrixBase) -> sp.MatrixBase:
    """The inverse of a 2 x 2 matrix, without the simplifications of sympy's own, which take minutes."""
    return sp.Matrix([[A[1, 1], -A[0, 1]], [-A[1, 0], A[0, 0]]]) / (A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0])


def _in_cone(state: State, d: Derivation, normal: sp.Expr, r_t: sp.MatrixBase) -> Sign:
    """POSITIVE if an impulse that is not zero is in the friction cone, NEGATIVE if not."""
    lifts = exact_sign(normal).sign
    if lifts in (Sign.NEGATIVE, Sign.ZERO):
        return Sign.NEGATIVE
    inside = d.scene.contact.section.membership(r_t / normal)
    sides = [exact_sign(state.exact(x)).sign for x in inside]
    if Sign.NEGATIVE in sides:
        return Sign.NEGATIVE
    return Sign.UNDECIDED if Sign.UNDECIDED in (lifts, *sides) else Sign.POSITIVE


def _better(state: State, d: Derivation, slip: sp.MatrixBase, found: list[LeastEnergy]) -> LeastEnergy:
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
