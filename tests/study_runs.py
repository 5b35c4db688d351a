"""The studies as their tests see them: modules beside the package, run in their quick form."""

from __future__ import annotations

import importlib.util
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

STUDIES = Path(__file__).parents[1] / "studies"


@cache
def load_study(name: str) -> ModuleType:
    """The module studies/NAME.py."""
    spec = importlib.util.spec_from_file_location(f"study_{name}", STUDIES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # where the dataclasses of a study look up their names
    spec.loader.exec_module(module)
    return module
