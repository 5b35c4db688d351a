"""The one-step contact problem at a configuration and a velocity, in exact numbers (docs/theory.md, section 1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from painleve.errors import InputError
from painleve.exact.balls import ball
from painleve.exact.parse import exact_number
from painleve.exact.signs import Sign, Signed, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import Scene
from painleve.mechanics.state import Number, State, resolve_parameters
from painleve.theory.sections.listed import theory_of
from painleve.theory.sections.section import Exact, Points

__all__ = ["ContactProblem", "Numbers", "make_problem", "problem_at"]

Numbers = Sequence[Number] | Mapping[str, Number]

_BITS = 512  # at which a number is compared with the rational number that it may be
_LONGEST_DENOMINATOR = 2**160


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactProblem:
    """Exact numbers at (q, v): `constraint` is the sign of g, `gamma` that of gamma; `delassus` = G and
    `contact_velocity` = (v_n, v_t) are in physical tangents; `responses` = M^-1 W (d x (1 + k)).

    The section is a polygon or a segment with the `vertices` (counterclockwise), or s = E sigma, |sigma| <= 1, with
    `section_map` = E; neither where there is no friction.
    """

    scene: Scene
    velocity: sp.ImmutableMatrix
    constraint: Signed
    gamma: Signed
    delassus: sp.ImmutableMatrix
    contact_velocity: sp.ImmutableMatrix
    responses: sp.ImmutableMatrix
    vertices: tuple[sp.ImmutableMatrix, ...]
    section_map: sp.ImmutableMatrix | None

    @property
    def normalised(self) -> tuple[sp.ImmutableMatrix, sp.ImmutableMatrix]:
        """G and (v_n, v_t) in tangents for which a disc or an ellipse is the unit disc."""
        change = sp.diag(1, self.section_map)
        G, v = change.T * self.delassus * change, change.T * self.contact_velocity
        return sp.ImmutableMatrix(G.applyfunc(recognised)), sp.ImmutableMatrix(v.applyfunc(recognised))


def make_problem(
    scene: Scene, q: Numbers, v: Numbers, parameters: Mapping[str, Number] | None = None
) -> ContactProblem:
    """Read q and v, one number a coordinate, and evaluate the scene there exactly.

    A mapping names the coordinates (q) and `u_<coordinate>` (v). Raises InputError for missing, unknown or inexact
    numbers, and where the scene is not sound: M or G not positive definite, no section of friction.
    """
    table = resolve_parameters(scene, dict(parameters or {}))
    point = {p.symbol: table[p.name] for p in scene.parameters}
    point |= dict(zip(scene.q, _read(scene, "q", q, [c.name for c in scene.coordinates]), strict=True))
    speeds = _read(scene, "v", v, [str(u) for u in scene.u])
    return _evaluate(scene, point, sp.ImmutableMatrix(speeds))


def problem_at(state: State) -> ContactProblem:
    """The tangential problem of a state (q, u-)."""
    return _evaluate(state.scene, state.substitution, sp.ImmutableMatrix(state.u))


def recognised(number: sp.Expr) -> sp.Expr:
    """The rational number that an exact number is, where it is one with a moderate denominator; else the number."""
    if number.is_Rational:
        return number
    enclosure = ball(number, bits=_BITS)
    if enclosure.rel_accuracy_bits() < _BITS // 2 and not enclosure.contains(0):
        return number
    middle = enclosure.mid().fmpq()
    guess = Fraction(int(middle.p), int(middle.q)).limit_denominator(_LONGEST_DENOMINATOR)
    rational = sp.Rational(guess.numerator, guess.denominator)
    return rational if exact_sign(number - rational).sign is Sign.ZERO else number


def _read(scene: Scene, what: str, given: Numbers, names: list[str]) -> list[sp.Expr]:
    if isinstance(given, Mapping):
        wrong = sorted(set(map(str, given)) ^ set(names))
        if wrong:
            raise InputError(
                f"scene {scene.name}: {what} needs exactly {', '.join(names)}; missing or unknown: {', '.join(wrong)}"
            )
        values = [given[name] for name in names]
    else:
        values = list(given)
        if isinstance(given, str) or len(values) != len(names):
            raise InputError(
                f"scene {scene.name}: {what} needs {len(names)} numbers ({', '.join(names)}), "
                f"not {1 if isinstance(given, str) else len(values)}"
            )
    return [exact_number(value, where=f"{what}: {name}") for value, name in zip(values, names, strict=True)]


def _evaluate(scene: Scene, point: Mapping[sp.Symbol, sp.Expr], v: sp.ImmutableMatrix) -> ContactProblem:
    d = derive(scene)

    def exact(matrix: sp.MatrixBase) -> sp.ImmutableMatrix:
        return sp.ImmutableMatrix(matrix.xreplace(dict(point)).applyfunc(recognised))

    M = exact(scene.inertia)
    if any(not _positive(M[:n, :n]) for n in range(1, scene.dimension + 1)):
        raise InputError(f"scene {scene.name}: M is not positive definite at this q; choose another configuration")
    W = exact(sp.Matrix.hstack(d.normal, scene.contact.tangents))
    Y = exact(sp.Matrix.hstack(d.normal_response, d.tangent_response))
    G = (W.T * Y).applyfunc(recognised)
    if any(not _positive(G[:n, :n]) for n in range(1, G.rows + 1)):
        raise InputError(
            f"scene {scene.name}: the normal and the tangents are not independent at this q (H3); "
            "choose another configuration"
        )
    vertices, section_map = _section(scene, exact)
    return ContactProblem(
        scene=scene,
        velocity=v,
        constraint=exact_sign(scene.contact.constraint.xreplace(dict(point))),
        gamma=exact_sign(d.gamma.xreplace(dict(point))),
        delassus=G,
        contact_velocity=(W.T * v).applyfunc(recognised),
        responses=Y,
        vertices=vertices,
        section_map=section_map,
    )


def _positive(minor: sp.MatrixBase) -> bool:
    return exact_sign(minor.det(method="berkowitz")).sign is Sign.POSITIVE


def _section(scene: Scene, exact: Exact) -> tuple[Points, sp.ImmutableMatrix | None]:
    """Vertices or the map E; neither for the section {0}, which is no friction."""
    where = f"scene {scene.name}"
    for condition in scene.contact.section.conditions:
        value = exact(sp.Matrix([condition.expression]))[0]
        if exact_sign(value).sign not in (Sign.POSITIVE, Sign.ZERO):
            raise InputError(
                f"{where}: {condition.sentence} is {float(ball(value).mid()):.6g} at this q; "
                "it must be zero or positive"
            )
    return theory_of(scene.contact).exact_section(where, exact)
