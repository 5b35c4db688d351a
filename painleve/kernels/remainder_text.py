"""Text that forms differences from a base point without cancellation, for any number of coordinates.

Every step x of a program is x0 + L + r: its value at the base point, its exact gradient there times the offset, and a
remainder r that is formed without subtracting close numbers (docs/theory.md, section 8): r(x y) = x0 r_y + y0 r_x +
Dx Dy with D = L + r, and stable forms for quotients, roots and the elementary functions. Where value and gradient of a
result vanish at the base point, what is left is its remainder alone, with its relative accuracy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import sympy as sp

from painleve.exact.program import Program

__all__ = ["RemainderText"]


class RemainderText:
    """Lines for the remainders of a program's steps at the offsets d_0, ..., d_(s-1) of the varying inputs.

    Base values are read from `base[i]` and gradients from `slopes[i, j]`, for step i and varying input j: once, by the
    lines `hoisted`, which do not depend on the offsets. Raises TypeError for an operation without a stable form here.
    """

    def __init__(self, program: Program, variables: Sequence[sp.Symbol]) -> None:
        self.lines: list[str] = []
        self._hoisted: dict[str, str] = {}
        self._program = program
        self._depends = program.depends(variables)
        self._remainders: list[str] = []
        self._differences: dict[int, str] = {}
        for i in range(len(program.steps)):
            self._remainders.append(self._remainder(i))

    def remainder(self, step: int) -> str:
        """The name of a step's remainder, or "" where it is zero: of what is linear in the varying inputs."""
        return self._remainders[step]

    @property
    def hoisted(self) -> list[str]:
        return [f"{name} = {text}" for name, text in self._hoisted.items()]

    def hoist(self, name: str, text: str) -> str:
        self._hoisted[name] = text
        return name

    def varies(self, step: int) -> bool:
        return bool(self._depends[step])

    def value(self, step: int) -> str:
        return self.hoist(f"b_{step}", f"base[{step}]")

    def linear(self, step: int) -> str:
        """The gradient times the offset, "" where nothing varies."""
        slopes = {j: self.hoist(f"g_{step}_{j}", f"slopes[{step}, {j}]") for j in sorted(self._depends[step])}
        return " + ".join(f"{slope}*d_{j}" for j, slope in slopes.items())

    def difference(self, step: int) -> str:
        """The name of the step's difference from its base value, "" where it does not vary."""
        if not self.varies(step):
            return ""
        if step not in self._differences:
            parts = [p for p in (self.linear(step), self.remainder(step)) if p]
            self.lines.append(f"D_{step} = {' + '.join(parts)}")
            self._differences[step] = f"D_{step}"
        return self._differences[step]

    def _remainder(self, i: int) -> str:
        step = self._program.steps[i]
        if not self.varies(i) or step.operation == "input":
            return ""
        form = _FORMS.get(step.operation)
        if form is None:
            raise TypeError(f"no stable difference for {step.operation}")
        text = form(self, i, *step.operands)
        if not text:
            return ""
        self.lines.append(f"r_{i} = {text}")
        return f"r_{i}"


def _sum(parts: Sequence[str]) -> str:
    return " + ".join(part for part in parts if part)


def _times(factor: str, name: str) -> str:
    return f"{factor}*{name}" if name else ""


def _add(text: RemainderText, _: int, x: int, y: int) -> str:
    return _sum([text.remainder(x), text.remainder(y)])


def _neg(text: RemainderText, _: int, x: int) -> str:
    return f"-{text.remainder(x)}" if text.remainder(x) else ""


def _mul(text: RemainderText, _: int, x: int, y: int) -> str:
    parts = [_times(text.value(x), text.remainder(y)), _times(text.value(y), text.remainder(x))]
    if text.difference(x) and text.difference(y):
        parts.append(f"{text.difference(x)}*{text.difference(y)}")
    return _sum(parts)


def _div(text: RemainderText, i: int, x: int, y: int) -> str:
    """z y = x: r_z (y0 + Dy) = r_x - z0 r_y - L_z Dy."""
    if not text.difference(y):
        return f"{text.remainder(x)}/{text.value(y)}" if text.remainder(x) else ""
    above = [text.remainder(x), f"-({text.linear(i)})*{text.difference(y)}"]
    above.append(_times(f"-{text.value(i)}", text.remainder(y)))
    return f"({_sum(above)})/({text.value(y)} + {text.difference(y)})"


def _sqrt(text: RemainderText, i: int, x: int) -> str:
    """z^2 = x: 2 z0 r_z = r_x - Dz^2, Dz = Dx/(z0 + z)."""
    D, x0, z0 = text.difference(x), text.value(x), text.value(i)
    text.lines.append(f"s_{i} = {D}/({z0} + math.sqrt({x0} + {D}))")
    return f"({_sum([text.remainder(x), f'-s_{i}*s_{i}'])})/(2.0*{z0})"


def _circular(own: str, other: str) -> Callable[[RemainderText, int, int], str]:
    """f(x0 + D) - f(x0) - f'(x0) L for the sine and the cosine, whose values at the base stand in the tables."""

    def form(text: RemainderText, i: int, x: int) -> str:
        D = text.difference(x)
        slope = text.hoist(f"s_{i}", f"{other}({text.value(x)})")
        parts = [f"{text.value(i)}*cosine_remainder({D})", f"{slope}*sine_remainder({D})"]
        return _sum([*parts, _times(slope, text.remainder(x))])

    return form


def _exp(text: RemainderText, i: int, x: int) -> str:
    return f"{text.value(i)}*({_sum([f'exponential_remainder({text.difference(x)})', text.remainder(x)])})"


def _log(text: RemainderText, _: int, x: int) -> str:
    parts = [f"logarithm_remainder({text.difference(x)}/{text.value(x)})"]
    if text.remainder(x):
        parts.append(f"{text.remainder(x)}/{text.value(x)}")
    return _sum(parts)


def _atan(text: RemainderText, i: int, x: int) -> str:
    """atan(x0 + D) - atan(x0) = atan(w), w = D/(1 + x0 (x0 + D))."""
    D, x0 = text.difference(x), text.value(x)
    text.lines += [f"s_{i} = 1.0 + {x0}*{x0}", f"w_{i} = {D}/(s_{i} + {x0}*{D})"]
    parts = [f"arctangent_remainder(w_{i})", f"-{x0}*{D}*w_{i}/s_{i}"]
    if text.remainder(x):
        parts.append(f"{text.remainder(x)}/s_{i}")
    return _sum(parts)


_FORMS: dict[str, Callable[..., str]] = {
    "add": _add,
    "neg": _neg,
    "mul": _mul,
    "div": _div,
    "sqrt": _sqrt,
    "sin": _circular("math.sin", "math.cos"),
    "cos": _circular("math.cos", "-math.sin"),
    "exp": _exp,
    "log": _log,
    "atan": _atan,
}
