"""From a path to a TOML document, within limits and whatever the path leads to; nothing in it is trusted."""

from __future__ import annotations

import os
import re
import stat
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath

from painleve.errors import InputError
from painleve.mechanics.scene_file.lines import Path, field_lines, too_nested, words_of
from painleve.mechanics.scene_file.names import shown

__all__ = ["Document", "Number", "read_document", "shown_file", "text_of_file"]

MAX_BYTES = 32 * 1024  # the scenes of the library would take 3 KB
MAX_DIGITS = 1200  # of one number: as many as its formula may have bits to hold them


class Number(str):
    """A number of a TOML file as it is written there, so that 0.1 is one tenth."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Document:
    """A TOML file: `name` is what messages call it, `lines` says where each of its fields stands."""

    name: str
    text: str
    table: Mapping[str, object]
    lines: Mapping[Path, int]


def text_of_file(path: str | FilePath) -> str:
    """The text of a small UTF-8 file. Raises InputError for anything else: a folder, a device, a pipe, other bytes."""
    name = shown_file(path)
    try:
        content = _read(path, name)
    except InputError:
        raise
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) and error.strerror else "there is no such name"
        raise InputError(f"{name}: the scene file cannot be read: {why}") from None
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{name}, line {line}: the file is not UTF-8 text; save it in that encoding") from None


def _read(path: str | FilePath, name: str) -> bytes:
    if not stat.S_ISREG(os.stat(path).st_mode):
        raise InputError(f"{name}: not a file; give the path of a scene file that ends in .toml")
    # what the path leads to may change in between: a pipe would make an open() wait for ever
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as file:
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            raise InputError(f"{name}: not a file; give the path of a scene file that ends in .toml")
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise InputError(f"{name}: the file is larger than {MAX_BYTES} bytes, the most that a scene may take")
    return content


def shown_file(path: str | FilePath) -> str:
    """The path as messages print it: on one line, without control characters."""
    text = os.fspath(path)
    return text if text.isprintable() and len(text) <= 200 else shown(text, 200)


def read_document(name: str, text: str) -> Document:
    """The tables of a TOML text. Raises InputError that names the line where it is not TOML, or nested too deep."""
    words = words_of(text)
    nested = too_nested(words)
    if nested is not None:
        raise InputError(f"{name}, line {nested[0]}: {nested[1]}, more than a scene needs")
    for word in words:
        if word.kind == "bare" and len(word.text) > MAX_DIGITS:
            raise InputError(f"{name}, line {word.line}: a number or a name of more than {MAX_DIGITS} characters")
    try:
        table = tomllib.loads(text, parse_float=Number)
    except tomllib.TOMLDecodeError as error:
        raise InputError(_syntax(name, str(error))) from None
    except (ValueError, RecursionError):
        raise InputError(f"{name}: not a TOML file that can be read: a value in it is out of range") from None
    return Document(name=name, text=text, table=table, lines=field_lines(words))


def _syntax(name: str, message: str) -> str:
    """The standard reader's message with the place in front, and printable."""
    place = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)$", message)
    line = f", line {place[1]}, column {place[2]}" if place and place[1] else ""
    reason = message[: place.start()] if place else message
    end = "" if line else " at the end"
    return f"{name}{line}: not TOML{end}: {reason if reason.isprintable() else shown(reason, 200)}"
