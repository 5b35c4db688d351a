"""Bounds by branch and bound hold whatever the models' remainders hide, at budgets of a few boxes.

A piece stands for all functions within a remainder of its polynomials. Here remainders are made large, for one kind of
function at a time, and functions are taken at their ends: members found by brute force must not pass the bound.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from painleve.asymptotics.certify.branch_and_bound import BoxSearch
from painleve.asymptotics.certify.method import CertifyOptions, certify_distance
from painleve.asymptotics.certify.pieces import Piece, contact_pieces, stick_piece
from painleve.asymptotics.certify.taylor_models import Models
from painleve.asymptotics.local import make_local_problem
from painleve.asymptotics.sample import SampleOptions, sample_distance
from painleve.core.codes import ContactMode
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.theory.limit_set import LimitSet, limit_set

STATES = [("slender_rod", "paradox"), ("slender_rod", "critical"), ("minimal", "crossing")]
EPS = 0.05
SHARE = 0.1  # of a function's size: the remainder that it is given
MEMBERS = 2500  # that are tried, of a piece
KINDS = ("c", "Q", "y", "e", "m", "l", "g", "p")


@cache
def limit_of(scene: str, state: str) -> LimitSet:
    return limit_set(make_state(load_scene(scene), state))


@cache
def pieces_of(scene: str, state: str) -> tuple[Piece, ...]:
    problem = make_local_problem(limit_of(scene, state))
    along = stick_piece(problem, EPS, np.eye(problem.dimension)[-1])
    return (*contact_pieces(problem, EPS), along)


@dataclass(frozen=True)
class Functions:
    """Of a piece at points xi: arrays with one row a point."""

    c: np.ndarray
    Q: np.ndarray
    y: np.ndarray
    e: np.ndarray
    m: np.ndarray
    l: np.ndarray  # noqa: E741
    g: np.ndarray
    p: np.ndarray


def split(piece: Piece, table: np.ndarray) -> Functions:
    n, d, k = len(table), piece.dimension, piece.constraints
    parts = np.split(table, np.cumsum([d, d * d, d]), axis=1)
    constraints = parts[3][:, :-2].reshape(n, k, d + 2)
    return Functions(
        c=parts[0],
        Q=parts[1].reshape(n, d, d),
        y=parts[2],
        e=constraints[:, :, 0],
        m=constraints[:, :, 1:-1],
        l=constraints[:, :, -1],
        g=table[:, -2],
        p=table[:, -1],
    )


def columns(piece: Piece, kind: str) -> np.ndarray:
    """Where the functions of one kind stand among the models, by marking them."""
    marks = split(piece, np.arange(len(piece.models.remainder), dtype=float)[None, :])
    return np.ravel(getattr(marks, kind)).astype(int)


def hidden(piece: Piece, kind: str) -> Piece:
    """The piece with large remainders of the functions of one kind."""
    models, where = piece.models, columns(piece, kind)
    remainder = models.remainder.copy()
    remainder[where] += SHARE * (models.size[where] + 0.1)
    return replace(piece, models=replace(models, remainder=remainder))


@dataclass(frozen=True)
class Tried:
    """Points (xi, lam, w) of a piece, and its polynomials there."""

    xi: np.ndarray
    lam: np.ndarray
    w: np.ndarray
    polynomials: np.ndarray


@cache
def tried(piece: Piece) -> Tried:
    random, models = np.random.default_rng(7), piece.models
    xi = in_ball(random, MEMBERS, models.powers.shape[1])
    return Tried(
        xi=xi,
        lam=random.uniform(*(piece.lam or (0.0, 0.0)), size=MEMBERS),
        w=in_ball(random, MEMBERS, piece.dimension),
        polynomials=np.prod(xi[:, None, :] ** models.powers[None, :, :], axis=2) @ models.coefficients,
    )


def farthest(piece: Piece, points: Tried, moved: np.ndarray) -> float:
    """The largest distance over members that are tried, of the polynomials moved by as much."""
    f, lam, w = split(piece, points.polynomials + moved), points.lam, points.w
    if piece.equality:
        m, level = f.m[:, 0], f.e[:, 0] + lam * f.l[:, 0]
        lack = ((m * w).sum(axis=1) + level) / np.maximum((m**2).sum(axis=1), 1e-12)
        w = w - lack[:, None] * m
    inequalities = (f.e + np.einsum("nkj,nj->nk", f.m, w) + lam[:, None] * f.l)[:, int(piece.equality) :]
    member = (np.linalg.norm(w, axis=1) <= 1.0) & (inequalities <= 0.0).all(axis=1)
    member &= f.g + piece.carried * np.sqrt(np.maximum(0.0, 1.0 - (points.xi**2).sum(axis=1))) >= 0.0
    if piece.slipping:
        member &= f.p > 0.0
    z = f.c + np.einsum("nij,nj->ni", f.Q, w) + lam[:, None] * f.y
    return float(np.where(member, distances(piece, z), 0.0).max())


def in_ball(random: np.random.Generator, n: int, dimension: int) -> np.ndarray:
    """Many of them on the sphere, where most maxima are."""
    x = random.normal(size=(n, dimension))
    radius = np.minimum(1.0, 1.5 * random.uniform(size=(n, 1)))
    return x / np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-300) * radius * (1.0 - 1e-12)


def distances(piece: Piece, z: np.ndarray) -> np.ndarray:
    """To A as far as this piece bounds it: what is not beyond the end is the business of the piece beside A."""
    seen = z @ piece.frame.T
    if piece.directions == "single":
        return seen[:, 0]
    beyond = (seen[:, 0] >= 0.0) | (piece.directions != "beyond")
    return np.where(beyond, np.linalg.norm(seen, axis=1), 0.0)


def ends(piece: Piece, kind: str) -> Iterator[np.ndarray]:
    """Of the remainders of one kind of functions: all up, all down, and some up and some down."""
    random, where, remainder = np.random.default_rng(5), columns(piece, kind), piece.models.remainder
    for signs in (1.0, -1.0, *random.choice([-1.0, 1.0], size=(6, where.size))):
        moved = np.zeros_like(remainder)
        moved[where] = signs * remainder[where]
        yield moved


@pytest.mark.parametrize(("scene", "state"), STATES)
@pytest.mark.parametrize("kind", KINDS)
def test_no_function_within_the_remainders_has_a_member_beyond_the_bound(scene, state, kind):
    for piece in pieces_of(scene, state):
        if piece.lam is None and kind in "ylp":
            continue  # they are zero, or ask for nothing
        spread = hidden(piece, kind)
        found = max(farthest(spread, tried(piece), moved) for moved in ends(spread, kind))
        search = BoxSearch(spread)
        for batch in (32, 64, 128):
            assert found <= search.upper * (1.0 + 1e-12), piece.label
            search.refine(0.0, batch)
        assert found <= search.upper * (1.0 + 1e-12), piece.label


# --- made-up pieces, each for one way in which a bound can be lost ---------------------------------------------------

X, Y, XX = (1, 0), (0, 1), (2, 0)


def made_up(
    variables: int, polynomials: dict[str, dict[tuple[int, int], float]], remainders: dict[str, float], **given: object
) -> Piece:
    """One constraint in two dimensions; z = c + Q w + lam y with all functions zero but those given.

    A kind names its first function; polynomials by their powers of two variables, of which one may not be there.
    """
    blank = Models(
        powers=np.array([(0, 0), X, Y, XX])[:, :variables] if variables == 2 else np.array([[0], [1], [2]]),
        coefficients=np.zeros((4 if variables == 2 else 3, 14)),
        remainder=np.zeros(14),
        bend=np.zeros(14),
        size=np.zeros(14),
    )
    settings: dict = {
        "frame": np.eye(2),
        "equality": False,
        "lam": None,
        "carried": 0.0,
        "slipping": False,
        "directions": "sphere",
    } | given
    piece = Piece(
        branch=ContactMode.STICK,
        label="made up",
        models=blank,
        constraints=1,
        shift=0.0,
        unit=1.0,
        **settings,
    )
    order = [(0, 0), X, Y, XX] if variables == 2 else [(0, 0), X, XX]
    for kind, terms in polynomials.items():
        for powers, value in terms.items():
            blank.coefficients[order.index(powers), columns(piece, kind)[0]] = value
    for kind, value in remainders.items():
        blank.remainder[columns(piece, kind)[0]] = value
    blank.size[:] = np.abs(blank.coefficients).sum(axis=0)
    blank.bend[:] = 2.0 * np.abs(blank.coefficients[order.index(XX)])
    return piece


ONE, ALWAYS = {(0, 0): 1.0}, {"e": {(0, 0): -1.0}, "g": {(0, 0): 1.0}}
MADE_UP = {
    "largest between the corners of a box, where the tangent in its middle is low": made_up(
        1, ALWAYS | {"c": {XX: 3.0}}, {}
    ),
    "the same in two variables": made_up(2, ALWAYS | {"c": {XX: 3.0}}, {}),
    "slope along the second variable": made_up(2, ALWAYS | {"c": {Y: 2.0, X: 1.0}}, {}),
    "contact within the remainder of g": made_up(1, {"c": ONE, "g": {(0, 0): -0.05}, "e": {(0, 0): -1.0}}, {"g": 0.1}),
    "the same in two variables, where g gets a multiplier": made_up(
        2, {"c": {(0, 0): 1.0, X: 1.0}, "g": {X: -0.1}, "e": {(0, 0): -1.0}}, {"g": 0.2}
    ),
    "contact by the carried coordinate": made_up(
        1, {"c": {X: 1.0}, "g": {(0, 0): -0.5}, "e": {(0, 0): -1.0}}, {}, carried=1.0
    ),
    "slip within the remainder of p": made_up(1, ALWAYS | {"c": ONE, "p": {(0, 0): -0.05}}, {"p": 0.1}, slipping=True),
    "the same in two variables, where p gets a multiplier": made_up(
        2, ALWAYS | {"c": {(0, 0): 1.0, X: 1.0}, "p": {X: -0.1}}, {"p": 0.2}, slipping=True
    ),
    "a constraint within the remainder of e": made_up(1, {"c": ONE, "g": ONE, "e": {(0, 0): 0.05}}, {"e": 0.1}),
    "a constraint within the remainder of m": made_up(1, {"c": ONE, "g": ONE, "e": {(0, 0): 0.05}}, {"m": 0.1}),
    "a constraint within the remainder of l": made_up(
        1, {"c": ONE, "g": ONE, "e": {(0, 0): 0.05}}, {"l": 0.1}, lam=(-1.0, 1.0)
    ),
    "an equality within the remainder of e": made_up(
        1, {"c": ONE, "g": ONE, "e": {(0, 0): -0.05}, "m": {(0, 0): 0.04}}, {"e": 0.05}, equality=True
    ),
    "an impulse as long as its range": made_up(1, ALWAYS | {"y": ONE}, {}, lam=(-3.0, 2.0)),
    "a direction between the axes": made_up(1, ALWAYS | {"c": {X: 1.0}, "Q": {(0, 0): 1.0}}, {}),
}


@pytest.mark.parametrize("name", MADE_UP)
def test_no_member_of_a_made_up_piece_is_beyond_the_bound(name):
    piece = MADE_UP[name]
    remainder = piece.models.remainder
    found = max(farthest(piece, tried(piece), sign * remainder) for sign in (1.0, -1.0))
    assert found > 0.5
    search = BoxSearch(piece)
    for _ in range(8):
        assert found <= search.upper * (1.0 + 1e-12)
        search.refine(0.0, 64)
    assert found <= search.upper * (1.0 + 1e-12)


@pytest.mark.parametrize(
    ("polynomials", "given"),
    [
        ({"c": ONE, "e": {(0, 0): -1.0}, "g": {(0, 0): -0.5}}, {}),
        ({"c": ONE, "e": {(0, 0): -1.0}, "g": {(0, 0): -0.5}}, {"carried": 0.4}),
        (ALWAYS | {"c": ONE, "p": {(0, 0): -0.5}}, {"slipping": True}),
        ({"c": ONE, "g": ONE, "e": {(0, 0): 0.5}, "m": {(0, 0): 0.4}}, {}),
        ({"c": ONE, "g": ONE, "e": {(0, 0): -0.5}, "m": {(0, 0): 0.4}}, {"equality": True}),
    ],
    ids=["no contact", "nor by the carried coordinate", "no slip", "no velocity", "no velocity to hold an equality"],
)
@pytest.mark.parametrize("variables", [1, 2])
def test_boxes_without_members_are_left_out(variables, polynomials, given):
    """Beyond doubt: a bound that kept them would be right, and of no use."""
    assert BoxSearch(made_up(variables, polynomials, {}, **given)).upper == 0.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_outermost_configuration_in_contact_is_not_cut_off(side):
    """1 + |x| over |x| <= 0.3, on one side: exact arithmetic gives 1.3, and a cut of 1e-10 would show."""
    along = made_up(
        1,
        {"c": {(0, 0): 1.0, X: side}, "g": {(0, 0): 0.3, X: -side}, "e": {(0, 0): -1.0}},
        {},
        directions="single",
        frame=np.eye(2)[:1],
    )
    assert 1.3 <= BoxSearch(along).upper <= 1.3 + 1e-9


@pytest.mark.parametrize("variables", [1, 2])
def test_bounds_close_in_on_the_largest_distance(variables):
    """|(1 + x, 0) + w| over the ball of w: 3 at x = 1."""
    search = BoxSearch(made_up(variables, ALWAYS | {"c": {(0, 0): 1.0, X: 1.0}, "Q": ONE}, {}))
    for _ in range(60):
        search.refine(search.best.value, 64)
    assert search.best.value <= search.upper
    assert 2.0 <= search.upper <= 3.0 * (1 + 1e-4)


# --- whole enclosures at budgets of a few boxes ----------------------------------------------------------------------

LARGE = [0.2, 1e-3]
FEW = (1, 1500)
WHOLE = [*STATES, ("slender_rod", "sliding"), ("slender_rod", "double_zero"), ("worn_tip_rod", "isolated")]


@pytest.mark.parametrize(
    ("scene", "state"),
    [
        ("slender_rod", "sliding"),
        ("slender_rod", "paradox"),
        ("slender_rod", "double_zero"),
        ("worn_tip_rod", "isolated"),
        ("minimal", "crossing"),
    ],
)
@pytest.mark.parametrize("eps", LARGE)
def test_a_budget_of_a_few_boxes_gives_wide_enclosures_and_no_wrong_one(scene, state, eps):
    limit = limit_of(scene, state)
    sampled = sample_distance(limit, eps, SampleOptions(samples=20_000))
    last = None
    for budget in FEW:
        found = certify_distance(limit, eps, CertifyOptions(width=1e-9, budget=budget))
        forward, backward = found.excess_Aeps_A.bounds, found.excess_A_Aeps.bounds
        assert sampled.excess_Aeps_A.bounds.lower <= forward.upper
        assert eps * (1 - 1e-9) <= forward.lower <= forward.upper
        assert backward.lower <= sampled.excess_A_Aeps.bounds.upper
        assert last is None or forward.upper <= last.upper
        last = forward


def test_a_slip_that_a_coarse_cover_cannot_exclude_and_a_finer_one_does_is_no_slip():
    """mu a little above 4/3: gamma < 0 around atan(2), up to the edge of the band; the ball ends just before it."""
    limit = limit_set(make_state(load_scene("slender_rod"), "double_zero", parameters={"mu": "4/3 + 1/1000"}))
    mu = 4 / 3 + 1 / 1000
    edge = np.arctan((3 * mu + np.sqrt(9 * mu**2 - 16)) / 2) - np.arctan(2)
    for short in (1e-11, 1e-10, 1e-9):
        found = certify_distance(limit, edge * (1 - short), CertifyOptions(width=1e-2, budget=3000))
        assert found.excess_Aeps_A.bounds.upper < 2.0 * edge
