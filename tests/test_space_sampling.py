"""Friction in space: compiled offsets against enclosures, and those against the conditions of least energy."""

from __future__ import annotations

import cvxpy as cp
import mpmath
import numpy as np
import pytest
import sympy as sp
from reference_law import to_mp
from space_scenes import SCENES, STATES, Impulse, limit_of, polygon_rod

from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.member import make_member
from painleve.asymptotics.sample import SampleOptions, _Stream, sample_distance, sample_members
from painleve.core.codes import ContactMode
from painleve.core.sampling import BLOCK
from painleve.errors import InputError
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.friction import Polygon
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import limit_set

CORRECT = 1e-9  # relative, of a distance: where gamma = 0 it is 1e-6 at the smallest eps, and rounding is 1e-16
DIGITS = 90


def sampled(limit, eps):
    return _Stream(make_local_problem(limit), eps, SampleOptions(samples=BLOCK, threads=1)).block(0)


def measured(limit, along, beyond, across2):
    """The distance to A as the compiled reductions measure it."""
    if limit.kind == "segment":
        return np.sqrt(across2 + np.maximum(beyond, 0.0) ** 2 + np.minimum(along, 0.0) ** 2)
    ends = along**2 if limit.kind == "point" else np.minimum(along**2, beyond**2)
    return np.sqrt(across2 + ends)


def chosen(branch, most=8):
    """A few of each branch."""
    return [int(i) for code in np.unique(branch) for i in np.flatnonzero(branch == code)[:most]]


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("eps", [3e-2, 1e-12])
def test_compiled_distances_in_space_are_those_of_the_enclosed_members(scene, state, eps):
    limit = limit_of(scene, state)
    problem = make_local_problem(limit)
    dq, dv, branch, along, beyond, across2 = sampled(limit, eps)
    found = measured(limit, along, beyond, across2)
    for i in chosen(branch):
        member = make_member(problem, dq[:, i], dv[:, i])
        assert int(member.branch) == branch[i]
        assert member.distance[0] * (1 - CORRECT) <= found[i] <= member.distance[1] * (1 + CORRECT)


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("eps", [1e-2, 1e-10])
def test_members_in_space_satisfy_the_conditions_of_least_energy_at_90_digits(scene, state, eps):
    limit = limit_of(scene, state)
    problem = make_local_problem(limit)
    dq, dv, branch, *_ = sampled(limit, eps)
    with mpmath.workdps(DIGITS):
        tiny, u = mpmath.mpf(10) ** -60, [to_mp(x) for x in limit.state.u]
        for i in chosen(branch, 5):
            member = make_member(problem, dq[:, i], dv[:, i])
            v = [x + to_mp(y) for x, y in zip(u, dv[:, i], strict=True)]
            S = [x + to_mp(y) for x, y in zip(u, member.enclosure, strict=True)]
            if member.branch is ContactMode.FREE:
                assert max(abs(x - y) for x, y in zip(S, v, strict=True)) < tiny
                continue
            impulse = Impulse(limit.state, list(dq[:, i]), v, S)
            assert impulse.residual < tiny
            assert abs(impulse.normal_velocity) < tiny
            if member.branch is ContactMode.STICK:
                assert mpmath.norm(impulse.velocity) < tiny
            elif isinstance(limit.state.scene.contact.section, Polygon):
                assert impulse.is_least_on_polygon(tiny)
            else:
                assert impulse.is_least_on_conic(tiny)


