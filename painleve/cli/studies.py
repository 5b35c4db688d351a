"""Where the studies are: packages beside this one in a checkout of the sources, and nowhere else."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from painleve.errors import InputError

__all__ = ["CHECKOUT", "claim_of", "drawings_of", "study_names", "title_of"]

CHECKOUT = Path(__file__).parents[2]
PACKAGE = "studies"


def study_names() -> list[str]:
    """The names of all studies. Raises InputError where this package is not in a checkout of the sources."""
    names = sorted(path.parent.name for path in (CHECKOUT / PACKAGE).glob("*/claim.py"))
    if not names:
        raise InputError("study: the studies come with the source tree, not with the installed package; run a checkout")
    return names


def title_of(name: str) -> str:
    """The first line of what a study claims, read and not imported: a list needs none of what the studies need."""
    text = (CHECKOUT / PACKAGE / name / "claim.py").read_text(encoding="utf-8")
    return (ast.get_docstring(ast.parse(text)) or "").splitlines()[0]


def claim_of(name: str) -> Any:
    """The module that says what a study claims, and runs it."""
    return _import(f"{name}.claim")


def drawings_of(kind: str) -> Mapping[str, Callable[[Any], Any]]:
    """The drawings of the study that draws datasets of this kind; none where no study does, or there are none."""
    for path in sorted((CHECKOUT / PACKAGE).glob("*/claim.py")):
        drawings: Mapping[str, Callable[[Any], Any]] = _import(f"{path.parent.name}.figures").DRAWINGS
        if kind in drawings:
            return drawings
    return {}


def _import(name: str) -> ModuleType:
    """A module of the studies beside this package: another package of that name on the path is not looked at."""
    if PACKAGE not in sys.modules:
        init = CHECKOUT / PACKAGE / "__init__.py"
        spec = importlib.util.spec_from_file_location(PACKAGE, init, submodule_search_locations=[str(init.parent)])
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[PACKAGE] = module
        spec.loader.exec_module(module)
    return importlib.import_module(f"{PACKAGE}.{name}")
