"""Polynomials in the shape offsets, evaluated through a block: the cancellation-free functions of q."""

from painleve._jit import jit


@jit
def monomial_block(parents, factors, dq, monomials):
    """monomials[m] = monomials[parents[m]] * dq[factors[m]]; those without a parent (-1) are dq[factors[m]]."""
    for m in range(parents.size):
        row, x = monomials[m], dq[factors[m]]
        if parents[m] < 0:
            row[:] = x
        else:
            parent = monomials[parents[m]]
            for i in range(row.size):
                row[i] = parent[i] * x[i]


@jit
def polynomial_block(coefficients, monomials, values):
    """values[r, i] = sum_m coefficients[r, m] monomials[m, i], small terms first (monomials by rising degree)."""
    last = coefficients.shape[1] - 1
    for r in range(coefficients.shape[0]):
        row = values[r]
        row[:] = 0.0
        for m in range(last, -1, -1):
            c = coefficients[r, m]
            if c != 0.0:
                x = monomials[m]
                for i in range(row.size):
                    row[i] += c * x[i]
