"""Write a scene's motion kernels as Python source: acceleration, inertia, one step of each scheme, the time loops.

The file holds `motion_at` (rows and M^-1 f), `inertia_at`, `force_at`, `drift_at` (what the curvature of g and of the
tangential displacement add to the contact accelerations), `step`, `run`, `run_members`, and `tabulate`.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from painleve.kernels.printing import assignments, indent, renamed, used
from painleve.kernels.rows import Rows
from painleve.mechanics.scene import Scene

__all__ = ["motion_source"]

HEADER = '''"""Motion of the scene {name}, written by painleve from its derivation; edits are lost.

Rows: {rows}
"""

import math

from painleve._jit import jit
from painleve.core.codes import Branch
from painleve.core.motion_codes import Change, Ending, FixedStep, Outcome
from painleve.core.steps import (
    contact_problem, contact_velocity, free_change, is_tangential, kind_of_change, quadratic_form, solutions,
)

D, ROWS, PLANAR = {dimension}, {row_count}, {planar}
FREE, STICK = int(Branch.FREE), int(Branch.STICK)
CONTACT_DYNAMICS, MOREAU_JEAN = int(FixedStep.CONTACT_DYNAMICS), int(FixedStep.MOREAU_JEAN)
STEWART_TRINKLE, SCHATZMAN_PAOLI = int(FixedStep.STEWART_TRINKLE), int(FixedStep.SCHATZMAN_PAOLI)
ORDINARY, JUMP_WITHOUT_COLLISION = int(Change.ORDINARY), int(Change.JUMP_WITHOUT_COLLISION)
REACHED_END, NOT_FINITE = int(Ending.REACHED_END), int(Ending.NOT_FINITE)
DEGENERATE, NOT_CONVERGED = int(Ending.DEGENERATE), int(Ending.NOT_CONVERGED)
JUMP, STICKS, LIFT_OFF, IMPACT = int(Outcome.JUMP), int(Outcome.STICK), int(Outcome.LIFT_OFF), int(Outcome.IMPACT)
SLIDE, FLIGHT, FAILED = int(Outcome.SLIDE), int(Outcome.FLIGHT), int(Outcome.FAILED)
NOT_SOLVED = -1  # in place of a branch
ITERATIONS, ACCURACY = 50, 1e-12  # of implicit steps: change, relative to the velocities, at which they are solved
ROUNDING = 1e-14  # of g; the velocity that would correct it in one step is known to this over h

'''

# The same for every scene, but compiled with it: a compiled function that is passed as an argument is compiled anew
# in every process.
SCHEMES = '''@jit
def solve_contact(touching, bias, rows, v):
    """(u1, v_n, r_n, r_t, branch): u1 = v + M^-1 W r."""
    v_n, v_t = contact_velocity(rows, D, PLANAR, v)
    if not touching:
        return v, v_n, 0.0, 0.0, FREE
    r_n, r_t, branch = contact_problem(rows, D, PLANAR, v_n, v_t, bias)
    if branch == FREE:
        return v, v_n, 0.0, 0.0, FREE
    return respond(rows, r_n, r_t, v), v_n, r_n, r_t, branch


@jit
def step_contact_dynamics(tolerance, t, h, q, u, p):
    q1 = add(q, h, u)
    rows, acceleration = motion_at(t + h, q1, u, p)
    v = add(u, h, acceleration)
    u1, v_n, r_n, r_t, branch = solve_contact(rows[0] >= -tolerance, 0.0, rows, v)
    return q1, u1, v_n, r_n, r_t, branch, rows, acceleration, v


@jit
def step_moreau_jean(theta, tolerance, t, h, q, u, p):
    middle = add(q, (1.0 - theta) * h, u)
    previous, code = u, NOT_SOLVED
    for _ in range(ITERATIONS):
        rows, acceleration = motion_at(t + (1.0 - theta) * h, middle, mix(theta, u, previous), p)
        v = add(u, h, acceleration)
        u1, v_n, r_n, r_t, branch = solve_contact(rows[0] >= -tolerance, 0.0, rows, v)
        if close(u1, previous, v, 0.0):
            code = branch
            break
        previous = u1
    return add(middle, theta * h, u1), u1, v_n, r_n, r_t, code, rows, acceleration, v


@jit
def step_complementarity(on_gap, tolerance, t, h, q, u, p):
    rows, acceleration = motion_at(t, q, u, p)
    v = add(u, h, acceleration)
    bias = -rows[0] / h if on_gap else 0.0
    u1, v_n, r_n, r_t, branch = solve_contact(on_gap or rows[0] >= -tolerance, bias, rows, v)
    return add(q, h, u1), u1, v_n, r_n, r_t, branch, rows, acceleration, v


@jit
def step_schatzman_paoli(t, h, q, u, p):
    acceleration = motion_at(t, q, u, p)[1]
    v = add(u, h, acceleration)
    previous, code = v, NOT_SOLVED
    for _ in range(ITERATIONS):
        q1 = add(q, h, previous)
        rows = rows_at(q1, p)
        bias = -rows[0] / h - contact_velocity(rows, D, False, previous)[0]
        u1, v_n, r_n, r_t, branch = solve_contact(True, bias, rows, v)
        noise = ROUNDING / h
        # What rounding of g does to u1 on this branch: on a slip 1/p times as much, p -> 0 at the edge of a paradox.
        blurred, _, _, _, same = solve_contact(True, bias - noise, rows, v)
        if close(u1, previous, v, noise + (size_of(add(blurred, -1.0, u1)) if same == branch else 0.0)):
            code = branch
            break
        previous = u1
    return q1, u1, v_n, r_n, r_t, code, rows, acceleration, v


@jit
def step(scheme, theta, tolerance, t, h, q, u, p):
    """One step of a scheme from (t, q, u).

    Returns (q1, u1, v_n, r_n, r_t, branch or NOT_SOLVED, rows, acceleration, v), the last three as the law took them.
    """
    if scheme == CONTACT_DYNAMICS:
        return step_contact_dynamics(tolerance, t, h, q, u, p)
    if scheme == MOREAU_JEAN:
        return step_moreau_jean(theta, tolerance, t, h, q, u, p)
    if scheme == SCHATZMAN_PAOLI:
        return step_schatzman_paoli(t, h, q, u, p)
    return step_complementarity(scheme == STEWART_TRINKLE, tolerance, t, h, q, u, p)


@jit
def failure_of(branch, rows, q1, u1):
    """The ending that a step calls for; REACHED_END if none."""
    if branch < 0:
        return NOT_CONVERGED
    if not size_of(q1) < math.inf:
        return NOT_FINITE
    if size_of(u1) < math.inf:
        return REACHED_END
    return NOT_FINITE if rows[1 + 2 * D] > 0.0 else DEGENERATE


@jit
def free_motion(h, q, u, p, rows, acceleration):
    """(F, M): the free change of a step (painleve.core.steps.free_change) and the inertia."""
    M = inertia_at(q, p)
    return free_change(h, rows[1 + 2 * D], M, acceleration, drift_at(q, u, p)[0], D), M


@jit
def change_at(h, since, q, u, p, rows, acceleration, v, v_n, r_n, r_t, branch):
    """What the contact impulse of a step did to the velocity (painleve.core.motion_codes.Change)."""
    free, M = free_motion(h, q, u, p, rows, acceleration)
    speed, v_t = math.sqrt(quadratic_form(M, v, v, D)), contact_velocity(rows, D, PLANAR, v)[1]
    return kind_of_change(rows, D, PLANAR, v_n, v_t, r_n, r_t, branch, free, since, speed)


@jit
def count_solutions(scheme, tolerance, h, rows, v):
    """How many impulses solve the contact problem of the step just taken."""
    v_n, v_t = contact_velocity(rows, D, PLANAR, v)
    if scheme == STEWART_TRINKLE:
        return solutions(rows, D, PLANAR, v_n, v_t, -rows[0] / h)
    if scheme == SCHATZMAN_PAOLI:  # one linearisation, about the free motion; where it pushes there is one solution
        return solutions(rows, D, PLANAR, 0.0, v_t, -rows[0] / h)
    return solutions(rows, D, PLANAR, v_n, v_t, 0.0) if rows[0] >= -tolerance else 1


@jit
def run(scheme, theta, tolerance, since, t, h, p, q, u, r, branch, change, several):
    """Take len(h) steps from q[0], u[0]; row i + 1 of each array is for the step that ends at t[i + 1].

    q, u: (n + 1, d); r: (n + 1, 2); branch, change, several (solutions of the step's problem): (n + 1,).
    since: steps since the last contact, at the start and at the end. Returns (steps taken, ending, since).
    """
    q0, u0 = load(q, 0), load(u, 0)
    for i in range(h.size):
        q1, u1, v_n, r_n, r_t, code, rows, acceleration, v = step(scheme, theta, tolerance, t[i], h[i], q0, u0, p)
        ending = failure_of(code, rows, q1, u1)
        if ending != REACHED_END:
            return i, ending, since
        since += 1
        if code != FREE:
            change[i + 1] = change_at(h[i], since, q1, u0, p, rows, acceleration, v, v_n, r_n, r_t, code)
            since = 0
        several[i + 1] = count_solutions(scheme, tolerance, h[i], rows, v)
        r[i + 1, 0], r[i + 1, 1], branch[i + 1] = r_n, r_t, code
        store(q, i + 1, q1)
        store(u, i + 1, u1)
        q0, u0 = q1, u1
    return h.size, REACHED_END, since


@jit
def tabulate(t, q, u, p, rows, M, f):
    """Rows, M (row by row) and f at many (t, q, u): t (n,), q, u (n, d); rows (n, ROWS), M (n, d d), f (n, d)."""
    for i in range(t.size):
        q0, u0 = load(q, i), load(u, i)
        values, inertia, force = rows_at(q0, p), inertia_at(q0, p), force_at(t[i], q0, u0, p)
        for j in range(ROWS):
            rows[i, j] = values[j]
        for j in range(D * D):
            M[i, j] = inertia[j]
        store(f, i, force)


@jit
def run_member(scheme, theta, tolerance, rounding, t0, h, until, q, u, p):
    """Step from (q, u) to the first thing that happens; returns (outcome, time, steps)."""
    touched = rows_at(q, p)[0] >= -tolerance - rounding
    steps, since = int(math.ceil(until / h * (1.0 - 1e-12))), 0
    for i in range(steps):
        q1, u1, v_n, r_n, r_t, code, rows, acceleration, v = step(scheme, theta, tolerance, t0 + i * h, h, q, u, p)
        now, since = t0 + (i + 1) * h, since + 1
        if failure_of(code, rows, q1, u1) != REACHED_END:
            return FAILED, now, i + 1
        if code != FREE:
            change = change_at(h, since, q1, u, p, rows, acceleration, v, v_n, r_n, r_t, code)
            if change != ORDINARY:
                return (JUMP if change == JUMP_WITHOUT_COLLISION else IMPACT), now, i + 1
            if code == STICK:
                return STICKS, now, i + 1
            touched, since = True, 0
        elif touched and v_n > 0.0:
            free = free_motion(h, q1, u, p, rows, acceleration)[0]
            if not is_tangential(v_n, rows[1 + 2 * D], free):
                return LIFT_OFF, now, i + 1
        q, u = q1, u1
    return (SLIDE if touched else FLIGHT), t0 + steps * h, steps


@jit
def run_members(scheme, theta, tolerance, rounding, t0, h, until, q, u, p, outcome, time, steps):
    """run_member for each row of q, u: (members, d) and h: (members,)."""
    for i in range(h.size):
        outcome[i], time[i], steps[i] = run_member(
            scheme, theta, tolerance, rounding, t0, h[i], until, load(q, i), load(u, i), p)
'''


def motion_source(scene: Scene, rows: Rows) -> str:
    """The source text of a scene's motion kernels."""
    header = HEADER.format(name=scene.name, rows=", ".join(rows.names), dimension=scene.dimension,
                           row_count=len(rows.names), planar=scene.friction is not None)  # fmt: skip
    M, f = scene.inertia, scene.force
    acceleration = M.adjugate() * f / M.det(method="berkowitz")
    parts = [
        _function(scene, "motion_at", "t, q, u, p", [rows.expressions, list(acceleration)]),
        _function(scene, "rows_at", "q, p", [rows.expressions]),
        _function(scene, "inertia_at", "q, p", [list(M)]),
        _function(scene, "force_at", "t, q, u, p", [list(f)]),
        _function(scene, "drift_at", "q, u, p", [_drifts(scene)]),
        *_vectors(scene),
        SCHEMES,
    ]
    return header + "\n\n".join(parts)


def _drifts(scene: Scene) -> list[sp.Expr]:
    """(dW/dt)^T u: the contact accelerations are W^T du/dt and these."""
    u = sp.Matrix(scene.u)
    normal = sp.Matrix([-sp.diff(scene.constraint, x) for x in scene.q])
    columns = [normal, scene.tangents if scene.friction is not None else sp.zeros(scene.dimension, 1)]
    return [(u.T * column.jacobian(scene.q) * u)[0, 0] for column in columns]


def _function(scene: Scene, name: str, arguments: str, tuples: Sequence[Sequence[sp.Expr]]) -> str:
    """A function that returns a tuple of numbers, or several."""
    names, q, p = renamed(scene)
    velocities = [f"u_{c.name}" for c in scene.coordinates]
    names |= {c.velocity: sp.Symbol(f"u_{c.name}", real=True) for c in scene.coordinates}
    expressions = [sp.sympify(e).xreplace(names) for group in tuples for e in group]
    lines = [f"{n} = q[{i}]" for i, n in used(q, expressions)]
    lines += [f"{n} = u[{i}]" for i, n in used(velocities, expressions)]
    lines += [f"{n} = p[{i}]" for i, n in used(p, expressions)]
    targets = [f"value_{k}" for k in range(len(expressions))]
    lines += assignments(expressions, targets)
    left = iter(targets)
    results = ["(" + "".join(f"{next(left)}, " for _ in group) + ")" for group in tuples]
    return f"@jit\ndef {name}({arguments}):\n" + indent([*lines, f"return {', '.join(results)}"], 1)


def _vectors(scene: Scene) -> list[str]:
    """Arithmetic of d-tuples, written out: a loop cannot build a tuple."""
    d = range(scene.dimension)
    n, t = 1 + scene.dimension, 3 + 3 * scene.dimension
    friction = " + rows[{t}]*r_t" if scene.friction is not None else ""

    def each(component: str) -> str:
        return "(" + "".join(component.format(j=j, n=n + j, t=t + j) + ", " for j in d) + ")"

    near = " and ".join(f"abs(x[{j}] - y[{j}]) <= bound" for j in d)
    bodies = {
        "add(x, s, y)": [f"return {each('x[{j}] + s*y[{j}]')}"],
        "mix(s, x, y)": [f"return {each('(1.0 - s)*x[{j}] + s*y[{j}]')}"],
        "respond(rows, r_n, r_t, v)": [f"return {each('v[{j}] + rows[{n}]*r_n' + friction)}"],
        "size_of(x)": [f"return {' + '.join(f'abs(x[{j}])' for j in d)}"],
        # Against the free velocity v too: x is v plus an impulse, and rounding in v is all that is left of x at rest.
        "close(x, y, v, noise)": ["bound = ACCURACY*(size_of(x) + size_of(v)) + noise", f"return {near}"],
        "load(x, i)": [f"return {each('x[i, {j}]')}"],
        "store(x, i, y)": [f"x[i, {j}] = y[{j}]" for j in d],
    }
    return [f"@jit\ndef {head}:\n" + indent(lines, 1) for head, lines in bodies.items()]
