"""A scene as data: coordinates, inertia, force and contact, all symbolic.

Conventions (paper, section 1): g(q) <= 0 is admissible, n = -grad g/|grad g| points inward, M du = f dt + r.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

import sympy as sp

from painleve.errors import InputError, nearest
from painleve.exact.tape import Tape
from painleve.mechanics.contact import Contact
from painleve.mechanics.friction import NoFriction, Section
from painleve.mechanics.tree.model import Tree

__all__ = ["Coordinate", "NamedState", "Outline", "Parameter", "Scene", "StateKey", "make_scene"]

Range = Literal["positive", "nonnegative", "real"]


@dataclass(frozen=True, kw_only=True)
class Coordinate:
    """A generalised coordinate; its velocity is the symbol `u_<name>`."""

    name: str
    unit: str
    sentence: str
    latex: str = ""

    @property
    def symbol(self) -> sp.Symbol:
        return sp.Symbol(self.name, real=True)

    @property
    def velocity(self) -> sp.Symbol:
        return sp.Symbol(f"u_{self.name}", real=True)


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """A constant of the scene; `default` is an expression in the parameters before it."""

    name: str
    unit: str
    sentence: str
    default: str
    range: Range = "positive"
    latex: str = ""

    @property
    def symbol(self) -> sp.Symbol:
        # No assumption but real: positivity is checked on numbers, and |.| must not be simplified away unproved.
        return sp.Symbol(self.name, positive=True) if self.range == "positive" else sp.Symbol(self.name, real=True)


@dataclass(frozen=True, kw_only=True)
class StateKey:
    """A natural quantity by which a user gives a state; exact expressions only. No default means it must be given.

    `default` is a number, or a formula in other keys and the parameters; where such a formula is used, parameters are
    what is given or their defaults, for the state is put where they say. `interval` are the ends between which the key
    varies along a curve of states, unless others are given.
    """

    name: str
    unit: str
    sentence: str
    default: str | None = None
    interval: tuple[str, str] | None = None

    @property
    def symbol(self) -> sp.Symbol:
        return sp.Symbol(self.name, real=True)


@dataclass(frozen=True, kw_only=True)
class NamedState:
    """A state with a name: values of keys and parameters as exact expressions; `place` says where a file gives it."""

    name: str
    sentence: str
    keys: Mapping[str, str]
    parameters: Mapping[str, str]
    place: str = ""


@dataclass(frozen=True, kw_only=True)
class Outline:
    """What a picture of the body needs, in metres: a polyline of points (x, y), and the height of the floor below it.

    Points are expressions in the coordinates and the parameters, the height in the parameters alone. A scene with an
    outline has minus the height of the contact point over that floor as its g. `contact_is_lowest`: the contact is at
    the lowest point of the body in every configuration, as it moves over a round one.
    """

    points: tuple[tuple[sp.Expr, sp.Expr], ...]
    floor: sp.Expr
    contact_is_lowest: bool = False

    def depths(self, constraint: sp.Expr) -> dict[int, sp.Expr]:
        """How far points are below the floor, by their place in `points`: of those that the contact does not hold up.

        Where the scene touches the floor, a depth is g identically; of points at one height the first is here.
        """
        depths: dict[int, sp.Expr] = {}
        if self.contact_is_lowest:
            return depths
        for i, (_, y) in enumerate(self.points):
            depth = sp.expand(self.floor - y)
            if sp.expand(depth - constraint) != 0 and depth not in depths.values():
                depths[i] = depth
        return depths

    def __post_init__(self) -> None:
        points = tuple((sp.sympify(x, strict=True), sp.sympify(y, strict=True)) for x, y in self.points)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "floor", sp.sympify(self.floor, strict=True))


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """A mechanical scene; build it with `make_scene`, which checks it.

    `inertia` is M(q) (d x d); `force` is f(t, q, u) (d x 1), gyroscopic terms included; `contact` is where it touches;
    `placement`, `velocity` and `contact_parameters` say, in terms of the state keys and the parameters, where the
    natural keys put q, u and those parameters that the contact fixes. `definitions` are the named intermediate results
    that M, f and the contact are written in, none where they stand in closed form. `tree` is the mechanism that they
    were derived from. `file` and `text` are the name and the text of the file that it was read from, empty for a scene
    that was not.
    """

    name: str
    sentence: str
    source: str
    coordinates: tuple[Coordinate, ...]
    parameters: tuple[Parameter, ...]
    inertia: sp.ImmutableMatrix
    force: sp.ImmutableMatrix
    contact: Contact
    keys: tuple[StateKey, ...]
    placement: Mapping[str, sp.Expr]
    velocity: Mapping[str, sp.Expr]
    contact_parameters: Mapping[str, sp.Expr]
    states: tuple[NamedState, ...] = field(default=())
    outline: Outline | None = None
    definitions: Tape = field(default_factory=Tape)
    tree: Tree | None = None
    file: str = ""
    text: str = ""

    def __repr__(self) -> str:
        """The name alone: states and results hold their scene, and would drown in its formulas."""
        return f"Scene({self.name!r})"

    @property
    def q(self) -> tuple[sp.Symbol, ...]:
        return tuple(c.symbol for c in self.coordinates)

    @property
    def u(self) -> tuple[sp.Symbol, ...]:
        return tuple(c.velocity for c in self.coordinates)

    @property
    def p(self) -> tuple[sp.Symbol, ...]:
        return tuple(p.symbol for p in self.parameters)

    @property
    def dimension(self) -> int:
        return len(self.coordinates)

    def parameter(self, name: str) -> Parameter:
        for parameter in self.parameters:
            if parameter.name == name:
                return parameter
        known = ", ".join(p.name for p in self.parameters)
        hint = nearest(name, (p.name for p in self.parameters))
        if name in {k.name for k in self.keys} | {str(s) for s in (*self.q, *self.u)}:
            hint = " (it is a state key, and given with the state)"
        raise InputError(f"scene {self.name}: no parameter {name!r}{hint}; it has {known or 'none'}")

    def state(self, name: str) -> NamedState:
        for state in self.states:
            if state.name == name:
                return state
        known = ", ".join(s.name for s in self.states) or "none"
        hint = nearest(name, (s.name for s in self.states))
        if name in {k.name for k in self.keys}:
            hint = f" (it is a state key: give {name}=EXPRESSION)"
        raise InputError(f"scene {self.name}: no state {name!r}{hint}; named states: {known}")


def make_scene(
    *,
    name: str,
    sentence: str,
    source: str,
    coordinates: Iterable[Coordinate],
    parameters: Iterable[Parameter],
    kinetic_energy: sp.Expr | None = None,
    inertia: sp.MatrixBase | None = None,
    potential: sp.Expr | None = None,
    force: sp.MatrixBase | None = None,
    constraint: sp.Expr,
    tangential_displacements: Iterable[sp.Expr] = (),
    tangents: sp.MatrixBase | None = None,
    friction: Section | None = None,
    keys: Iterable[StateKey] = (),
    placement: Mapping[str, sp.Expr] | None = None,
    velocity: Mapping[str, sp.Expr] | None = None,
    contact_parameters: Mapping[str, sp.Expr] | None = None,
    states: Iterable[NamedState] = (),
    outline: Outline | None = None,
) -> Scene:
    """Check a scene and derive M, f and H from what describes it.

    Give either the kinetic energy (a quadratic form in the velocities) or M, either a potential or the generalised
    force without gyroscopic terms (default: no force); g, or minus the contact point's height; and for each direction
    of friction one tangential displacement of the contact point, or one column of H itself (d x k): H^T u is the
    velocity of the body's material point at the contact, which has no displacement where that point changes.

    Raises InputError that names the symbol or the shape at fault.
    """
    coordinates, parameters, keys, states = tuple(coordinates), tuple(parameters), tuple(keys), tuple(states)
    fixed = [p.name for p in parameters] + [str(c.velocity) for c in coordinates] + ["t"]
    _check_names(name, [c.name for c in coordinates] + fixed)
    _check_names(name, [k.name for k in keys] + fixed)  # a key may be a coordinate
    _check_names(name, [s.name for s in states])
    q, u, p = ([c.symbol for c in coordinates], [c.velocity for c in coordinates], [s.symbol for s in parameters])
    M = _inertia(name, kinetic_energy, inertia, q, u)
    f = sp.ImmutableMatrix(_applied_force(name, potential, force, q) + gyroscopic_force(M, q, u))
    constraint = sp.sympify(constraint, strict=True)
    H = _tangents(name, tangential_displacements, tangents, q)
    section = friction if friction is not None else NoFriction()
    _check_friction(name, H, section)
    time = sp.Symbol("t", real=True)
    _check_symbols(name, "M", M, [*q, *p])
    _check_symbols(name, "f", f, [time, *q, *u, *p])
    _check_symbols(name, "g", sp.Matrix([constraint]), [*q, *p])
    _check_symbols(name, "H", H, [*q, *p])
    _check_symbols(name, "the friction section", sp.Matrix(section.expressions), [*q, *p])
    if outline is not None:
        _check_symbols(name, "the outline", sp.Matrix(outline.points), [*q, *p])
        _check_symbols(name, "the floor of the outline", sp.Matrix([outline.floor]), p)
    if all(sp.diff(constraint, x) == 0 for x in q):
        raise InputError(f"scene {name}: g does not depend on any coordinate; give a constraint g(q) <= 0")
    given = [*(k.symbol for k in keys), *p]
    rules = [placement or {}, velocity or {}, contact_parameters or {}]
    targets = ([c.name for c in coordinates], [c.name for c in coordinates], [p.name for p in parameters])
    for rule, allowed in zip(rules, targets, strict=True):
        _check_symbols(name, "a state key's rule", sp.Matrix(list(rule.values()) or [0]), given)
        _check_targets(name, rule, allowed)
    return Scene(
        name=name,
        sentence=sentence,
        source=source,
        coordinates=coordinates,
        parameters=parameters,
        inertia=M,
        force=f,
        contact=Contact(constraint=constraint, tangents=H, section=section),
        keys=keys,
        placement=MappingProxyType(dict(rules[0])),
        velocity=MappingProxyType(dict(rules[1])),
        contact_parameters=MappingProxyType(dict(rules[2])),
        states=states,
        outline=outline,
    )


def gyroscopic_force(M: sp.MatrixBase, q: list[sp.Symbol], u: list[sp.Symbol]) -> sp.Matrix:
    """-(dM/dt u - grad_q(u.M u)/2): what Lagrange's equations put beside the applied force."""
    velocity = sp.Matrix(u)
    quadratic = (velocity.T * M * velocity)[0, 0]
    rate = sum((M.diff(x) * v for x, v in zip(q, u, strict=True)), sp.zeros(*M.shape))
    return sp.Matrix([sp.diff(quadratic, x) / 2 for x in q]) - rate * velocity


