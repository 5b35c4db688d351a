"""One value of a scene file with its place: what it may be, and errors that name file, line and field."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

import sympy as sp

from painleve.errors import InputError, nearest
from painleve.exact.parse import parse_expression
from painleve.mechanics.scene_file.document import Document, Number
from painleve.mechanics.scene_file.lines import Path
from painleve.mechanics.scene_file.names import shown, why_no_latex, why_no_sentence

__all__ = ["Field"]

MAX_BITS = 4096  # of a whole number
MAX_SENTENCE, MAX_UNIT = 200, 30  # characters
_BARE = re.compile(r"[A-Za-z0-9_-]{1,40}", re.ASCII)


@dataclass(frozen=True, kw_only=True, eq=False)
class Field:
    """A table, an array or a value; every method raises InputError unless it is what the method wants."""

    document: Document
    path: Path
    value: object

    @property
    def where(self) -> str:
        """`file, line 12, parameters.mu.default`; without a line where it is not known."""
        line = self.document.lines.get(self.path)
        parts = [self.document.name, *([f"line {line}"] if line else []), *([self.label] if self.path else [])]
        return ", ".join(parts)

    @property
    def label(self) -> str:
        label = ""
        for part in self.path:
            if isinstance(part, int):
                label += f"[{part}]"
            else:
                label += ("." if label else "") + (part if _BARE.fullmatch(part) else shown(part))
        return label

    def refuse(self, why: str) -> InputError:
        return InputError(f"{self.where}: {why}")

    def _inside(self, part: str | int, value: object) -> Field:
        return Field(document=self.document, path=(*self.path, part), value=value)

    def _mapping(self) -> Mapping[str, object]:
        if not isinstance(self.value, dict):
            raise self.refuse(f"this has to be a table, {_sort(self.value)} stands here")
        return self.value

    def table(self, required: Iterable[str] = (), optional: Iterable[str] = ()) -> dict[str, Field]:
        """The fields of a table, which has all the required ones and none but these."""
        required, given = tuple(required), self._mapping()
        allowed = (*required, *optional)
        for name in given:
            if name not in allowed:
                raise self._inside(name, None).refuse(
                    f"there is no such field{nearest(name, allowed)}; here are allowed: {', '.join(allowed) or 'none'}"
                )
        missing = [name for name in required if name not in given]
        if missing:
            raise self.refuse(f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing")
        return {name: self._inside(name, given[name]) for name in given}

    def some(self, names: Collection[str]) -> dict[str, Field]:
        """Those of the named fields that the table has, whatever else it has."""
        given = self._mapping()
        return {name: self._inside(name, given[name]) for name in names if name in given}

    def one_of(self, names: Collection[str], fields: Mapping[str, Field]) -> Field:
        """The only one of the named fields of this table."""
        given = [name for name in names if name in fields]
        if len(given) != 1:
            raise self.refuse(f"give either {' or '.join(names)}" + (", not both" if given else ""))
        return fields[given[0]]

    def named(self, most: int) -> dict[str, Field]:
        """The fields of a table whose names the file chooses."""
        given = self._mapping()
        if len(given) > most:
            raise self.refuse(f"there are {len(given)} of these, more than {most}")
        return {name: self._inside(name, value) for name, value in given.items()}

    def array(self, most: int, *, length: int | None = None, what: str = "values") -> list[Field]:
        """The elements of an array of at most `most`, or exactly `length`, values."""
        if not isinstance(self.value, list):
            raise self.refuse(f"this has to be an array, {_sort(self.value)} stands here")
        if length is not None and len(self.value) != length:
            raise self.refuse(f"the array has {len(self.value)} {what}; it needs {length}")
        if not 0 < len(self.value) <= most:
            raise self.refuse(f"the array has {len(self.value)} {what}; it may have 1 to {most}")
        return [self._inside(i, value) for i, value in enumerate(self.value)]

    def string(self) -> str:
        if not isinstance(self.value, str) or isinstance(self.value, Number):
            raise self.refuse(f"this has to be text in quotes, {_sort(self.value)} stands here")
        return self.value

    def sentence(self) -> str:
        return self._checked(why_no_sentence(self.string(), MAX_SENTENCE)).strip()

    def unit(self) -> str:
        return self._checked(why_no_sentence(self.string(), MAX_UNIT)).strip()

    def latex(self) -> str:
        return self._checked(why_no_latex(self.string()))

    def choice(self, allowed: Collection[str]) -> str:
        text = self.string()
        if text not in allowed:
            raise self.refuse(f"{shown(text)} is not one of {', '.join(allowed)}{nearest(text, allowed)}")
        return text

    def formula(self, symbols: Mapping[str, sp.Expr]) -> sp.Expr:
        """An exact formula in these symbols, from text or from a number."""
        return parse_expression(self.formula_text(), symbols, where=self.where)

    def formula_text(self) -> str:
        """The formula as text on one line; a number is one as it is written in the file."""
        value = self.value
        if isinstance(value, Number):
            return value.replace("_", "")
        if isinstance(value, str):
            return value.replace("\n", " ")
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.refuse(f"this has to be a formula in quotes or a number, {_sort(value)} stands here")
        if value.bit_length() > MAX_BITS:
            raise self.refuse(f"the number has more than {MAX_BITS} bits")
        return str(value)

    def _checked(self, why: str | None) -> str:
        if why is not None:
            raise self.refuse(why)
        return self.string()


def _sort(value: object) -> str:
    """What sort of TOML value this is."""
    if isinstance(value, bool):
        return "a truth value"
    if isinstance(value, int | Number):
        return "a number"
    sorts = {str: "text", dict: "a table", list: "an array"}
    return next((name for sort, name in sorts.items() if isinstance(value, sort)), "a date or a time")
