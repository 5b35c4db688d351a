"""The law S against convex solvers, its identities as properties, and the compiled scenes against the definition."""

from __future__ import annotations

from dataclasses import dataclass

import clarabel
import cvxpy as cp
import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planar_scenes import SCENE_NAMES
from reference_law import DIGITS, Local, Reference, law, to_mp
from scipy import sparse

from painleve.core.codes import ContactMode
from painleve.core.rows import row_parts
from painleve.core.sections import none, segment
from painleve.kernels.compiled import make_kernels
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

# --- random contacts -------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Contact:
    """One configuration: M, w_n = -grad g, H (None: no friction), the section [-minus, plus] and g."""

    M: np.ndarray
    w_n: np.ndarray
    H: np.ndarray | None
    minus: float
    plus: float
    g: float = 0.0

    @property
    def rows(self) -> np.ndarray:
        """In the order that the law reads (painleve.core.rows)."""
        Y_n = np.linalg.solve(self.M, self.w_n)
        a = self.w_n @ Y_n
        if self.H is None:
            return np.array([self.g, *self.w_n, *Y_n, a, a])
        Y_t = np.linalg.solve(self.M, self.H)
        b, C = self.w_n @ Y_t, self.H @ Y_t
        tail = [b, C, a - self.minus * b, self.plus, self.minus]
        return np.array([self.g, *self.w_n, *Y_n, a, a + self.plus * b, *self.H, *Y_t, *tail])

    @property
    def generators(self) -> np.ndarray:
        """(d, 1 or 2): the edges of the cone of impulses."""
        if self.H is None:
            return self.w_n[:, None]
        return np.column_stack([self.w_n + self.plus * self.H, self.w_n - self.minus * self.H])

    @property
    def gamma(self) -> float:
        """gamma |grad g|^2."""
        return float(np.min(self.w_n @ np.linalg.solve(self.M, self.generators)))

    def norm(self, v: np.ndarray) -> float:
        return float(np.sqrt(v @ self.M @ v))

    def law(self, v: np.ndarray) -> tuple[np.ndarray, ContactMode]:
        result = np.empty_like(v)
        section = none if self.H is None else segment
        branch = section.law_from_rows(self.rows, v.size, v, result)
        return result, ContactMode(branch)


def random_contact(rng: np.random.Generator, ratio: float | None = None) -> Contact:
    """A contact in d = 2 ... 6; `ratio`: of mu to the critical friction (gamma < 0 above 1)."""
    d = int(rng.integers(2, 7))
    root = rng.normal(size=(d, d))
    M = root @ root.T + 0.3 * np.eye(d)
    w_n, H = rng.normal(size=d), rng.normal(size=d)
    a, b = w_n @ np.linalg.solve(M, w_n), w_n @ np.linalg.solve(M, H)
    if ratio is None:
        ratio = float(rng.choice([0.3, 0.9, 0.999, 1.001, 1.1, 3.0]))
    minus, plus = ratio * a / abs(b) * np.array([1.0, rng.choice([0.0, 0.3, 1.0])])[rng.permutation(2)]
    return Contact(M=M, w_n=w_n, H=H, minus=minus, plus=plus)


def impacting(contact: Contact, rng: np.random.Generator) -> np.ndarray:
    """A velocity with v_n < 0."""
    v = rng.normal(size=contact.w_n.size)
    v_n = contact.w_n @ v
    return v if v_n < 0.0 else -v


SETTINGS = clarabel.DefaultSettings()
SETTINGS.verbose = False
SETTINGS.tol_gap_abs = SETTINGS.tol_gap_rel = SETTINGS.tol_feas = 1e-12


def clarabel_velocity(contact: Contact, v: np.ndarray) -> np.ndarray:
    """minimise u.M u/2 over u with M u - E x = M v, <w_n, u> = 0, x >= 0: the definition, with impulses E x."""
    d, E = v.size, contact.generators
    n = E.shape[1]
    P = np.block([[contact.M, np.zeros((d, n))], [np.zeros((n, d)), np.zeros((n, n))]])
    A = np.block([[contact.M, -E], [contact.w_n[None, :], np.zeros((1, n))], [np.zeros((n, d)), -np.eye(n)]])
    b = np.concatenate([contact.M @ v, np.zeros(1 + n)])
    cones = [clarabel.ZeroConeT(d + 1), clarabel.NonnegativeConeT(n)]
    solver = clarabel.DefaultSolver(
        sparse.csc_matrix(np.triu(P)), np.zeros(d + n), sparse.csc_matrix(A), b, cones, SETTINGS
    )
    solution = solver.solve()
    assert solution.status in (clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved), solution.status
    return np.array(solution.x[:d])


