"""Templates: modules of real Python that are written out again for a scene.

A compiled function that is passed as an argument is compiled anew in every process, and numba's disk cache wants a
file. So what is the same for every scene is compiled with it: the statements of the templates go into the scene's file,
and the names that they import from one another are defined there. A template is also a module like any other; where
nothing is compiled (NUMBA_DISABLE_JIT=1) it runs as it stands, on the sample that it imports.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import ModuleType

__all__ = ["write_out"]


def write_out(package: str, templates: Iterable[ModuleType], constants: Mapping[str, int], given: Iterable[str]) -> str:
    """The text of one module: imports, the constants, the `given` definitions, and the statements of the templates.

    The constants stand for those of the same name in a template, and what a template imports from `package` is expected
    among the definitions. `tuple(... for j in range(D))` becomes the tuple of its terms, D one of the constants:
    compiled code cannot build a tuple in a loop. Raises ValueError where two templates define a name differently.
    """
    imports: dict[str, None] = {}
    statements: dict[str, None] = {}
    meanings: dict[str, object] = {}
    for template in templates:
        for statement in ast.parse(Path(str(template.__file__)).read_text(encoding="utf-8")).body:
            names = set(_bound(statement))
            if not names or names <= constants.keys() or _is_from(package, statement):
                continue
            for name in names:
                meaning = getattr(template, name)
                if meanings.setdefault(name, meaning) != meaning:
                    raise ValueError(f"{template.__name__}: another template defines {name} differently")
            kept = imports if isinstance(statement, ast.Import | ast.ImportFrom) else statements
            kept[ast.unparse(_WrittenOut(constants).visit(statement))] = None
    numbers = (f"{name} = {value}" for name, value in constants.items())
    return "\n".join([*sorted(imports), "", *numbers]) + "\n\n\n" + "\n\n\n".join([*given, *statements]) + "\n"


def _bound(statement: ast.stmt) -> Iterator[str]:
    """The names that a statement of a module binds; none for a docstring."""
    if isinstance(statement, ast.FunctionDef):
        yield statement.name
    elif isinstance(statement, ast.Import | ast.ImportFrom):
        yield from (alias.asname or alias.name for alias in statement.names)
    elif isinstance(statement, ast.Assign):
        yield from (node.id for target in statement.targets for node in ast.walk(target) if isinstance(node, ast.Name))


def _is_from(package: str, statement: ast.stmt) -> bool:
    return isinstance(statement, ast.ImportFrom) and f"{statement.module}.".startswith(f"{package}.")


class _WrittenOut(ast.NodeTransformer):
    """tuple(... for j in range(D)) as the tuple of its terms."""

    def __init__(self, constants: Mapping[str, int]) -> None:
        self.constants = constants

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        match node:
            case ast.Call(ast.Name("tuple"), [ast.GeneratorExp(term, [ast.comprehension(ast.Name(j), indices)])]):
                count = self.constants[ast.unparse(indices).removeprefix("range(").removesuffix(")")]
                terms = [_Numbered(j, k).visit(copy.deepcopy(term)) for k in range(count)]
                return ast.Tuple(terms, ast.Load())
        return node


class _Numbered(ast.NodeTransformer):
    """A name as a number."""

    def __init__(self, name: str, number: int) -> None:
        self.name, self.number = name, number

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return ast.Constant(self.number) if node.id == self.name else node
