"""The right velocities that Coulomb's law with maximal dissipation admits at a tangential contact.

Where g(q) = 0 and <u-, n> = 0 they are u+ = u- + M^-1 W r with r = lambda (1, s), lambda >= 0, s in the section, u+_n
= 0 and, where lambda > 0, the least s.u+_t (paper, section 1; docs/theory.md, sections 2 and 3). u- itself is
one.

Which others there are. Write G = [[a, b], [b, C]] and let the section be the unit disc (or, for k = 1, [-1, 1]).
1. lambda > 0 asks for a + b.s = 0. If gamma > 0 there is no such s: {u-}.
2. If u+_t = 0, then r = -G^-1 (0, v_t): sticking is at most one solution. Otherwise |s| = 1.
3. k = 1: s = -a/b, so |s| = 1 only where gamma = 0; there u+_t = v_t + lambda (b + C s), and s (b + C s) = C s^2 - a
   = rho.G rho > 0, rho = (1, s). If s v_t < 0, every lambda up to the sticking one solves the problem; if not, none
   does. For gamma < 0 sticking is in the cone if and only if b v_t > 0. So the set is A(q, u-) of the projection (7).
4. k = 2, gamma < 0: a + b.d = 0 holds for two unit vectors d. Friction opposes the slip where d x (v_t + lambda (b +
C d))
   = 0 and d.(v_t + lambda (b + C d)) < 0. The first equation is linear in lambda: a slip each at most, and a family of
   them, from u- to sticking, only where v_t and b + C d are both parallel to d. So in general the set is finite: u-,
   sticking where it is in the cone, and at most two slips; A(q, u-) of the projection is {u-, u_tilde}.
5. k = 2, gamma = 0: d = -b/|b| alone, a double root of a + b.d = 0. d x (b + C d) = d x C d does not vanish unless b is
   an eigenvector of C: there is at most one slip. If b is one, there is none unless v_t is parallel to b, and then the
   segment from u- to sticking if d.v_t < 0. So a slip that is oblique to b may not jump, where the projection does.

When there must be a jump. Dissipation, r.u <= 0, gives r.G r <= -r.v: all solutions of the one-step problem are
bounded, uniformly while b is shrunk to 0, and there the solution is unique (a convex problem). So the degree of the
natural map of the problem is 1 for every v and G: it has a solution, and generically an odd number of them. At v_n =
0 let c = a - b.v_t/|v_t| be the normal compliance against the slip. For v_n < 0, small, u- continues as a slip if c >
0 and as nothing if c < 0, while isolated jumps continue. Hence generically the number of jumps is odd, and there is
one, if c < 0; it is even if c > 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import sympy as sp

from painleve import sets
from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.state import State
from painleve.theory.coulomb.impulses import Impulse, ImpulseKind, find_impulses
from painleve.theory.coulomb.problem import ContactProblem, problem_at, recognised

__all__ = ["CoulombJump", "CoulombLimitSet", "coulomb_limit_set"]


@dataclass(frozen=True, kw_only=True, eq=False)
class CoulombJump:
    """One right velocity, or the open segment of them from `velocity` to `end`, with the impulses; all exact.

    `kind` is open (u+ = u-, no impulse), stick or slip; `multiplicity` that of the root of the slip equation, None of a
    family.
    """

    kind: ImpulseKind
    impulse: tuple[sp.Expr, ...]
    velocity: tuple[sp.Expr, ...]
    multiplicity: int | None
    end_impulse: tuple[sp.Expr, ...] | None
    end: tuple[sp.Expr, ...] | None

    def __repr__(self) -> str:
        return f"CoulombJump({self.kind}{', a family' if self.end is not None else ''})"


@dataclass(frozen=True, kw_only=True, eq=False)
class CoulombLimitSet:
    """Coulomb's right velocities at (q, u-): finitely many, or with a family (a segment) among them; or undecided."""

    state: State
    kind: Literal["finite", "family", "undecided"]
    gamma: Signed
    jumps: tuple[CoulombJump, ...]
    reason: str

    def __repr__(self) -> str:
        jumps = ", ".join(jump.kind for jump in self.jumps)
        return f"CoulombLimitSet({self.state.scene.name!r}, {self.state.label!r}, {self.kind}: {jumps})"

    @property
    def parts(self) -> tuple[sets.Points | sets.LineSegment, ...]:
        """The closure of the set in the space of velocities, to rounding: its segments, then its other points.

        Raises ValueError where the set is undecided.
        """
        if self.kind == "undecided":
            raise ValueError(f"Coulomb's right velocities are undecided: {self.reason}")
        segments = [
            sets.LineSegment(self.floats(j.velocity), self.floats(j.end)) for j in self.jumps if j.end is not None
        ]
        points = [self.floats(jump.velocity) for jump in _isolated(self.jumps)]
        return (*segments, *([sets.Points(np.array(points))] if points else []))

    def floats(self, velocity: tuple[sp.Expr, ...]) -> np.ndarray:
        """(d,) floats of a velocity of these, without negative zeros."""
        return np.array([self.state.number(x) for x in velocity]) + 0.0

    def as_dict(self) -> dict[str, object]:
        return {
            "scene": self.state.scene.name,
            "state": self.state.label,
            "law": "coulomb",
            "kind": self.kind,
            "reason": self.reason,
            "gamma": self.gamma.value,
            "sign_of_gamma": self.gamma.sign.name.lower(),
            "u_minus": self.floats(self.state.u).tolist(),
            "solutions": [self._as_dict(jump) for jump in self.jumps],
        }

    def _as_dict(self, jump: CoulombJump) -> dict[str, object]:
        return {
            "kind": jump.kind,
            "impulse": [self.state.number(x) for x in jump.impulse],
            "velocity": self.floats(jump.velocity).tolist(),
            "multiplicity": jump.multiplicity,
            "end": None if jump.end is None else self.floats(jump.end).tolist(),
        }


