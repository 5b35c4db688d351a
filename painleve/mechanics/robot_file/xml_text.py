"""What is looked at in a stranger's XML before anything else reads it: size, depth, and no entities."""

from __future__ import annotations

from pathlib import Path
from xml.parsers import expat

from painleve.errors import InputError

__all__ = ["root_of_file"]

MOST_BYTES = 10_000_000
MOST_DEPTH = 200
MOST_ELEMENTS = 100_000


def root_of_file(path: Path) -> str:
    """The name of the root element of an XML file.

    Raises InputError for a file that is missing, too large, no XML, too deep, or that declares a document type:
    entities of its own can make a short file expand without end, and no robot needs them.
    """
    if not path.is_file():
        raise InputError(f"{path}: there is no such file; give a robot's file, MJCF (.xml) or URDF (.urdf)")
    if path.stat().st_size > MOST_BYTES:
        raise InputError(f"{path}: the file has more than {MOST_BYTES // 1_000_000} MB; no robot's file is that large")
    reader = _Reader(path.name)
    parser = expat.ParserCreate()
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.StartDoctypeDeclHandler = reader.doctype
    try:
        parser.Parse(path.read_bytes(), True)
    except expat.ExpatError as error:
        reason = expat.errors.messages.get(error.code, "it cannot be read")
        raise InputError(f"{path}, line {error.lineno}: this is no XML: {reason}") from None
    return reader.root


class _Reader:
    def __init__(self, name: str) -> None:
        self.name, self.root, self.depth, self.elements = name, "", 0, 0

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.root = self.root or tag
        self.depth += 1
        self.elements += 1
        if self.depth > MOST_DEPTH:
            raise InputError(f"{self.name}: elements stand in each other more than {MOST_DEPTH} deep")
        if self.elements > MOST_ELEMENTS:
            raise InputError(f"{self.name}: there are more than {MOST_ELEMENTS} elements")

    def end(self, tag: str) -> None:
        self.depth -= 1

    def doctype(self, *_: object) -> None:
        raise InputError(
            f"{self.name}: the file declares a document type, which a robot's file has no need of; remove it"
        )
