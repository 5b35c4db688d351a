"""Formulas from text: read exactly, refused in one line, never executed, never a long computation."""

from __future__ import annotations

import math
import time
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import mpmath
import pytest
import sympy
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from painleve.errors import InputError
from painleve.exact.parse import exact_number, parse_expression, parse_number

X, MU = sympy.symbols("x mu", real=True)
SYMBOLS = {"x": X, "mu": MU}
SECONDS = 30.0  # of the processor: what is unbounded takes hours, what is bounded far less on any machine

HOSTILE = [
    "__import__('os').system('touch pwned')",
    "__import__(chr(111)+chr(115)).system(chr(116))",
    'eval("1")',
    "open('pwned','w')",
    "exec('1')",
    "().__class__.__base__.__subclasses__()",
    "x.__class__",
    "x.subs(x, 1)",
    "sin.__globals__",
    "x[0]",
    "x[0:1]",
    "[1, 2]",
    "{1: 2}",
    "{1}",
    "(1, 2)",
    "()",
    "1,",
    "lambda: 1",
    "lambda x: x",
    "(lambda: 1)()",
    "[x for x in (1, 2)]",
    "(x for x in y)",
    "(x := 3)",
    "f'{x}'",
    "f\"{__import__('os')}\"",
    "'a'",
    "b'a'",
    "`ls`",
    "x if x else x",
    "x and x",
    "x or x",
    "not x",
    "~x",
    "x @ x",
    "x // 2",
    "x % 2",
    "x << 2",
    "x >> 2",
    "x | x",
    "x & x",
    "x ^ 2",
    "x < 2",
    "x == 2",
    "x = 2",
    "x; x",
    "x\nx",
    "1\n+2",
    "\\\n1",
    "1 # comment",
    "await x",
    "yield",
    "yield x",
    "*x",
    "sin(*x)",
    "sin(**x)",
    "sin(x=1)",
    "sin()",
    "sin(x, x)",
    "sin",
    "sin + 1",
    "(sin)(x)",
    "x(1)",
    "x(1)(2)",
    "2x",
    "2(x)",
    "(x)(x)",
    "x x",
    "1 2",
    "1_000",
    "0x10",
    "0b1",
    "1j",
    "1e",
    "1e+",
    ".",
    "..",
    "...",
    "1.2.3",
    "",
    " ",
    "\t",
    "(",
    ")",
    "(()",
    "+",
    "1 +",
    "* 1",
    "1 ** ",
    "1***1",
    "None",
    "True",
    "False",
    "Ellipsis",
    "__debug__",
    "nan",
    "NaN",
    "inf",
    "-inf",
    "Infinity",
    "oo",
    "zoo",
    "I",
    "E",
    "e",
    "S",
    "N(1)",
    "Integer(1)",
    "Symbol('x')",
    "factorial(9)",
    "factorial(10**9)",
    "Sum(x, (x, 1, 9))",
    "gamma(3)",
    "9**9**9**9",
    "9**9**9",
    "2**(2**(2**(2**(2**2))))",
    "((9**64)**64)**64",
    "(x**64)**64",
    "2**65",
    "2**-65",
    "2**(1/65)",
    "2**0.0001",
    "2**pi",
    "2**x",
    "x**x",
    "1e401",
    "1e-401",
    "1e999999999",
    "1e9999999999999999999999",
    "exp(exp(exp(100)))",
    "exp(1e300)",
    "exp(10**12*log(2))",
    "exp(1e300*log(2) + x)",
    "exp(x*log(2))",
    "sqrt(-1)",
    "(-8)**(1/3)",
    "sqrt(1 - sqrt(2))",
    "log(-1)",
    "log(0)",
    "log(1 - 1)",
    "asin(2)",
    "acos(-2)",
    "acos(sqrt(2))",
    "1/0",
    "1/(1 - 1)",
    "x/(x - x)",
    "0**-1",
    "0/0",
    "tan(pi/2)",
    "cot(0)",
    "cot(pi)",
    "atan2(0, 0)",
    "1/(sqrt(2) + sqrt(3) - sqrt(5 + 2*sqrt(6)))",
    "abs(sqrt(2) + sqrt(3) + sqrt(5) + sqrt(7) + sqrt(11) + sqrt(13) - "
    + str(sympy.N(sum(sympy.sqrt(p) for p in (2, 3, 5, 7, 11, 13)), 300))
    + ")",
    "sqrt(" + "9" * 400 + ")",
    "1" * 1001,
    "x" * 1001,
    "(" * 41 + "1" + ")" * 41,
    "(" * 900,
    "(" * 500 + ")" * 500,
    "[" * 900,
    "-" * 200 + "1",
    "+" * 999 + "1",
    "1" + "+1" * 400,
    "sin(" * 30 + "x" + ")" * 30,
    "x**2" + "**2" * 100,
    "\x00",
    "1\x00",
    "x\x00.__class__",
    "\ufeff1",
    "\u202e1",
    "\u20281",
    "\r\n",
    "\x0c1",
    "\ud800",
    "１",
    "１+１",
    "٣",
    "x²",
    "²",
    "½",
    "π",
    "√2",
    "∞",
    "2×3",
    "1−1",
    "ｓｉｎ(1)",
    "ｅｖａｌ(1)",
    "ｘ",
    "𝑥",
    "х",  # Cyrillic
    "ﬁ",
    "x\u0301",
    "x\u200b",
    "😀",
]


