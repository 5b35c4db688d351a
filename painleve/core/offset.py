"""S(q0 + dq, u- + dv) relative to the limit set, from differences that are formed without cancellation.

Every impulse is split as r = tau r_jump + e, where r_jump is the impulse of the jump u- -> u_tilde at the base state
(zero if there is none), so that S = u- + tau (u_tilde - u-) + z with z of the size of the offsets. The sticking
impulse differs from the one at the base state by e = -G^-1 (dv_c + dG r_base), because G_base r_base = -v_base.

The law of painleve.core.law is written here once more, without branches, so that a loop over it vectorises: every case
is computed and one is selected. What is not selected may be infinite or NaN, so nothing is added up by weights.
"""

from painleve._jit import jit
from painleve.core.law import FREE, SLIP_MINUS, SLIP_PLUS, STICK


@jit
def planar_split(
    hit,
    a,
    b,
    C,
    edge_plus,
    edge_minus,
    mu_plus,
    mu_minus,
    da,
    db,
    dC,
    dmu_plus,
    dmu_minus,
    v_n,
    dv_t,
    base_n,
    base_t,
    multiplier,
    critical_edge,
):
    """(branch, tau, e_n, e_t) at an offset state.

    `hit`: in contact with v_n < 0; da ... dmu_minus: differences from the base state; (base_n, base_t): its sticking
    impulse; `multiplier`: the normal impulse of the jump, 0 if there is none; `critical_edge`: +1 or -1 if gamma = 0
    on that edge of the cone at the base state and there is a jump, else 0.
    """
    jumps, inverse = multiplier > 0.0, 1.0 / (a * C - b * b)
    n, t = v_n + da * base_n + db * base_t, dv_t + db * base_n + dC * base_t
    stick_n, stick_t = (b * t - C * n) * inverse, (b * n - a * t) * inverse
    # Which edge binds: as in painleve.core.law.planar_branch.
    r_t = base_t + stick_t
    plus = hit & (edge_plus > 0.0) & (r_t * edge_plus > -mu_plus * v_n)
    minus = hit & (edge_minus > 0.0) & (-r_t * edge_minus > -mu_minus * v_n) & (not plus)
    # On the critical edge the impulse is tau r_jump but for the change of the edge's own direction.
    normal = -v_n / (edge_plus if plus else edge_minus)
    s, ds = (mu_plus, dmu_plus) if plus else (-mu_minus, -dmu_minus)
    critical = (critical_edge == 1) if plus else (critical_edge == -1)
    slip_tau = normal * (1.0 / multiplier) if critical else 0.0
    slip_n, slip_t = 0.0 if critical else normal, normal * (ds if critical else s)
    stick_tau = 1.0 if jumps else 0.0
    stick_n = stick_n if jumps else base_n + stick_n
    stick_t = stick_t if jumps else r_t
    slips = plus | minus
    tau, e_n, e_t = (slip_tau, slip_n, slip_t) if slips else (stick_tau, stick_n, stick_t)
    slip_code = SLIP_PLUS if plus else SLIP_MINUS
    code = slip_code if slips else STICK
    return code if hit else FREE, tau if hit else 0.0, e_n if hit else 0.0, e_t if hit else 0.0
