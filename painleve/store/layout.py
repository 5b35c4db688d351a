"""What a kind of dataset holds, as lines of text that say it once for people and for the check.

    number along across (state, eps, member)
    number? floor ()
    code limit_set (state, ...)
    text state (state)
    attribute scene

A line has a kind, the names that have it, and their dimensions; `?` marks what may be missing, `...` stands for
whatever dimensions are there.
"""

from __future__ import annotations

import re

import xarray as xr

from painleve.errors import InputError
from painleve.notes import one_line
from painleve.store.schema import MOST_WORDS

__all__ = ["hold_to_layout"]

_LINE = re.compile(r"(?P<kind>number|code|text|attribute)(?P<optional>\??) (?P<names>[\w ]+?)(?: \((?P<dims>[^)]*)\))?")


def hold_to_layout(dataset: xr.Dataset, layout: str) -> None:
    """Raises InputError, which names the first thing that is missing or not as the layout says."""
    for line in filter(None, layout.strip().splitlines()):
        found = _LINE.fullmatch(line.strip())
        assert found is not None, line
        dims = None if found["dims"] is None else found["dims"].replace(" ", "")
        for name in found["names"].split():
            if found["kind"] == "attribute":
                _hold_attribute(dataset, name)
            elif name in dataset.variables:
                _hold_variable(name, dataset[name].variable, found["kind"], dims or "")
            elif not found["optional"]:
                raise InputError(f"the dataset has no {name}, which a dataset of its kind has")


def _hold_attribute(dataset: xr.Dataset, name: str) -> None:
    value = dataset.attrs.get(name)
    if not isinstance(value, str) or len(value) > MOST_WORDS:
        raise InputError(f"the dataset has no attribute {name} that is a short text, as one of its kind has")


def _hold_variable(name: str, variable: xr.Variable, kind: str, dims: str) -> None:
    is_code = "flag_values" in variable.attrs
    fits = {"number": variable.dtype.kind in "iuf", "code": is_code, "text": variable.dtype.kind in "OU"}
    if not fits[kind]:
        raise InputError(f"{name} is not {'text' if kind == 'text' else f'a {kind}'}, as in a dataset of its kind")
    if kind == "text" and any(len(str(value)) > MOST_WORDS for value in variable.values.flat):
        raise InputError(f"{name} holds texts of more than {MOST_WORDS} characters, which no figure can show")
    expected = re.escape(dims).replace(re.escape(",..."), "(,.*)?").replace(re.escape("..."), ".*")
    if not re.fullmatch(expected, ",".join(map(str, variable.dims))):
        shown = ", ".join(map(str, variable.dims))
        raise InputError(f"{name} is over ({one_line(shown)}); in a dataset of its kind it is over ({dims})")
