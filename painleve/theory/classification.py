"""Which branch of Theorem 1 (paper, section 3) holds at a state: exact signs of gamma at q and near q."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from painleve.mechanics.state import State
from painleve.progress import told
from painleve.theory.limit_set import LimitSet, limit_set
from painleve.theory.neighbourhood import Neighbourhood, Neighbours, neighbours

__all__ = ["Branch", "Classification", "classify"]


class Branch(Enum):
    """Branches of Theorem 1; NONE where nothing is indeterminate: gamma > 0, or u_tilde = u-."""

    NONE = "none"
    NEGATIVE = "negative"
    CRITICAL_APPROACHED = "critical_approached"
    CRITICAL_ISOLATED = "critical_isolated"
    UNDECIDED = "undecided"


STATEMENTS = {
    Branch.NONE: "A = {u-}, and A_eps tends to it",
    Branch.NEGATIVE: "d_H(A, A_eps) -> 0 with A = {u-, u_tilde}",
    Branch.CRITICAL_APPROACHED: "d_H(A, A_eps) -> 0 with A = [u-, u_tilde]",
    Branch.CRITICAL_ISOLATED: "d_H({u-, u_tilde}, A_eps) -> 0, and d_H([u-, u_tilde], A_eps) -> |u_tilde - u-|/2",
    Branch.UNDECIDED: "no branch is decided",
}

_CRITICAL = {
    Neighbourhood.APPROACHED: Branch.CRITICAL_APPROACHED,
    Neighbourhood.ISOLATED: Branch.CRITICAL_ISOLATED,
    Neighbourhood.UNDECIDED: Branch.UNDECIDED,
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Classification:
    """The branch at a state, decided in exact arithmetic, its limit set, and why."""

    branch: Branch
    limit: LimitSet
    neighbours: Neighbours | None
    reason: str

    def __repr__(self) -> str:
        state = self.limit.state
        return f"Classification({state.scene.name!r}, {state.label!r}, {self.branch.value})"

    @property
    def statement(self) -> str:
        return STATEMENTS[self.branch]

    def as_dict(self) -> dict[str, object]:
        limit = self.limit
        return {
            "scene": limit.state.scene.name,
            "state": limit.state.label,
            "law": "projection",
            "branch": self.branch.value,
            "reason": self.reason,
            "statement": self.statement,
            "gamma": limit.gamma_value,
            "sign_of_gamma": limit.gamma.sign.name.lower(),
            "u_minus": limit.u_minus.tolist(),
            "u_tilde": limit.u_plus.tolist(),
            "limit_set": limit.kind if limit.kind != "undecided" else None,
            "q": [limit.state.number(x) for x in limit.state.q],
            "parameters": {name: limit.state.number(x) for name, x in limit.state.parameters.items()},
        }


@told(lambda state: f"deciding the branch of {state.scene.name} at {state.label}")
def classify(state: State) -> Classification:
    """The branch of Theorem 1 at an exact state: exact signs of gamma at q and near q, or an undecided one."""
    limit = limit_set(state)
    if limit.kind == "point":
        return Classification(branch=Branch.NONE, limit=limit, neighbours=None, reason=limit.reason)
    if limit.kind == "undecided":
        return Classification(branch=Branch.UNDECIDED, limit=limit, neighbours=None, reason=limit.reason)
    if limit.kind == "pair":
        return Classification(branch=Branch.NEGATIVE, limit=limit, neighbours=None, reason=limit.reason)
    near = neighbours(state, limit.edge)
    return Classification(branch=_CRITICAL[near.kind], limit=limit, neighbours=near, reason=f"gamma = 0; {near.reason}")
