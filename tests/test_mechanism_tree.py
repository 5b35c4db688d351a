"""M and f of a tree of bodies against Lagrange's equations, with velocities by differentiating where bodies are."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import combinations_with_replacement

import mpmath as mp
import pytest
import sympy as sp

from painleve.exact.tape import TapeBuilder
from painleve.mechanics.tree.contact import contact_of, position_of
from painleve.mechanics.tree.dynamics import force_of, inertia_of
from painleve.mechanics.tree.kinematics import place
from painleve.mechanics.tree.model import ALONG_X, ALONG_Y, ALONG_Z, Body, Joint, Mechanism, Plane, TouchingPoint
from painleve.mechanics.tree.vectors import Algebra, rotation_about

mp.mp.dps = 40
R = sp.Rational
GRAVITY = (sp.Integer(0), sp.Integer(0), R(-981, 100))
FLOOR = Plane(point=(R(1, 7), R(0), R(-1, 3)), normal=ALONG_Z, tangents=(ALONG_X, ALONG_Y))


def spatial_chain() -> Mechanism:
    """Every kind of joint about axes that are not aligned, two joints on one body, a branch, rotated frames."""
    tilted = rotation_about((R(2, 3), R(-1, 3), R(2, 3)), sp.pi / 3)
    full = sp.ImmutableMatrix(
        [[R(3, 10), R(1, 50), R(-1, 40)], [R(1, 50), R(2, 5), R(1, 30)], [R(-1, 40), R(1, 30), R(1, 2)]]
    )
    base = Body(
        name="base",
        joints=(
            Joint(name="a", kind="prismatic", axis=(R(1), R(2), R(2)), reference=R(1, 4)),
            Joint(
                name="b", kind="revolute", axis=(R(0), R(3), R(4)), anchor=(R(1, 5), R(0), R(-1, 6)), armature=R(1, 9)
            ),
        ),
        mass=R(2),
        centre=(R(1, 10), R(-1, 5), R(1, 3)),
        inertia=full,
    )
    arm = Body(
        name="arm",
        parent="base",
        position=(R(1, 2), R(1, 3), R(-1, 4)),
        rotation=tilted,
        joints=(
            Joint(name="c", kind="revolute", axis=(R(1), R(0), R(0)), damping=R(1, 3), stiffness=R(5), rest=R(1, 8)),
        ),
        mass=R(1, 2),
        centre=(R(0), R(1, 4), R(0)),
        inertia=full,
    )
    slide = Body(
        name="slide",
        parent="arm",
        position=(R(0), R(1, 2), R(0)),
        joints=(Joint(name="d", kind="prismatic", axis=ALONG_Y),),
        mass=R(1, 3),
        centre=(R(1, 9), R(0), R(0)),
    )
    twin = Body(
        name="twin",
        parent="base",
        joints=(Joint(name="e", kind="revolute", axis=ALONG_Z, anchor=(R(0), R(1, 7), R(0))),),
        mass=R(3, 4),
        centre=(R(1, 3), R(1, 3), R(0)),
        inertia=full,
    )
    plate = Body(name="plate", parent="twin", position=(R(0), R(0), R(1, 2)), mass=R(1, 5), inertia=full)
    return Mechanism(bodies=(base, arm, slide, twin, plate), gravity=GRAVITY)


def planar_chain() -> Mechanism:
    thin = sp.ImmutableMatrix.diag(R(1, 12), R(1, 12), 0)
    link = {"mass": R(1), "centre": (R(0), R(0), R(-1, 2)), "inertia": thin}
    upper = Body(name="upper", joints=(Joint(name="p", kind="revolute", axis=ALONG_Y),), **link)
    lower = Body(
        name="lower",
        parent="upper",
        position=(R(0), R(0), R(-1)),
        joints=(Joint(name="r", kind="revolute", axis=(R(0), R(-1), R(0))),),
        **link,
    )
    return Mechanism(bodies=(upper, lower), gravity=GRAVITY)


MECHANISMS = {"spatial": spatial_chain, "planar": planar_chain}


class Figures:
    """The mechanism in mpmath by homogeneous transforms, each joint on its own: a second route."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism = mechanism

    def frames(self, q: dict[str, mp.mpf]) -> dict[str, tuple[mp.matrix, mp.matrix]]:
        found = {"": (mp.matrix([0, 0, 0]), mp.eye(3))}
        for body in self.mechanism.bodies:
            origin, axes = found[body.parent]
            origin, axes = origin + axes * vector(body.position), axes * numbers(body.rotation)
            for joint in body.joints:
                travel = q[joint.name] - number(joint.reference)
                axis = axes * vector(joint.axis)
                axis = axis / mp.norm(axis)
                if joint.kind == "prismatic":
                    origin = origin + axis * travel
                else:
                    anchor = origin + axes * vector(joint.anchor)
                    turn = exponential(axis, travel)
                    origin, axes = anchor + turn * (origin - anchor), turn * axes
            found[body.name] = origin, axes
        return found

    def point(self, body: str, local: object, q: dict[str, mp.mpf]) -> mp.matrix:
        origin, axes = self.frames(q)[body]
        return origin + axes * vector(local)

    def energies(self, q: dict[str, mp.mpf], u: dict[str, mp.mpf]) -> tuple[mp.mpf, mp.mpf]:
        """Kinetic energy without armature, by central differences of places along the motion, and the potential."""
        kinetic, potential, h = mp.mpf(0), mp.mpf(0), mp.mpf(10) ** -12
        ahead = self.frames({n: x + h * u[n] for n, x in q.items()})
        behind = self.frames({n: x - h * u[n] for n, x in q.items()})
        now = self.frames(q)
        for body in self.mechanism.bodies:
            m, c = number(body.mass), vector(body.centre)
            (o1, A1), (o0, A0), (o, A) = ahead[body.name], behind[body.name], now[body.name]
            v = ((o1 + A1 * c) - (o0 + A0 * c)) / (2 * h)
            skew = A.T * (A1 - A0) / (2 * h)
            w = mp.matrix([skew[2, 1], skew[0, 2], skew[1, 0]])
            kinetic += (m * (v.T * v)[0] + (w.T * numbers(body.inertia) * w)[0]) / 2
            potential -= m * (vector(self.mechanism.gravity).T * (o + A * c))[0]
        return kinetic, potential