# A gap of 1e-12 in the energy is a distance of 1.4e-6 in the kinetic metric: the energy is its squared half.
SOLVER = 2e-6


def test_s_is_the_projection_that_an_interior_point_solver_finds_on_4000_contacts_of_both_signs_of_gamma():
    rng = np.random.default_rng(1)
    signs, branches = [], []
    for _ in range(4000):
        contact = random_contact(rng)
        v = impacting(contact, rng)
        result, branch = contact.law(v)
        assert contact.norm(result - clarabel_velocity(contact, v)) < SOLVER * max(1.0, contact.norm(v))
        signs.append(contact.gamma > 0.0)
        branches.append(branch)
    assert min(signs.count(True), signs.count(False)) > 1000
    assert min(branches.count(b) for b in (ContactMode.STICK, ContactMode.SLIP_PLUS, ContactMode.SLIP_MINUS)) > 500


def test_s_is_the_projection_that_a_modelling_language_finds_from_the_paper_s_formula():
    """minimise |u|_q over (v + M^-1 R) in T as written in eq. (7): R the cone over n + D_1."""
    rng = np.random.default_rng(2)
    for _ in range(100):
        contact = random_contact(rng)
        v = impacting(contact, rng)
        root = np.linalg.cholesky(contact.M).T
        u, normal, tangential = cp.Variable(v.size), cp.Variable(nonneg=True), cp.Variable()
        reaction = contact.w_n * normal + contact.H * tangential
        rules = [
            contact.M @ (u - v) == reaction,
            contact.w_n @ u == 0,
            tangential <= contact.plus * normal,
            -tangential <= contact.minus * normal,
        ]
        problem = cp.Problem(cp.Minimize(cp.sum_squares(root @ u) / 2), rules)
        problem.solve(solver=cp.CLARABEL, tol_gap_abs=1e-12, tol_gap_rel=1e-12, tol_feas=1e-12)
        assert contact.norm(contact.law(v)[0] - u.value) < SOLVER * max(1.0, contact.norm(v))


def test_without_friction_s_is_the_projection_on_the_tangent_space_in_the_kinetic_metric():
    rng = np.random.default_rng(3)
    for _ in range(300):
        planar = random_contact(rng)
        contact = Contact(M=planar.M, w_n=planar.w_n, H=None, minus=0.0, plus=0.0)
        v = impacting(contact, rng)
        result, branch = contact.law(v)
        assert branch is ContactMode.FRICTIONLESS
        assert contact.norm(result - clarabel_velocity(contact, v)) < SOLVER * max(1.0, contact.norm(v))
        tangent = np.linalg.svd(contact.w_n[None, :])[2][1:].T  # an orthonormal basis of T
        closest = tangent @ np.linalg.solve(tangent.T @ contact.M @ tangent, tangent.T @ contact.M @ v)
        np.testing.assert_allclose(result, closest, rtol=0, atol=1e-11 * max(1.0, np.abs(v).max()))


# --- the identities of docs/theory.md, section 2 ----------------------------------------------------------------

SEEDS = st.integers(0, 2**32 - 1)
RATIOS = st.sampled_from([0.0, 1e-9, 0.3, 0.999, 1.001, 3.0, 1e3])
thorough = settings(max_examples=200)


@given(SEEDS, RATIOS)
@thorough
def test_s_leaves_every_velocity_alone_that_is_not_stopped(seed, ratio):
    rng = np.random.default_rng(seed)
    contact = random_contact(rng, ratio)
    v = impacting(contact, rng)
    apart = Contact(M=contact.M, w_n=contact.w_n, H=contact.H, minus=contact.minus, plus=contact.plus, g=-1e-300)
    for there, velocity in ((contact, -v), (apart, v), (apart, -v), (contact, np.zeros_like(v))):
        result, branch = there.law(velocity)
        assert branch is ContactMode.FREE
        assert np.array_equal(result, velocity)


@given(SEEDS, RATIOS, st.integers(-300, 300))
@thorough
def test_s_is_positively_homogeneous_exactly_for_powers_of_two(seed, ratio, exponent):
    rng = np.random.default_rng(seed)
    contact = random_contact(rng, ratio)
    v = impacting(contact, rng)
    result, branch = contact.law(v)
    scaled, same = contact.law(np.ldexp(v, exponent))
    assert same is branch
    assert np.array_equal(scaled, np.ldexp(result, exponent))


