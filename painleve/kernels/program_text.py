"""A program of elementary steps as straight-line text in floats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from painleve.exact.balls import ball
from painleve.exact.program import Program

__all__ = ["number_text", "program_lines"]

BITS = 320
_INFIX = {"add": "+", "mul": "*", "div": "/"}
_CALLS = {"min": "min", "max": "max", "abs": "abs"}


def program_lines(program: Program, inputs: Mapping[sp.Symbol, str], prefix: str) -> tuple[list[str], list[str]]:
    """(one line a step, the names of the outputs); numbers and inputs stand where they are used."""
    names: list[str] = []
    lines: list[str] = []
    for i, step in enumerate(program.steps):
        if step.operation == "input":
            names.append(inputs[step.value])
        elif step.operation == "number":
            names.append(number_text(step.value))
        else:
            lines.append(f"{prefix}{i} = {_text(step.operation, [names[j] for j in step.operands])}")
            names.append(f"{prefix}{i}")
    return lines, [names[i] for i in program.outputs]


def number_text(value: sp.Expr) -> str:
    """An exact number rounded once, as a literal that stands in any expression."""
    text = repr(float(ball(value, bits=BITS).mid()))
    return f"({text})" if text.startswith("-") else text


def _text(operation: str, operands: Sequence[str]) -> str:
    if operation in _INFIX:
        return f"{operands[0]}{_INFIX[operation]}{operands[1]}"
    if operation == "neg":
        return f"-{operands[0]}"
    if operation in ("cot", "sec", "csc"):
        inverse = {"cot": "tan", "sec": "cos", "csc": "sin"}[operation]
        return f"1.0/math.{inverse}({operands[0]})"
    if operation == "sign":
        return f"math.copysign(1.0, {operands[0]})"
    return f"{_CALLS.get(operation, f'math.{operation}')}({', '.join(operands)})"