def refusal(text: str, symbols: dict[str, sympy.Expr] | None = None) -> str:
    with pytest.raises(InputError) as caught:
        parse_expression(text, SYMBOLS if symbols is None else symbols, where="slender_rod, mu")
    return str(caught.value)


@pytest.mark.parametrize("text", HOSTILE, ids=lambda text: ascii(text[:40]))
def test_hostile_text_is_refused_at_once_in_one_line_and_executes_nothing(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    start = time.process_time()
    message = refusal(text)
    assert time.process_time() - start < SECONDS
    assert message.startswith("slender_rod, mu: ")
    assert message.isprintable()
    assert len(message) < 500
    assert list(tmp_path.iterdir()) == []


FRAGMENTS = """0 1 2 64 0.1 1e-3 1e300 x mu pi I lambda eval __class__ sin cos atan2 sqrt exp log abs acos
+ - * / ** ( ( ( ) ) ) , . [ ] { } ' " : := = ; % // @ ^ ~ １ ｘ **64 **(1/2) **9**9"""


@given(st.text(max_size=60) | st.lists(st.sampled_from([*FRAGMENTS.split(), "\n", "\x00"]), max_size=40).map("".join))
@settings(max_examples=600)
def test_any_text_is_read_or_refused_in_one_line_and_never_takes_long(text: str) -> None:
    start = time.process_time()
    refused, value = None, None
    try:
        value = parse_expression(text, SYMBOLS, where="state")
    except InputError as error:
        refused = str(error)
    assert time.process_time() - start < SECONDS
    assert refused.isprintable() if value is None else value.free_symbols <= {X, MU}


CONSTANTS = st.sampled_from([("pi", mpmath.pi)]) | st.decimals(0, 1000, places=3).map(lambda d: (str(d), Fraction(d)))
UNARY = {
    "-": lambda v: -v,
    "sin": mpmath.sin,
    "cos": mpmath.cos,
    "tan": mpmath.tan,
    "cot": mpmath.cot,
    "asin": mpmath.asin,
    "acos": mpmath.acos,
    "atan": mpmath.atan,
    "sqrt": mpmath.sqrt,
    "exp": mpmath.exp,
    "log": mpmath.log,
    "abs": abs,
    "sinh": mpmath.sinh,
    "cosh": mpmath.cosh,
    "tanh": mpmath.tanh,
}
BINARY = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
}


