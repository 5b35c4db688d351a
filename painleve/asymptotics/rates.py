"""The constant C in d_H = C eps + o(eps), from first derivatives (docs/theory.md, section 9); k <= 1.
In space (k = 2) the rate at gamma = 0 is the root of eps: see painleve.asymptotics.space.rates.

With dq = eps xi and dv = eps eta every row enters by its value and its gradient at q, known to dozens of digits. In the
limit each branch of the law leaves a linear problem on the two unit balls, subject to grad g . xi >= 0 (the coordinates
that only carry the contact give room for it, which the ball counts) and to vdot_n = w_n . eta + (Dw_n xi) . u- <= 0:

- free: C >= 1, always attained;
- sticking: the derivative of the sticking map; at gamma = 0 subject also to vdot_n + lam pdot <= 0, lam the jump's
  impulse and p = a + s b on the critical edge: the full norm where it points beyond u_tilde, else the part across A;
- along the segment, for each impulse l in [0, lam]: the part of eta + l D(M^-1 W rho) xi across A, subject to
  vdot_n + l pdot = 0 and pdot >= 0, over those xi near which p > 0 occurs in contact. Where grad p vanishes or is
  -kappa grad g, kappa >= 0, that is a question of second order: the form of p + kappa g on the tangent directions;
- gamma > 0: the derivative of the slip that balances u-, eta - vdot_n/p M^-1 W rho.

At an isolated critical state A_eps tends to the ends of A, and C belongs to the distance from those.

Closed form. For d = 3 and one shape coordinate, sticking leaves one degree of freedom, with unit velocity e: S changes
by xi c + (n . eta) e, n = P^T e for the sticking projector P. Where Dw_n . u- = 0 nothing couples xi and eta, and C is
the largest of |xi c + m e| over the ends of both intervals, xi in [-k, 1] (k = h/sqrt(h^2 + g'^2), h the carried slope
and g' > 0 the slope of g) and m in [-|n|, |n| sin a], a the angle between n and w_n. For the uniform rod with unit mass
and half length, slip -1 and no spin: C^2 = max over xi, m of 2 (m + 3 xi cos(theta)/4)^2 + 9 xi^2 sin(theta)^2/16, with
|n|^2 = 5/8, cos(a)^2 = 2 c^2/(5 (1 + c^2)), k^2 = 1/(1 + c^2), c = cos(theta).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import combinations, product

import numpy as np
import sympy as sp

from painleve.asymptotics.charts import PlaneChart
from painleve.asymptotics.local import LocalProblem, make_local_problem
from painleve.asymptotics.sample import KINDS
from painleve.asymptotics.search import SLIPS, FarthestMember, PlaneSearch
from painleve.asymptotics.sections.listed import asymptotics_of
from painleve.asymptotics.space.rates import root_rate
from painleve.core.codes import ContactMode
from painleve.errors import InputError
from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.progress import told
from painleve.theory.limit_set import LimitSet
from painleve.theory.neighbourhood import Neighbourhood, neighbours

__all__ = ["Rate", "rate"]

TINY = 1e-100  # in the place of eps: second orders vanish beside first ones, and nothing under- or overflows
LONG = 200  # operations of W^T M^-1 W beyond which a closed form takes minutes and fills the screen
VANISHING = 1e-60  # relative; gradients known to 320 bits are either zero, by an identity, or far above this


@dataclass(frozen=True, kw_only=True, eq=False)
class Rate:
    """C in d_H = C eps^power + o(eps^power), exact to rounding: a maximum found by search, whose closed form is known
    for some. power: 1, or 1/2 in space at gamma = 0.

    part: which members attain it; dq, dv: their offsets in units of eps, to first order; `sentence` says between what.
    """

    limit: LimitSet
    C: float
    part: str
    dq: np.ndarray
    dv: np.ndarray
    sentence: str
    power: float = 1.0

    def __repr__(self) -> str:
        state, power = self.limit.state, "eps" if self.power == 1.0 else f"eps^{self.power:g}"
        return f"Rate({state.scene.name!r}, {state.label!r}, {self.C:.9g} {power}, {self.part})"

    @cached_property
    def closed_form(self) -> sp.Expr | None:
        """C as an exact expression, where one is known and short; worked out when asked for, which takes seconds."""
        if self.part == "free":
            return sp.Integer(1)
        return _closed_form(self.limit) if self.part == "sticking" and self.limit.kind == "pair" else None

    def as_dict(self) -> dict[str, object]:
        form = None if self.closed_form is None else str(self.closed_form)
        return {
            "C": self.C,
            "power": self.power,
            "closed_form": form,
            "part": self.part,
            "dq": self.dq.tolist(),
            "dv": self.dv.tolist(),
            "sentence": self.sentence,
        }


def rate(limit: LimitSet) -> Rate:
    """The rate of d_H(A, A_eps); at an isolated critical state that of d_H({u-, u_tilde}, A_eps).

    Raises InputError where the limit set or the neighbourhood of a critical state is undecided, for more than two shape
    coordinates, and in space unless gamma = 0 on a disc or an ellipse and the jump ends in slip.
    """
    where = f"state {limit.state.label}"
    if limit.kind == "undecided":
        raise InputError(f"{where}: no rate towards a limit set that is undecided: {limit.reason}")
    near = neighbours(limit.state, limit.edge) if limit.critical else None
    if near is not None and near.kind is Neighbourhood.UNDECIDED:
        raise InputError(f"{where}: no rate while it is undecided which part of A is approached: {near.reason}")
    isolated = near is not None and near.kind is Neighbourhood.ISOLATED
    if asymptotics_of(limit.state.scene.contact).branch_excesses is None:
        return _in_space(limit, isolated)
    problem = make_local_problem(limit)
    if len(problem.shape) > 2:
        raise InputError(
            f"rate: scene {limit.state.scene.name} has {len(problem.shape)} coordinates on which the law "
            "depends; at most 2 are searched"
        )
    if not problem.analytic:
        raise InputError(f"rate: scene {limit.state.scene.name} is not analytic at this state: it has no derivatives")
    search = _FirstOrder(problem, isolated)
    found = search.best(search.branches, search.kind)
    sentence = _sentence(limit, isolated)
    if found is None or found.value <= 1.0:
        away = -problem.direction if problem.length > 0.0 else problem.normal
        dq, dv = np.zeros(problem.dimension), away / np.linalg.norm(away)
        return Rate(limit=limit, C=1.0, part="free", dq=dq, dv=dv, sentence=sentence)
    return Rate(
        limit=limit,
        C=found.value,
        part=_part(limit, found),
        dq=_unit_offset(problem, found),
        dv=found.dv,
        sentence=sentence,
    )


def _in_space(limit: LimitSet, isolated: bool) -> Rate:
    root = root_rate(limit, isolated)
    return Rate(
        limit=limit,
        C=root.C,
        part="beside the end u_tilde of the segment",
        dq=root.dq,
        dv=root.dv,
        power=0.5,
        sentence=_sentence(limit, isolated).replace("eps + o(eps)", "sqrt(eps) + o(sqrt(eps))"),
    )


class _FirstOrder(PlaneSearch):
    """The search over the unit balls with rows that are linear in the offsets."""

    def __init__(self, problem: LocalProblem, isolated: bool) -> None:
        limit, base = problem.limit, problem.base.copy()
        if limit.gamma.sign is Sign.ZERO and limit.edge:
            base[problem.kernels.rows.edges[limit.edge]] = 0.0
        self.gradients = _gradients(problem)
        kind = KINDS["pair" if isolated else limit.kind]
        super().__init__(problem, TINY, kind, lambda x: TINY * (self.gradients @ x), base=base)
        self.critical = {1: ContactMode.SLIP_PLUS, -1: ContactMode.SLIP_MINUS}[limit.edge] if limit.critical else None
        if isolated:
            self.branches = tuple(b for b in self.branches if b is not self.critical)

    def charts(self, branch: ContactMode) -> Sequence[PlaneChart]:
        """On the critical edge the sign of p may be a question of second order."""
        if branch is not self.critical:
            return super().charts(branch)
        p = self.gradients[self.problem.kernels.rows.edges[SLIPS[branch]]]
        if self.problem.carried == 0.0 and len(p) == 2 and np.any(p) and _parallel(self.problem.limit):
            return self._along_the_constraint(p, branch)
        if np.any(p):
            return super().charts(branch)
        form = _hessian(self.problem, branch)
        return self.within(lambda x: np.stack([self.contact(x), np.sum(x * (form @ x), axis=0)]))

    def _along_the_constraint(self, p: np.ndarray, branch: ContactMode) -> Sequence[PlaneChart]:
        """grad p = -kappa grad g. kappa < 0: p > 0 wherever g > 0. Else approached along the tangent alone."""
        g = self.gradients[self.problem.parts.g]
        if p @ g > 0.0:
            return self.within(lambda x: self.contact(x)[None, :])
        tangent = np.array([-g[1], g[0]]) / np.linalg.norm(g)
        # On the tangent g and p vanish to first order: exactly so, not up to rounding.
        self.gradients[self.problem.kernels.rows.edges[SLIPS[branch]]] = 0.0
        return [PlaneChart(size=1, place=lambda box: tangent[:, None] * (2.0 * box[0] - 1.0))]


def _gradients(problem: LocalProblem) -> np.ndarray:
    """(R, s): derivatives of all rows with respect to the shape coordinates."""
    rows = problem.kernels.rows
    full = np.zeros((problem.base.size, len(problem.shape)))
    for m, powers in enumerate(problem.powers):
        if sum(powers) == 1:
            full[list(rows.varying), powers.index(1)] = problem.table[:, m]
    return np.where(np.abs(full) > VANISHING * np.max(np.abs(full), initial=0.0), full, 0.0)


def _hessian(problem: LocalProblem, branch: ContactMode) -> np.ndarray:
    """Second derivatives of a + s b on that edge, halved, with respect to the shape coordinates."""
    row = problem.table[problem.kernels.rows.varying.index(problem.kernels.rows.edges[SLIPS[branch]])]
    form = np.zeros((len(problem.shape), len(problem.shape)))
    for powers, value in zip(problem.powers, row, strict=True):
        axes = [j for j, power in enumerate(powers) for _ in range(power)]
        if len(axes) == 2:
            form[axes[0], axes[1]] += 0.5 * value
            form[axes[1], axes[0]] += 0.5 * value
    return form


def _parallel(limit: LimitSet) -> bool:
    """Whether grad p is parallel to grad g, exactly."""
    state, d = limit.state, derive(limit.state.scene)
    p = d.edge_compliance[limit.edge]
    grads = [[state.exact(sp.diff(f, x)) for x in state.scene.q] for f in (p, state.scene.contact.constraint)]
    for i, j in combinations(range(len(grads[0])), 2):
        minor = exact_sign(grads[0][i] * grads[1][j] - grads[0][j] * grads[1][i])
        if minor.sign is Sign.UNDECIDED:
            raise InputError(
                f"state {limit.state.label}: no rate while it is undecided whether grad gamma is parallel "
                f"to grad g: {minor.reason}"
            )
        if minor.sign is not Sign.ZERO:
            return False
    return True


def _unit_offset(problem: LocalProblem, found: FarthestMember) -> np.ndarray:
    dq = np.zeros(problem.dimension)
    dq[list(problem.shape)] = found.x
    return dq + problem.carried_direction * np.sqrt(max(0.0, 1.0 - float(dq @ dq)))


def _part(limit: LimitSet, found: FarthestMember) -> str:
    if found.branch is ContactMode.STICK:
        return "at the end u_tilde of the segment" if limit.kind == "segment" else "sticking"
    if found.branch in SLIPS:
        return "along the segment" if limit.kind == "segment" else "slipping"
    return "impact without friction"


def _sentence(limit: LimitSet, isolated: bool) -> str:
    if isolated:
        return "d_H({u-, u_tilde}, A_eps) = C eps + o(eps); d_H([u-, u_tilde], A_eps) tends to |u_tilde - u-|/2"
    sets = {"point": "{u-}", "pair": "{u-, u_tilde}", "segment": "[u-, u_tilde]"}
    return f"d_H(A, A_eps) = C eps + o(eps) with A = {sets[limit.kind]}"


@told(lambda limit: f"working out C in closed form for {limit.state.scene.name}")
def _closed_form(limit: LimitSet) -> sp.Expr | None:
    """C of the sticking branch where it has a closed form (see above), exact; None elsewhere."""
    state, scene, d = limit.state, limit.state.scene, derive(limit.state.scene)
    if scene.dimension != 3 or len(d.shape) != 1 or sum(x.count_ops() for x in d.delassus) > LONG:
        return None
    theta, u = scene.q[d.shape[0]], sp.Matrix(scene.u)
    if exact_sign(state.exact((sp.diff(d.normal, theta).T * u)[0, 0])).sign is not Sign.ZERO:
        return None
    stopped = _stopped(scene)
    e = d.normal.cross(scene.contact.tangents)
    e = state.exact(e / sp.sqrt((e.T * e)[0, 0]))
    change = state.exact(-sp.diff(stopped, theta) * u)
    n, normal = e - state.exact(stopped.T) * e, state.exact(d.normal)
    size2, leaning = (n.T * n)[0, 0], (n.T * normal)[0, 0]
    # m runs from -|n| on the side of falling v_n to |n| sin(a) on the other.
    inward = -1 if sp.N(leaning) < 0 else 1
    m_ends = (-inward * sp.sqrt(size2), inward * sp.sqrt(size2 - leaning**2 / (normal.T * normal)[0, 0]))
    slope = state.exact(sp.diff(scene.contact.constraint, theta))
    carried = sum((state.exact(d.normal[i]) ** 2 for i in d.carried), sp.Integer(0))
    sense = -1 if sp.N(slope) < 0 else 1
    xi_ends = (sp.Integer(sense), -sense * sp.sqrt(carried / (carried + slope**2)))
    squares = [
        xi**2 * (change.T * change)[0, 0] + 2 * xi * m * (change.T * e)[0, 0] + m**2
        for xi, m in product(xi_ends, m_ends)
    ]
    largest = max(squares, key=sp.N)
    return sp.sqrt(largest if largest.atoms(sp.Function) else sp.simplify(largest))


@lru_cache(maxsize=16)
def _stopped(scene: Scene) -> sp.MatrixBase:
    """Y G^-1 W^T: what of v the sticking impulse takes away."""
    d = derive(scene)
    W, Y = d.normal.row_join(scene.contact.tangents), d.normal_response.row_join(d.tangent_response)
    inverse = (W.T * Y).applyfunc(sp.cancel).inv().applyfunc(_shortened)
    return (Y * inverse * W.T).applyfunc(_shortened).applyfunc(sp.expand_trig)


def _shortened(x: sp.Expr) -> sp.Expr:
    return sp.trigsimp(sp.cancel(x))
