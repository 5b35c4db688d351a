"""From a TOML document to a scene: every field is read, checked and named in what is refused."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from typing import Any, TypeVar, cast

import sympy as sp

from painleve.errors import InputError
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import NoFriction
from painleve.mechanics.scene import Coordinate, NamedState, Outline, Parameter, Range, Scene, StateKey, make_scene
from painleve.mechanics.scene_file.bodies import read_mechanism, read_tree
from painleve.mechanics.scene_file.document import Document, read_document
from painleve.mechanics.scene_file.fields import Field
from painleve.mechanics.scene_file.mechanics import read_contact, read_motion, read_section
from painleve.mechanics.scene_file.names import why_no_name, why_no_symbol
from painleve.mechanics.scene_file.work import TooMuchWork, limited_calls, nodes_of
from painleve.mechanics.tree.scene import make_tree_scene
from painleve.progress import told

__all__ = ["scene_of_text"]

RULES = ("placement", "velocity", "contact_parameters")  # what the state keys say
MOST_COORDINATES, MOST_PARAMETERS, MOST_KEYS, MOST_STATES, MOST_POINTS = 6, 32, 16, 64, 64
MOST_CALLS = 4_000_000  # of Python functions in deriving a scene
MOST_NODES = 20_000  # of the derived a, b, C and M^-1 W

Symbols = Mapping[str, sp.Expr]
Declared = TypeVar("Declared", Coordinate, Parameter, StateKey)


@lru_cache(maxsize=32)  # one scene for one text, so that what is derived from it is derived once
@told(lambda name, *_, **__: f"deriving the scene of {name}")
def scene_of_text(name: str, text: str) -> Scene:
    """The scene that a TOML text describes; `name` is what messages call the file.

    Raises InputError, one line with file, line and field, for everything that is not a scene within the limits.
    """
    document = read_document(name, text)
    try:
        with limited_calls(MOST_CALLS):
            scene = _scene(document)
            if scene.definitions.steps:
                return scene
            derivation = derive(scene)
    except TooMuchWork:
        raise InputError(f"{name}: deriving this scene takes too much algebra; shorten the formulas") from None
    rows = [*derivation.normal_response, *(derivation.tangent_response or ()), *scene.force]
    nodes = nodes_of(rows)
    if nodes > MOST_NODES:
        raise InputError(
            f"{name}: the derived formulas have {nodes} numbers, names and operations, more than "
            f"{MOST_NODES}; shorten the formulas of the inertia (it is sparse in coordinates of "
            "the centre of mass) or use fewer coordinates"
        )
    return scene


def _scene(document: Document) -> Scene:
    top = Field(document=document, path=(), value=document.table)
    return _tree_scene(top) if "body" in document.table else _formula_scene(top)


def _tree_scene(top: Field) -> Scene:
    """Of a mechanism, by its bodies and joints."""
    fields = top.table(
        ("name", "sentence", "body", "contact"),
        ("source", "parameters", "mechanism", "friction", "states", "contact_parameters"),
    )
    name, document = _named(fields["name"], fields["name"].string()), top.document
    parameters = _parameters(fields.get("parameters"))
    p = _symbols(parameters)
    mechanism = read_mechanism(fields.get("mechanism"), fields["body"], p)
    joints = {joint.name: joint.symbol for joint in mechanism.joints}
    friction = read_section(fields["friction"], {**joints, **p}) if "friction" in fields else NoFriction()
    tree = read_tree(fields["contact"], mechanism, p, friction.dimension)
    parts: dict[str, Any] = {"tree": tree, "friction": friction, "parameters": parameters}
    if "contact_parameters" in fields:
        given = fields["contact_parameters"].table((), [x.name for x in parameters])
        parts["contact_parameters"] = {n: rule.formula({**joints, **p}) for n, rule in given.items()}
    try:
        scene = make_tree_scene(
            name=name,
            sentence=fields["sentence"].sentence(),
            source=fields["source"].sentence() if "source" in fields else f"a scene file, {document.name}",
            **parts,
        )
    except InputError as error:
        raise InputError(f"{document.name}: {error}") from None
    states = _states(fields.get("states"), scene.coordinates, parameters, scene.keys)
    return dataclasses.replace(scene, states=states, file=document.name, text=document.text)


def _formula_scene(top: Field) -> Scene:
    """By its kinetic energy and the formulas of its contact."""
    document = top.document
    fields = top.table(
        ("name", "sentence", "coordinates", "mechanics", "contact"),
        ("source", "parameters", "friction", "keys", *RULES, "states", "outline"),
    )
    name = _named(fields["name"], fields["name"].string())
    coordinates = _declared(fields["coordinates"], MOST_COORDINATES, _coordinate)
    if not coordinates:
        raise fields["coordinates"].refuse("there is none; a scene needs at least one coordinate")
    parameters = _parameters(fields.get("parameters"))
    keys = _declared(fields.get("keys"), MOST_KEYS, _key)
    q, p = _symbols(coordinates), _symbols(parameters)
    _refuse_shared(fields, q, p, _symbols(keys))
    u = {f"u_{c.name}": c.velocity for c in coordinates}
    rules = _rules(fields, coordinates, parameters, keys)
    _refuse_idle_keys(fields, keys, rules)
    parts: dict[str, Any] = {
        **read_motion(fields["mechanics"], q, u, p),
        **read_contact(fields["contact"], fields.get("friction"), q, p),
        **rules,
        "states": _states(fields.get("states"), coordinates, parameters, keys),
        "outline": _outline(fields.get("outline"), q, p),
        "sentence": fields["sentence"].sentence(),
        "source": fields["source"].sentence() if "source" in fields else f"a scene file, {name}",
    }
    try:
        scene = make_scene(name=name, coordinates=coordinates, parameters=parameters, keys=keys, **parts)
    except InputError as error:
        raise InputError(f"{document.name}: {error}") from None
    return dataclasses.replace(scene, file=document.name, text=document.text)


def _named(field: Field, name: str) -> str:
    why = why_no_name(name)
    if why is not None:
        raise field.refuse(why)
    return name


def _declared(field: Field | None, most: int, read: Callable[[str, Field], Declared]) -> tuple[Declared, ...]:
    return tuple(read(name, inside) for name, inside in field.named(most).items()) if field is not None else ()


def _symbols(declared: Iterable[Coordinate | Parameter | StateKey]) -> dict[str, sp.Expr]:
    return {d.name: d.symbol for d in declared}


def _symbol_name(field: Field, name: str, *, coordinate: bool = False) -> str:
    why = why_no_symbol(name, coordinate=coordinate)
    if why is not None:
        raise field.refuse(why)
    return name


def _coordinate(name: str, field: Field) -> Coordinate:
    name = _symbol_name(field, name, coordinate=True)
    fields = field.table(("unit", "sentence"), ("latex",))
    return Coordinate(
        name=name,
        unit=fields["unit"].unit(),
        sentence=fields["sentence"].sentence(),
        latex=fields["latex"].latex() if "latex" in fields else "",
    )


def _parameters(field: Field | None) -> tuple[Parameter, ...]:
    """Each default is a formula in the parameters before it."""
    before: dict[str, sp.Expr] = {}

    def read(name: str, inside: Field) -> Parameter:
        parameter = _parameter(name, inside, before)
        before[name] = parameter.symbol
        return parameter

    return _declared(field, MOST_PARAMETERS, read)


def _parameter(name: str, field: Field, before: Symbols) -> Parameter:
    name = _symbol_name(field, name)
    fields = field.table(("unit", "sentence", "default"), ("range", "latex"))
    fields["default"].formula(before)
    range_ = fields["range"].choice(("positive", "nonnegative", "real")) if "range" in fields else "positive"
    return Parameter(
        name=name,
        unit=fields["unit"].unit(),
        sentence=fields["sentence"].sentence(),
        default=fields["default"].formula_text(),
        range=cast(Range, range_),
        latex=fields["latex"].latex() if "latex" in fields else "",
    )


def _key(name: str, field: Field) -> StateKey:
    name = _symbol_name(field, name)
    fields = field.table(("unit", "sentence"), ("default",))
    default = None
    if "default" in fields:
        fields["default"].formula({})
        default = fields["default"].formula_text()
    return StateKey(name=name, unit=fields["unit"].unit(), sentence=fields["sentence"].sentence(), default=default)


def _refuse_shared(fields: Mapping[str, Field], q: Symbols, p: Symbols, keys: Symbols) -> None:
    """A parameter has a name of its own; a key may be a coordinate."""
    for table, names, others in (("parameters", p, q), ("keys", keys, p)):
        shared = next((name for name in names if name in others), None)
        if shared is not None:
            raise fields[table].named(len(names))[shared].refuse("this name is declared twice; choose another one")


def _rules(
    fields: Mapping[str, Field],
    coordinates: tuple[Coordinate, ...],
    parameters: tuple[Parameter, ...],
    keys: tuple[StateKey, ...],
) -> dict[str, dict[str, sp.Expr]]:
    """Where the keys put q, u and parameters; a key with the name of a coordinate is that coordinate unless told."""
    symbols = {**_symbols(keys), **_symbols(parameters)}
    moving, fixed = [c.name for c in coordinates], [p.name for p in parameters]
    rules: dict[str, dict[str, sp.Expr]] = {}
    for table, targets in zip(RULES, (moving, moving, fixed), strict=True):
        given = fields[table].table((), targets) if table in fields else {}
        rules[table] = {name: rule.formula(symbols) for name, rule in given.items()}
    same = {k.name: k.symbol for k in keys if k.name in moving}
    rules["placement"] = same | rules["placement"]
    return rules


def _refuse_idle_keys(
    fields: Mapping[str, Field], keys: tuple[StateKey, ...], rules: Mapping[str, Mapping[str, sp.Expr]]
) -> None:
    used = set().union(*(rule.free_symbols for table in rules.values() for rule in table.values()))
    for key in keys:
        if key.symbol not in used:
            field = fields["keys"].named(MOST_KEYS)[key.name]
            raise field.refuse(f"no rule of {', '.join(RULES)} uses this key; add one, or take the key away")


def _states(
    field: Field | None,
    coordinates: tuple[Coordinate, ...],
    parameters: tuple[Parameter, ...],
    keys: tuple[StateKey, ...],
) -> tuple[NamedState, ...]:
    if field is None:
        return ()
    components = [c.name for c in coordinates] + [f"u_{c.name}" for c in coordinates]
    given = tuple(dict.fromkeys([*(k.name for k in keys), *components]))
    found = []
    for name, state in field.named(MOST_STATES).items():
        parts = state.table(("sentence",), ("keys", "parameters"))
        found.append(
            NamedState(
                name=_named(state, name),
                sentence=parts["sentence"].sentence(),
                keys=_values(parts.get("keys"), given),
                parameters=_values(parts.get("parameters"), [p.name for p in parameters]),
                place=state.where,
            )
        )
    return tuple(found)


def _values(field: Field | None, allowed: Iterable[str]) -> dict[str, str]:
    """Exact numbers by name, as text."""
    fields = field.table((), allowed) if field is not None else {}
    for value in fields.values():
        value.formula({})
    return {name: value.formula_text() for name, value in fields.items()}


def _outline(field: Field | None, q: Symbols, p: Symbols) -> Outline | None:
    if field is None:
        return None
    fields = field.table(("points", "floor"))
    points = []
    for point in fields["points"].array(MOST_POINTS, what="points"):
        x, y = (part.formula({**q, **p}) for part in point.array(2, length=2, what="coordinates"))
        points.append((x, y))
    return Outline(points=tuple(points), floor=fields["floor"].formula(p))
