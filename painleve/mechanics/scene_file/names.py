"""Which names, units and sentences a scene file may choose: they reach generated code, files, figures and terminals."""

from __future__ import annotations

import keyword
import re

from painleve.dataset_names import EXACT, IN_FRICTION_MAPS, IN_REGIMES, IN_SWEEPS, IN_TRAJECTORIES

__all__ = ["shown", "why_no_latex", "why_no_name", "why_no_sentence", "why_no_symbol"]

MAX_NAME = 32  # characters
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


# What formulas use already, and what they refuse by name.
IN_FORMULAS = _words("sin cos tan cot asin acos atan atan2 sqrt exp log abs sinh cosh tanh pi t nan inf infinity oo")
_LETTER = "|".join(
    _words(
        "alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi pi rho sigma tau"
        " upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega ell"
    )
)
_ATOM = rf"(?:[A-Za-z0-9]|\\(?:{_LETTER}))"
_LATEX = re.compile(rf"{_ATOM}'{{0,2}}(?:[_^](?:{_ATOM}|\{{[A-Za-z0-9 ,+-]{{1,16}}\}})){{0,2}}", re.ASCII)


def shown(text: str, limit: int = 40) -> str:
    """Somebody else's text for a message: quoted, short, and in ASCII, so that no letter passes for another."""
    return ascii(text[:limit]) + ("..." if len(text) > limit else "")


def why_no_name(name: str) -> str | None:
    """Why a name cannot be that of a scene, a state, a coordinate, a parameter or a key; None if it can."""
    if not _NAME.fullmatch(name) or len(name) > MAX_NAME:
        return f"{shown(name)} is not a name: a letter, then letters, digits and _ (ASCII), {MAX_NAME} at most"
    if keyword.iskeyword(name):
        return f"{name} is a word of Python's; choose another name, such as {name}_0"
    return None


def why_no_symbol(name: str, *, coordinate: bool) -> str | None:
    """Why a name cannot be that of a coordinate, or of a parameter or a key; None if it can."""
    if name in IN_FORMULAS:
        return f"{name} has a meaning in formulas already; choose another name"
    swept = name in IN_SWEEPS | IN_REGIMES | IN_FRICTION_MAPS or name.endswith(EXACT)
    if swept or (coordinate and name in IN_TRAJECTORIES):
        return f"{name} is what datasets call something else; choose another name, such as {name}_0"
    if name.startswith("u_"):
        return f"{name} would be a velocity, as every name that begins with u_; choose another name"
    return why_no_name(name)


def why_no_sentence(text: str, limit: int) -> str | None:
    """Why a text cannot be a sentence or a unit; None if it can."""
    if not text.strip():
        return "the text is empty"
    if len(text) > limit:
        return f"the text has {len(text)} characters, more than {limit}"
    if not text.isprintable():
        return "the text holds a line break or a control character"
    if set(text) & set("$\\"):
        return "the text holds $ or \\, which begin formulas in figures"
    return None


def why_no_latex(text: str) -> str | None:
    """Why a text cannot be a symbol in LaTeX; None if it can."""
    if _LATEX.fullmatch(text):
        return None
    return f"{shown(text)} is not a symbol such as x, m_1, 'theta' with a backslash before it, or l_{{max}}"
