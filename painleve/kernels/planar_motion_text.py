"""The text of a scene's motion without friction or with planar friction: the law of a step, and every scheme."""

__all__ = ["CONSTANTS", "IMPORTS", "PLANAR_SCHEMES"]

IMPORTS = "from painleve.core.steps import contact_problem, contact_velocity, kind_of_change, solutions"
CONSTANTS = """PLANAR = {planar}
STEWART_TRINKLE, SCHATZMAN_PAOLI = int(FixedStep.STEWART_TRINKLE), int(FixedStep.SCHATZMAN_PAOLI)
ROUNDING = 1e-14  # of g; the velocity that would correct it in one step is known to this over h"""

PLANAR_SCHEMES = '''@jit
def solve_contact(touching, bias, rows, v):
    """(u1, v_n, r, branch): u1 = v + M^-1 W r, r = (r_n, r_t)."""
    v_n, v_t = contact_velocity(rows, D, PLANAR, v)
    if not touching:
        return v, v_n, (0.0, 0.0), FREE
    r_n, r_t, branch = contact_problem(rows, D, PLANAR, v_n, v_t, bias)
    if branch == FREE:
        return v, v_n, (0.0, 0.0), FREE
    return respond(rows, r_n, r_t, v), v_n, (r_n, r_t), branch


@jit
def step_complementarity(on_gap, tolerance, t, h, q, u, p):
    rows, acceleration = motion_at(t, q, u, p)
    v = add(u, h, acceleration)
    bias = -rows[0] / h if on_gap else 0.0
    u1, v_n, r, branch = solve_contact(on_gap or rows[0] >= -tolerance, bias, rows, v)
    return add(q, h, u1), u1, v_n, r, branch, rows, acceleration, v


@jit
def step_schatzman_paoli(t, h, q, u, p):
    acceleration = motion_at(t, q, u, p)[1]
    v = add(u, h, acceleration)
    previous, code = v, NOT_SOLVED
    for _ in range(ITERATIONS):
        q1 = add(q, h, previous)
        rows = rows_at(q1, p)
        bias = -rows[0] / h - contact_velocity(rows, D, False, previous)[0]
        u1, v_n, r, branch = solve_contact(True, bias, rows, v)
        noise = ROUNDING / h
        # What rounding of g does to u1 on this branch: on a slip 1/p times as much, p -> 0 at the edge of a paradox.
        blurred, _, _, same = solve_contact(True, bias - noise, rows, v)
        if close(u1, previous, v, noise + (size_of(add(blurred, -1.0, u1)) if same == branch else 0.0)):
            code = branch
            break
        previous = u1
    return q1, u1, v_n, r, code, rows, acceleration, v


@jit
def step(scheme, theta, tolerance, t, h, q, u, p):
    """One step of a scheme from (t, q, u).

    Returns (q1, u1, v_n, r, branch or NOT_SOLVED, rows, acceleration, v), the last three as the law took them.
    """
    if scheme == CONTACT_DYNAMICS:
        return step_contact_dynamics(tolerance, t, h, q, u, p)
    if scheme == MOREAU_JEAN:
        return step_moreau_jean(theta, tolerance, t, h, q, u, p)
    if scheme == SCHATZMAN_PAOLI:
        return step_schatzman_paoli(t, h, q, u, p)
    return step_complementarity(scheme == STEWART_TRINKLE, tolerance, t, h, q, u, p)


@jit
def change_at(h, since, q, u, p, rows, acceleration, v, v_n, r, branch):
    """What the contact impulse of a step did to the velocity (painleve.core.motion_codes.Change)."""
    free, M = free_motion(h, q, u, p, rows, acceleration)
    speed, v_t = math.sqrt(quadratic_form(M, v, v, D)), contact_velocity(rows, D, PLANAR, v)[1]
    return kind_of_change(rows, D, PLANAR, v_n, v_t, r[0], r[1], branch, free, since, speed)


@jit
def count_solutions(scheme, tolerance, h, rows, v):
    """How many impulses solve the contact problem of the step just taken."""
    v_n, v_t = contact_velocity(rows, D, PLANAR, v)
    if scheme == STEWART_TRINKLE:
        return solutions(rows, D, PLANAR, v_n, v_t, -rows[0] / h)
    if scheme == SCHATZMAN_PAOLI:  # one linearisation, about the free motion; where it pushes there is one solution
        return solutions(rows, D, PLANAR, 0.0, v_t, -rows[0] / h)
    return solutions(rows, D, PLANAR, v_n, v_t, 0.0) if rows[0] >= -tolerance else 1
'''
