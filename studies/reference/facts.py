"""Published facts as data: read from a TOML file, and checked so that a fact that is half stated is refused."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TypeVar

import sympy as sp

from painleve.errors import InputError
from painleve.exact.parse import parse_expression, parse_number

__all__ = ["Basis", "Fact", "FactKind", "Source", "load_facts"]

DOI = re.compile(r"10\.\d{4,9}/\S+")
ARXIV = re.compile(r"\d{4}\.\d{4,5}")
DECIMAL = re.compile(r"-?\d+\.\d+")
WORDS = {str: "text", int: "a whole number", list: "a list", dict: "a table"}
E = TypeVar("E", bound=Enum)


class FactKind(Enum):
    """What a published value is, and so how a found one is compared with it."""

    EXACT = "exact"
    FORMULA = "formula"
    DECIMAL = "decimal"
    LABEL = "label"


class Basis(Enum):
    """Where a value was seen: in an abstract, in the source text of a test, or computed for this project."""

    ABSTRACT = "abstract"
    TEST = "test"
    RECOMPUTED = "recomputed"


@dataclass(frozen=True, kw_only=True)
class Source:
    """A publication, and how much of it could be read; what is not known of it is empty."""

    id: str
    authors: str
    year: int
    read: str
    title: str = ""
    where: str = ""
    doi: str = ""
    arxiv: str = ""

    @property
    def citation(self) -> str:
        """One line."""
        parts = [self.title, self.where, self.doi and f"doi {self.doi}", self.arxiv and f"arXiv {self.arxiv}"]
        return f"{self.authors} ({self.year}): " + "; ".join(part for part in parts if part)


@dataclass(frozen=True, kw_only=True)
class Fact:
    """A published statement and its value as printed; `says` is what the source says in other words."""

    id: str
    statement: str
    kind: FactKind
    value: str
    basis: Basis
    source: Source
    says: str
    symbols: tuple[str, ...] = ()

    @property
    def expression(self) -> sp.Expr:
        """The value as an exact expression in its symbols, which are positive. Raises InputError for a label."""
        where = f"fact {self.id}: value"
        if self.kind is FactKind.LABEL:
            raise InputError(f"{where}: {self.value!r} is a label and not a number")
        if self.kind is FactKind.FORMULA:
            names = {name: sp.Symbol(name, positive=True) for name in self.symbols}
            return parse_expression(self.value, names, where=where)
        return parse_number(self.value, where=where)

    @property
    def decimals(self) -> int:
        """Digits printed after the decimal point."""
        return len(self.value.partition(".")[2])


def load_facts(path: Path) -> tuple[Fact, ...]:
    """The facts of a file in their order. Raises InputError that names the file, the entry and the field at fault."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{path.name}: cannot be read ({str(error).splitlines()[0]})") from None
    _check_fields(path.name, table, {"source": dict, "fact": list}, {})
    sources = {name: _source(f"{path.name}, source {name}", name, entry) for name, entry in table["source"].items()}
    facts = [_fact(f"{path.name}, fact {i + 1}", entry, sources) for i, entry in enumerate(table["fact"])]
    names = [fact.id for fact in facts]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(f"{path.name}: {', '.join(twice)} is stated twice; every fact needs an id of its own")
    return tuple(facts)


def _source(where: str, name: str, entry: object) -> Source:
    optional = {"title": str, "where": str, "doi": str, "arxiv": str}
    fields = _check_fields(where, entry, {"authors": str, "year": int, "read": str}, optional)
    for key, pattern in (("doi", DOI), ("arxiv", ARXIV)):
        if key in fields and not pattern.fullmatch(str(fields[key])):
            raise InputError(f"{where}: {key} = {fields[key]!r} has not the form of one")
    return Source(id=name, **fields)  # type: ignore[arg-type]


def _fact(where: str, entry: object, sources: Mapping[str, Source]) -> Fact:
    needed = dict.fromkeys(("id", "statement", "kind", "value", "basis", "source", "says"), str)
    fields = _check_fields(where, entry, needed, {"symbols": list})
    if fields["source"] not in sources:
        raise InputError(f"{where}: no source {fields['source']!r}; declare it as [source.{fields['source']}]")
    symbols = fields.pop("symbols", [])
    if not all(isinstance(symbol, str) and symbol.isidentifier() for symbol in symbols):  # type: ignore[attr-defined]
        raise InputError(f"{where}: symbols must be a list of names")
    fact = Fact(
        **fields
        | {  # type: ignore[arg-type]
            "kind": _choice(where, "kind", fields["kind"], FactKind),
            "basis": _choice(where, "basis", fields["basis"], Basis),
            "source": sources[str(fields["source"])],
            "symbols": tuple(symbols),  # type: ignore[arg-type]
        }
    )
    _check_value(where, fact)
    return fact


def _check_value(where: str, fact: Fact) -> None:
    """The value can be read as its kind, and uses all symbols that it declares."""
    if bool(fact.symbols) != (fact.kind is FactKind.FORMULA):
        raise InputError(f"{where}: symbols go with a formula, and a formula needs them")
    if fact.kind is FactKind.DECIMAL and not DECIMAL.fullmatch(fact.value):
        raise InputError(f"{where}: value {fact.value!r} is not a decimal number such as 1.25")
    if fact.kind is not FactKind.LABEL:
        unused = set(fact.symbols) - {symbol.name for symbol in fact.expression.free_symbols}
        if unused:
            raise InputError(f"{where}: the value does not depend on {', '.join(sorted(unused))}")


def _choice(where: str, field: str, value: object, choices: type[E]) -> E:
    allowed = {choice.value: choice for choice in choices}
    if value not in allowed:
        raise InputError(f"{where}: {field} = {value!r}; choose one of {', '.join(allowed)}")
    return allowed[value]


def _check_fields(
    where: str, entry: object, needed: Mapping[str, type], optional: Mapping[str, type]
) -> dict[str, object]:
    if not isinstance(entry, dict):
        raise InputError(f"{where}: must be a table of fields")
    known = {**needed, **optional}
    for name, value in entry.items():
        if name not in known:
            raise InputError(f"{where}: no field {name!r}; it may have {', '.join(known)}")
        if type(value) is not known[name] or value in ("", [], {}):
            raise InputError(f"{where}: {name} must be {WORDS[known[name]]}, and not empty")
    missing = [name for name in needed if name not in entry]
    if missing:
        raise InputError(f"{where}: lacks {', '.join(missing)}")
    return dict(entry)
