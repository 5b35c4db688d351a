"""The text of a scene's motion with friction in space: the law of a step, and the schemes that take it as it is.

The impulses of the law are in the tangents in which a disc or an ellipse is the unit disc (painleve.kernels.rows);
those that are stored are in the scene's own tangents, r_t = E r' with the section E times the disc.
"""

__all__ = ["CONIC", "CONSTANTS", "IMPORTS", "POLYGON", "SPACE_SCHEMES"]

IMPORTS = "from painleve.core.space.steps import {problem}, {edge}, contact_velocity, kind_of_change"
CONSTANTS = "{vertices}SECTION = {section}  # the first row of E, row by row"
CONIC = {"problem": "conic_problem", "edge": "conic_edge", "of": "rows, D"}
POLYGON = {"problem": "polygon_problem", "edge": "polygon_edge", "of": "rows, D, VERTICES"}

SPACE_SCHEMES = '''@jit
def solve_contact(touching, bias, rows, v):
    """(u1, v_n, r, branch): u1 = v + M^-1 W r, r = (r_n, r'_1, r'_2)."""
    v_n, v_1, v_2 = contact_velocity(rows, D, v)
    if not touching:
        return v, v_n, (0.0, 0.0, 0.0), FREE
    r_n, r_1, r_2, branch = {problem}({of}, v_n + bias, v_1, v_2)
    if branch == FREE:
        return v, v_n, (0.0, 0.0, 0.0), FREE
    return respond(rows, r_n, r_1, r_2, v), v_n, (r_n, r_1, r_2), branch


@jit
def step(scheme, theta, tolerance, t, h, q, u, p):
    """One step of a scheme from (t, q, u): CONTACT_DYNAMICS or MOREAU_JEAN.

    Returns (q1, u1, v_n, r, branch or NOT_SOLVED, rows, acceleration, v), the last three as the law took them.
    """
    if scheme == CONTACT_DYNAMICS:
        return step_contact_dynamics(tolerance, t, h, q, u, p)
    return step_moreau_jean(theta, tolerance, t, h, q, u, p)


@jit
def change_at(h, since, q, u, p, rows, acceleration, v, v_n, r, branch):
    """What the contact impulse of a step did to the velocity (painleve.core.motion_codes.Change)."""
    free, M = free_motion(h, q, u, p, rows, acceleration)
    speed, v_t = math.sqrt(quadratic_form(M, v, v, D)), contact_velocity(rows, D, v)
    return kind_of_change(rows, D, v_n, {edge}({of}, v_t[1], v_t[2]), r, branch, free, since, speed)


@jit
def count_solutions(scheme, tolerance, h, rows, v):
    """One: the law is a projection (what solves Coulomb's law beside it: painleve.core.space.coulomb)."""
    return 1
'''