def condition(contact: Contact) -> float:
    """How much rounding the law may amplify: by M, by the Delassus matrix and by the slipping edge's compliance."""
    rows, at = contact.rows, row_parts(contact.w_n.size, 1, 3)
    a, (b,), (C,), (edge_minus, _, _) = rows[at.a], rows[at.b], rows[at.C], rows[at.section]
    lifts = [e for e in (rows[at.edge_plus], edge_minus) if e > 0.0]
    mu = max(contact.minus, contact.plus)
    return float(np.linalg.cond(contact.M) * (a * C / (a * C - b * b)) * (1.0 + (a + mu * abs(b)) / min(lifts)))


@given(SEEDS, RATIOS)
@thorough
def test_s_is_tangent_and_its_impulse_is_in_the_cone(seed, ratio):
    rng = np.random.default_rng(seed)
    contact = random_contact(rng, ratio)
    v = impacting(contact, rng)
    result, _ = contact.law(v)
    small = 1e-13 * condition(contact) * max(1.0, contact.norm(v))
    assert abs(contact.w_n @ result) <= small * np.linalg.norm(contact.w_n)
    basis = np.column_stack([contact.w_n, contact.H])
    impulse = contact.M @ (result - v)
    r_n, r_t = np.linalg.lstsq(basis, impulse, rcond=None)[0]
    size = max(1.0, abs(r_n), abs(r_t))
    assert np.linalg.norm(impulse - basis @ (r_n, r_t)) <= small * size * np.linalg.norm(contact.M)
    slack = small * size * np.linalg.cond(basis) * np.linalg.norm(contact.M)
    assert r_n >= -slack
    assert -contact.minus * r_n - slack <= r_t <= contact.plus * r_n + slack


@given(SEEDS, RATIOS)
@thorough
def test_proposition_1_the_impulse_dissipates_and_the_kinetic_norm_does_not_grow(seed, ratio):
    rng = np.random.default_rng(seed)
    contact = random_contact(rng, ratio)
    v = impacting(contact, rng)
    result, _ = contact.law(v)
    small = 1e-13 * condition(contact) * contact.norm(v)
    impulse = contact.M @ (result - v)
    assert result @ impulse <= small * (np.linalg.norm(impulse) + np.linalg.norm(v))
    assert contact.norm(result) <= contact.norm(v) + small


@given(SEEDS, RATIOS)
@thorough
def test_in_the_plane_the_projection_is_coulomb_s_law_of_maximal_dissipation(seed, ratio):
    """Complementarity: the tip sticks, or slips against the friction, which is then on its edge."""
    rng = np.random.default_rng(seed)
    contact = random_contact(rng, ratio)
    v = impacting(contact, rng)
    result, branch = contact.law(v)
    slip = contact.H @ result
    small = 1e-12 * condition(contact) * max(1.0, contact.norm(v)) * np.linalg.norm(contact.H)
    if branch is ContactMode.STICK:
        assert abs(slip) <= small
    if branch is ContactMode.SLIP_PLUS:  # r_t = +mu_plus r_n opposes a slip to the left
        assert slip <= small
    if branch is ContactMode.SLIP_MINUS:
        assert slip >= -small


@given(SEEDS, st.sampled_from([1e3, 1e6]))
@thorough
def test_with_a_huge_friction_coefficient_s_is_the_least_energy_of_the_definition(seed, ratio):
    rng = np.random.default_rng(seed)
    contact = random_contact(rng, ratio)
    v = impacting(contact, rng)
    with mpmath.workdps(DIGITS):
        expected = law(as_local(contact), [to_mp(x) for x in v])
    result, _ = contact.law(v)
    assert np.all(np.isfinite(result))
    error = np.array([float(to_mp(x) - y) for x, y in zip(result, expected, strict=True)])
    assert contact.norm(error) <= 1e-13 * condition(contact) * contact.norm(v)


@pytest.mark.parametrize("edge", [1e-300, 1e-20, 1e-8, 0.0, -1e-300, -1e-20, -1e-8])
@pytest.mark.parametrize("v_t", [-1.0, 1.0])
def test_a_tiny_compliance_of_either_sign_gives_the_least_energy_of_the_definition(edge, v_t):
    """a = 1, C = 1, b = -1/2, and mu such that a + mu b = edge, given beside b so that no rounding hides it."""
    a, b, C, v_n = 1.0, -0.5, 1.0, -1e-3
    contact = segment.SegmentContact(a, b, C, edge, 2.0, 2.0, 2.0)
    r_n, r_t, branch = segment.segment_impulse(contact, v_n, v_t)
    stick = np.linalg.solve([[a, b], [b, C]], [-v_n, -v_t])
    if stick[1] * edge > -2.0 * v_n:  # beyond the edge that lifts
        assert branch == ContactMode.SLIP_PLUS
        assert (r_n, r_t) == (-v_n / edge, -2.0 * v_n / edge)
    elif -stick[1] * 2.0 > -2.0 * v_n:
        assert branch == ContactMode.SLIP_MINUS
        assert (r_n, r_t) == (-v_n / 2.0, v_n)
    else:
        assert branch == ContactMode.STICK
        np.testing.assert_allclose([r_n, r_t], stick, rtol=1e-15)


