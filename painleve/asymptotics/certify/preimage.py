"""From a point that an optimiser found, in doubles, to a member of A_eps: an exact preimage in the two balls."""

from __future__ import annotations

import flint
import numpy as np

from painleve.asymptotics.ball_arithmetic import BITS, Balls, is_inside
from painleve.asymptotics.certify.branch_and_bound import Candidate
from painleve.asymptotics.local import LocalProblem
from painleve.asymptotics.member import Member, base_balls, make_member, row_balls
from painleve.asymptotics.search import SLIPS

__all__ = ["candidate_member", "free_member"]

# An optimum is at the boundary of its domain, as a rule: how far it is drawn inside, in units of eps, to be a member.
SHRINK = (1e-13, 1e-11, 1e-9, 1e-7, 1e-5, 1e-3)


def free_member(problem: LocalProblem, eps: float) -> Member:
    """A member without contact at the distance eps from A: v_eps - u- is orthogonal to A."""
    grad_g = -problem.normal
    across = np.linalg.svd(problem.direction[None, :])[2][-1]
    for depth in (0.5, 0.1, 0.01):
        dq = -depth * eps * grad_g / np.linalg.norm(grad_g)
        if row_balls(problem, [flint.arb(float(x)) for x in dq])[problem.parts.g] < 0:
            return make_member(problem, dq, eps * (1.0 - 1e-15) * across)
    # Where the ball is so large that no such step leaves contact, u- itself is a member.
    return make_member(problem, np.zeros(problem.dimension), np.zeros(problem.dimension))


def candidate_member(problem: LocalProblem, eps: float, candidate: Candidate) -> Member | None:
    """The member over the candidate's point, drawn inside its domain by as little as makes it one; None: it is none."""
    for shrink in SHRINK:
        dq = _configuration(problem, eps, candidate, shrink)
        dv = _velocity(problem, eps, candidate, dq, shrink)
        if not (is_inside(dq, eps) and is_inside(dv, eps) and row_balls(problem, dq)[problem.parts.g] >= 0):
            continue
        try:
            member = make_member(problem, dq, dv)
        except ArithmeticError:
            continue
        if member.branch is candidate.piece.branch:
            return member
    return None


def _configuration(problem: LocalProblem, eps: float, candidate: Candidate, shrink: float) -> Balls:
    """q_eps - q with the candidate's shape coordinates, and the carried ones as deep in contact as the ball lets."""
    xi = candidate.xi * (1.0 - shrink)
    dq = np.zeros(problem.dimension)
    dq[list(problem.shape)] = eps * xi
    if problem.carried > 0.0:
        dq += eps * np.sqrt(max(0.0, (1.0 - shrink / 2.0) ** 2 - float(xi @ xi))) * problem.carried_direction
        return [flint.arb(float(x)) for x in dq]
    return _into_contact(problem, [flint.arb(float(x)) for x in dq], eps)


def _into_contact(problem: LocalProblem, dq: Balls, eps: float) -> Balls:
    """Newton steps along grad g, where g < 0 by a little: onto a penetration that p cannot tell from none."""
    grad_g = -problem.normal
    squared = float(grad_g @ grad_g)
    if row_balls(problem, dq)[problem.parts.g] >= 0:
        return dq
    with flint.ctx.workprec(BITS):
        wanted = flint.arb(1e-9) * flint.arb(eps) ** 2
        for _ in range(4):
            lack = (wanted - row_balls(problem, dq)[problem.parts.g]) / squared
            dq = [flint.arb((x + lack * float(y)).mid()) for x, y in zip(dq, grad_g, strict=True)]
    return dq


def _velocity(problem: LocalProblem, eps: float, candidate: Candidate, dq: Balls, shrink: float) -> Balls:
    """v_eps - u-: with v_n = -Lambda p for a slip whose impulse is given, else with v_n a little below zero."""
    piece = candidate.piece
    w_n = row_balls(problem, dq)[problem.parts.w_n]
    with flint.ctx.workprec(BITS):
        dv = [flint.arb(float(eps * (1.0 - shrink) * x)) for x in candidate.w]
        v = [x + y for x, y in zip(dv, base_balls(problem)[2], strict=True)]
        v_n = sum((x * y for x, y in zip(w_n, v, strict=True)), flint.arb(0))
        squared = sum((x * x for x in w_n), flint.arb(0))
        if piece.lam is None:
            push = flint.arb(eps * shrink / 2.0) / squared.sqrt()
            return [flint.arb((x - push * y).mid()) for x, y in zip(dv, w_n, strict=True)]
        row = problem.kernels.rows.edges[SLIPS[piece.branch]]
        impulse = flint.arb(piece.shift) + flint.arb(piece.unit) * flint.arb(candidate.lam)
        excess = (v_n + impulse * row_balls(problem, dq)[row]) / squared
        return [flint.arb((x - excess * y).mid()) for x, y in zip(dv, w_n, strict=True)]