def formulas() -> st.SearchStrategy[tuple[str, object]]:
    """Texts beside the same formula as mpmath's own functions applied by Python's own arithmetic."""
    leaves = CONSTANTS.map(lambda pair: (pair[0], lambda value=pair[1]: _as_mpf(value)))
    return st.recursive(leaves, _grown, max_leaves=5)


def _as_mpf(value: object) -> mpmath.mpf:
    return mpmath.mpf(value.numerator) / value.denominator if isinstance(value, Fraction) else +value


def _grown(inner: st.SearchStrategy) -> st.SearchStrategy:
    one = st.tuples(st.sampled_from(sorted(UNARY)), inner).map(
        lambda t: (f"{t[0]}({t[1][0]})", lambda: UNARY[t[0]](t[1][1]()))
    )
    two = st.tuples(inner, st.sampled_from(sorted(BINARY)), inner).map(
        lambda t: (f"({t[0][0]}){t[1]}({t[2][0]})", lambda: BINARY[t[1]](t[0][1](), t[2][1]()))
    )
    power = st.tuples(inner, st.integers(-5, 5), st.integers(1, 4)).map(
        lambda t: (f"({t[0][0]})**({t[1]}/{t[2]})", lambda: mpmath.power(t[0][1](), mpmath.mpf(t[1]) / t[2]))
    )
    quadrant = st.tuples(inner, inner).map(
        lambda t: (f"atan2({t[0][0]}, {t[1][0]})", lambda: mpmath.atan2(t[0][1](), t[1][1]()))
    )
    return one | two | power | quadrant


@given(formulas())
@settings(max_examples=300)
def test_formulas_have_the_value_that_mpmath_gives_with_fifty_digits(formula: tuple[str, object]) -> None:
    text, independent = formula
    try:
        value = parse_number(text, where="formula")
    except InputError:
        assume(False)
    with mpmath.workdps(400):  # so that cancellation in the plain evaluation cannot show
        expected = independent()
    assert abs(mpmath.im(expected)) < mpmath.mpf(10) ** -300
    with mpmath.workdps(60):
        found = mpmath.mpf(str(sympy.N(value, 60)))
        assert abs(found - mpmath.re(expected)) <= mpmath.mpf(10) ** -50 * max(1, abs(expected))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("atan(2)", sympy.atan(2)),
        ("3 - sqrt(5)", 3 - sympy.sqrt(5)),
        ("4/3", sympy.Rational(4, 3)),
        ("0.1", sympy.Rational(1, 10)),
        ("1e-3", sympy.Rational(1, 1000)),
        (".5", sympy.Rational(1, 2)),
        ("5.", sympy.Integer(5)),
        ("007", sympy.Integer(7)),
        ("-2**2", sympy.Integer(-4)),
        ("2**3**2", sympy.Integer(512)),
        ("2**-1", sympy.Rational(1, 2)),
        ("--1", sympy.Integer(1)),
        ("1/3 - 1/3", sympy.Integer(0)),
        ("4**0.5", sympy.Integer(2)),
        ("abs(-3)", sympy.Integer(3)),
        ("sin(pi)", sympy.Integer(0)),
        ("atan2(-1, 0)", -sympy.pi / 2),
        ("atan2(0, -1)", sympy.pi),
        ("sqrt(2) + sqrt(3) - sqrt(5 + 2*sqrt(6))", None),
    ],
)
def test_known_texts_are_read_exactly(text: str, value: sympy.Expr | None) -> None:
    found = parse_number(text, where="known")
    if value is None:  # an unsimplified zero may stand alone: nothing asks for its sign while it is read
        assert abs(sympy.N(found, 30, maxn=40)) < 1e-25
    else:
        assert found == value


@given(st.decimals(allow_nan=False, allow_infinity=False, min_value=-1_000_000, max_value=1_000_000))
@example(Decimal("0.1"))
def test_a_decimal_is_the_rational_number_that_it_spells(number: Decimal) -> None:
    assume(abs(number.adjusted()) < 300 and -number.as_tuple().exponent < 300)
    value = parse_number(str(number), where="decimal")
    assert Fraction(int(value.p), int(value.q)) == Fraction(number)


