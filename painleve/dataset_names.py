"""The names in datasets that also hold quantities under the names that a scene gives them: a register.

Imports go upwards only: the rooms that make such datasets stand above the one that reads scene files, and a file may
not call a coordinate, a parameter or a key what a dataset calls something else. So these names are written once, here:
scene files refuse them, and whoever makes such a dataset has it held to the register.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable

from painleve.errors import InputError

__all__ = ["EXACT", "IN_FRICTION_MAPS", "IN_REGIMES", "IN_SWEEPS", "IN_TRAJECTORIES", "hold_to"]

EXACT = "_exact"
"""What follows the name of a swept quantity where its values stand as text."""


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


# Beside the coordinates of a scene and their velocities, u_ and the coordinate.
IN_TRAJECTORIES = _words(
    "time point g gamma v_n v_t v_t1 v_t2 r_n r_t r_t1 r_t2 kinetic_energy contact_force contact_work"
    " splitting_loss branch change outline_x outline_y floor"
)
# Beside the parameters and the state keys that are swept.
IN_SWEEPS = _words(
    "state eps law_branch coordinate counts fit seconds outcome outcome_reason gamma half_jump slope u_minus u_tilde"
    " theorem_branch theorem_branch_reason verdict verdict_reason witnessed_upper"
    " excess_Aeps_A_lower excess_Aeps_A_upper excess_A_Aeps_lower excess_A_Aeps_upper hausdorff_lower hausdorff_upper"
    " ends_excess_Aeps_A_lower ends_excess_Aeps_A_upper ends_excess_A_Aeps_lower ends_excess_A_Aeps_upper"
    " ends_hausdorff_lower ends_hausdorff_upper farthest_dq farthest_dv farthest_offset farthest_branch"
)
# Beside the two state keys that are the axes of a map.
IN_REGIMES = _words("regime slip_compliance free_acceleration")
# Beside what varies in a map of friction.
IN_FRICTION_MAPS = _words(
    "admitted critical_friction_plus critical_friction_minus gamma_negative_plus gamma_negative_minus"
)


def hold_to(register: frozenset[str], names: Iterable[Hashable], own: Iterable[str]) -> None:
    """Hold a dataset's names to a register; `own` are those that are the scene's.

    Raises InputError where the scene has a name of the register, and ValueError for any other name that is not there.
    """
    own = set(own)
    taken, stray = sorted(own & register), sorted({str(name) for name in names} - register - own)
    if taken:
        raise InputError(f"dataset: the scene's {', '.join(taken)} is what datasets call something else; rename it")
    if stray:
        raise ValueError(f"painleve.dataset_names does not list {', '.join(stray)}; a scene file could take that name")
