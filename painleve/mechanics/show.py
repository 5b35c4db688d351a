"""A scene's derivation as a person would write it: simplified, in order, every symbol with its sentence and unit."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import sympy as sp

from painleve.errors import InputError
from painleve.exact.parse import parse_expression
from painleve.mechanics.derive import Derivation, derive
from painleve.mechanics.formula import Formula
from painleve.mechanics.scene import Coordinate, Parameter, Scene
from painleve.mechanics.scene_file.work import TooMuchWork, limited_calls
from painleve.mechanics.sections.section import norm
from painleve.progress import told

__all__ = ["as_dict", "as_latex", "as_text", "derivation_lines"]

MOST_CALLS = 15_000_000  # of Python functions, for a stranger's formulas

SHORT = 12  # operations of a formula that is left as it is
LONG = 380  # and of one that is only factored: trigonometric identities would take seconds


@told(lambda scene: f"simplifying the formulas of {scene.name}")
def derivation_lines(scene: Scene) -> list[Formula]:
    """The formulas from M to the critical friction; simplifying takes up to some seconds.

    Raises InputError for a scene from a file whose formulas take too much work to simplify.
    """
    if not scene.text:
        return [*_mechanics(scene), *_contact(scene)]
    try:
        with limited_calls(MOST_CALLS):
            return [*_mechanics(scene), *_contact(scene)]
    except TooMuchWork:
        raise InputError(
            f"{scene.file}: the formulas of this scene take too much work to simplify for printing; "
            "shorten them (no other command needs this)"
        ) from None


def _mechanics(scene: Scene) -> Iterator[Formula]:
    d = derive(scene)
    size = sp.sqrt(_short(d.gradient_squared))
    yield Formula(name="M", plain="M(q)", latex="M(q)", sentence="inertia", expression=scene.inertia.applyfunc(_short))
    yield Formula(
        name="f",
        plain="f(t, q, u)",
        latex="f(t, q, u)",
        expression=scene.force.applyfunc(_short),
        sentence="force, gyroscopic terms included",
    )
    yield Formula(
        name="g",
        plain="g(q)",
        latex="g(q)",
        expression=_short(scene.contact.constraint),
        sentence="constraint: admissible where g <= 0, so the gap is -g",
    )
    yield Formula(
        name="grad_g",
        plain="∇g(q)",
        latex=r"\nabla g(q)",
        sentence="gradient of the constraint",
        expression=(-d.normal).applyfunc(_short),
    )
    yield Formula(
        name="n",
        plain="n(q)",
        latex="n(q)",
        sentence="inward unit normal, -∇g/|∇g|",
        expression=d.normal.applyfunc(_short) / size,
    )


def _contact(scene: Scene) -> Iterator[Formula]:
    d, section = derive(scene), scene.contact.section
    if section.dimension:
        H = scene.contact.tangents.applyfunc(_short)
        yield Formula(
            name="H",
            plain="H(q)",
            latex="H(q)",
            expression=H,
            sentence="gradients of the contact point's tangential displacements, column by column",
        )
        yield from section.formulas(H, sp.sqrt(_short(d.gradient_squared)))
    yield Formula(name="a", plain="a(q)", latex="a(q)", expression=_short(d.a), sentence="normal compliance, ∇g·M⁻¹∇g")
    if section.dimension:
        yield Formula(
            name="b",
            plain="b(q)",
            latex="b(q)",
            expression=_scalar(d.couplings.applyfunc(_short)),
            sentence="coupling of normal and tangent, -∇g·M⁻¹H",
        )
        yield Formula(
            name="C",
            plain="C(q)",
            latex="C(q)",
            expression=_scalar(d.compliance.applyfunc(_short)),
            sentence="tangential compliance, H·M⁻¹H",
        )
    yield from _indicator(d)


def _scalar(matrix: sp.MatrixBase) -> sp.Expr | sp.MatrixBase:
    """A 1 x 1 matrix as its entry."""
    return matrix[0] if matrix.shape == (1, 1) else matrix


def _indicator(d: Derivation) -> Iterator[Formula]:
    yield Formula(
        name="gamma",
        plain="γ(q)",
        latex=r"\gamma(q)",
        expression=_gamma(d, {}),
        sentence="least of <n, M⁻¹(n + w)> over D₁: negative in the paradox",
    )
    if d.critical_friction is not None:
        yield Formula(
            name="critical_friction",
            plain="μ_c(q)",
            latex=r"\mu_c(q)",
            expression=_critical(d, {}),
            sentence="critical friction: γ < 0 where μ > μ_c",
        )
    defaults = dependent_defaults(d.scene)
    if defaults:
        given = ", ".join(f"{name} = {value}" for name, value in defaults.items())
        yield Formula(
            name="gamma_default",
            plain="γ(q)",
            latex=r"\gamma(q)",
            sentence=f"γ with {given}",
            expression=_gamma(d, defaults),
        )
        if d.critical_friction is not None:
            yield Formula(
                name="critical_friction_default",
                plain="μ_c(q)",
                latex=r"\mu_c(q)",
                sentence=f"critical friction with {given}",
                expression=_critical(d, defaults),
            )


def dependent_defaults(scene: Scene) -> dict[sp.Symbol, sp.Expr]:
    """Parameters whose default is a formula in others, such as I = m l^2/3."""
    known = {p.name: p.symbol for p in scene.parameters}
    formulas = {p.symbol: parse_expression(p.default, known, where=f"default of {p.name}") for p in scene.parameters}
    return {symbol: formula for symbol, formula in formulas.items() if formula.free_symbols}


def _gamma(d: Derivation, values: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    def short(expression: sp.Expr) -> sp.Expr:
        return _short(expression.xreplace(values))

    section = d.scene.contact.section
    return section.shown_compliance(d.a, d.couplings, short) / short(d.gradient_squared)


def _critical(d: Derivation, values: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    size = norm(d.couplings.xreplace(values).applyfunc(_short))
    if size == 0:
        return sp.oo
    ratio = d.a.xreplace(values) / size.replace(sp.Abs, lambda x: x)
    forms = [sp.fraction(sp.factor(sp.together(form))) for form in (ratio, _short(ratio))]
    return min((_absolute(n) / _absolute(m) for n, m in forms), key=_length)


def _length(expression: sp.Expr) -> int:
    return len(str(expression))


def _absolute(expression: sp.Expr) -> sp.Expr:
    """|.| with what is known to be positive taken out."""
    return sp.Abs(sp.factor_terms(expression))


@lru_cache(maxsize=1024)
def _short(expression: sp.Expr) -> sp.Expr:
    """The shortest of the forms that simplification offers; the given one where it is as short."""
    expression = sp.sympify(expression)
    operations = expression.count_ops()
    if operations < SHORT:
        return expression
    together = sp.factor(sp.together(expression))
    forms = [expression, together]
    if operations < LONG:
        forms.append(sp.trigsimp(sp.simplify(together)))
    return min(forms, key=_length)


def as_text(scene: Scene) -> str:
    """The derivation in plain text: symbols with units, then the formulas."""
    parts = [f"{scene.name}: {scene.sentence}", f"source: {scene.source}", "", "Coordinates"]
    parts += [f"  {c.name:10} [{c.unit}]  {c.sentence}" for c in scene.coordinates]
    parts += ["", "Parameters"]
    parts += [f"  {p.name:10} [{p.unit}]  {p.sentence}; default {p.default}" for p in scene.parameters]
    for line in derivation_lines(scene):
        formula = sp.pretty(sp.Eq(sp.Symbol(line.plain), line.expression, evaluate=False), wrap_line=False)
        parts += ["", f"{line.sentence}:", *(f"    {row}" for row in formula.splitlines())]
    return "\n".join(parts)


def as_latex(scene: Scene) -> str:
    """The derivation as LaTeX: one displayed formula a line, with its sentence as a comment above."""
    declared: list[Coordinate | Parameter] = [*scene.coordinates, *scene.parameters]
    names = {s.symbol: s.latex for s in declared if s.latex}
    names |= {c.velocity: rf"\dot{{{c.latex or c.name}}}" for c in scene.coordinates}
    rows = []
    for line in derivation_lines(scene):
        rows.append(f"% {line.sentence}")
        rows.append(rf"\[ {line.latex} = {sp.latex(line.expression, symbol_names=names)} \]")
    return "\n".join(rows)


def as_dict(scene: Scene) -> dict[str, object]:
    """The derivation for machines; formulas as text that Python reads."""
    lines = {
        line.name: {"sentence": line.sentence, "formula": _plain(line.expression)} for line in derivation_lines(scene)
    }
    declared: list[Coordinate | Parameter] = [*scene.coordinates, *scene.parameters]
    symbols = [{"name": s.name, "unit": s.unit, "sentence": s.sentence} for s in declared]
    roles = derive(scene)
    return {
        "scene": scene.name,
        "sentence": scene.sentence,
        "source": scene.source,
        "symbols": symbols,
        "formulas": lines,
        "coordinates_of_the_law": [scene.coordinates[i].name for i in roles.shape],
    }


def _plain(expression: sp.Expr | sp.MatrixBase) -> object:
    if isinstance(expression, sp.MatrixBase):
        return [[str(x) for x in row] for row in expression.tolist()]
    return str(expression)
