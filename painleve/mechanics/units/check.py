"""The units that a scene states against its formulas: is the kinetic energy an energy, the height a length?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction

import sympy as sp

from painleve.exact.parse import parse_expression
from painleve.mechanics.scene import Scene
from painleve.mechanics.units.dimension import PURE, Disagreement, Unit, read_unit, unit_of
from painleve.mechanics.units.mechanism import fields_of

__all__ = ["Agreement", "UnitFinding", "UnitsCheck", "check_units"]


class Agreement(Enum):
    """How far the units of something are settled."""

    AGREES = "agrees"
    UNCHECKED = "not checked"
    DISAGREES = "does not agree"


@dataclass(frozen=True, kw_only=True)
class UnitFinding:
    """One quantity: what it is, how far its unit agrees, and why not (empty where it does)."""

    what: str
    agreement: Agreement
    sentence: str


@dataclass(frozen=True, kw_only=True, eq=False)
class UnitsCheck:
    """The findings about a scene; `agreement` is the worst of them."""

    scene: Scene
    findings: tuple[UnitFinding, ...]

    @property
    def agreement(self) -> Agreement:
        order = list(Agreement)
        return max((f.agreement for f in self.findings), key=order.index, default=Agreement.AGREES)

    @property
    def open(self) -> tuple[UnitFinding, ...]:
        """What does not agree, or could not be checked."""
        return tuple(f for f in self.findings if f.agreement is not Agreement.AGREES)

    def __repr__(self) -> str:
        return f"UnitsCheck({self.scene.name!r}, {len(self.findings)} quantities: {self.agreement.value})"

    def as_dict(self) -> dict[str, object]:
        """For machines: what agrees in one list, and a sentence for all else."""
        return {
            "status": self.agreement.value,
            "agree": [f.what for f in self.findings if f.agreement is Agreement.AGREES],
            "open": [{"what": f.what, "status": f.agreement.value, "sentence": f.sentence} for f in self.open],
        }


@dataclass(frozen=True, kw_only=True)
class _Quantity:
    """A formula, the unit that it should have, and that in words."""

    what: str
    expression: sp.Expr
    wanted: Unit
    words: str
    of: Mapping[sp.Symbol, Unit]


def check_units(scene: Scene) -> UnitsCheck:
    """The units of coordinates, parameters and keys against M, f, g, H, friction, defaults, keys' rules and outline.

    Time is in seconds, as everywhere here; other units may be of any system as long as they go together. A number in a
    formula may hide a unit (9.81 for gravity): a quantity that agrees with that reading alone is not checked.

    Raises InputError where pint is not installed.
    """
    stated, findings = _stated(scene)
    findings += [_judged(quantity) for quantity in _quantities(scene, stated)]
    return UnitsCheck(scene=scene, findings=tuple(findings))


def _stated(scene: Scene) -> tuple[dict[str, Unit], list[UnitFinding]]:
    """Units by what they are of, such as "parameter m"; one that is none is reported, and then fits everywhere."""
    kinds = {"coordinate": scene.coordinates, "parameter": scene.parameters, "key": scene.keys}
    texts = {f"{kind} {x.name}": x.unit for kind, declared in kinds.items() for x in declared}  # type: ignore[attr-defined]
    stated, findings = {}, []
    for what, text in texts.items():
        try:
            stated[what] = read_unit(text)
        except Disagreement as why:
            stated[what] = Unit(free=True)
            findings.append(UnitFinding(what=f"unit of {what}", agreement=Agreement.DISAGREES, sentence=str(why)))
    return stated, findings


def _judged(quantity: _Quantity) -> UnitFinding:
    """First with all numbers pure; where that fails, with numbers that may have a unit."""
    why = ""
    for agreement, lenient in ((Agreement.AGREES, False), (Agreement.UNCHECKED, True)):
        try:
            found = unit_of(quantity.expression, quantity.of, lenient=lenient)
        except Disagreement as reason:
            why = why or str(reason)
            continue
        if found.agrees(quantity.wanted):
            hidden = "only if a number in it has a unit; give that number a name and a unit, as a parameter"
            sentence = "" if agreement is Agreement.AGREES else f"{why}: agrees {hidden}"
            return UnitFinding(what=quantity.what, agreement=agreement, sentence=sentence)
        why = why or f"it has the unit {found}, and {quantity.words} is {quantity.wanted}"
    return UnitFinding(what=quantity.what, agreement=Agreement.DISAGREES, sentence=why)


def _quantities(scene: Scene, stated: Mapping[str, Unit]) -> Iterator[_Quantity]:
    second = read_unit("s")
    rate = {c.name: stated[f"coordinate {c.name}"].times(second, Fraction(-1)) for c in scene.coordinates}
    parameters = {p.symbol: stated[f"parameter {p.name}"] for p in scene.parameters}
    known = {sp.Symbol("t", real=True): second} | parameters
    known |= {c.symbol: stated[f"coordinate {c.name}"] for c in scene.coordinates}
    known |= {c.velocity: rate[c.name] for c in scene.coordinates}
    keys = {k.symbol: stated[f"key {k.name}"] for k in scene.keys} | parameters
    if scene.tree is None:
        yield from _mechanics(scene, rate, known)
        yield from _places(scene, stated, rate, keys)
    else:
        for what, formula, unit in fields_of(scene.tree):
            wanted = read_unit(unit)
            yield _Quantity(what=what, expression=formula, wanted=wanted, words="its field's unit", of=known)
    for name, rule in scene.contact_parameters.items():
        wanted, words = stated[f"parameter {name}"], f"the parameter {name}"
        yield _Quantity(what=f"contact parameter {name}", expression=rule, wanted=wanted, words=words, of=keys)
    for x in scene.contact.section.expressions:
        yield _Quantity(what=f"friction {str(x)[:40]}", expression=x, wanted=PURE, words="a pure number", of=known)
    yield from _defaults(scene, stated)
    if scene.outline is not None:
        points = [x for point in scene.outline.points for x in point]
        for expression in dict.fromkeys([*points, scene.outline.floor]):
            what, metre = f"outline {str(expression)[:40]}", read_unit("m")
            yield _Quantity(what=what, expression=expression, wanted=metre, words="a place in metres", of=known)


def _mechanics(scene: Scene, rate: Mapping[str, Unit], known: Mapping[sp.Symbol, Unit]) -> Iterator[_Quantity]:
    """Height, kinetic energy, forces and tangential displacements."""
    metre, joule = read_unit("m"), read_unit("J")
    contact = scene.contact
    length = _first_unit(contact.constraint, known, metre)
    energy = _energy(scene, rate, known, joule)
    yield _Quantity(what="height g", expression=contact.constraint, wanted=length, words="a length", of=known)
    for i, c in enumerate(scene.coordinates):
        for j, other in enumerate(scene.coordinates[: i + 1]):
            if scene.inertia[i, j] != 0:
                velocities = rate[c.name].times(rate[other.name])
                what = f"kinetic energy of {c.name}" if i == j else f"kinetic energy of {c.name} and {other.name}"
                wanted = energy.times(velocities, Fraction(-1))
                yield _Quantity(
                    what=what,
                    expression=scene.inertia[i, j],
                    wanted=wanted,
                    words="an energy over velocities",
                    of=known,
                )
        wanted = energy.times(known[c.symbol], Fraction(-1))
        words = f"the force of {c.name}, an energy over {c.unit},"
        yield _Quantity(what=f"force of {c.name}", expression=scene.force[i], wanted=wanted, words=words, of=known)
        for k in range(contact.tangents.cols):
            wanted = length.times(known[c.symbol], Fraction(-1))
            words = f"a length over {c.unit}"
            what = f"tangential displacement {k + 1} with {c.name}"
            yield _Quantity(what=what, expression=contact.tangents[i, k], wanted=wanted, words=words, of=known)


def _places(
    scene: Scene, stated: Mapping[str, Unit], rate: Mapping[str, Unit], keys: Mapping[sp.Symbol, Unit]
) -> Iterator[_Quantity]:
    """What the state keys are put into."""
    for name, rule in scene.placement.items():
        wanted, words = stated[f"coordinate {name}"], f"the coordinate {name}"
        yield _Quantity(what=f"placement of {name}", expression=rule, wanted=wanted, words=words, of=keys)
    for name, rule in scene.velocity.items():
        what, words = f"velocity of {name}", f"the velocity of {name}"
        yield _Quantity(what=what, expression=rule, wanted=rate[name], words=words, of=keys)


def _defaults(scene: Scene, stated: Mapping[str, Unit]) -> Iterator[_Quantity]:
    """Defaults that are formulas; a number is in the unit that stands beside it."""
    of = {p.symbol: stated[f"parameter {p.name}"] for p in scene.parameters}
    symbols = {p.name: p.symbol for p in scene.parameters}
    for p in scene.parameters:
        default = parse_expression(p.default, symbols, where=f"default of {p.name}")
        if default.free_symbols:
            wanted, words = stated[f"parameter {p.name}"], f"the parameter {p.name}"
            yield _Quantity(what=f"default of {p.name}", expression=default, wanted=wanted, words=words, of=of)
    of |= {k.symbol: stated[f"key {k.name}"] for k in scene.keys}
    symbols |= {k.name: k.symbol for k in scene.keys}
    for k in scene.keys:
        default = parse_expression(k.default or "0", symbols, where=f"default of {k.name}")
        if default.free_symbols:
            wanted, words = stated[f"key {k.name}"], f"the key {k.name}"
            yield _Quantity(what=f"default of {k.name}", expression=default, wanted=wanted, words=words, of=of)


def _first_unit(expression: sp.Expr, known: Mapping[sp.Symbol, Unit], wanted: Unit) -> Unit:
    """The wanted unit in the system that the scene is in: with the factor that the formula itself has."""
    try:
        found = unit_of(expression, known, lenient=False)
    except Disagreement:
        return wanted
    return Unit(wanted.powers, found.log_factor) if found.powers == wanted.powers and not found.free else wanted


def _energy(scene: Scene, rate: Mapping[str, Unit], known: Mapping[sp.Symbol, Unit], joule: Unit) -> Unit:
    """The unit of energy of the scene's system: that of its first kinetic energy."""
    name = scene.coordinates[0].name
    try:
        found = unit_of(scene.inertia[0, 0], known, lenient=False).times(rate[name]).times(rate[name])
    except Disagreement:
        return joule
    return Unit(joule.powers, found.log_factor) if found.powers == joule.powers and not found.free else joule
