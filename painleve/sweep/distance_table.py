"""The arrays of a sweep of distances while they fill up, and the dataset that they become."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from painleve.asymptotics.member import Member
from painleve.asymptotics.theorem import Evidence, Verdict
from painleve.dataset_names import IN_SWEEPS, hold_to
from painleve.errors import InputError
from painleve.mechanics.norm_units import ball_unit, gamma_unit, velocity_unit
from painleve.sets import Bounds
from painleve.sweep.grid import SweepGrid
from painleve.sweep.variables import BRANCHES, LAW_BRANCHES, OUTCOMES, STATUSES, code, coded, text
from painleve.theory.classification import Classification

__all__ = ["DistanceTable"]

# Names of the bounded numbers, with the sentence that each side completes.
MEASURED = {
    "excess_Aeps_A": "e(A_eps, A), how far members of A_eps lie from A (eq. 9)",
    "excess_A_Aeps": "e(A, A_eps), how far points of A lie from A_eps (eq. 10)",
    "hausdorff": "the Hausdorff distance between A and A_eps",
    "ends_excess_Aeps_A": "e(A_eps, {u-, u_tilde}), how far members lie from the ends of A",
    "ends_excess_A_Aeps": "e({u-, u_tilde}, A_eps), how far the ends of A lie from A_eps",
    "ends_hausdorff": "the Hausdorff distance between the ends of A and A_eps",
}


class DistanceTable:
    """The arrays of the dataset while they fill up; a point is an index of the grid, with eps last."""

    def __init__(self, grid: SweepGrid, eps: np.ndarray) -> None:
        self.grid, self.eps = grid, eps
        self.at_state, self.at_eps = grid.shape, (*grid.shape, len(eps))
        d = grid.scene.dimension
        self.bounds = {f"{name}_{side}": self._nan() for name in MEASURED for side in ("lower", "upper")}
        self.witnessed, self.fit, self.seconds = self._nan(), self._nan(), self._nan()
        self.outcome, self.reason = np.zeros(self.at_eps, np.int8), np.full(self.at_eps, "", dtype=object)
        self.counts = np.full((*self.at_eps, len(LAW_BRANCHES)), -1, dtype=np.int64)
        self.farthest = {name: np.full((*self.at_eps, d), np.nan) for name in ("dq", "dv", "offset")}
        self.farthest_branch = np.zeros(self.at_eps, np.int8)
        self.gamma, self.slope, self.half_jump = (np.full(self.at_state, np.nan) for _ in range(3))
        self.branch, self.status = np.zeros(self.at_state, np.int8), np.zeros(self.at_state, np.int8)
        self.why_branch, self.why_status = (np.full(self.at_state, "", dtype=object) for _ in range(2))
        self.u_minus, self.u_tilde = (np.full((*self.at_state, d), np.nan) for _ in range(2))

    def _nan(self) -> np.ndarray:
        return np.full(self.at_eps, np.nan)

    def fail(self, index: tuple[int, ...], reason: str) -> None:
        """One point, or all eps of a state."""
        self.outcome[index] = code("failed", OUTCOMES)
        self.reason[index] = reason

    def refuse_if_all_failed(self) -> None:
        if np.all(self.outcome == code("failed", OUTCOMES)):
            raise InputError(self.reason.flat[0])

    def put_state(self, index: tuple[int, ...], classification: Classification) -> None:
        limit = classification.limit
        self.branch[index] = code(classification.branch.value, BRANCHES)
        self.why_branch[index], self.gamma[index] = classification.reason, limit.gamma_value
        self.u_minus[index], self.u_tilde[index] = limit.u_minus, limit.u_plus
        self.half_jump[index] = np.linalg.norm(limit.jump) / 2.0

    def put_evidence(self, index: tuple[int, ...], evidence: Evidence, seconds: float) -> None:
        for prefix, measured in (("", evidence.distance), ("ends_", evidence.ends)):
            self._put_bounds(f"{prefix}excess_Aeps_A", index, measured.excess_Aeps_A.bounds)
            self._put_bounds(f"{prefix}excess_A_Aeps", index, measured.excess_A_Aeps.bounds)
            self._put_bounds(f"{prefix}hausdorff", index, measured.hausdorff)
        for label, count in evidence.distance.counts.items():
            self.counts[(*index, LAW_BRANCHES.index(label))] = count
        self._put_farthest(index, evidence.distance.excess_Aeps_A.member)
        self.witnessed[index] = np.nan if evidence.witnessed is None else evidence.witnessed
        self.seconds[index], self.outcome[index] = seconds, code("done", OUTCOMES)

    def _put_bounds(self, name: str, index: tuple[int, ...], bounds: Bounds) -> None:
        for side, value in bounds.as_dict().items():
            self.bounds[f"{name}_{side}"][index] = np.nan if value is None else value

    def _put_farthest(self, index: tuple[int, ...], member: Member | None) -> None:
        if member is not None:
            self.farthest["dq"][index], self.farthest["dv"][index] = member.dq, member.dv
            self.farthest["offset"][index] = member.offset
            self.farthest_branch[index] = code(member.branch.label, LAW_BRANCHES)

    def put_verdict(self, index: tuple[int, ...], verdict: Verdict) -> None:
        self.status[index], self.why_status[index] = code(verdict.status.value, STATUSES), verdict.reason
        if verdict.slope is not None:
            self.slope[index] = verdict.slope
            self.fit[index] = _line(self.eps, verdict.slope, self._judged(index))

    def _judged(self, index: tuple[int, ...]) -> np.ndarray:
        """The excess whose slope the verdict reports: to the ends of A at an isolated critical state, else to A."""
        isolated = self.branch[index] == code("critical_isolated", BRANCHES)
        return self.bounds[f"{'ends_' if isolated else ''}excess_Aeps_A_lower"][index]

    def dataset(self, attributes: Mapping[str, str]) -> xr.Dataset:
        """Variables with their dimensions, units and sentences."""
        variables = self._eps_variables() | self._state_variables()
        scene = self.grid.scene
        eps = {"units": ball_unit(scene), "long_name": "radius of the two closed balls about q and about u-"}
        coordinates = self.grid.coordinates() | {
            "eps": xr.Variable(("eps",), self.eps, eps),
            "law_branch": text(["law_branch"], list(LAW_BRANCHES), "branch of the discrete contact law S"),
            "coordinate": text(["coordinate"], [c.name for c in scene.coordinates], "coordinate of the configuration"),
        }
        dataset = xr.Dataset(variables, coordinates, dict(attributes))
        hold_to(IN_SWEEPS, [*dataset.variables, *dataset.dims], self.grid.own_names)
        return dataset

    def _eps_variables(self) -> dict[str, xr.Variable]:
        dims, unit = (*self.grid.dims, "eps"), velocity_unit(self.grid.scene)

        def number(values: np.ndarray, sentence: str, units: str = unit, *more: str) -> xr.Variable:
            return xr.Variable((*dims, *more), values, {"units": units, "long_name": sentence})

        found = {
            f"{name}_{side}": number(
                self.bounds[f"{name}_{side}"], f"{side} bound on {sentence}; NaN where that side is unknown"
            )
            for name, sentence in MEASURED.items()
            for side in ("lower", "upper")
        }
        found["witnessed_upper"] = number(
            self.witnessed, "upper bound on e(A, A_eps) from witnesses that shadow all of A; NaN where none were found"
        )
        found["fit"] = number(self.fit, "power law fitted to the excess whose slope the verdict reports")
        found["seconds"] = number(self.seconds, "wall time of the point, compilation at first use included", "s")
        sentence = "evaluations of the law by its branch; -1 where not run"
        found["counts"] = number(self.counts, sentence, "1", "law_branch")
        for name, letter, units in (("dq", "q", ball_unit(self.grid.scene).split(";")[0]), ("dv", "u-", unit)):
            sentence = f"offset from {letter} of the preimage of the member farthest from A"
            found[f"farthest_{name}"] = number(self.farthest[name], sentence, units, "coordinate")
        sentence = "offset from u- of the member of A_eps farthest from A"
        found["farthest_offset"] = number(self.farthest["offset"], sentence, unit, "coordinate")
        sentence = "branch of the law at the member farthest from A"
        found["farthest_branch"] = coded(dims, self.farthest_branch, LAW_BRANCHES, sentence)
        found["outcome"] = coded(dims, self.outcome, OUTCOMES, "how the computation of the point ended")
        found["outcome_reason"] = text(dims, self.reason, "why the point failed, empty otherwise")
        return found

    def _state_variables(self) -> dict[str, xr.Variable]:
        dims, unit, own = self.grid.dims, velocity_unit(self.grid.scene), gamma_unit(self.grid.scene)

        def number(values: np.ndarray, sentence: str, units: str, *more: str) -> xr.Variable:
            return xr.Variable((*dims, *more), values, {"units": units, "long_name": sentence})

        return {
            "gamma": number(self.gamma, "gamma(q), the least normal compliance over the friction section", own),
            "half_jump": number(self.half_jump, "half the distance between u- and u_tilde", unit),
            "slope": number(self.slope, "slope of the logarithm of the excess against that of eps", "1"),
            "u_minus": number(self.u_minus, "left velocity u- of the state", unit, "coordinate"),
            "u_tilde": number(self.u_tilde, "other end u_tilde of the limit set A", unit, "coordinate"),
            "theorem_branch": coded(dims, self.branch, BRANCHES, "branch of Theorem 1, by exact arithmetic"),
            "theorem_branch_reason": text(dims, self.why_branch, "why this branch of Theorem 1 holds"),
            "verdict": coded(dims, self.status, STATUSES, "what the distances say of the branch's statement"),
            "verdict_reason": text(dims, self.why_status, "on what the verdict on the statement rests"),
        }


def _line(eps: np.ndarray, slope: float, values: np.ndarray) -> np.ndarray:
    """The power law of that slope through the geometric mean of the positive values."""
    known = values > 0.0
    level = np.mean(np.log(values[known]) - slope * np.log(eps[known]))
    return np.exp(level + slope * np.log(eps))