def number(x: sp.Expr) -> mp.mpf:
    return mp.mpf(str(sp.N(x, 45)))


def vector(v: object) -> mp.matrix:
    return mp.matrix([number(sp.sympify(x)) for x in v])


def numbers(m: sp.MatrixBase) -> mp.matrix:
    return mp.matrix([[number(x) for x in m.row(i)] for i in range(3)])


def exponential(axis: mp.matrix, angle: mp.mpf) -> mp.matrix:
    x, y, z = axis
    return mp.expm(mp.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]]) * angle)


def values_at(expressions: list[sp.Expr], builder: TapeBuilder, point: dict[sp.Symbol, mp.mpf]) -> list[mp.mpf]:
    known = dict(point)
    for symbol, expression in builder.tape.needed(expressions).steps:
        known[symbol] = evaluated(expression, known)
    return [evaluated(e, known) for e in expressions]


def evaluated(expression: sp.Expr, known: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
    symbols = sorted(expression.free_symbols, key=str)
    return mp.mpf(sp.lambdify(symbols, expression, "mpmath")(*(known[s] for s in symbols)))


@pytest.fixture(params=sorted(MECHANISMS))
def derived(request: pytest.FixtureRequest):
    mechanism = MECHANISMS[request.param]()
    builder = TapeBuilder("z")
    algebra = Algebra(builder)
    pose = place(mechanism, algebra)
    names = [joint.name for joint in mechanism.joints]
    q = {n: mp.mpf(k + 2) / 7 * (-1) ** k for k, n in enumerate(names)}
    u = {n: mp.mpf(3 - k) / 5 for k, n in enumerate(names)}
    point = {j.symbol: q[j.name] for j in mechanism.joints} | {j.velocity: u[j.name] for j in mechanism.joints}
    return mechanism, builder, algebra, pose, q, u, point


def test_m_is_the_matrix_of_the_kinetic_energy(derived):
    mechanism, builder, algebra, pose, q, _, point = derived
    M = inertia_of(mechanism, pose, algebra)
    d, names, figures = M.shape[0], list(q), Figures(mechanism)
    values = mp.matrix(d, d)
    for k, value in enumerate(values_at(list(M), builder, point)):
        values[k // d, k % d] = value

    @cache
    def energy(*moving: str) -> mp.mpf:
        return figures.energies(q, {n: mp.mpf(n in moving) for n in names})[0]

    for i, j in combinations_with_replacement(range(d), 2):
        armature = number(mechanism.joints[i].armature) if i == j else 0
        expected = 2 * energy(names[i]) if i == j else energy(names[i], names[j]) - energy(names[i]) - energy(names[j])
        assert abs(values[i, j] - expected - armature) < mp.mpf(10) ** -18
        assert values[i, j] == values[j, i]


def test_f_is_what_lagrange_s_equations_leave_at_no_acceleration(derived):
    mechanism, builder, algebra, pose, q, u, point = derived
    found = values_at(list(force_of(mechanism, pose, algebra)), builder, point)
    figures, h = Figures(mechanism), mp.mpf(10) ** -8

    def kinetic(shift: dict[str, mp.mpf], rates: dict[str, mp.mpf]) -> mp.mpf:
        return figures.energies({n: x + shift.get(n, 0) for n, x in q.items()}, rates)[0]

    for joint, value in zip(mechanism.joints, found, strict=True):
        n, e = joint.name, {joint.name: h}
        along = {m: h * u[m] for m in q}
        against = {m: -h * u[m] for m in q}

        def momentum(shift: dict[str, mp.mpf], n: str = n) -> mp.mpf:
            """dT/du_n, exact for a quadratic form by a central difference of any width."""
            more, less = {**u, n: u[n] + 1}, {**u, n: u[n] - 1}
            return (kinetic(shift, more) - kinetic(shift, less)) / 2

        rate = (momentum(along) - momentum(against)) / (2 * h)  # of the momentum at constant velocities
        slope = (kinetic(e, u) - kinetic({n: -h}, u)) / (2 * h)
        weight = -(figures.energies({**q, n: q[n] + h}, u)[1] - figures.energies({**q, n: q[n] - h}, u)[1]) / (2 * h)
        applied = -number(joint.damping) * u[n] - number(joint.stiffness) * (q[n] - number(joint.rest))
        assert abs(value - (slope - rate + weight + applied)) < mp.mpf(10) ** -9


@pytest.mark.parametrize("radius", [R(0), R(1, 6)])
def test_w_n_and_h_are_the_velocity_of_the_material_point_that_touches(derived, radius):
    mechanism, builder, algebra, pose, q, u, point = derived
    body = mechanism.bodies[-1].name
    touching = TouchingPoint(body=body, point=(R(1, 5), R(-1, 7), R(-1, 2)), radius=radius)
    contact = contact_of(touching, FLOOR, pose, algebra)
    W = sp.Matrix.hstack(contact.normal, contact.tangents)
    figures, h = Figures(mechanism), mp.mpf(10) ** -12
    centre = figures.point(body, touching.point, q)
    origin, axes = figures.frames(q)[body]
    lowest = axes.T * (centre - mp.matrix([0, 0, number(radius)]) - origin)  # a point of the body, held fast in it
    o1, A1 = figures.frames({n: x + h * u[n] for n, x in q.items()})[body]
    o0, A0 = figures.frames({n: x - h * u[n] for n, x in q.items()})[body]
    velocity = ((o1 + A1 * lowest) - (o0 + A0 * lowest)) / (2 * h)
    found = values_at(list(W.T * sp.Matrix([j.velocity for j in mechanism.joints])), builder, point)
    for value, expected in zip(found, (velocity[2], velocity[0], velocity[1]), strict=True):
        assert abs(value - expected) < mp.mpf(10) ** -18
    (height,) = values_at([contact.height], builder, point)
    assert abs(height - (centre[2] - number(FLOOR.point[2]) - number(radius))) < mp.mpf(10) ** -30
    for value, expected in zip(
        values_at(list(position_of(body, touching.point, pose, algebra)), builder, point), centre, strict=True
    ):
        assert abs(value - expected) < mp.mpf(10) ** -30


def test_a_base_that_shifts_does_not_enter_m():
    mechanism = planar_chain()
    rail = Body(name="rail", joints=(Joint(name="x", kind="prismatic", axis=ALONG_X),), mass=R(1))
    moving = (rail, replace(mechanism.bodies[0], parent="rail"), mechanism.bodies[1])
    builder = TapeBuilder("z")
    M = inertia_of(Mechanism(bodies=moving), place(Mechanism(bodies=moving), Algebra(builder)), Algebra(builder))
    assert sp.Symbol("x", real=True) not in builder.tape.inputs(list(M))


def test_a_locked_joint_is_the_joint_at_that_value(derived):
    mechanism, *_, point = derived
    last = mechanism.bodies[-2] if not mechanism.bodies[-1].joints else mechanism.bodies[-1]
    joint = last.joints[-1]
    value = R(1, 3)
    fixed = replace(last, joints=(*last.joints[:-1], replace(joint, locked=value)))
    bodies = tuple(fixed if body.name == last.name else body for body in mechanism.bodies)
    found = []
    for tree in (mechanism, Mechanism(bodies=bodies, gravity=mechanism.gravity)):
        builder = TapeBuilder("z")
        algebra = Algebra(builder)
        pose = place(tree, algebra)
        at = {**point, joint.symbol: number(value)}
        M = inertia_of(tree, pose, algebra)
        kept = [k for k, other in enumerate(tree.joints) if other.name != joint.name]
        found.append(values_at([M[i, j] for i in kept for j in kept], builder, at))
    for x, y in zip(*found, strict=True):
        assert abs(x - y) < mp.mpf(10) ** -30


def test_the_closed_form_is_the_tape_expanded():
    builder = TapeBuilder("z")
    mechanism = planar_chain()
    M = inertia_of(mechanism, place(mechanism, Algebra(builder)), Algebra(builder))
    r = mechanism.joints[1].symbol
    closed = sp.Matrix(2, 2, builder.tape.expand(list(M)))
    # two uniform unit links, the second one turned by p - r against the vertical
    absolute = sp.Matrix([[R(4, 3), sp.cos(r) / 2], [sp.cos(r) / 2, R(1, 3)]])
    J = sp.Matrix([[1, 0], [1, -1]])
    assert sp.simplify(closed - J.T * absolute * J) == sp.zeros(2)