def coulomb_limit_set(state: State) -> CoulombLimitSet:
    """Coulomb's right velocities of a state, from exact signs; kind "undecided" where a sign cannot be decided."""
    problem = problem_at(state)
    found, doubts = find_impulses(problem)
    jumps = tuple(_jump(problem, impulse) for impulse in found)
    family = any(jump.end is not None for jump in jumps)
    return CoulombLimitSet(
        state=state,
        kind="undecided" if doubts else "family" if family else "finite",
        gamma=problem.gamma,
        jumps=jumps,
        reason="; ".join(doubts) or _reason(problem, jumps),
    )


def _jump(problem: ContactProblem, found: Impulse) -> CoulombJump:
    return CoulombJump(
        kind=found.kind,
        impulse=found.values,
        velocity=_after(problem, found.values),
        multiplicity=found.multiplicity,
        end_impulse=found.end,
        end=None if found.end is None else _after(problem, found.end),
    )


def _after(problem: ContactProblem, impulse: tuple[sp.Expr, ...]) -> tuple[sp.Expr, ...]:
    return tuple(recognised(x) for x in problem.velocity + problem.responses * sp.Matrix(impulse))


def _reason(problem: ContactProblem, jumps: tuple[CoulombJump, ...]) -> str:
    sign = f"gamma is {problem.gamma.sign.value}"
    if len(jumps) == 1:
        return f"{sign}: Coulomb's law admits no jump"
    said = [f"jump to {jump.kind}" for jump in _isolated(jumps) if jump.kind != "open"]
    said += ["take any velocity of a family up to sticking" for j in jumps if j.end is not None]
    return f"{sign}: stay at u-, or {', or '.join(said)}"


def _isolated(jumps: tuple[CoulombJump, ...]) -> list[CoulombJump]:
    """Those that are no end of a family."""
    ends = [end for jump in jumps if jump.end_impulse is not None for end in (jump.impulse, jump.end_impulse)]
    return [jump for jump in jumps if jump.end is None and not any(_same(jump.impulse, end) for end in ends)]


def _same(first: tuple[sp.Expr, ...], second: tuple[sp.Expr, ...]) -> bool:
    return all(exact_sign(x - y).sign is Sign.ZERO for x, y in zip(first, second, strict=True))
