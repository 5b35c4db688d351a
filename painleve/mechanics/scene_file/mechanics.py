"""The mechanical part of a scene file: inertia and force, the contact, and its friction."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import sympy as sp

from painleve.mechanics.friction import SECTIONS, NoFriction, Section
from painleve.mechanics.scene_file.fields import Field
from painleve.mechanics.scene_file.work import terms_of

__all__ = ["read_contact", "read_motion", "read_section"]

MOST_TERMS = 2000  # of an expanded formula
MOST_DIRECTIONS = max(section.dimension for section in SECTIONS)  # of friction

Symbols = Mapping[str, sp.Expr]


def read_motion(field: Field, q: Symbols, u: Symbols, p: Symbols) -> dict[str, sp.MatrixBase | sp.Expr]:
    """`inertia`, and `potential` or `force` where there is one, for make_scene."""
    fields = field.table((), ("kinetic_energy", "M", "potential", "force"))
    inertia = field.one_of(("kinetic_energy", "M"), fields)
    found: dict[str, sp.MatrixBase | sp.Expr] = {
        "inertia": _matrix(inertia, q, p) if "M" in fields else _hessian(inertia, q, u, p)
    }
    if "potential" in fields or "force" in fields:
        applied = field.one_of(("potential", "force"), fields)
        if "potential" in fields:
            found["potential"] = smooth(applied, {**q, **p})
        else:
            known = {**q, **u, **p, "t": sp.Symbol("t", real=True)}
            found["force"] = sp.Matrix([part.formula(known) for part in _by_coordinate(applied, q)])
    return found


def smooth(field: Field, known: Symbols) -> sp.Expr:
    """A formula that is differentiated later: |.| of something that may change its sign has no derivative there."""
    formula = field.formula(known)
    if formula.has(sp.Abs, sp.sign):
        raise field.refuse(
            "this formula is differentiated, and abs (or the root of a square) has no derivative at 0; "
            'write it without, or give the range "positive" to what is inside'
        )
    return formula


def _by_coordinate(field: Field, q: Symbols) -> list[Field]:
    return field.array(len(q), length=len(q), what="components")


def _expanded(field: Field, formula: sp.Expr) -> sp.Expr:
    terms = terms_of(formula)
    if terms > MOST_TERMS:
        raise field.refuse(f"multiplied out, the formula may have more than {MOST_TERMS} terms; write it simpler")
    return sp.expand(formula)


def _hessian(field: Field, q: Symbols, u: Symbols, p: Symbols) -> sp.MatrixBase:
    """M of a kinetic energy, from the terms of the energy multiplied out: each holds exactly two velocities."""
    energy = _expanded(field, smooth(field, {**q, **u, **p}))
    velocities = list(u.values())
    M = sp.zeros(len(velocities), len(velocities))
    for term in sp.Add.make_args(energy):
        powers = term.as_powers_dict()
        held = [i for i, v in enumerate(velocities) for _ in range(_power(powers.get(v, 0)))]
        rest = term / sp.prod(velocities[i] for i in held)
        if len(held) != 2 or rest.free_symbols & set(velocities):
            raise field.refuse(
                "the kinetic energy is not a quadratic form in the velocities "
                f"{', '.join(u)}: it has the term {str(term)[:80]}"
            )
        i, j = held
        M[i, j] += rest
        M[j, i] += rest
    return M


def _power(exponent: Any) -> int:
    return int(exponent) if exponent in (1, 2) else 0


def _matrix(field: Field, q: Symbols, p: Symbols) -> sp.MatrixBase:
    """M, row by row; its two halves have to agree once they are multiplied out."""
    rows = [row.array(len(q), length=len(q), what="entries") for row in field.array(len(q), length=len(q), what="rows")]
    M = sp.Matrix([[smooth(entry, {**q, **p}) for entry in row] for row in rows])
    for i in range(len(q)):
        for j in range(i):
            if _expanded(rows[i][j], M[i, j]) != _expanded(rows[j][i], M[j, i]):
                raise rows[i][j].refuse(
                    f"M is not symmetric: {str(M[i, j])[:60]} here, but {str(M[j, i])[:60]} in "
                    f"{rows[j][i].label}; write both alike"
                )
            M[i, j] = M[j, i]
    return M


def read_contact(field: Field, friction: Field | None, q: Symbols, p: Symbols) -> dict[str, object]:
    """`constraint`, `tangential_displacements` and `friction` for make_scene."""
    fields = field.table((), ("height", "g", "tangential_displacements"))
    given = field.one_of(("height", "g"), fields)
    constraint = smooth(given, {**q, **p})
    if not constraint.free_symbols & set(q.values()):
        raise given.refuse("this does not depend on any coordinate")
    displacements = fields.get("tangential_displacements")
    formulas = [smooth(part, {**q, **p}) for part in _one_or_more(displacements)] if displacements is not None else []
    section = read_section(friction, {**q, **p}) if friction is not None else NoFriction()
    directions = section.dimension
    if len(formulas) != directions:
        kind = f"where friction is a {section.kind}" if directions else "without friction"
        raise (displacements or field).refuse(
            f"there {'is' if len(formulas) == 1 else 'are'} {len(formulas) or 'no'} tangential displacement"
            f"{'s' * (len(formulas) != 1)}; {kind} the contact needs {directions or 'none'}"
        )
    return {
        "constraint": -constraint if "height" in fields else constraint,
        "tangential_displacements": formulas,
        "friction": section,
    }


def _one_or_more(field: Field) -> list[Field]:
    return field.array(MOST_DIRECTIONS, what="displacements") if isinstance(field.value, list) else [field]


def read_section(field: Field, known: Symbols) -> Section:
    """The friction section; its coefficients may depend on q."""
    kinds = {section.kind: section for section in SECTIONS}
    given = field.table(("kind",), dict.fromkeys(name for section in SECTIONS for name in section.fields))
    return kinds[given["kind"].choice(tuple(kinds))].read(field, given, partial(smooth, known=known))
