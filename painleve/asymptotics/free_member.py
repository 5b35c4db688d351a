"""Free members, which are known in closed form."""

from __future__ import annotations

import numpy as np

from painleve.asymptotics.local import LocalProblem
from painleve.asymptotics.member import Member, make_member
from painleve.core.codes import ContactMode

__all__ = ["free_member"]


def free_member(problem: LocalProblem, eps: float, *, away: bool) -> Member:
    """v_eps itself, as far from A or as far along the jump as the ball allows, over a configuration with g < 0."""
    p = problem
    outward = p.normal / np.linalg.norm(p.normal)
    direction = p.direction if p.length > 0.0 else outward
    dv = (-direction if away else direction) * (eps * (1.0 - 1e-15))
    for size in (0.5, 0.1, 1e-2, 1e-3, 1e-4):
        member = make_member(p, outward * (size * eps), dv)
        if member.branch is ContactMode.FREE:
            return member
    raise ArithmeticError("no configuration with g < 0 was found, yet grad g is not zero")
