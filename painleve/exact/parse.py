"""Exact formulas from untrusted text: a whitelist walk of Python's syntax tree into sympy; no text is ever evaluated.

Text is cut into words first, and every number and name becomes a placeholder before Python's parser sees anything: its
grammar then has nothing to act on but operators and parentheses, and a symbol may be called `lambda`. Work is bounded
before it is done: every node carries a bound on the size of its numbers and powers, and every constant its enclosure
in ball arithmetic, so that sympy meets no power tower, no division by zero and no constant whose sign it must hunt.
"""

from __future__ import annotations

import ast
import itertools
import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from numbers import Integral
from types import MappingProxyType

import sympy
from flint import arb, ctx, fmpq

from painleve.errors import InputError, nearest
from painleve.exact.balls import ball

__all__ = ["exact_number", "parse_expression", "parse_number"]

MAX_LENGTH = 1000  # characters
MAX_NODES = 200  # numbers, names and operators
MAX_DEPTH = 40  # parentheses within parentheses
MAX_EXPONENT = 64  # of a power: numerator and denominator
MAX_DECIMAL_EXPONENT = 400
MAX_SIZE = 4096  # bits of the numbers, times the powers they are raised to
MAX_RADICAND_SIZE = 512  # sympy factors what stands under a root: 0.01 s here, a second at 4000 bits

# Below the 333 bits at which sympy gives up on finding a sign numerically and starts algebra without bounds.
_BITS = 256
_LARGEST = arb(2) ** MAX_SIZE

_WORD = re.compile(
    r"(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)|(?P<name>[^\W\d]\w*)|(?P<sign>\*\*|[-+*/(),])"
)


class _Refused(Exception):
    """Why a text is refused; the public functions add where it stood."""


@dataclass(frozen=True, slots=True)
class _Word:
    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class _Node:
    """A sub-expression, a bound on the size of its numbers and powers, and for a constant its enclosure."""

    expr: sympy.Expr
    size: int
    value: arb | None


@dataclass(frozen=True, slots=True)
class _Function:
    arity: int
    build: Callable[..., sympy.Expr]
    enclose: Callable[..., arb]


_FUNCTIONS: Mapping[str, _Function] = MappingProxyType(
    {
        "sin": _Function(1, sympy.sin, arb.sin),
        "cos": _Function(1, sympy.cos, arb.cos),
        "tan": _Function(1, sympy.tan, arb.tan),
        "cot": _Function(1, sympy.cot, arb.cot),
        "asin": _Function(1, sympy.asin, arb.asin),
        "acos": _Function(1, sympy.acos, arb.acos),
        "atan": _Function(1, sympy.atan, arb.atan),
        "atan2": _Function(2, sympy.atan2, arb.atan2),
        "sqrt": _Function(1, sympy.sqrt, arb.sqrt),
        "exp": _Function(1, sympy.exp, arb.exp),
        "log": _Function(1, sympy.log, arb.log),
        "abs": _Function(1, sympy.Abs, abs),
        "sinh": _Function(1, sympy.sinh, arb.sinh),
        "cosh": _Function(1, sympy.cosh, arb.cosh),
        "tanh": _Function(1, sympy.tanh, arb.tanh),
    }
)

_NO_SYMBOLS: Mapping[str, sympy.Expr] = MappingProxyType({})


def parse_expression(text: str, symbols: Mapping[str, sympy.Expr] = _NO_SYMBOLS, *, where: str) -> sympy.Expr:
    """Read a formula exactly: integers, decimals (0.1 is 1/10), + - * / **, parentheses, pi, `symbols` and functions.

    The functions are sin, cos, tan, cot, asin, acos, atan, atan2, sqrt, exp, log, abs, sinh, cosh and tanh. A declared
    symbol hides the constant of its name. Exponents are rational numbers. Raises InputError, with one line that begins
    with `where`, on anything else: other syntax, undeclared names, values that are not real and finite, too much work.
    """
    try:
        if not isinstance(text, str):
            raise _Refused(f"a formula is text, not {type(text).__name__}")
        words = _split(text)
        with ctx.workprec(_BITS):
            return _ExpressionReader(words, symbols).read(_tree(words))
    except _Refused as refused:
        raise InputError(f"{_one_line(where)}: {refused} (in {_shown(text)})") from None


