"""What every method of distance returns: three bounds that know their side, and where they are attained."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from painleve.asymptotics.member import Member
from painleve.sets import Bounds, largest
from painleve.theory.limit_set import LimitSet

__all__ = ["Attained", "Distance"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Attained:
    """Bounds on an excess, with the member of A_eps and the point of A (d,) between which it is attained."""

    bounds: Bounds
    member: Member | None = None
    point: np.ndarray | None = None

    def __repr__(self) -> str:
        return f"Attained({self.bounds})"


@dataclass(frozen=True, kw_only=True, eq=False)
class Distance:
    """e(A_eps, A) (paper, eq. 9), e(A, A_eps) (eq. 10) and d_H, in the Euclidean norm of the scene's velocities.

    counts: samples or pieces per branch of the law; evaluations: of the law; ending: a sentence that says how it ended.
    """

    limit: LimitSet
    eps: float
    method: str
    excess_Aeps_A: Attained
    excess_A_Aeps: Attained
    counts: Mapping[str, int]
    evaluations: int
    ending: str
    settings: Mapping[str, object] = field(default_factory=dict)

    def __repr__(self) -> str:
        state, there, back = self.limit.state, self.excess_Aeps_A.bounds, self.excess_A_Aeps.bounds
        head = f"Distance({state.scene.name!r}, {state.label!r}, eps = {self.eps:g}, {self.method}"
        return f"{head}: e(A_eps, A) {there}, e(A, A_eps) {back})"

    @property
    def hausdorff(self) -> Bounds:
        return largest(self.excess_Aeps_A.bounds, self.excess_A_Aeps.bounds)

    def as_dict(self) -> dict[str, object]:
        return {
            "eps": self.eps,
            "method": self.method,
            "excess_Aeps_A": self.excess_Aeps_A.bounds.as_dict(),
            "excess_A_Aeps": self.excess_A_Aeps.bounds.as_dict(),
            "hausdorff": self.hausdorff.as_dict(),
            "counts": dict(self.counts),
            "evaluations": self.evaluations,
            "ending": self.ending,
            "settings": dict(self.settings),
        }
