"""The digest that stands after a file's HDF5: what was damaged is known before any library reads it.

HDF5 ignores what follows its end, and drops it when a file is changed in place; a dataset that is written anew by
xarray alone has none. So a digest that is there and does not fit means damage, and one that is missing means nothing.
"""

from __future__ import annotations

import hashlib
import re
from typing import BinaryIO

__all__ = ["Damaged", "content_digest", "seal"]

_SEAL = re.compile(rb"\npainleve sha256 ([0-9a-f]{64})\n")
_SEAL_BYTES = 82
_BLOCK = 1 << 20


class Damaged(ValueError):
    """A file whose content is not what was written."""


def seal(digest: str) -> bytes:
    """What follows the content that has this digest."""
    return f"\npainleve sha256 {digest}\n".encode()


def content_digest(file: BinaryIO) -> str:
    """SHA-256 of a file without its seal. Raises Damaged where the seal says something else."""
    size = file.seek(0, 2)
    file.seek(max(0, size - _SEAL_BYTES))
    found = _SEAL.fullmatch(file.read())
    left = size - _SEAL_BYTES if found else size
    file.seek(0)
    digest = hashlib.sha256()
    while left > 0 and (block := file.read(min(left, _BLOCK))):
        digest.update(block)
        left -= len(block)
    if found and found[1].decode() != digest.hexdigest():
        raise Damaged("the content does not have the digest that follows it")
    return digest.hexdigest()