def as_local(contact: Contact) -> Local:
    """The same contact for the reference; its floats taken as they are."""
    return Local(
        M=mpmath.matrix(contact.M.tolist()),
        w_n=mpmath.matrix(contact.w_n.tolist()),
        H=None if contact.H is None else mpmath.matrix(contact.H.tolist()),
        minus=to_mp(contact.minus),
        plus=to_mp(contact.plus),
        g=to_mp(contact.g),
    )


# --- the compiled scenes ---------------------------------------------------------------------------------------------


Point = tuple[np.ndarray, np.ndarray, np.ndarray]


def scene_points(name: str, count: int) -> list[Point]:
    """(q, parameters, v) about two states of a scene, with ordinary friction and with a paradox."""
    scene = load_scene(name)
    rng = np.random.default_rng(5)
    points = []
    for state in (make_state(scene, "sliding"), make_state(scene, "paradox")):
        q, u = ([state.number(x) for x in values] for values in (state.q, state.u))
        p = np.array([state.number(state.parameters[p.name]) for p in scene.parameters])
        for _ in range(count):
            points.append((q + 0.5 * rng.normal(size=len(q)), p, u + 0.5 * rng.normal(size=len(u))))
    return points


@pytest.mark.parametrize("name", SCENE_NAMES)
def test_every_compiled_row_is_what_the_definition_gives_at_60_digits(name):
    kernels, reference = make_kernels(load_scene(name)), Reference(load_scene(name))
    for q, p, _ in scene_points(name, 20):
        rows = np.empty(len(kernels.rows.names))
        kernels.rows_at(q, p, rows)
        with mpmath.workdps(DIGITS):
            local = reference.at([to_mp(x) for x in q], [to_mp(x) for x in p])
            Y_n, Y_t = (mpmath.lu_solve(local.M, w) for w in (local.w_n, local.H))
            a, b, C = (mpmath.fdot(list(x), list(y)) for x, y in ((local.w_n, Y_n), (local.w_n, Y_t), (local.H, Y_t)))
            expected = [
                local.g,
                *local.w_n,
                *Y_n,
                a,
                a + local.plus * b,
                *local.H,
                *Y_t,
                b,
                C,
                a - local.minus * b,
                local.plus,
                local.minus,
            ]
        # The edges are differences: their error is that of their terms.
        scale = float(max(1.0, a + local.plus * abs(b), *map(abs, expected)))
        np.testing.assert_array_less(np.abs(rows - np.array([float(x) for x in expected])), 1e-13 * scale)


@pytest.mark.parametrize("name", SCENE_NAMES)
def test_the_compiled_law_of_a_scene_is_the_least_energy_of_the_definition(name):
    kernels, reference = make_kernels(load_scene(name)), Reference(load_scene(name))
    counts = dict.fromkeys(ContactMode, 0)
    for q, p, v in scene_points(name, 400):
        result = np.empty(v.size)
        branch = ContactMode(kernels.law_at(q, p, v, result))
        counts[branch] += 1
        with mpmath.workdps(30):
            local = reference.at([to_mp(x) for x in q], [to_mp(x) for x in p])
            expected = np.array([float(x) for x in law(local, [to_mp(x) for x in v])])
            lifts = [float(x) for x in local.lifts()]
        # Where an edge is nearly critical, its slip is a quotient of small numbers.
        smallest = min(abs(x) for x in lifts) / max(abs(x) for x in lifts)
        np.testing.assert_allclose(result, expected, rtol=0, atol=1e-12 * (1.0 + np.abs(v).max()) / smallest)
    assert counts[ContactMode.FREE] > 50
    assert counts[ContactMode.STICK] > 20
    assert counts[ContactMode.SLIP_PLUS] + counts[ContactMode.SLIP_MINUS] > 20


def test_a_section_of_zero_width_acts_like_no_friction():
    rng = np.random.default_rng(7)
    for _ in range(50):
        contact = random_contact(rng, 0.0)
        smooth = Contact(M=contact.M, w_n=contact.w_n, H=None, minus=0.0, plus=0.0)
        v = impacting(contact, rng)
        expected, _ = smooth.law(v)
        np.testing.assert_allclose(contact.law(v)[0], expected, rtol=0, atol=1e-13 * np.abs(expected).max())
