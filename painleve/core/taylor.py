"""Polynomials in the shape offsets, evaluated through a block: the cancellation-free functions of q.

A pass over a block costs as much for its loads and stores as for its arithmetic, so rows take up to four terms at a
time, terms that vanish are left out, and a row that is a multiple of another is made from it.
(docs/theory.md, section 8.2.)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from painleve._jit import jit

__all__ = ["Polynomials", "monomial_block", "no_polynomials", "polynomial_block", "sparse_polynomials"]

PROPORTIONAL = 2.0**-51  # relative: two coefficients and their ratio, each rounded once
TERMS = 4  # that one pass over a row adds


class Polynomials(NamedTuple):
    """Sparse polynomials without constant terms.

    Monomial m is monomial parents[m] times variable factors[m], or the variable alone if parents[m] is -1. Row r has
    the terms starts[r] ... starts[r + 1] - 1, small terms first: coefficients[k] times monomial terms[k]. If
    like[r] < r, row r is ratio[r] times row like[r] instead. Polynomials of one variable have no monomials but that
    variable, and all their terms down to the linear one: they are evaluated by Horner's rule.
    """

    parents: np.ndarray
    factors: np.ndarray
    starts: np.ndarray
    terms: np.ndarray
    coefficients: np.ndarray
    like: np.ndarray
    ratio: np.ndarray
    single: bool


def sparse_polynomials(parents: np.ndarray, factors: np.ndarray, table: np.ndarray) -> Polynomials:
    """The polynomials of a table (rows, monomials by rising degree) of correctly rounded coefficients."""
    rows, single = len(table), not np.any(factors)
    like, ratio = np.arange(rows), np.ones(rows)
    terms: list[np.ndarray] = []
    for r, row in enumerate(table):
        for s in range(r):
            factor = _ratio(row, table[s])
            if like[s] == s and factor is not None:
                like[r], ratio[r] = s, factor
                break
        terms.append(_terms(row, single) if like[r] == r else np.zeros(0, np.int64))
    flat = np.concatenate([np.zeros(0, np.int64), *terms])
    owner = np.repeat(np.arange(rows), [len(t) for t in terms])
    starts = np.concatenate([[0], np.cumsum([len(t) for t in terms], dtype=np.int64)]).astype(np.int64)
    coefficients = np.ascontiguousarray(table[owner, flat])
    if single:
        parents, factors = parents[:1], factors[:1]
    return Polynomials(parents, factors, starts, flat, coefficients, like, ratio, single)


def _terms(row: np.ndarray, single: bool) -> np.ndarray:
    present = np.flatnonzero(row)[::-1]
    return np.arange(present[0], -1, -1) if single and present.size else present


def no_polynomials() -> Polynomials:
    """In the place of polynomials where rows are evaluated plainly."""
    none = np.zeros(0, np.int64)
    return sparse_polynomials(none, none, np.zeros((0, 0)))


def _ratio(row: np.ndarray, other: np.ndarray) -> float | None:
    """f if row = f other up to the rounding of the coefficients, else None."""
    largest = int(np.argmax(np.abs(other)))
    if other[largest] == 0.0:
        return None
    f = float(row[largest] / other[largest])
    return f if f != 0.0 and np.all(np.abs(row - f * other) <= PROPORTIONAL * np.abs(row)) else None


@jit
def monomial_block(polynomials, dq, monomials):
    """monomials[m] = monomials[parents[m]] * dq[factors[m]], or dq[factors[m]] for those without a parent."""
    for m in range(polynomials.parents.size):
        parent, factor = polynomials.parents[m], polynomials.factors[m]
        if parent < 0:
            _copy(dq, factor, monomials, m)
        else:
            _multiply(monomials, parent, dq, factor, m)


@jit
def polynomial_block(polynomials, monomials, values):
    """values[r, i] = the polynomial of row r at the monomials [:, i], small terms first."""
    for r in range(values.shape[0]):
        first, last, like = polynomials.starts[r], polynomials.starts[r + 1], polynomials.like[r]
        if like < r:
            _scale(polynomials.ratio[r], values, like, values, r)
        elif first == last:
            _clear(values, r)
        elif polynomials.single:
            _horner(polynomials.coefficients, first, last, monomials, values, r)
        else:
            _sum(polynomials.coefficients, polynomials.terms, first, last, monomials, values, r)


@jit
def _horner(c, first, last, x, y, r):
    head = (last - first - 1) % TERMS + 1
    if head == 1:
        _scale(c[first], x, 0, y, r)
    elif head == 2:
        _horner_two(c, first, x, y, r)
    elif head == 3:
        _horner_three(c, first, x, y, r)
    else:
        _clear(y, r)
        _horner_four(c, first, x, y, r)
    for k in range(first + head, last, TERMS):
        _horner_four(c, k, x, y, r)


@jit
def _sum(c, m, first, last, x, y, r):
    head = (last - first - 1) % TERMS + 1
    if head == 1:
        _scale(c[first], x, m[first], y, r)
    elif head == 2:
        _set_two(c, m, first, x, y, r)
    elif head == 3:
        _set_three(c, m, first, x, y, r)
    else:
        _clear(y, r)
        _add_four(c, m, first, x, y, r)
    for k in range(first + head, last, TERMS):
        _add_four(c, m, k, x, y, r)


# The loops below index whole arrays: a view of a row would cost two atomic operations each time it is made.


@jit
def _copy(x, j, y, r):
    for i in range(y.shape[1]):
        y[r, i] = x[j, i]


@jit
def _clear(y, r):
    for i in range(y.shape[1]):
        y[r, i] = 0.0


@jit
def _multiply(y, parent, x, factor, r):
    for i in range(y.shape[1]):
        y[r, i] = y[parent, i] * x[factor, i]


@jit
def _scale(c, x, j, y, r):
    for i in range(y.shape[1]):
        y[r, i] = c * x[j, i]


@jit
def _set_two(c, m, k, x, y, r):
    c0, c1, m0, m1 = c[k], c[k + 1], m[k], m[k + 1]
    for i in range(y.shape[1]):
        y[r, i] = c0 * x[m0, i] + c1 * x[m1, i]


@jit
def _set_three(c, m, k, x, y, r):
    c0, c1, c2, m0, m1, m2 = c[k], c[k + 1], c[k + 2], m[k], m[k + 1], m[k + 2]
    for i in range(y.shape[1]):
        y[r, i] = c0 * x[m0, i] + c1 * x[m1, i] + c2 * x[m2, i]


@jit
def _add_four(c, m, k, x, y, r):
    c0, c1, c2, c3 = c[k], c[k + 1], c[k + 2], c[k + 3]
    m0, m1, m2, m3 = m[k], m[k + 1], m[k + 2], m[k + 3]
    for i in range(y.shape[1]):
        y[r, i] = y[r, i] + c0 * x[m0, i] + c1 * x[m1, i] + c2 * x[m2, i] + c3 * x[m3, i]


@jit
def _horner_two(c, k, x, y, r):
    c0, c1 = c[k], c[k + 1]
    for i in range(y.shape[1]):
        t = x[0, i]
        y[r, i] = (c0 * t + c1) * t


@jit
def _horner_three(c, k, x, y, r):
    c0, c1, c2 = c[k], c[k + 1], c[k + 2]
    for i in range(y.shape[1]):
        t = x[0, i]
        y[r, i] = ((c0 * t + c1) * t + c2) * t


@jit
def _horner_four(c, k, x, y, r):
    """y becomes (((y + c0) x + c1) x + ...) x: the factor x of the last step is already in y."""
    c0, c1, c2, c3 = c[k], c[k + 1], c[k + 2], c[k + 3]
    for i in range(y.shape[1]):
        t = x[0, i]
        y[r, i] = ((((y[r, i] + c0) * t + c1) * t + c2) * t + c3) * t