def _inertia(
    name: str, energy: sp.Expr | None, M: sp.MatrixBase | None, q: list[sp.Symbol], u: list[sp.Symbol]
) -> sp.ImmutableMatrix:
    if (energy is None) == (M is None):
        raise InputError(f"scene {name}: give either the kinetic energy or the inertia matrix M")
    if energy is not None:
        M = sp.hessian(energy, u)
        M = M.applyfunc(sp.expand)
        remainder = sp.expand(energy - (sp.Matrix(u).T * M * sp.Matrix(u))[0, 0] / 2)
        if sp.simplify(remainder) != 0:
            raise InputError(
                f"scene {name}: the kinetic energy is not a quadratic form in the velocities "
                f"{', '.join(map(str, u))}; left over: {remainder}"
            )
    assert M is not None
    if M.shape != (len(q), len(q)):
        raise InputError(f"scene {name}: M has shape {M.shape}; {len(q)} coordinates need {(len(q), len(q))}")
    skew = (M - M.T).applyfunc(sp.simplify)
    if not skew.is_zero_matrix:
        i, j = next((i, j) for i in range(len(q)) for j in range(len(q)) if skew[i, j] != 0)
        raise InputError(
            f"scene {name}: M is not symmetric: M[{q[i]}, {q[j]}] = {M[i, j]} but M[{q[j]}, {q[i]}] = {M[j, i]}"
        )
    return sp.ImmutableMatrix(M)


