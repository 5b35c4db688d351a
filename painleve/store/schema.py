"""What a dataset has to say of itself, whatever its kind: asked of what is written, and of every file that is read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from painleve.store.contents import MOST_ATTRIBUTES, MOST_TEXT, MOST_VARIABLES
from painleve.store.origin import PROVENANCE

__all__ = ["NOT_RUN", "check_schema", "flags", "labels_of"]

NOT_RUN = 0  # the code of a point that nobody computed, so that an outer merge can fill codes and keep them integers
MOST_WORDS = 1000  # characters of what figures may show


def flags(labels: Sequence[str]) -> dict[str, object]:
    """CF attributes of a code: 0 is `not_run`, the labels count from 1. Store such a variable as int8."""
    values = np.arange(len(labels) + 1, dtype=np.int8)
    return {"flag_values": values, "flag_meanings": " ".join(["not_run", *labels]), "units": "1"}


def labels_of(code: xr.DataArray) -> np.ndarray:
    """The meanings of a variable of codes, in its shape."""
    values = np.atleast_1d(code.attrs["flag_values"]).tolist()
    meanings = dict(zip(values, code.attrs["flag_meanings"].split(), strict=True))
    return np.vectorize(meanings.__getitem__, otypes=[object])(code.values)


def check_schema(dataset: xr.Dataset) -> None:
    """Raises ValueError, which names the variable and what it lacks, unless the dataset explains itself.

    Every variable holds numbers or text and needs `units` and a sentence `long_name`; an int8 variable is a code and
    needs `flag_values` and `flag_meanings` with `not_run`; the dataset needs a title, a kind and its provenance;
    attributes are text, numbers or arrays of numbers.
    """
    if len(dataset.variables) > MOST_VARIABLES:
        raise ValueError(f"the dataset has more than {MOST_VARIABLES} variables")
    for name, variable in dataset.variables.items():
        _check_variable(str(name), variable)
    for name in ("title", "kind", *PROVENANCE):
        value = dataset.attrs.get(name)
        if not (isinstance(value, str) and value):
            raise ValueError(f"the dataset lacks the attribute {name}, which has to be text")
    _check_attributes("the dataset", dataset.attrs)


def _check_variable(name: str, variable: xr.Variable) -> None:
    if not name.isidentifier():
        raise ValueError(f"variable {name!r}: its name is not an identifier")
    for attribute, meaning in (("units", "a unit (1 if it has none)"), ("long_name", "a sentence")):
        value = variable.attrs.get(attribute)
        if not (isinstance(value, str) and value):
            raise ValueError(f"variable {name} lacks {attribute}: {meaning}")
        if len(value) > MOST_WORDS:
            raise ValueError(f"variable {name}: its {attribute} has more than {MOST_WORDS} characters")
    if len(variable.attrs["long_name"].split()) < 3:
        raise ValueError(f"variable {name}: its long_name {variable.attrs['long_name']!r} is not a sentence")
    text = variable.dtype.kind == "O" and all(isinstance(value, str) for value in variable.values.flat)
    if not (text or variable.dtype.kind in "iufU"):
        raise ValueError(f"variable {name} holds neither numbers nor text")
    if variable.dtype == np.int8 or "flag_values" in variable.attrs:
        _check_code(name, variable)
    _check_attributes(f"variable {name}", variable.attrs)


def _check_code(name: str, variable: xr.Variable) -> None:
    values = np.atleast_1d(variable.attrs.get("flag_values", np.empty(0, np.int8)))
    meanings = str(variable.attrs.get("flag_meanings", "")).split()
    if len(values) != len(meanings) or dict(zip(values.tolist(), meanings, strict=True)).get(NOT_RUN) != "not_run":
        raise ValueError(f"code {name} needs flag_values and flag_meanings, with {NOT_RUN} for not_run")
    strange = set(np.unique(variable.values).tolist()) - set(values.tolist())
    if strange:
        raise ValueError(f"code {name} has values without a meaning: {sorted(strange)}")


def _check_attributes(where: str, attributes: Mapping[object, object]) -> None:
    if len(attributes) > MOST_ATTRIBUTES:
        raise ValueError(f"{where} has more than {MOST_ATTRIBUTES} attributes")
    for name, value in attributes.items():
        if isinstance(value, str):
            if len(value.encode()) > MOST_TEXT:
                raise ValueError(f"{where}: attribute {name} has more than {MOST_TEXT} bytes")
        elif np.asarray(value).dtype.kind not in "iuf":
            raise ValueError(f"{where}: attribute {name} is neither text nor numbers; keep it as JSON text")
