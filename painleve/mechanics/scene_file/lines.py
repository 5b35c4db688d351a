"""On which line of a TOML text each field stands: the standard reader of TOML does not tell.

One pass cuts the text into words, with strings and comments whole; then keys, headers, arrays and inline tables are
followed. The nesting is bounded here too, before the recursive reader of TOML sees the text.
"""

from __future__ import annotations

import re
import tomllib
from contextlib import suppress
from dataclasses import dataclass

__all__ = ["Path", "Word", "field_lines", "too_nested", "words_of"]

Path = tuple[str | int, ...]  # names of tables and fields, and positions in arrays

MAX_DEPTH = 6  # brackets within brackets
MAX_PARTS = 8  # of a dotted key

_WORD = re.compile(
    r"""(?P<string>\"{3}(?:[^"\\]|\\.|"{1,2}(?!"))*+"{3,5} | '{3}(?:[^']|'{1,2}(?!'))*+'{3,5}
                 | "(?:[^"\\\n]|\\.)*+" | '[^'\n]*+')
      | (?P<comment>\#[^\n]*) | (?P<newline>\n) | (?P<sign>[][{}=,.])
      | (?P<bare>[^][{}=,.\s"'\#]+) | (?P<space>[ \t\r]+)
    """,
    re.VERBOSE | re.DOTALL,
)


@dataclass(frozen=True, slots=True)
class Word:
    """A piece of a TOML text and the line on which it begins."""

    kind: str
    text: str
    line: int


def words_of(text: str) -> list[Word]:
    """The words of the text, spaces and comments left out, up to the first thing that TOML does not know."""
    words, position, line = [], 0, 1
    while match := _WORD.match(text, position):
        kind, word = str(match.lastgroup), match.group()
        if word in ('""', "''") and text.startswith(word[0], match.end()):
            break  # a string of several lines that never ends
        if kind not in ("comment", "space"):
            words.append(Word(kind, word, line))
        line += word.count("\n")
        position = match.end()
    return words


def too_nested(words: list[Word]) -> tuple[int, str] | None:
    """The line, and what is too deep there; None for a text that is not nested beyond what a scene needs."""
    depth = parts = 0
    for word in words:
        depth += (word.text in ("[", "{")) - (word.text in ("]", "}"))
        if depth > MAX_DEPTH:
            return word.line, f"brackets nest deeper than {MAX_DEPTH}"
        parts = 0 if word.kind in ("sign", "newline") and word.text != "." else parts + (word.text == ".")
        if parts >= MAX_PARTS:
            return word.line, f"a key has more than {MAX_PARTS} parts"
    return None


def field_lines(words: list[Word]) -> dict[Path, int]:
    """The line of every field, table and element of an array, in a text that is sound TOML.

    In a text that is not, those before the place where it goes wrong.
    """
    scanner = _Scanner(words)
    with suppress(_Lost):
        scanner.document()
    return scanner.lines


class _Lost(Exception):
    """The words are not those of a TOML text."""


class _Scanner:
    """Follows the words and notes where each path begins; what it is called with is bounded by `too_nested`."""

    def __init__(self, words: list[Word]) -> None:
        self.words = words
        self.position = 0
        self.lines: dict[Path, int] = {}
        self.lengths: dict[Path, int] = {}  # of the arrays of tables

    def document(self) -> None:
        prefix: Path = ()
        while self.position < len(self.words):
            if self._skip("\n"):
                continue
            prefix = self._header() if self._text() == "[" else self._pair(prefix)

    def _text(self) -> str:
        """The next word; a string is never mistaken for a sign, for it keeps its quotes."""
        return self.words[self.position].text if self.position < len(self.words) else ""

    def _take(self) -> Word:
        self._line()
        self.position += 1
        return self.words[self.position - 1]

    def _line(self) -> int:
        """The line of the next word."""
        if self.position == len(self.words):
            raise _Lost
        return self.words[self.position].line

    def _skip(self, text: str) -> bool:
        found = self._text() == text
        self.position += found
        return found

    def _note(self, path: Path, line: int) -> None:
        for size in range(1, len(path) + 1):
            self.lines.setdefault(path[:size], line)

    def _header(self) -> Path:
        """`[a.b]`, or `[[a.b]]` for one more table of an array."""
        line = self._take().line
        repeated = self._skip("[")
        path: Path = ()
        for part in self._key():
            path = (*self._latest(path), part)
        self._note(path, line)
        if repeated:
            self.lengths[path] = self.lengths.get(path, 0) + 1
            path = self._latest(path)
            self._note(path, line)
        while self._skip("]"):
            pass
        return path

    def _latest(self, path: Path) -> Path:
        return (*path, self.lengths[path] - 1) if path in self.lengths else path

    def _pair(self, prefix: Path) -> Path:
        """`key = value`; returns the prefix, which stays what it was."""
        line = self._line()
        path = (*prefix, *self._key())
        self._note(path, line)
        if self._take().text != "=":
            raise _Lost
        self._value(path)
        return prefix

    def _key(self) -> list[str]:
        parts = [_plain(self._take())]
        while self._skip("."):
            parts.append(_plain(self._take()))
        return parts

    def _value(self, path: Path) -> None:
        if self._skip("["):
            self._elements(path)
        elif self._skip("{"):
            while not self._skip("}"):
                if self._text() in (",", "\n"):
                    self._take()
                else:
                    self._pair(path)
        else:
            while self._text() not in ("", ",", "]", "}", "\n"):
                self._take()

    def _elements(self, path: Path) -> None:
        index = 0
        while not self._skip("]"):
            if self._text() in (",", "\n"):
                index += self._take().text == ","
            else:
                self._note((*path, index), self._line())
                self._value((*path, index))


def _plain(word: Word) -> str:
    """A key without its quotes."""
    if word.kind == "bare":
        return word.text
    if word.kind != "string":
        raise _Lost
    try:
        return str(tomllib.loads(f"key = {word.text}")["key"])
    except tomllib.TOMLDecodeError:
        raise _Lost from None