def clarabel(scene, rows, v):
    """S by a cone solver, from M^-1 W and the section: the velocity of least kinetic energy."""
    names = {name: i for i, name in enumerate(rows[0])}
    value = rows[1]
    axes = [c.name for c in scene.coordinates]
    Y = np.array([[value[names[f"{y}_{x}"]] for y in ("Yn", "Y1", "Y2")] for x in axes])
    W = np.array([[value[names[f"{w}_{x}"]] for w in ("w", "H1", "H2")] for x in axes])
    G = W.T @ Y
    r = cp.Variable(3)
    conditions = [G[0] @ r == -W[:, 0] @ v]
    if isinstance(scene.contact.section, Polygon):
        n = len(scene.contact.section.vertices)
        x = cp.Variable(n, nonneg=True)
        s = np.array([[value[names[f"s_{k}_{i + 1}"]] for i in range(n)] for k in (1, 2)])
        conditions += [r[0] == cp.sum(x), r[1:] == s @ x]
    else:
        conditions += [cp.SOC(r[0], r[1:])]
    root = np.linalg.cholesky((G + G.T) / 2).T
    cp.Problem(cp.Minimize(cp.sum_squares(root @ r) / 2 + (W.T @ v) @ r), conditions).solve(solver="CLARABEL")
    return v + Y @ r.value


@pytest.mark.parametrize("name", SCENES)
def test_the_compiled_law_in_space_is_what_a_cone_solver_finds(name):
    scene, rng = SCENES[name], np.random.default_rng(3)
    kernels = make_kernels(scene)
    limit = limit_of(name, "oblique")
    p, seen = make_local_problem(limit).p, set()
    for _ in range(40):
        q = np.array([0.0, 0.0, 0.0, rng.uniform(0.4, 1.2), rng.uniform(-3.0, 3.0)])
        q[2] = np.sin(q[3]) - 0.01
        v, result = rng.normal(size=5), np.empty(5)
        branch = kernels.law_at(q, p, v, result)
        seen.add(ContactMode(branch))
        if branch == ContactMode.FREE:
            assert np.array_equal(result, v)
            continue
        rows = np.empty(len(kernels.rows.names))
        kernels.rows_at(q, p, rows)
        # a gap of 1e-9 in the solver's energy leaves the root of that in its point
        assert result == pytest.approx(clarabel(scene, (kernels.rows.names, rows), v), abs=3e-4)
    assert seen == {ContactMode.FREE, ContactMode.STICK, ContactMode.SLIP}


@pytest.mark.parametrize("heading", ["pi", "0"])
def test_in_the_rods_plane_the_disc_gives_the_planar_law(heading):
    """Offsets without a part across the rod's vertical plane; the planar rod has the same theta, slip and friction."""
    theta, sense = "atan(3 - sqrt(5))", -1 if heading == "pi" else 1
    keys = {"spatial_rod": {"theta": theta, "heading": heading}, "slender_rod": {"theta": theta, "slip": sense}}
    space, plane = (
        make_local_problem(limit_set(make_state(load_scene(name), keys=given, parameters={"mu": 2})))
        for name, given in keys.items()
    )
    rng, seen = np.random.default_rng(5), set()
    for _ in range(60):
        dq, dv = 1e-3 * rng.normal(size=(2, 3))
        wide_q, wide_v = (np.array([x[0], 0.0, x[1], x[2], 0.0]) for x in (dq, dv))
        flat, deep = make_member(plane, dq, dv), make_member(space, wide_q, wide_v)
        seen.add(flat.branch)
        assert deep.offset[[0, 2, 3]] == pytest.approx(flat.offset, rel=1e-12, abs=1e-15)
        assert np.abs(deep.offset[[1, 4]]).max() < 1e-60
        assert (deep.branch is ContactMode.SLIP) == (flat.branch in (ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS))
    assert len(seen) == 3 if heading == "pi" else len(seen) >= 2


@pytest.mark.parametrize("state", ["oblique", "critical_oblique"])
def test_distances_do_not_depend_on_the_azimuth(state):
    """A turn about the vertical axis maps balls onto balls and members onto members."""
    scene = load_scene("spatial_rod")
    straight, turned = (make_local_problem(limit_set(make_state(scene, state, keys={"phi": phi}))) for phi in (0, 1))
    c, s = np.cos(1.0), np.sin(1.0)
    turn = np.eye(5)
    turn[:2, :2] = [[c, -s], [s, c]]
    rng, slips = np.random.default_rng(9), 0
    for _ in range(40):
        dq, dv = 1e-4 * rng.normal(size=(2, 5))
        one, other = make_member(straight, dq, dv), make_member(turned, turn @ dq, turn @ dv)
        assert one.branch is other.branch
        slips += one.branch is ContactMode.SLIP
        assert other.distance[0] == pytest.approx(one.distance[0], rel=1e-8)
    assert slips > 5