def parse_number(text: str, *, where: str) -> sympy.Expr:
    """Read a real, finite, exact number such as `atan(2)`, `3 - sqrt(5)`, `4/3` or `0.1`; raises InputError."""
    return parse_expression(text, where=where)


def exact_number(value: object, *, where: str) -> sympy.Expr:
    """An exact number from text, an int, a Fraction, an exact sympy number, or a float.

    A float becomes the shortest decimal that Python prints for it: 0.1 is 1/10, not the nearby binary fraction. Raises
    InputError for NaN, infinities, truth values, symbols, sympy's own floats and everything else.
    """
    if isinstance(value, str):
        return parse_number(value, where=where)
    if isinstance(value, bool | sympy.logic.boolalg.BooleanAtom):
        raise InputError(f"{_one_line(where)}: a truth value is not a number (got {value})")
    if isinstance(value, Integral):
        return sympy.Integer(int(value))
    if isinstance(value, Fraction):
        return sympy.Rational(value.numerator, value.denominator)
    if isinstance(value, float):
        return _decimal_of_float(value, where)
    if isinstance(value, sympy.Expr):
        return _checked_sympy_number(value, where)
    raise InputError(f"{_one_line(where)}: expected a number or a formula, not {type(value).__name__}")


def _decimal_of_float(value: float, where: str) -> sympy.Expr:
    if not math.isfinite(value):
        raise InputError(f"{_one_line(where)}: {float(value)!r} is not a finite number")
    return sympy.Rational(float.__repr__(value))


def _checked_sympy_number(value: sympy.Expr, where: str) -> sympy.Expr:
    if value.free_symbols:
        names = ", ".join(sorted(str(symbol) for symbol in value.free_symbols))
        raise InputError(f"{_one_line(where)}: expected a number, but {_shown(str(value))} contains {names}")
    if value.has(sympy.Float):
        raise InputError(f"{_one_line(where)}: {_shown(str(value))} holds rounded numbers: give exact ones")
    try:
        known = ball(value, bits=_BITS).is_finite()
    except TypeError as reason:
        raise InputError(f"{_one_line(where)}: {_shown(str(value))} cannot be used: {_one_line(str(reason))}") from None
    if not known:
        raise InputError(f"{_one_line(where)}: {_shown(str(value))} is not known to be real and finite")
    return value


def _shown(text: object, limit: int = 60) -> str:
    """The text as Python would print it, on one line and short."""
    if not isinstance(text, str):
        return type(text).__name__
    shown = repr(text[: limit + 1])
    return shown if len(text) <= limit else f"{text[:limit]!r}..."


def _one_line(where: str) -> str:
    return where if where.isprintable() else repr(where)[1:-1]


def _split(text: str) -> list[_Word]:
    """The words of the text, within the limits of length, number and depth."""
    if len(text) > MAX_LENGTH:
        raise _Refused(f"the formula has {len(text)} characters, more than {MAX_LENGTH}")
    words: list[_Word] = []
    position = 0
    while position < len(text):
        if text[position] in " \t":
            position += 1
            continue
        match = _WORD.match(text, position)
        if match is None:
            raise _Refused(_about_character(text[position]))
        words.append(_Word(str(match.lastgroup), match.group()))
        position = match.end()
    _check_layout(words)
    return words


def _about_character(character: str) -> str:
    if character == "^":
        return "write ** for a power, not ^"
    if character == "°":
        return "angles are in radians: write 60*pi/180 for 60°"
    return f"the character {character!r} has no meaning in a formula"


def _check_layout(words: list[_Word]) -> None:
    if not words:
        raise _Refused("the formula is empty")
    if sum(word.text not in "()," for word in words) > MAX_NODES:
        raise _Refused(f"the formula has more than {MAX_NODES} numbers, names and operators")
    depth = 0
    for word in words:
        depth += (word.text == "(") - (word.text == ")")
        if depth > MAX_DEPTH:
            raise _Refused(f"the parentheses nest deeper than {MAX_DEPTH}")
    for left, right in itertools.pairwise(words):
        _check_neighbours(left, right)


def _check_neighbours(left: _Word, right: _Word) -> None:
    """Refuse `2 x`, `2(x)` and `(x)(y)`; `sin(x)` and `x(y)` are for the walk to tell apart."""
    ends = left.kind in ("number", "name") or left.text == ")"
    begins = right.kind in ("number", "name") or (right.text == "(" and left.kind != "name")
    if ends and begins:
        raise _Refused(f"an operator is missing between {_shown(left.text)} and {_shown(right.text)}")


