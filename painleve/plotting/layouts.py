"""What the figure of each kind of dataset reads of it, in the language of painleve.store.layout."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

__all__ = ["LAYOUTS"]

LAYOUTS: Mapping[str, str] = MappingProxyType(
    {
        "distances": """
            number excess_Aeps_A_lower excess_Aeps_A_upper excess_A_Aeps_lower excess_A_Aeps_upper (state, ..., eps)
            number ends_excess_Aeps_A_lower ends_excess_A_Aeps_upper witnessed_upper fit (state, ..., eps)
            number half_jump slope (state, ...)
            code theorem_branch (state, ...)
            code outcome (state, ..., eps)
            text state (state)
            number eps (eps)
            attribute scene method
        """,
        "members": """
            number along across (state, eps, member)
            code law_branch (state, eps, member)
            number witness_along witness_across (state, eps, end)
            number axis_along axis_across (state, coordinate)
            number jump_length (state)
            code limit_set (state)
            text state (state)
            text coordinate (coordinate)
            number eps (eps)
            attribute scene
        """,
        "friction_map": """
            code admitted (...)
            number? critical_friction_plus critical_friction_minus (...)
            code? gamma_negative_plus gamma_negative_minus (...)
            attribute scene
        """,
        "gamma_map": """
            number gamma (state, path, friction)
            number critical_friction own_friction (state, path)
            number state_path state_friction panel (state)
            code theorem_branch (state)
            text state (state)
            number path (path)
            number friction (friction)
            attribute scene path_symbol
        """,
        "regimes": """
            code regime (...)
            number slip_compliance free_acceleration (...)
            attribute scene
        """,
        "trajectory": """
            number time gamma kinetic_energy contact_work v_n (time)
            number? v_t v_t1 v_t2 (time)
            number? outline_x outline_y (time, point)
            number? floor ()
            code change (time)
            attribute scene start scheme status
        """,
    }
)
