"""S(q0 + dq, u- + dv) relative to the limit set, from differences that are formed without cancellation.

Every impulse is split as r = tau r_jump + e, where r_jump is the impulse of the jump u- -> u_tilde at the base state
(zero if there is none), so that S = u- + tau (u_tilde - u-) + z with z of the size of the offsets. The sticking
impulse differs from the one at the base state by e = -G^-1 (dv_c + dG r_base), because G_base r_base = -v_base.
"""

from painleve._jit import jit
from painleve.core.law import FREE, SLIP_MINUS, SLIP_PLUS, STICK, planar_branch, stick_impulse


@jit
def planar_split(
    hit, a, b, C, edge_plus, edge_minus, mu_plus, mu_minus, da, db, dC, dmu_plus, dmu_minus,
    v_n, dv_t, base_n, base_t, multiplier, critical_edge,
):  # fmt: skip
    """(branch, tau, e_n, e_t) at an offset state.

    `hit`: in contact with v_n < 0; da ... dmu_minus: differences from the base state; (base_n, base_t): its sticking
    impulse; `multiplier`: the normal impulse of the jump, 0 if there is none; `critical_edge`: +1 or -1 if gamma = 0
    on that edge of the cone at the base state and there is a jump, else 0.
    """
    e_n, e_t = stick_impulse(a, b, C, v_n + da * base_n + db * base_t, dv_t + db * base_n + dC * base_t)
    branch = planar_branch(edge_plus, edge_minus, mu_plus, mu_minus, v_n, base_t + e_t) if hit else FREE
    jumps = multiplier > 0.0
    tau = 1.0 if (branch == STICK and jumps) else 0.0
    if branch == STICK and not jumps:
        e_n, e_t = base_n + e_n, base_t + e_t
    if branch == FREE:
        e_n, e_t = 0.0, 0.0
    if branch == SLIP_PLUS:
        tau, e_n, e_t = _slip(-v_n / edge_plus, mu_plus, dmu_plus, multiplier, critical_edge == 1)
    if branch == SLIP_MINUS:
        tau, e_n, e_t = _slip(-v_n / edge_minus, -mu_minus, -dmu_minus, multiplier, critical_edge == -1)
    return branch, tau, e_n, e_t


@jit
def _slip(normal, s, ds, multiplier, on_critical_edge):
    """On the critical edge the impulse is tau r_jump but for the change of the edge's own direction."""
    if on_critical_edge:
        return normal / multiplier, 0.0, normal * ds
    return 0.0, normal, normal * s