def regular(n, size):
    """Exact vertices of a regular polygon with its first one at angle 0."""
    return [(size * sp.cos(2 * sp.pi * k / n), size * sp.sin(2 * sp.pi * k / n)) for k in range(n)]


def energies(scene, p, q, v):
    """Kinetic energy after S at each velocity."""
    kernels, found, result = make_kernels(scene), [], np.empty(5)
    M = np.diag([1.0, 1.0, 1.0, 1 / 3, np.cos(q[3]) ** 2 / 3])
    for x in v:
        kernels.law_at(q, p, x, result)
        found.append(result @ M @ result / 2)
    return np.array(found)


def test_inscribed_and_circumscribed_polygons_bracket_the_energy_that_the_disc_leaves():
    """A larger section leaves no more kinetic energy."""
    n, rng = 8, np.random.default_rng(2)
    disc = load_scene("spatial_rod")
    p = make_local_problem(limit_of("spatial_rod", "sliding")).p
    q = np.array([0.0, 0.0, np.sin(0.9) - 0.01, 0.9, 0.3])
    v = rng.normal(size=(60, 5))
    v[:, 2] = -np.abs(v[:, 2]) - 1.0
    inner, outer = polygon_rod("inner", regular(n, 1)), polygon_rod("outer", regular(n, 1 / sp.cos(sp.pi / n)))
    less, between, more = (energies(scene, p, q, v) for scene in (outer, disc, inner))
    assert np.all(less <= between * (1 + 1e-13))
    assert np.all(between <= more * (1 + 1e-13))
    assert np.sum(less < between) > 20
    assert np.sum(between < more) > 20


@pytest.mark.parametrize("sampler", ["kronecker", "uniform"])
def test_sampled_bounds_in_space_do_not_depend_on_the_number_of_threads(sampler):
    limit = limit_of("spatial_rod", "critical_oblique")
    one, two = (sample_distance(limit, 1e-3, SampleOptions(samples=5000, sampler=sampler, threads=k)) for k in (1, 2))
    assert one.as_dict() == two.as_dict()
    assert set(one.counts) == {"free", "stick", "slip"}


def test_sampled_members_in_space_are_the_law_at_their_offsets():
    limit = limit_of("spatial_rod", "oblique")
    problem = make_local_problem(limit)
    found = sample_members(limit, 1e-2, SampleOptions(samples=60, sampler="uniform"))
    for i in range(0, 60, 6):
        member = make_member(problem, found["dq"][i], found["dv"][i])
        assert int(member.branch) == found["branch"][i]
        assert found["offset"][i] == pytest.approx(member.offset, abs=1e-12)


@pytest.mark.parametrize("mu", ["1e-60", "1e-90", "1e-110", "1e-140"])
def test_members_with_vanishing_friction_are_those_of_little_friction(mu):
    """mu^4, the determinant of Q, is no double from 1e-81 downwards."""
    options = SampleOptions(samples=20_000, threads=1)
    little, none = (
        sample_distance(
            limit_set(make_state(load_scene("spatial_rod"), "sliding", parameters={"mu": m})), 1e-2, options
        )
        for m in ("1e-14", mu)
    )
    assert none.counts == little.counts
    for mine, theirs in ((none.excess_Aeps_A, little.excess_Aeps_A), (none.excess_A_Aeps, little.excess_A_Aeps)):
        np.testing.assert_allclose(mine.member.offset, theirs.member.offset, rtol=1e-10, atol=1e-14)


def test_friction_too_small_for_doubles_is_refused_by_its_size():
    limit = limit_set(make_state(load_scene("spatial_rod"), "sliding", parameters={"mu": "1e-150"}))
    with pytest.raises(InputError, match="coefficient of friction of 1e-150 is too small"):
        sample_distance(limit, 1e-2)
