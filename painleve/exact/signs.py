"""The exact sign of a real constant: proved, or reported as undecided; never guessed by a tolerance.

A value away from zero is settled by ball arithmetic. A zero needs a proof, and one idea serves for all: rewrite the
constant as roots and rational operations on integers, roots of polynomials and independent unknowns (half-angle
tangents and exponentials of the numbers that are left, pi, logarithms). Without unknowns it is an algebraic number, and
one that is not zero cannot be arbitrarily small: a separation bound says how small (Burnikel, Funke, Mehlhorn, Schirra
and Schmitt, "A separation bound for real algebraic expressions", Algorithmica 55 (2009) 14-28). With unknowns it is
zero if it vanishes identically, which as many integer points as its degree demands decide, each by the same bound. The
work is estimated before it is begun. (docs/theory.md, section 8.3.)
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType

import sympy
from flint import arb

from painleve.exact.balls import ball, make_ball_function

__all__ = ["Sign", "Signed", "exact_sign"]

_PRECISIONS = (64, 256, 1024)
_MAX_WORK = 10**9  # evaluations times cost of their operations times bits: about half a second
_MAX_TURNS = 64  # the largest multiple of an inverse function's value that is expanded
_MAX_UNITS = 16  # the largest multiple of an unknown angle or exponent
_MAX_MIXED_UNITS = 8  # the same where it is measured in two units
_MAX_LENGTH = 10_000  # nodes of a rewritten expression
_GRIDS = 4  # attempts at a grid of points on which nothing is divided by zero

_Direction = tuple[sympy.Expr, sympy.Expr, sympy.Expr]  # (x, y, r): cosine x/r, sine y/r, r > 0, divided late


class Sign(Enum):
    """The sign of a real constant, as far as it is proved."""

    NEGATIVE = "negative"
    ZERO = "zero"
    POSITIVE = "positive"
    UNDECIDED = "undecided"


@dataclass(frozen=True, kw_only=True)
class Signed:
    """A sign, one sentence on how it was decided, and the value to double precision (NaN where there is none)."""

    sign: Sign
    reason: str
    value: float

    def __repr__(self) -> str:
        return f"Signed({self.sign.value}, {self.value:.6g})"


class _Undecidable(Exception):
    """Why no proof was attempted or found."""


def exact_sign(expr: sympy.Expr) -> Signed:
    """The sign of a constant without free symbols: exact, or `Sign.UNDECIDED` with the reason.

    Understands rational numbers, roots, real roots of polynomials (`CRootOf`), pi, the trigonometric functions and
    their inverses, exp, log, hyperbolic functions, Abs and sign. A value is decided where 1024 bits tell it from zero,
    an algebraic number whenever the work is not too much, another zero where the rewriting shows it. A removable
    division by zero, such as tan(a) cot(a) at a hidden right angle, counts as removed.
    """
    value = math.nan
    try:
        for bits in _PRECISIONS:
            enclosure = ball(expr, bits=bits)
            value = float(enclosure.mid())
            if _sign_of(enclosure) is not None:
                return _signed_by_ball(enclosure, f"ball arithmetic at {bits} bits")
        return _prove(expr, enclosure)
    except (_Undecidable, TypeError, ValueError) as reason:
        return Signed(sign=Sign.UNDECIDED, reason=str(reason), value=value)


def _sign_of(enclosure: arb) -> Sign | None:
    if enclosure > 0:
        return Sign.POSITIVE
    if enclosure < 0:
        return Sign.NEGATIVE
    return Sign.ZERO if enclosure.is_zero() else None


def _signed_by_ball(enclosure: arb, method: str) -> Signed:
    sign = _sign_of(enclosure) or Sign.UNDECIDED
    reason = "it is exactly 0" if sign is Sign.ZERO else f"it lies in {enclosure.str(5)}"
    return Signed(sign=sign, reason=f"{reason}, by {method}", value=float(enclosure.mid()))


def _prove(expr: sympy.Expr, enclosure: arb) -> Signed:
    rewriter = _Rewriter(expr)
    form = rewriter.rational_form(expr)
    unknowns = sorted(form.free_symbols, key=str)
    if not unknowns:
        return _decide_algebraic(form)
    if not enclosure.is_finite():
        raise _Undecidable(
            "it may not be defined: a root, a logarithm or a division cannot be told from an invalid one"
        )
    _check_identity(form, unknowns)
    names = ", ".join(rewriter.meaning(unknown) for unknown in unknowns)
    return Signed(sign=Sign.ZERO, reason=f"it vanishes whatever the values of {names}", value=0.0)


# --- algebraic numbers: a separation bound ---------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Size:
    """Bounds, as powers of two, on all conjugates of U and of L, where the number is U/L with algebraic integers."""

    upper: int
    lower: int

    def times(self, other: _Size) -> _Size:
        return _Size(self.upper + other.upper, self.lower + other.lower)

    def plus(self, other: _Size) -> _Size:
        return _Size(max(self.upper + other.lower, other.upper + self.lower) + 1, self.lower + other.lower)

    def power(self, n: int) -> _Size:
        size = _Size(self.upper * abs(n), self.lower * abs(n))
        return size if n >= 0 else _Size(size.lower, size.upper)

    def root(self, k: int) -> _Size:
        """The root of U/L is the root of U L^(k-1), an algebraic integer, over L."""
        return _Size(-(-(self.upper + (k - 1) * self.lower) // k), self.lower)


def _log2_above(n: int) -> int:
    return max(abs(n) - 1, 0).bit_length()


def _size(form: sympy.Expr, memo: dict[sympy.Expr, _Size]) -> _Size:
    if form not in memo:
        memo[form] = _new_size(form, memo)
    return memo[form]


def _new_size(form: sympy.Expr, memo: dict[sympy.Expr, _Size]) -> _Size:
    if form.is_Rational:
        return _Size(_log2_above(int(form.p)), _log2_above(int(form.q)))
    if isinstance(form, sympy.CRootOf):  # leading coefficient times root: an algebraic integer; Cauchy's bound on roots
        leading, *others = [abs(int(c)) for c in form.poly.all_coeffs()]
        return _Size(_log2_above(leading + max(others)), _log2_above(leading))
    if form.is_Pow:
        base = _size(form.base, memo)
        return (base if form.exp.q == 1 else base.root(int(form.exp.q))).power(int(form.exp.p))
    sizes = [_size(part, memo) for part in form.args]
    total = sizes[0]
    for size in sizes[1:]:
        total = total.plus(size) if form.is_Add else total.times(size)
    return total


def _degree_of_field(form: sympy.Expr) -> int:
    """A bound on the degree of the field that holds the number: the product of the degrees of its distinct roots."""
    roots = {(part.base, int(part.exp.q)) for part in form.atoms(sympy.Pow) if part.exp.q != 1}
    polynomials = form.atoms(sympy.CRootOf)
    return math.prod(q for _, q in roots) * math.prod(root.poly.degree() for root in polynomials)


def _separation(form: sympy.Expr, unknowns: Mapping[sympy.Expr, _Size] = MappingProxyType({})) -> int:
    """N such that the number is zero if it is below 2^-N: the norm of U, an integer, is at most |U| upper^(D-1)."""
    size = _size(form, dict(unknowns))
    return size.lower + (_degree_of_field(form) - 1) * size.upper


def _cost(part: sympy.Expr) -> int:
    """In sums or products of two numbers, as measured at 1000 to 200000 bits."""
    if isinstance(part, sympy.CRootOf):
        return 100 * int(part.poly.degree()) ** 2
    return 5 if part.is_Pow else len(part.args)


def _check_work(points: int, form: sympy.Expr, bits: int) -> None:
    operations = sum(map(_cost, {*sympy.preorder_traversal(form)}))
    if points * operations * bits > _MAX_WORK:
        raise _Undecidable(f"a proof would take {points} evaluations at {bits} bits, more than is attempted")


def _decide_algebraic(form: sympy.Expr) -> Signed:
    separation = _separation(form)
    _check_work(1, form, separation + 128)
    enclosure = _resolved(lambda bits: ball(form, bits=bits), separation)
    degree = _degree_of_field(form)
    if _sign_of(enclosure) in (Sign.POSITIVE, Sign.NEGATIVE):
        return _signed_by_ball(enclosure, "ball arithmetic on its algebraic form")
    reason = (
        f"an algebraic number in a field of degree at most {degree}, and below 2^-{separation}: only zero is so small"
    )
    return Signed(sign=Sign.ZERO, reason=reason, value=0.0)


def _resolved(evaluate: Callable[[int], arb], separation: int) -> arb:
    """The enclosure at a precision at which it either excludes zero or is small enough to be zero."""
    limit = arb(2) ** -separation
    for bits in (separation + 128, 2 * separation + 256):
        enclosure = evaluate(bits)
        if not enclosure.is_finite():
            raise _Undecidable("it may not be defined: a root or a division cannot be told from an invalid one")
        if _sign_of(enclosure) is not None or abs(enclosure) < limit:
            return enclosure
    raise _Undecidable(f"{2 * separation + 256} bits did not suffice")


# --- identities in the unknowns --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Fraction:
    """Degree of a numerator, and the powers of the distinct factors below it, each with its own degree."""

    above: int
    below: Mapping[sympy.Expr, tuple[int, int]]

    def deficit(self, other: Mapping[sympy.Expr, tuple[int, int]]) -> int:
        return sum((power - self.below.get(part, (0, 0))[0]) * degree for part, (power, degree) in other.items())


def _fraction(form: sympy.Expr, unknown: sympy.Symbol, memo: dict[sympy.Expr, _Fraction]) -> _Fraction:
    if form not in memo:
        memo[form] = _new_fraction(form, unknown, memo)
    return memo[form]


def _new_fraction(form: sympy.Expr, unknown: sympy.Symbol, memo: dict[sympy.Expr, _Fraction]) -> _Fraction:
    if form == unknown:
        return _Fraction(1, {})
    if not form.args or (form.is_Pow and not form.exp.is_Integer) or isinstance(form, sympy.CRootOf):
        return _Fraction(0, {})  # another unknown or a constant: no root holds an unknown any more
    if form.is_Pow:
        return _fraction_of_power(form.base, int(form.exp), _fraction(form.base, unknown, memo))
    parts = [_fraction(part, unknown, memo) for part in form.args]
    if form.is_Mul:
        return _Fraction(sum(part.above for part in parts), _merged(parts, lambda a, b: a + b))
    common = _merged(parts, max)
    return _Fraction(max(part.above + part.deficit(common) for part in parts), common)


def _fraction_of_power(base: sympy.Expr, n: int, fraction: _Fraction) -> _Fraction:
    if n > 0:
        return _Fraction(n * fraction.above, {part: (n * p, d) for part, (p, d) in fraction.below.items()})
    return _Fraction(-n * sum(p * d for p, d in fraction.below.values()), {base: (-n, fraction.above)})


def _merged(parts: Sequence[_Fraction], join: Callable[[int, int], int]) -> dict[sympy.Expr, tuple[int, int]]:
    merged: dict[sympy.Expr, tuple[int, int]] = {}
    for part in parts:
        for factor, (power, degree) in part.below.items():
            merged[factor] = (join(merged.get(factor, (0, 0))[0], power), degree)
    return merged


def _check_identity(form: sympy.Expr, unknowns: Sequence[sympy.Symbol]) -> None:
    """Prove that a rational function is zero on a grid with one point more a side than the degree of its numerator."""
    sides = [_fraction(form, unknown, {}).above + 1 for unknown in unknowns]
    points = math.prod(sides)
    largest = _Size(_log2_above(max(_starts(sides, _GRIDS)) + max(sides)), 0)
    separation = _separation(form, dict.fromkeys(unknowns, largest))
    _check_work(points, form, separation + 256)
    for attempt in range(_GRIDS):
        if _vanishes_on(form, unknowns, _grid(sides, attempt), separation):
            return
    raise _Undecidable("no grid of points was found on which it is defined")


def _starts(sides: Sequence[int], attempt: int) -> list[int]:
    """First integers for the unknowns, so that no two take the same value: differences are the likeliest divisors."""
    return [2 + attempt + (max(sides) + 1) * ((attempt + 2) ** i - 1) for i in range(len(sides))]


def _grid(sides: Sequence[int], attempt: int) -> Iterator[tuple[int, ...]]:
    starts = _starts(sides, attempt)
    return itertools.product(*(range(start, start + side) for start, side in zip(starts, sides, strict=True)))


def _vanishes_on(
    form: sympy.Expr, unknowns: Sequence[sympy.Symbol], grid: Iterator[tuple[int, ...]], separation: int
) -> bool:
    """True if zero at every point, False if somewhere undefined; raises _Undecidable where it is not zero."""
    function = make_ball_function([form], unknowns, bits=separation + 256, as_written=True)
    limit = arb(2) ** -separation
    for point in grid:
        value = function([arb(k) for k in point])[0]
        if not value.is_finite():
            return False
        if not abs(value) < limit:
            raise _Undecidable(
                "within 2^-1000 or so of zero, and not shown to be zero by the identities that are known here"
            )
    return True


# --- rewriting -------------------------------------------------------------------------------------------------------


class _Rewriter:
    """Constants as rational functions of algebraic numbers and unknowns; one instance for one constant."""

    def __init__(self, expr: sympy.Expr) -> None:
        self._unknowns: dict[sympy.Expr, sympy.Symbol] = {}
        self._memo: dict[sympy.Expr, sympy.Expr] = {}
        self._lengths: dict[sympy.Basic, int] = {}
        self._check_length(expr)
        self._angle_units = _units(expr, _CIRCULAR)
        self._exponent_units = _units(expr, _EXPONENTIAL)

    def meaning(self, unknown: sympy.Symbol) -> str:
        return next(str(expr) for expr, symbol in self._unknowns.items() if symbol == unknown)

    def rational_form(self, expr: sympy.Expr) -> sympy.Expr:
        """Roots of unknowns become unknowns last, when all their squares have been formed."""
        form = self._rewrite(expr)
        roots = {power for power in form.atoms(sympy.Pow) if not power.exp.is_Integer and power.base.free_symbols}
        return form.xreplace({power: self._unknown(_root(power.base, power.exp.q)) ** power.exp.p for power in roots})

    def _rewrite(self, expr: sympy.Expr) -> sympy.Expr:
        if expr not in self._memo:
            self._memo[expr] = self._rewritten(expr)
            self._check_length(self._memo[expr])
        return self._memo[expr]

    def _check_length(self, *forms: sympy.Expr) -> None:
        if sum(map(self._length, forms)) > _MAX_LENGTH:
            raise _Undecidable("within 2^-1000 or so of zero, and too long when written out for a proof")

    def _length(self, form: sympy.Expr) -> int:
        """Of the written-out tree, without writing it out: equal parts are counted once and looked up."""
        if form not in self._lengths:
            self._lengths[form] = 1 + sum(map(self._length, form.args))
        return self._lengths[form]

    def _rewritten(self, expr: sympy.Expr) -> sympy.Expr:
        if expr.is_Rational or isinstance(expr, sympy.CRootOf):
            return expr
        if expr.is_Add or expr.is_Mul:
            return expr.func(*map(self._rewrite, expr.args))
        if expr.is_Pow:
            return _root(self._rewrite(expr.base), expr.exp.q) ** expr.exp.p
        if expr.func in _CIRCULAR:
            return _CIRCULAR[expr.func](*self._direction(_argument(expr)))
        if expr.func in _EXPONENTIAL:
            return _EXPONENTIAL[expr.func](self._exponential(_argument(expr)))
        if isinstance(expr, sympy.Abs | sympy.sign):
            return self._by_sign(expr)
        return self._unknown(expr)

    def _unknown(self, expr: sympy.Expr) -> sympy.Symbol:
        return self._unknowns.setdefault(expr, sympy.Dummy(f"u{len(self._unknowns):03}", real=True))

    def _by_sign(self, expr: sympy.Expr) -> sympy.Expr:
        signed = exact_sign(expr.args[0])
        if signed.sign is Sign.UNDECIDED:
            raise _Undecidable(f"the sign of {expr.args[0]} is undecided: {signed.reason}")
        sign = {Sign.NEGATIVE: -1, Sign.ZERO: 0, Sign.POSITIVE: 1}[signed.sign]
        return sympy.Integer(sign) if isinstance(expr, sympy.sign) else sign * self._rewrite(expr.args[0])

    def _exponential(self, exponent: sympy.Expr) -> sympy.Expr:
        powers = _measured_parts(self._exponent_units, exponent)
        return sympy.Mul(*(self._unknown(sympy.exp(unit * part)) ** n for part, unit, n in powers))

    def _direction(self, angle: sympy.Expr) -> _Direction:
        """The direction of a sum of whole multiples of known and unknown angles."""
        total: _Direction = (sympy.Integer(1), sympy.Integer(0), sympy.Integer(1))
        for part, unit, n in _measured_parts(self._angle_units, angle):
            total = _sum_of_angles(total, self._multiple(part, unit, n))
            self._check_length(*total)
        return total

    def _multiple(self, part: sympy.Expr, unit: sympy.Rational, n: int) -> _Direction:
        if part == sympy.pi:
            cosine, sine = sympy.cos(n * unit * part), sympy.sin(n * unit * part)
            if not (cosine.has(*_CIRCULAR) or sine.has(*_CIRCULAR)):
                return cosine, sine, sympy.Integer(1)
        if part.func in _INVERSES and unit.q & (unit.q - 1) == 0:
            return _turned(self._known(part, int(unit.q)), n * int(unit.p))
        u = self._unknown(sympy.tan(unit * part / 2))
        return _turned((1 - u**2, 2 * u, 1 + u**2), n)

    def _known(self, part: sympy.Expr, n: int) -> _Direction:
        """The direction of an inverse function's value over n, a power of two, by bisection."""
        if n > 1:  # the values of all inverse functions lie in (-pi, pi]: half of them have no negative cosine
            x, y, r = self._known(part, n // 2)
            return r + x, y, _root(2 * r * (r + x), 2)
        y, *rest = map(self._rewrite, part.args)
        if isinstance(part, sympy.asin):
            return _root(1 - y**2, 2), y, sympy.Integer(1)
        if isinstance(part, sympy.acos):
            return y, _root(1 - y**2, 2), sympy.Integer(1)
        x = rest[0] if rest else sympy.Integer(1)
        return x, y, _root(x**2 + y**2, 2)


def _root(base: sympy.Expr, k: int) -> sympy.Expr:
    """Left unevaluated: sympy would look for the sign of the base, in its own way and without bounds."""
    if k == 1:
        return base
    if base.is_Rational and base >= 0:
        return base ** sympy.Rational(1, k)
    if not base.free_symbols and ball(base, bits=256).contains(0) and exact_sign(base).sign is Sign.ZERO:
        return sympy.Integer(0)
    return sympy.Pow(base, sympy.Rational(1, k), evaluate=False)


_INVERSES = (sympy.atan, sympy.asin, sympy.acos, sympy.atan2)

_CIRCULAR: Mapping[type[sympy.Basic], Callable[[sympy.Expr, sympy.Expr, sympy.Expr], sympy.Expr]] = MappingProxyType(
    {
        sympy.cos: lambda x, y, r: x / r,
        sympy.sin: lambda x, y, r: y / r,
        sympy.tan: lambda x, y, r: y / x,
        sympy.cot: lambda x, y, r: x / y,
        sympy.sec: lambda x, y, r: r / x,
        sympy.csc: lambda x, y, r: r / y,
    }
)

_EXPONENTIAL: Mapping[type[sympy.Basic], Callable[[sympy.Expr], sympy.Expr]] = MappingProxyType(
    {
        sympy.exp: lambda e: e,
        type(sympy.E): lambda e: e,
        sympy.cosh: lambda e: (e + 1 / e) / 2,
        sympy.sinh: lambda e: (e - 1 / e) / 2,
        sympy.tanh: lambda e: (e**2 - 1) / (e**2 + 1),
    }
)


def _argument(call: sympy.Expr) -> sympy.Expr:
    return call.args[0] if call.args else sympy.Integer(1)  # sympy's E is no call, but means exp(1)


def _parts(expr: sympy.Expr) -> list[tuple[sympy.Expr, sympy.Rational]]:
    return [(part, coefficient) for part, coefficient in expr.as_coefficients_dict().items() if coefficient != 0]


_Units = Mapping[sympy.Expr, Sequence[sympy.Rational]]


def _units(expr: sympy.Expr, functions: Mapping[type[sympy.Basic], object]) -> _Units:
    """For each part of the arguments of these functions, the units of which its multiples are small whole multiples."""
    multiples: dict[sympy.Expr, set[sympy.Rational]] = {}
    for call in expr.atoms(*functions):
        for part, coefficient in _parts(_argument(call)):
            multiples.setdefault(part, set()).add(abs(coefficient))
    ascending = {part: sorted(coefficients) for part, coefficients in multiples.items()}
    return {part: min((_common_units(c, merge) for merge in (False, True)), key=len) for part, c in ascending.items()}


def _common_units(coefficients: Sequence[sympy.Rational], merge: bool) -> list[sympy.Rational]:
    """Units of which every coefficient is a small whole multiple, or the sum of such multiples of two units.

    A coefficient that they do not measure refines a unit to a common divisor (`merge`), or becomes one more unit.
    """
    units: list[sympy.Rational] = []
    for coefficient in coefficients:  # upwards: this one is the largest that its unit has to serve
        if _measured(units, coefficient) is None:
            common = ((i, _common_divisor(unit, coefficient)) for i, unit in enumerate(units) if merge)
            place, unit = next(((i, c) for i, c in common if coefficient / c <= _MAX_UNITS), (len(units), coefficient))
            units[place : place + 1] = [unit]
    return units


def _common_divisor(first: sympy.Rational, second: sympy.Rational) -> sympy.Rational:
    return sympy.Rational(math.gcd(first.p, second.p), math.lcm(first.q, second.q))


def _measured(units: Sequence[sympy.Rational], coefficient: sympy.Rational) -> list[tuple[sympy.Rational, int]] | None:
    """The coefficient as a small whole multiple of one unit, or a sum of multiples of two (angles and differences)."""
    for unit in units:
        turns = coefficient / unit
        if turns.is_Integer and abs(turns) <= _MAX_UNITS:
            return [(unit, int(turns))]
    small = sorted(range(-_MAX_MIXED_UNITS, _MAX_MIXED_UNITS + 1), key=abs)
    for (first, second), n in itertools.product(itertools.combinations(units, 2), small):
        rest = (coefficient - n * first) / second
        if rest.is_Integer and abs(rest) <= _MAX_MIXED_UNITS:
            return [(first, n), (second, int(rest))]
    return None


def _measured_parts(units: _Units, expr: sympy.Expr) -> list[tuple[sympy.Expr, sympy.Rational, int]]:
    """The terms of an angle or exponent as parts, their units and whole multiples of these."""
    measured = []
    for part, coefficient in _parts(expr):
        multiples = _measured(units[part], coefficient)
        if multiples is None:
            raise _Undecidable(f"no unit was found for {coefficient * part}")
        measured += [(part, unit, n) for unit, n in multiples]
    return measured


def _sum_of_angles(first: _Direction, second: _Direction) -> _Direction:
    (x, y, r), (u, v, q) = first, second
    return x * u - y * v, y * u + x * v, r * q


def _turned(direction: _Direction, n: int) -> _Direction:
    """n times an angle: de Moivre's formula."""
    if abs(n) > _MAX_TURNS:
        raise _Undecidable(f"an angle is multiplied by {n}, more than {_MAX_TURNS}")
    x, y, r = direction if n >= 0 else (direction[0], -direction[1], direction[2])
    terms = [(-1) ** (k // 2) * math.comb(abs(n), k) * x ** (abs(n) - k) * y**k for k in range(abs(n) + 1)]
    return sympy.Add(*terms[::2]), sympy.Add(*terms[1::2]), r ** abs(n)
