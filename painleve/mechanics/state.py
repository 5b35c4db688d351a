"""An exact state (q, u-, parameters) at a tangential contact, built from natural keys and checked exactly."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import TypeAlias

import sympy as sp

from painleve.errors import InputError, nearest
from painleve.exact.balls import ball
from painleve.exact.definite import least_minor_sign
from painleve.exact.parse import exact_number, parse_expression
from painleve.exact.signs import Sign, exact_sign
from painleve.mechanics.derive import derive
from painleve.mechanics.scene import NamedState, Scene
from painleve.progress import told

__all__ = ["Number", "State", "make_curve", "make_family", "make_state", "resolve_parameters"]

Number: TypeAlias = str | int | float | Fraction | sp.Expr


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """A configuration q in contact, g(q) = 0, with a tangential velocity, <u-, n> = 0; every number is exact."""

    scene: Scene
    label: str
    parameters: Mapping[str, sp.Expr]
    q: tuple[sp.Expr, ...]
    u: tuple[sp.Expr, ...]

    def __repr__(self) -> str:
        """How it was given, without the formulas of its coordinates, which can be long."""
        return f"State({self.scene.name!r}, {self.label!r})"

    @property
    def substitution(self) -> dict[sp.Symbol, sp.Expr]:
        parameters = {p.symbol: self.parameters[p.name] for p in self.scene.parameters}
        return parameters | dict(zip(self.scene.q, self.q, strict=True)) | dict(zip(self.scene.u, self.u, strict=True))

    def exact(self, expression: sp.Expr) -> sp.Expr:
        """The exact value of an expression in coordinates, velocities and parameters."""
        return expression.xreplace(self.substitution)

    def number(self, expression: sp.Expr) -> float:
        """The value rounded to a float, from as many digits as it takes for cancellation not to show.

        0 where 2048 bits see nothing else, NaN where there is no value.
        """
        value = self.exact(expression)
        for bits in (128, 512, 2048):
            enclosure = ball(value, bits=bits)
            if enclosure.rel_accuracy_bits() >= 64:
                break
        return float(enclosure.mid()) + 0.0  # no negative zero


@told(lambda scene, *_, **__: f"checking a state of {scene.name} in exact arithmetic")
def make_state(
    scene: Scene,
    name: str | None = None,
    *,
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
) -> State:
    """The state of that name, or the one that the keys give, with parameters overridden.

    Keys are the scene's natural ones; `<coordinate>` and `u_<coordinate>` override single components.
    Values are exact: text such as "atan(2)", integers, fractions, sympy numbers; a float means the decimal it prints.

    Raises InputError for unknown keys or parameters, for values out of range, and for a state that is not exactly in
    contact with a tangential velocity; the message says by how much. For a scene
    from a file it names that file, and the line of a named state.
    """
    named = scene.state(name) if name is not None else None
    try:
        return _state(scene, named, keys, parameters)
    except InputError as error:
        place = named.place if named else scene.file
        if place:
            raise InputError(f"{place}: {error}") from None
        raise


def _state(
    scene: Scene, named: NamedState | None, keys: Mapping[str, Number] | None, parameters: Mapping[str, Number] | None
) -> State:
    given = dict(named.keys if named else {}) | dict(keys or {})
    values, formulas, components = _sort_keys(scene, given)
    chosen = dict(named.parameters if named else {}) | dict(parameters or {})
    table = resolve_parameters(scene, chosen, None if formulas else values)
    point = values | {p.symbol: table[p.name] for p in scene.parameters}
    for key, formula in formulas.items():
        point[key] = exact_number(formula.xreplace(point), where=f"scene {scene.name}, state key {key} by default")
    q = _components(scene, {c.name: c.name for c in scene.coordinates}, scene.placement, point, components)
    u = _components(scene, {c.name: f"u_{c.name}" for c in scene.coordinates}, scene.velocity, point, components)
    label = _label(named.name if named else None, keys, parameters)
    state = State(scene=scene, label=label, parameters=MappingProxyType(table), q=q, u=u)
    _check(state)
    return state


def make_curve(
    scene: Scene,
    along: str,
    name: str | None = None,
    *,
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
) -> dict[sp.Symbol, sp.Expr]:
    """Coordinates, velocities and parameters along the curve on which one state key varies: in that key's symbol.

    The rest is as for make_state, and so are the errors; states of the curve are checked when they are made.
    """
    if along not in {key.name for key in scene.keys}:
        names = [key.name for key in scene.keys]
        raise InputError(
            f"scene {scene.name}: no state key {along!r} to go along{nearest(along, names)}; keys: {', '.join(names)}"
        )
    if along in (keys or {}):
        raise InputError(f"scene {scene.name}: {along} is given, and so cannot vary; leave it out")
    return make_family(scene, (along,), name, keys=keys, parameters=parameters)


def make_family(
    scene: Scene,
    free: Collection[str],
    name: str | None = None,
    *,
    keys: Mapping[str, Number] | None = None,
    parameters: Mapping[str, Number] | None = None,
) -> dict[sp.Symbol, sp.Expr]:
    """Coordinates, velocities and parameters in terms of the free names, each in its own symbol.

    A free name is a state key, a single component or a parameter; the rest is as for make_state, and so are the errors.
    Nothing is checked of the states: the family may leave the domain of the scene.
    """
    named = scene.state(name) if name is not None else None
    given = {k: v for k, v in (dict(named.keys if named else {}) | dict(keys or {})).items() if k not in free}
    values, formulas, components = _sort_keys(scene, given, free)
    chosen = dict(named.parameters if named else {}) | dict(parameters or {})
    table = resolve_parameters(scene, chosen, None if formulas else values, free)
    point = values | {p.symbol: table[p.name] for p in scene.parameters}
    for key, formula in formulas.items():
        point[key] = formula.xreplace(point)
    rules = {p.symbol: table[p.name] for p in scene.parameters}
    for c in scene.coordinates:
        for symbol, own, rule in ((c.symbol, c.name, scene.placement), (c.velocity, f"u_{c.name}", scene.velocity)):
            rules[symbol] = components.get(own, sp.sympify(rule.get(c.name, 0)).xreplace(point))
    return rules


def resolve_parameters(
    scene: Scene,
    given: Mapping[str, Number],
    keys: Mapping[sp.Symbol, sp.Expr] | None = None,
    free: Collection[str] = (),
) -> dict[str, sp.Expr]:
    """Exact values of all parameters: given, else fixed by the contact, else the default; of the free ones, themselves.

    Raises InputError for unknown parameters and values out of range.
    """
    for name in given:
        scene.parameter(name)
    table: dict[str, sp.Expr] = {}
    late = {} if keys is None else scene.contact_parameters
    for parameter in scene.parameters:
        if parameter.name in free:
            table[parameter.name] = parameter.symbol
        elif parameter.name in given:
            table[parameter.name] = exact_number(given[parameter.name], where=f"parameter {parameter.name}")
        elif parameter.name not in late:
            earlier = {p.name: table[p.name] for p in scene.parameters if p.name in table}
            table[parameter.name] = parse_expression(parameter.default, earlier, where=f"default of {parameter.name}")
    for name, rule in late.items():
        if name not in table:
            point = dict(keys or {}) | {p.symbol: table[p.name] for p in scene.parameters if p.name in table}
            table[name] = rule.xreplace(point)
    for parameter in scene.parameters:
        _check_range(scene, parameter.name, parameter.range, table[parameter.name])
    return {p.name: table[p.name] for p in scene.parameters}


def _sort_keys(
    scene: Scene, given: Mapping[str, Number], free: Collection[str] = ()
) -> tuple[dict[sp.Symbol, sp.Expr], dict[sp.Symbol, sp.Expr], dict[str, sp.Expr]]:
    """Natural keys by symbol, with defaults, free ones as their symbols; those whose default is a formula; and raw
    components by name."""
    raw = {c.name for c in scene.coordinates} | {f"u_{c.name}" for c in scene.coordinates}
    natural = {k.name: k for k in scene.keys}
    for name in given:
        if name not in natural and name not in raw:
            hint = nearest(name, [*natural, *sorted(raw)])
            if name in {p.name for p in scene.parameters}:
                hint = " (it is a parameter, and given beside the state: --set)"
            raise InputError(
                f"scene {scene.name}: no state key {name!r}{hint}; keys: {', '.join(natural)}; "
                f"single components: {', '.join(sorted(raw - set(natural)))}"
            )
    exact = {name: exact_number(value, where=f"state key {name}") for name, value in given.items()}
    known = {k.name: k.symbol for k in scene.keys} | {p.name: p.symbol for p in scene.parameters}
    values: dict[sp.Symbol, sp.Expr] = {}
    formulas: dict[sp.Symbol, sp.Expr] = {}
    for name, key in natural.items():
        if name in free:
            values[key.symbol] = key.symbol
        elif name in exact:
            values[key.symbol] = exact[name]
        elif key.default is not None:
            default = parse_expression(key.default, known, where=f"default of {name}")
            (formulas if default.free_symbols else values)[key.symbol] = default
        else:
            raise InputError(
                f"scene {scene.name}: the state needs {name} ({key.sentence}, {key.unit}); "
                f"give {name}=EXPRESSION or a named state: "
                f"{', '.join(s.name for s in scene.states) or 'none'}"
            )
    components = {name: value for name, value in exact.items() if name in raw and name not in natural}
    single = {str(s): s for s in (*scene.q, *scene.u)}
    components |= {name: single[name] for name in free if name in raw and name not in natural}
    return values, formulas, components


def _components(
    scene: Scene,
    keys: Mapping[str, str],
    rules: Mapping[str, sp.Expr],
    point: Mapping[sp.Symbol, sp.Expr],
    given: Mapping[str, sp.Expr],
) -> tuple[sp.Expr, ...]:
    values = []
    for coordinate, key in keys.items():
        value = given[key] if key in given else rules.get(coordinate, sp.Integer(0)).xreplace(dict(point))
        if not (value.is_number and value.is_finite is not False) or value.has(sp.zoo, sp.nan, sp.oo):
            raise InputError(f"scene {scene.name}: {key} is not finite at this state; give other keys")
        values.append(value)
    return tuple(values)


def _label(name: str | None, keys: Mapping[str, Number] | None, parameters: Mapping[str, Number] | None) -> str:
    parts = ([name] if name else []) + [f"{k}={v}" for k, v in {**(keys or {}), **(parameters or {})}.items()]
    return " ".join(parts)


def _check_range(scene: Scene, name: str, range_: str, value: sp.Expr) -> None:
    if range_ == "real" or value.free_symbols:
        return
    sign = exact_sign(value).sign
    allowed = {Sign.POSITIVE} if range_ == "positive" else {Sign.POSITIVE, Sign.ZERO}
    if sign not in allowed:
        wanted = "positive" if range_ == "positive" else "zero or positive"
        raise InputError(f"scene {scene.name}: parameter {name} = {value} must be {wanted}")


def _check(state: State) -> None:
    """The state is in contact, tangential, and the scene is sound there."""
    scene, d = state.scene, derive(state.scene)
    where = f"scene {scene.name}, state {state.label or 'given'}"
    if least_minor_sign(state.exact(scene.inertia)) is not Sign.POSITIVE:
        raise InputError(f"{where}: M is not positive definite there; choose another configuration")
    if exact_sign(state.exact(d.gradient_squared)).sign is not Sign.POSITIVE:
        raise InputError(f"{where}: grad g vanishes there; choose another configuration")
    section = scene.contact.section
    if section.dimension:
        if scene.dimension < 1 + section.dimension:
            raise InputError(
                f"{where}: friction needs {1 + section.dimension} coordinates at least, so that its directions vary "
                f"independently of g (H3), and this scene has {scene.dimension}: no configuration can do; give what "
                'the contact rubs against a coordinate of its own, or take the friction away (kind = "none")'
            )
        if least_minor_sign(state.exact(d.delassus)) is not Sign.POSITIVE:
            raise InputError(
                f"{where}: the tangential displacements do not vary independently of g there (H3); "
                "choose another configuration"
            )
        for condition in section.conditions:
            if exact_sign(state.exact(condition.expression)).sign not in (Sign.POSITIVE, Sign.ZERO):
                raise InputError(
                    f"{where}: {condition.sentence} is {state.number(condition.expression):.6g} there; "
                    "it must be zero or positive"
                )
    _check_zero(where, "g(q)", state.exact(scene.contact.constraint), "the state is off the constraint")
    v_n = (d.normal.T * sp.Matrix(scene.u))[0, 0]
    _check_zero(where, "<u-, -grad g(q)>", state.exact(v_n), "the velocity is not tangential")


def _check_zero(where: str, what: str, value: sp.Expr, meaning: str) -> None:
    signed = exact_sign(value)
    if signed.sign is Sign.ZERO:
        return
    if signed.sign is Sign.UNDECIDED:
        raise InputError(
            f"{where}: whether {what} is exactly zero is undecided ({signed.reason}); give simpler numbers"
        )
    raise InputError(f"{where}: {meaning}: {what} = {signed.value:.6g} and must be exactly 0")