def _applied_force(name: str, potential: sp.Expr | None, force: sp.MatrixBase | None, q: list[sp.Symbol]) -> sp.Matrix:
    if potential is not None and force is not None:
        raise InputError(f"scene {name}: give a potential or a force, not both")
    if force is not None and tuple(force.shape) != (len(q), 1):
        raise InputError(f"scene {name}: the force has shape {tuple(force.shape)}; it needs {(len(q), 1)}")
    if force is not None:
        return sp.Matrix(force)
    return sp.Matrix([-sp.diff(potential, x) if potential is not None else 0 for x in q])


def _tangents(
    name: str, displacements: Iterable[sp.Expr], tangents: sp.MatrixBase | None, q: list[sp.Symbol]
) -> sp.ImmutableMatrix:
    displacements = [sp.sympify(s, strict=True) for s in displacements]
    if tangents is None:
        return sp.ImmutableMatrix(len(q), len(displacements), lambda i, j: sp.diff(displacements[j], q[i]))
    if displacements:
        raise InputError(f"scene {name}: give tangential displacements or their gradients H, not both")
    if tangents.shape[0] != len(q):
        raise InputError(f"scene {name}: H has {tangents.shape[0]} rows; it needs {len(q)}, one for each coordinate")
    return sp.ImmutableMatrix(tangents)


def _check_names(scene: str, names: list[str]) -> None:
    twice = sorted({n for n in names if names.count(n) > 1})
    if twice:
        raise InputError(
            f"scene {scene}: {', '.join(twice)} is declared twice; everything needs a name of its own, "
            "and t and u_<coordinate> are taken"
        )


def _check_targets(scene: str, rule: Mapping[str, sp.Expr], allowed: list[str]) -> None:
    unknown = ", ".join(sorted(set(rule) - set(allowed)))
    if unknown:
        raise InputError(f"scene {scene}: a state key's rule gives {unknown}, which is not one of {', '.join(allowed)}")


def _check_friction(scene: str, H: sp.MatrixBase, section: Section) -> None:
    k = H.shape[1]
    if k != section.dimension:
        have = f"a {section.kind} as friction section" if section.dimension else "no friction section"
        raise InputError(
            f"scene {scene}: {k} tangential displacements with {have}; no friction needs none, "
            "a segment one, a section in space two"
        )
    if section.flaw:
        raise InputError(f"scene {scene}: {section.flaw}")


def _check_symbols(scene: str, where: str, expressions: sp.MatrixBase, declared: list[sp.Symbol]) -> None:
    stray = sorted(str(s) for s in expressions.free_symbols - set(declared))
    if stray:
        known = ", ".join(map(str, declared))
        hint = ""
        if set(stray) & set(map(str, declared)):  # sympy tells symbols of one name apart by what it assumes of them
            hint = "; build formulas from the `symbol` and `velocity` of what is declared"
        raise InputError(f"scene {scene}: undeclared symbol {', '.join(stray)} in {where}; declared: {known}{hint}")