@pytest.mark.parametrize(
    "name",
    ["I", "N", "S", "E", "Q", "O", "beta", "gamma", "lambda", "pi", "nan", "sin", "in", "not", "None", "θ", "_1"],
)
def test_a_declared_symbol_hides_constants_functions_and_keywords(name: str) -> None:
    symbol = sympy.Symbol(name)
    assert parse_expression(f"2*{name} + 1", {name: symbol}, where="symbol") == 2 * symbol + 1


def test_a_function_can_still_be_called_when_a_symbol_has_its_name() -> None:
    symbol = sympy.Symbol("log")
    assert parse_expression("log(log)", {"log": symbol}, where="symbol") == sympy.log(symbol)


def test_an_undeclared_name_is_named_with_its_place_and_the_names_allowed() -> None:
    message = refusal("1 + foo*x")
    assert "slender_rod, mu: the name 'foo' is not declared" in message
    assert "allowed are mu, pi, x, and the functions sin, cos" in message


def test_a_caret_is_answered_with_the_operator_that_was_meant() -> None:
    assert "write ** for a power, not ^" in refusal("x^2")


def test_the_place_is_shown_on_one_line_too() -> None:
    with pytest.raises(InputError) as caught:
        parse_number("1/0", where="key\nwith a newline")
    assert str(caught.value) == r"key\nwith a newline: division by zero (in '1/0')"


def test_a_long_text_is_shown_cut() -> None:
    assert len(refusal("foo" + "+1" * 90, {})) < 300


def test_a_root_of_a_negative_symbol_is_refused_as_not_real() -> None:
    positive = sympy.Symbol("p", positive=True)
    assert "not real" in refusal("sqrt(-p)", {"p": positive})


@pytest.mark.parametrize(
    ("value", "exact"),
    [
        ("4/3", sympy.Rational(4, 3)),
        (3, sympy.Integer(3)),
        (Fraction(4, 3), sympy.Rational(4, 3)),
        (0.1, sympy.Rational(1, 10)),
        (1e-12, sympy.Rational(1, 10**12)),
        (-0.0, sympy.Integer(0)),
        (sympy.atan(2), sympy.atan(2)),
        (sympy.CRootOf(5 * X**3 - 7 * X**2 + 2 * X - 1, 0), sympy.CRootOf(5 * X**3 - 7 * X**2 + 2 * X - 1, 0)),
    ],
)
def test_exact_numbers_pass_and_a_float_is_the_decimal_that_it_prints(value: object, exact: sympy.Expr) -> None:
    assert exact_number(value, where="mu") == exact


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_float_is_recovered_from_its_exact_number(value: float) -> None:
    exact = exact_number(value, where="mu")
    assert Fraction(int(exact.p), int(exact.q)) == Fraction(Decimal(repr(value)))
    assert int(exact.p) / int(exact.q) == value


@pytest.mark.parametrize(
    "value",
    [
        True,
        sympy.true,
        math.nan,
        math.inf,
        -math.inf,
        1j,
        None,
        b"1",
        [1],
        pytest.param(object(), id="an object"),  # its repr holds an address, which no two processes share
        X,
        sympy.Float("0.1"),
        sympy.pi + sympy.Float(1),
        sympy.I,
        sympy.nan,
        sympy.oo,
        -sympy.oo,
        sympy.zoo,
        sympy.sqrt(-2),
        sympy.log(-2),
        "x",
    ],
    ids=repr,
)
def test_what_is_not_an_exact_real_number_is_refused_in_one_line(value: object) -> None:
    with pytest.raises(InputError, match=r"^mu: ") as caught:
        exact_number(value, where="mu")
    assert str(caught.value).isprintable()


def test_text_is_expected_where_a_formula_is_read() -> None:
    with pytest.raises(InputError, match=r"^mu: a formula is text, not int"):
        parse_expression(3, where="mu")  # type: ignore[arg-type]
