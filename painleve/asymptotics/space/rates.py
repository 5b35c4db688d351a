"""The constant C in d_H = C sqrt(eps) + o(sqrt(eps)) where gamma = 0 in space and the jump ends in slip.

At q the section touches the line a + b.s = 0 in one point s_0 = -b/|b| (of the unit disc), and the impulses that keep
the normal velocity are the multiples of one ray. Near q the impulses of normal size Lambda that cancel v_n = -nu are a
chord across that ray, of half-width

    Y = sqrt(2 Lambda (nu - Lambda p)/a) (1 + o(1)),      p = a - |b| of the size of eps, of either sign:

the ellipse or hyperbola of section 2 of docs/theory.md is that thin. Where the jump ends in slip, the tip's
velocity kappa e_perp after it (e = b/|b|, kappa != 0) is across the ray, so that energy is lost by going to the end of
the chord: y = -sign(kappa) Y. That moves S off the segment sideways by O(sqrt(eps)), and along it, by what minimises
Q_11 Delta^2/2 - Q_12 Delta y - |kappa| Y(lambda_tilde + Delta), Q = C - b b^T/a in the frame (e, e_perp):

    Delta = (|kappa| Y' + Q_12 y)/Q_11,      Y' = (nu - 2 lambda_tilde p)/(a Y).

So S - u_tilde = Delta M^-1 W (1, s_0) + y M^-1 H e_perp + O(eps), with nu = eps (-w_n . eta - (Dw_n xi) . u-) and p =
eps grad p . xi. What is left is a search over the two unit balls; for given xi the distance is largest at the least or
the greatest nu. Members that end before u_tilde (nu/p < lambda_tilde) are nearer; where the jump ends in sticking
(kappa = 0: u_t parallel to Q b, for the rod in space to b) all are, and the rate is eps. So it is for a polygon, whose
cone has no curved edge. As kappa tends to 0 the constant does not: what shrinks, like kappa^2, is the eps below which
it shows. Above, the tip sticks within the chord, at a distance of the size of kappa.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from painleve.asymptotics.local import LocalProblem, make_local_problem
from painleve.core.sections.conic import ConicBase
from painleve.errors import InputError
from painleve.theory.limit_set import LimitSet

__all__ = ["Root", "root_rate"]

POINTS, ZOOMS, SHRINK = 41, 24, 0.3  # of the grid of shape offsets about the best place so far


@dataclass(frozen=True, kw_only=True)
class Root:
    """C, and the offsets in units of eps that attain it, (d,) each."""

    C: float
    dq: np.ndarray
    dv: np.ndarray


def root_rate(limit: LimitSet, isolated: bool) -> Root:
    """The constant of the distance to A, or to its ends alone where the critical state is isolated.

    Raises InputError where none is known: unless gamma = 0 on a disc or an ellipse and the jump ends in slip.
    """
    problem, where = make_local_problem(limit), f"rate: scene {limit.state.scene.name}"
    if not (limit.critical and isinstance(problem.impulse, ConicBase)) or problem.impulse.jump_sticks:
        raise InputError(
            f"{where}: with friction in space C is known only where gamma = 0 on a disc or an ellipse and "
            "the jump ends in slip; sweep the distance over eps for its slope"
        )
    if len(problem.shape) > 2:
        raise InputError(
            f"{where} has {len(problem.shape)} coordinates on which the law depends; at most 2 are searched"
        )
    if not problem.analytic:
        raise InputError(f"{where} is not analytic at this state: it has no derivatives")
    search = _RootSearch(problem, isolated)
    squared, x, nu = search.best()
    dq = np.zeros(problem.dimension)
    dq[list(problem.shape)] = x
    dq += problem.carried_direction * np.sqrt(max(0.0, 1.0 - float(x @ x)))
    w_n = problem.normal
    return Root(C=float(np.sqrt(squared)), dq=dq, dv=-(nu + search.turn @ x) * w_n / (w_n @ w_n))


class _RootSearch:
    """Numbers of the base state, and the distance as a function of the offsets."""

    def __init__(self, problem: LocalProblem, isolated: bool) -> None:
        base, parts = problem.base, problem.parts
        self.problem, self.isolated = problem, isolated
        gradients = problem.gradients
        self.p, self.g = gradients[parts.edge_plus], gradients[parts.g]
        self.w_n = problem.normal
        self.turn = problem.u @ gradients[parts.w_n]
        b, a = base[parts.b], float(base[parts.a])
        C_11, C_12, C_22 = base[parts.C]
        C = np.array([[C_11, C_12], [C_12, C_22]])
        e = b / np.linalg.norm(b)
        across = np.array([-e[1], e[0]])
        Q = C - np.outer(b, b) / a
        Y_n = base[parts.Y_n]
        Y_t = np.stack([base[part] for part in parts.Y_t], axis=1)
        self.a, self.Q_11, self.Q_12, self.jump = a, float(e @ Q @ e), float(e @ Q @ across), problem.multiplier
        self.ray, self.side = Y_n - Y_t @ e, Y_t @ across
        assert isinstance(problem.impulse, ConicBase)
        self.kappa = -problem.impulse.after_across  # s_0 = -e, so that its perpendicular is -e_perp

    def best(self) -> tuple[float, np.ndarray, float]:
        """(largest squared distance, shape offset, nu), all in units of eps."""
        centre, reach = np.zeros(len(self.problem.shape)), 1.0
        found = (-1.0, centre, 0.0)
        for _ in range(ZOOMS):
            steps = np.meshgrid(*[np.linspace(-reach, reach, POINTS)] * centre.size, indexing="ij")
            grid = np.array([s.ravel() for s in steps]).reshape(centre.size, -1)
            x = found[1][:, None] + np.hstack([centre[:, None], grid])  # of equal places the nearest to q
            for value, nu in self._values(x):
                i = int(np.argmax(value))
                if value[i] > found[0]:
                    found = (float(value[i]), x[:, i], float(nu[i]))
            reach *= SHRINK
        return found

    def _values(self, x: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Squared distance at the shape offsets x (s, n), for the greatest and the least nu; -1 where no member is."""
        left = 1.0 - np.sum(x * x, axis=0)
        contact = self.g @ x + self.problem.carried * np.sqrt(np.maximum(left, 0.0)) >= 0.0
        most = np.linalg.norm(self.w_n) - self.turn @ x
        known = (left >= 0.0) & contact & (most >= 0.0)
        return [(np.where(known, self._squared(nu, self.p @ x), -1.0), nu) for nu in (most, np.zeros_like(most))]

    def _squared(self, nu: np.ndarray, p: np.ndarray) -> np.ndarray:
        """Of the distance of S to the end of A, for nu - lambda_tilde p > 0, else 0."""
        wide = np.maximum(nu - self.jump * p, 1e-300)
        Y = np.sqrt(2.0 * self.jump * wide / self.a)
        y = -np.sign(self.kappa) * Y
        delta = (abs(self.kappa) * (nu - 2.0 * self.jump * p) / (self.a * Y) + self.Q_12 * y) / self.Q_11
        length = float(np.linalg.norm(self.ray))
        inward = float(self.side @ self.ray) / length
        along = delta * length + y * inward
        if not self.isolated:
            along = np.maximum(along, 0.0)
        squared = along**2 + y**2 * (float(self.side @ self.side) - inward**2)
        return np.where(nu - self.jump * p > 1e-12, squared, 0.0)
