"""Whether the law is defined at every configuration of a ball: the definition of A_eps supposes it (docs/theory.md,
section 4).

S(q, v) asks for a positive definite M, for grad g != 0 and for a friction section where g >= 0; where g < 0 it is v,
whatever M is. That is proved on boxes that cover the ball and are cut until enclosures tell, or refuted by a
configuration. Work is bounded; where it ends before either, the question is undecided, and that is said.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import flint
import numpy as np
import sympy as sp
from flint import arb, arb_mat

from painleve.errors import InputError
from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import State
from painleve.theory.hypotheses.region import BITS, Box, Evaluator, Region
from painleve.theory.hypotheses.simplest import complexity, simplest_points

__all__ = ["check_domain"]

MAX_BOXES = 2000
MAX_EXACT = 8  # boxes left that are searched for a configuration at which a condition fails with nothing to spare

Values = Sequence[arb]


@dataclass(frozen=True, kw_only=True)
class _Condition:
    """What must hold of some expressions in contact: tests on enclosures, one by exact signs at q, and words."""

    expressions: tuple[sp.Expr, ...]
    holds: Callable[[Values], bool]
    fails: Callable[[Values], bool]
    fails_exactly: Callable[[Sequence[sp.Expr]], bool]
    subject: str
    wanted: str
    failure: str


def check_domain(state: State, eps: float) -> None:
    """Raises InputError unless S is proved to be defined at every configuration of the closed ball B(q, eps).

    The message names a configuration at which it is not, or near which that is undecided.
    """
    found = _obstacle(state, Fraction(eps))
    if found is not None:
        raise InputError(f"scene {state.scene.name}, state {state.label}: eps = {eps:g} is too large: {found}")


@lru_cache(maxsize=1024)
def _obstacle(state: State, eps: Fraction) -> str | None:
    """What keeps the law from being defined on the ball, in words; None: it is proved to be defined."""
    conditions = _conditions(state.scene)
    if not conditions:
        return None
    try:
        return _Search(Region(state=state, radius=eps), conditions).run()
    except (TypeError, ValueError) as error:  # a function that has no ball arithmetic
        return f"whether S is defined on the ball is undecided: {error}"


class _Search:
    """Boxes that cover the ball, and the conditions on them."""

    def __init__(self, region: Region, conditions: Sequence[_Condition]) -> None:
        self.region, self.conditions = region, conditions
        self.g = region.state.scene.contact.constraint
        self.evaluator = Evaluator(region, [self.g, *(e for c in conditions for e in c.expressions)])

    def run(self) -> str | None:
        boxes = deque([self.region.cube(self.evaluator.coordinates)])
        for _ in range(MAX_BOXES):
            if not boxes:
                return None
            box = boxes.popleft()
            if self._unproved(box) is None:
                continue
            failed = self._failed_at_a_point(box)
            if failed is not None:
                return failed
            boxes.extend(half for half in box.halves() if self.region.holds(half.nearest))
        left = [box for box in boxes if self._unproved(box) is not None]
        simplest = sorted(left, key=lambda box: complexity(self.region, self.evaluator.coordinates, box))
        failed_there = (self._failed_exactly(box) for box in simplest[:MAX_EXACT])
        return next((f for f in failed_there if f is not None), None) or (
            self._undecided(simplest[0]) if left else None
        )

    def _parts(self, values: Values) -> Iterator[tuple[_Condition, Values]]:
        place = 1
        for condition in self.conditions:
            yield condition, values[place : place + len(condition.expressions)]
            place += len(condition.expressions)

    def _unproved(self, box: Box) -> _Condition | None:
        """The first condition that is not proved on a box; None: there is none, or the box holds no contact."""
        values = self.evaluator.on(box)
        if values[0] < 0:
            return None
        return next((c for c, part in self._parts(values) if not c.holds(part)), None)

    def _failed_at_a_point(self, box: Box) -> str | None:
        """How a condition fails at one configuration of the box that is in contact."""
        offset = box.centre if self.region.holds(box.centre) else box.nearest
        values, q = self.evaluator.at(offset), self.region.exact(self.evaluator.coordinates, offset)
        if not all(x.is_finite() for x in values):
            return self._fails_exactly(q)
        failed = next((c for c, part in self._parts(values) if c.fails(part)), None) if values[0] >= 0 else None
        return None if failed is None else self._failure(failed.failure, q)

    def _failed_exactly(self, box: Box) -> str | None:
        """The same at one of the simplest exact configurations, where a condition fails with nothing to spare."""
        points = simplest_points(self.region, self.evaluator.coordinates, box)
        return next((f for q in points if (f := self._fails_exactly(q)) is not None), None)

    def _fails_exactly(self, q: tuple[sp.Expr, ...]) -> str | None:
        g = self.region.value(self.g, q)
        if _is_undefined([g]):
            return self._failure("g is not defined", q, "")
        if exact_sign(g).sign not in (Sign.POSITIVE, Sign.ZERO):
            return None
        for condition in self.conditions:
            values = [self.region.value(e, q) for e in condition.expressions]
            if _is_undefined(values):
                return self._failure(f"{condition.subject} is not defined", q)
            if condition.fails_exactly(values):
                return self._failure(condition.failure, q)
        return None

    def _failure(self, what: str, q: tuple[sp.Expr, ...], where: str = " and in contact") -> str:
        return f"{what} at {self.region.place(q)}, which is in the ball{where}: S is not defined there"

    def _undecided(self, box: Box) -> str:
        condition = self._unproved(box)
        assert condition is not None
        near = self.region.place(self.region.exact(self.evaluator.coordinates, box.centre))
        return f"whether {condition.wanted} is undecided near {near} after {MAX_BOXES} boxes"


@lru_cache(maxsize=64)
def _conditions(scene: Scene) -> tuple[_Condition, ...]:
    """Those that depend on q; at the state itself all of them are decided when it is made."""
    found = []
    if _varies(scene, scene.inertia):
        found.append(_definiteness(scene))
    normal = tuple(e for e in derive(scene).normal if e != 0)
    if all(_varies(scene, [e]) for e in normal):
        found.append(_nonzero_gradient(normal))
    for condition in scene.contact.section.conditions:
        if _varies(scene, [condition.expression]):
            found.append(_nonnegative(condition.expression, condition.sentence))
    formulas = (scene.contact.constraint, *normal, *scene.contact.tangents)
    others = tuple(e for e in formulas if _varies(scene, [e]) and not _is_entire(e))
    if others:
        found.append(_defined(others))
    return tuple(dict.fromkeys(found))


def _varies(scene: Scene, expressions: Sequence[sp.Expr] | sp.MatrixBase) -> bool:
    return any(e.free_symbols & set(scene.q) for e in expressions)


def _is_entire(expression: sp.Expr) -> bool:
    """Defined for all real values of its symbols, by its form."""
    entire = (sp.sin, sp.cos, sp.exp, sp.sinh, sp.cosh, sp.tanh, sp.atan, sp.Abs, sp.sign, sp.Min, sp.Max)
    parts = expression.atoms(sp.Pow, sp.Function)
    return all(part.exp.is_Integer and part.exp > 0 if part.is_Pow else isinstance(part, entire) for part in parts)


def _definiteness(scene: Scene) -> _Condition:
    d = scene.dimension
    divisor, matrix = _common_divisor(scene)

    def signed(values: Values) -> arb_mat | None:
        """The matrix with the sign of the divisor; None where that is open."""
        if not bool(values[0] > 0 or values[0] < 0):
            return None
        return arb_mat(d, d, [x if values[0] > 0 else -x for x in values[1:]])

    return _Condition(
        expressions=(divisor, *matrix),
        holds=lambda values: (M := signed(values)) is not None and _is_definite(M),
        fails=lambda values: (M := signed(values)) is not None and _is_indefinite(M),
        fails_exactly=lambda values: _is_exactly_indefinite(sp.Matrix(d, d, list(values[1:])) / values[0]),
        subject="M",
        wanted="M is positive definite",
        failure="M is not positive definite",
    )


def _common_divisor(scene: Scene) -> tuple[sp.Expr, sp.MatrixBase]:
    """(D, D M) for the divisor that varies with q and that all entries of M share, if they do: else (1, M).

    Entries with one divisor vary together, which enclosures of the quotients do not see.
    """
    M = scene.inertia
    if not any(part.exp.is_negative and _varies(scene, [part.base]) for part in M.atoms(sp.Pow)):
        return sp.Integer(1), M
    parts = [sp.fraction(sp.together(e)) for e in M]
    divisors = {below for _, below in parts if _varies(scene, [below])}
    if len(divisors) != 1:
        return sp.Integer(1), M
    (divisor,) = divisors
    entries = [above if below == divisor else above * divisor / below for above, below in parts]
    return divisor, sp.Matrix(*M.shape, entries)


def _nonzero_gradient(normal: tuple[sp.Expr, ...]) -> _Condition:
    return _Condition(
        expressions=normal,
        holds=lambda values: any(bool(x > 0 or x < 0) for x in values),
        fails=lambda values: all(x.is_zero() for x in values),
        fails_exactly=lambda values: all(exact_sign(x).sign is Sign.ZERO for x in values),
        subject="grad g",
        wanted="grad g does not vanish",
        failure="grad g vanishes",
    )


def _nonnegative(expression: sp.Expr, what: str) -> _Condition:
    return _Condition(
        expressions=(expression,),
        holds=lambda values: bool(values[0] >= 0),
        fails=lambda values: bool(values[0] < 0),
        fails_exactly=lambda values: exact_sign(values[0]).sign is Sign.NEGATIVE,
        subject=what,
        wanted=f"{what} is nowhere negative",
        failure=f"{what} is negative",
    )


def _defined(expressions: tuple[sp.Expr, ...]) -> _Condition:
    return _Condition(
        expressions=expressions,
        holds=lambda values: all(x.is_finite() for x in values),
        fails=lambda values: False,
        fails_exactly=lambda values: False,
        subject="g, grad g or H",
        wanted="g, grad g and H are defined",
        failure="",
    )


def _is_definite(M: arb_mat) -> bool:
    """Proved: C M C^T is strictly dominated by a positive diagonal, for an invertible C that makes it nearly 1."""
    d = M.nrows()
    try:
        C = np.linalg.inv(np.linalg.cholesky(_middle(M)))
    except np.linalg.LinAlgError:
        return False
    if not (np.isfinite(C).all() and np.all(np.diag(C) > 0.0)):
        return False
    change = arb_mat(d, d, C.ravel().tolist())
    near_one = change * M * change.transpose()
    return all(
        bool(near_one[i, i] - sum((abs(near_one[i, j]) for j in range(d) if j != i), arb(0)) > 0) for i in range(d)
    )


def _is_indefinite(M: arb_mat) -> bool:
    """Proved: x.M x <= 0 for some x != 0."""
    middle = _middle(M)
    if not np.isfinite(middle).all():
        return False
    x = arb_mat(M.nrows(), 1, np.linalg.eigh(middle)[1][:, 0].tolist())
    return bool((x.transpose() * M * x)[0, 0] <= 0)


def _is_undefined(values: Sequence[sp.Expr]) -> bool:
    return any(x.has(sp.zoo, sp.nan, sp.oo) or x.is_real is False for x in values)


def _is_exactly_indefinite(M: sp.MatrixBase) -> bool:
    """A leading minor is not positive, or there is a division by zero."""
    if M.has(sp.zoo, sp.nan, sp.oo):
        return True
    minors = (M[:size, :size].det(method="berkowitz") for size in range(1, M.rows + 1))
    return any(exact_sign(minor).sign in (Sign.NEGATIVE, Sign.ZERO) for minor in minors)


def _middle(M: arb_mat) -> np.ndarray:
    with flint.ctx.workprec(BITS):
        d = M.nrows()
        return np.array([[float(M[i, j].mid()) for j in range(d)] for i in range(d)])
