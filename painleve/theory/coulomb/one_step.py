"""Coulomb's law with maximal dissipation at one configuration and velocity: all of its solutions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np
import sympy as sp
from flint import arb, ctx

from painleve.exact.balls import ball
from painleve.exact.signs import Sign, Signed
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number
from painleve.theory.coulomb.impulses import BITS, Exact, Impulse, ImpulseKind, find_impulses
from painleve.theory.coulomb.problem import ContactProblem, Numbers, make_problem, recognised

__all__ = ["CoulombSolution", "CoulombSolutions", "Enumeration", "coulomb_solutions", "enumerate_solutions"]


class Enumeration(Enum):
    """Whether the list of solutions is known to be complete."""

    COMPLETE = "complete"
    UNDECIDED = "undecided"


@dataclass(frozen=True, kw_only=True, eq=False)
class CoulombSolution:
    """One solution, or a family of them; all numbers are rounded from exact ones or from balls of 256 bits.

    `impulse` = (lambda, r_t), (1 + k,), in the units of M times velocity along the gradients; `velocity` = u (d,);
    `contact_velocity` = (u_n, u_t), (1 + k,); `slip` = u_t/|u_t| (k,), zeros where the tip sticks. `multiplicity`
    counts a double root of the slip equation twice. A family has None there and in `family` the impulses (2, 1 + k)
    and in `family_velocities` the velocities (2, d) at its two ends, which need not belong to it; what else is said
    of it holds at its middle. `residual` is by how much, in the units of the contact velocity and in double
    precision, the rounded impulse misses u_n = 0 (or u_n >= 0) and the least s.u_t.
    """

    kind: ImpulseKind
    impulse: np.ndarray
    velocity: np.ndarray
    contact_velocity: np.ndarray
    slip: np.ndarray
    multiplicity: int | None
    residual: float
    family: np.ndarray | None
    family_velocities: np.ndarray | None

    def __repr__(self) -> str:
        impulse = ", ".join(f"{x:.6g}" for x in self.impulse)
        return f"CoulombSolution({_named(self)}, impulse = ({impulse}))"


@dataclass(frozen=True, kw_only=True, eq=False)
class CoulombSolutions:
    """All solutions at (q, v), as far as exact arithmetic decided; `doubts` says what it did not decide."""

    solutions: tuple[CoulombSolution, ...]
    gamma: Signed
    enumeration: Enumeration
    doubts: tuple[str, ...]

    def __repr__(self) -> str:
        return f"CoulombSolutions({', '.join(map(_named, self.solutions)) or 'none found'}: {self.enumeration.value})"

    @property
    def sentence(self) -> str:
        """How many there are, of which kinds."""
        kinds = ", ".join(_named(solution) for solution in self.solutions) or "none found"
        count = len(self.solutions)
        head = f"{count} solution{'s' * (count != 1)}: {kinds}"
        return head if not self.doubts else f"{head}; undecided: {'; '.join(self.doubts)}"


def coulomb_solutions(
    scene: Scene, q: Numbers, v: Numbers, *, parameters: Mapping[str, Number] | None = None
) -> CoulombSolutions:
    """Every solution of Coulomb's one-step problem with maximal dissipation at a configuration q and a velocity v.

    Wanted are r = lambda (1, s), lambda >= 0, s in the section of friction, and u = v + M^-1 W r with u_n >= 0,
    lambda u_n = 0 and, where lambda > 0, the least s.u_t (docs/theory.md, section 2). Where g(q) < 0 there is no
    contact and u = v alone. q and v are sequences, or mappings from the coordinates and from `u_<coordinate>`; their
    numbers and the parameters are exact as in a state: text, fractions, sympy numbers, and a float means the decimal
    that it prints. The number of solutions and their multiplicities are decided, by exact arithmetic for rational
    data and by balls for other, or `enumeration` is UNDECIDED. A disc or an ellipse has at most three of them, families
    apart (docs/theory.md, section 2.6), a polygon may have more: five and seven occur (section 10.1).

    Raises InputError for bad numbers, and where M, the tangents or the section are not sound at q.
    """
    return enumerate_solutions(make_problem(scene, q, v, parameters))


def enumerate_solutions(problem: ContactProblem) -> CoulombSolutions:
    """The same of a problem whose numbers were read before."""
    impulses, doubts = find_impulses(problem)
    return CoulombSolutions(
        solutions=tuple(_rounded(problem, impulse) for impulse in impulses),
        gamma=problem.gamma,
        enumeration=Enumeration.UNDECIDED if doubts else Enumeration.COMPLETE,
        doubts=tuple(doubts),
    )


def _named(solution: CoulombSolution) -> str:
    if solution.family is not None:
        return f"a family with {solution.kind}"
    return solution.kind if solution.multiplicity == 1 else f"{solution.kind} (multiplicity {solution.multiplicity})"


def _rounded(problem: ContactProblem, found: Impulse) -> CoulombSolution:
    with ctx.workprec(BITS):
        ends = [found.values] if found.end is None else [found.values, found.end]
        middle = tuple(sum(x) / len(ends) for x in zip(*ends, strict=True))
        contact = _moved(problem.contact_velocity, problem.delassus, middle)
        velocities = [_floats(_moved(problem.velocity, problem.responses, r)) for r in (middle, *ends)]
        impulse = _floats(middle)
        if found.kind != "open":
            contact[0] = sp.Integer(0)
        if found.kind == "stick":
            contact = [sp.Integer(0)] * len(contact)
        return CoulombSolution(
            kind=found.kind,
            impulse=impulse,
            contact_velocity=_floats(contact),
            slip=_unit(contact[1:]),
            velocity=velocities[0],
            multiplicity=found.multiplicity,
            residual=_residual(problem, impulse),
            family=None if found.end is None else np.array([_floats(r) for r in ends]),
            family_velocities=None if found.end is None else np.array(velocities[1:]),
        )


def _moved(start: sp.MatrixBase, response: sp.MatrixBase, impulse: tuple[Exact, ...]) -> list[Exact]:
    """start + response impulse: exact numbers stay exact."""
    if all(isinstance(x, sp.Expr) for x in impulse):
        return [recognised(x) for x in start + response * sp.Matrix(impulse)]
    return [
        _ball(start[i]) + sum((_ball(response[i, j]) * _ball(r) for j, r in enumerate(impulse)), arb(0))
        for i in range(response.rows)
    ]


def _ball(number: Exact) -> arb:
    return ball(number, bits=BITS) if isinstance(number, sp.Expr) else number


def _floats(numbers: Iterable[Exact]) -> np.ndarray:
    return np.array([float(_ball(x).mid()) for x in numbers]) + 0.0  # no negative zeros


def _unit(velocity: list[Exact]) -> np.ndarray:
    u = _floats(velocity)
    size = float(np.linalg.norm(u))
    return u / size if size > 0.0 else u


def _residual(problem: ContactProblem, impulse: np.ndarray) -> float:
    """In plain doubles, from the rounded impulse and the rounded data."""
    G, v = (_floats(m).reshape(m.shape) for m in (problem.delassus, problem.contact_velocity))
    u = v[:, 0] + G @ impulse
    if impulse[0] == 0.0:
        return 0.0 if problem.constraint.sign is Sign.NEGATIVE else max(0.0, -float(u[0]))
    dissipation = float(impulse[1:] @ u[1:]) / impulse[0]
    return max(abs(float(u[0])), abs(dissipation - _least_product(problem, u[1:])))


def _least_product(problem: ContactProblem, u_t: np.ndarray) -> float:
    """The least s.u_t over the section."""
    if problem.section_map is not None:
        E = _floats(problem.section_map).reshape(2, 2)
        return -float(np.linalg.norm(E.T @ u_t))
    return min((float(_floats(V) @ u_t) for V in problem.vertices), default=0.0)