def _tree(words: list[_Word]) -> ast.expr:
    """Python's syntax tree, with word number i, where it is a number or a name, as the name `_i`."""
    masked = (f"_{i}" if word.kind != "sign" else word.text for i, word in enumerate(words))
    try:
        return ast.parse(" ".join(masked), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise _Refused("this is not a complete formula: check its parentheses and operators") from None


class _ExpressionReader:
    """The walk from the syntax tree to sympy, over the words of one text and the declared symbols."""

    def __init__(self, words: list[_Word], symbols: Mapping[str, sympy.Expr]) -> None:
        self.words = words
        self.symbols = symbols

    def read(self, tree: ast.expr) -> sympy.Expr:
        return self._node(tree).expr

    def _node(self, node: ast.expr) -> _Node:
        match node:
            case ast.Name():
                word = self._word(node)
                return _number(word.text) if word.kind == "number" else self._name(word.text)
            case ast.UnaryOp(op=ast.USub()):
                operand = self._node(node.operand)
                return _checked(-operand.expr, operand.size, None if operand.value is None else -operand.value)
            case ast.UnaryOp(op=ast.UAdd()):
                return self._node(node.operand)
            case ast.BinOp() if type(node.op) in _OPERATORS:
                return _OPERATORS[type(node.op)](self._node(node.left), self._node(node.right))
            case ast.Call(func=ast.Name() as function):
                return self._call(self._word(function).text, node)
        raise _Refused("only numbers, names, + - * / **, parentheses and function calls are allowed")

    def _word(self, node: ast.Name) -> _Word:
        return self.words[int(node.id[1:])]

    def _name(self, name: str) -> _Node:
        if name in self.symbols:
            expr = self.symbols[name]
            return _Node(expr, 2, _enclosed(expr))
        if name == "pi":
            return _Node(sympy.pi, 2, arb.pi())
        if name in _FUNCTIONS:
            raise _Refused(f"{name} is a function: write {name}(...)")
        if name.lower() in ("nan", "inf", "infinity", "oo"):
            raise _Refused(f"{_shown(name)} is not a finite number")
        hint = nearest(name, self.symbols)
        raise _Refused(f"the name {_shown(name)} is not declared{hint}; {self._allowed()}")

    def _allowed(self) -> str:
        names = ", ".join(sorted({*self.symbols, "pi"}))
        return f"allowed are {names}, and the functions {', '.join(_FUNCTIONS)}"

    def _call(self, name: str, node: ast.Call) -> _Node:
        if name not in _FUNCTIONS:
            if name in self.symbols:
                raise _Refused(f"an operator is missing between {_shown(name)} and '('")
            raise _Refused(f"the function {_shown(name)} is not known; {self._allowed()}")
        function = _FUNCTIONS[name]
        if node.keywords or len(node.args) != function.arity:
            given = len(node.args) + len(node.keywords)
            raise _Refused(f"{name} takes {function.arity} argument{'s'[: function.arity - 1]}, not {given}")
        return _apply(name, [self._node(argument) for argument in node.args])


def _enclosed(expr: sympy.Expr) -> arb | None:
    return arb(fmpq(int(expr.p), int(expr.q))) if expr.is_Rational else None


def _number(text: str) -> _Node:
    """The exact rational number that a literal spells."""
    exponent = text.lower().partition("e")[2] or "0"
    if abs(int(exponent)) > MAX_DECIMAL_EXPONENT:
        raise _Refused(f"the number {_shown(text)} has an exponent beyond {MAX_DECIMAL_EXPONENT}")
    value = Fraction(text)
    size = value.numerator.bit_length() + value.denominator.bit_length()
    expr = sympy.Rational(value.numerator, value.denominator)
    return _checked(expr, size, _enclosed(expr))


def _checked(expr: sympy.Expr, size: int, value: arb | None) -> _Node:
    """The node, unless sympy or the balls say that it is not a real, finite number."""
    if expr.has(sympy.I, sympy.nan, sympy.oo, -sympy.oo, sympy.zoo):
        raise _Refused("the value is not real and finite")
    exact = _enclosed(expr)
    value = value if exact is None else exact
    if value is not None and not (value.is_finite() and value.abs_upper() < _LARGEST):
        raise _Refused("the value is not real and finite, or too large")
    return _Node(expr, size, value)


def _check_size(size: int) -> int:
    if size > MAX_SIZE:
        raise _Refused(f"the numbers or powers grow beyond {MAX_SIZE} bits")
    return size


def _check_told_from_zero(node: _Node) -> None:
    """Refuse a constant that is zero in disguise, or nearly zero, wherever sympy would have to find out its sign."""
    if node.value is not None and node.expr != 0 and node.value.contains(0):
        raise _Refused(f"{_shown(str(node.expr))} is zero, or too near zero to be told from it: simplify it")


def _both(left: _Node, right: _Node, enclose: Callable[[arb, arb], arb]) -> arb | None:
    return None if left.value is None or right.value is None else enclose(left.value, right.value)


def _add(left: _Node, right: _Node) -> _Node:
    size = _check_size(left.size + right.size)
    return _checked(left.expr + right.expr, size, _both(left, right, operator.add))


def _subtract(left: _Node, right: _Node) -> _Node:
    size = _check_size(left.size + right.size)
    return _checked(left.expr - right.expr, size, _both(left, right, operator.sub))


def _multiply(left: _Node, right: _Node) -> _Node:
    size = _check_size(left.size + right.size)
    _check_told_from_zero(left)
    _check_told_from_zero(right)
    return _checked(left.expr * right.expr, size, _both(left, right, operator.mul))


def _divide(left: _Node, right: _Node) -> _Node:
    size = _check_size(left.size + right.size)
    if right.expr == 0:
        raise _Refused("division by zero")
    _check_told_from_zero(left)
    _check_told_from_zero(right)
    return _checked(left.expr / right.expr, size, _both(left, right, operator.truediv))


def _power(base: _Node, exponent: _Node) -> _Node:
    power = exponent.expr
    if not power.is_Rational:
        raise _Refused("an exponent must be a rational number")
    if max(abs(power.p), power.q) > MAX_EXPONENT:
        raise _Refused(f"an exponent beyond {MAX_EXPONENT}, in its numerator or denominator")
    size = _check_size(base.size * max(abs(power.p), power.q))
    _check_base(base, power)
    value = None if base.value is None else _enclosed_power(base.value, power)
    return _checked(base.expr**power, size, value)


def _check_base(base: _Node, power: sympy.Rational) -> None:
    _check_told_from_zero(base)
    if base.expr == 0 and power < 0:
        raise _Refused("division by zero")
    if not power.is_Integer:
        if base.size > MAX_RADICAND_SIZE:
            raise _Refused(f"what stands under a root has more than {MAX_RADICAND_SIZE} bits")
        if base.value is not None and base.value < 0:
            raise _Refused(f"a root of the negative number {_shown(str(base.expr))} is not real")


def _enclosed_power(base: arb, power: sympy.Rational) -> arb:
    """The constant base is zero, or told from zero, and positive where the power is not whole."""
    root = base if power.is_Integer else base.root(int(power.q))
    whole = arb(1)
    for _ in range(abs(int(power.p))):
        whole *= root
    return 1 / whole if power < 0 else whole


_OPERATORS: Mapping[type[ast.operator], Callable[[_Node, _Node], _Node]] = MappingProxyType(
    {ast.Add: _add, ast.Sub: _subtract, ast.Mult: _multiply, ast.Div: _divide, ast.Pow: _power}
)


def _apply(name: str, arguments: list[_Node]) -> _Node:
    if name == "sqrt":
        return _power(arguments[0], _Node(sympy.Rational(1, 2), 3, None))
    function = _FUNCTIONS[name]
    for argument in arguments:
        _check_told_from_zero(argument)
    if name == "exp" and arguments[0].expr.has(sympy.log):
        raise _Refused("exp of a logarithm: write it as a power")  # sympy would raise to any power at once
    if name == "atan2" and all(argument.expr == 0 for argument in arguments):
        raise _Refused("atan2(0, 0) has no value")
    # sympy turns sin(atan(x)) and its like into roots of polynomials in x: two functions, numbers four times as long
    size = _check_size(sum(2 * argument.size + 4 for argument in arguments))
    values = [argument.value for argument in arguments if argument.value is not None]
    value = function.enclose(*values) if len(values) == function.arity else None
    if value is not None and not value.is_finite():
        shown = ", ".join(str(argument.expr) for argument in arguments)
        raise _Refused(f"{name} has no real and finite value at {_shown(shown)}")
    return _checked(function.build(*(argument.expr for argument in arguments)), size, value)
