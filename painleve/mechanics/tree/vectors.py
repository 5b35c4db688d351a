"""Vectors and matrices of three whose entries are names on a tape."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from painleve.exact.tape import TapeBuilder
from painleve.mechanics.tree.model import Vector

__all__ = ["Algebra", "Matrix3", "quaternion_rotation", "rotation_about", "rows_of", "transposed"]

Matrix3 = tuple[Vector, Vector, Vector]


class Algebra:
    """Every result is bound to names; zeros and ones fold away."""

    def __init__(self, tape: TapeBuilder) -> None:
        self.tape = tape

    def vector(self, entries: Sequence[sp.Expr]) -> Vector:
        x, y, z = (self.tape.name(sp.sympify(e, strict=True)) for e in entries)
        return x, y, z

    def add(self, *vectors: Vector) -> Vector:
        return self.vector([sp.Add(*entries) for entries in zip(*vectors, strict=True)])

    def scale(self, factor: sp.Expr, v: Vector) -> Vector:
        return self.vector([factor * x for x in v])

    def dot(self, v: Vector, w: Vector) -> sp.Expr:
        return self.tape.name(sp.Add(*(x * y for x, y in zip(v, w, strict=True))))

    def cross(self, v: Vector, w: Vector) -> Vector:
        return self.vector([v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]])

    def apply(self, matrix: Matrix3, v: Vector) -> Vector:
        return self.vector([self.dot(row, v) for row in matrix])

    def product(self, left: Matrix3, right: Matrix3) -> Matrix3:
        columns = tuple(zip(*right, strict=True))
        return self.matrix([[self.dot(row, column) for column in columns] for row in left])

    def matrix(self, rows: Sequence[Sequence[sp.Expr]]) -> Matrix3:
        x, y, z = (self.vector(row) for row in rows)
        return x, y, z

    def sum(self, *matrices: Matrix3) -> Matrix3:
        return self.matrix([[sp.Add(*(m[i][j] for m in matrices)) for j in range(3)] for i in range(3)])

    def rotation(self, axis: Vector, angle: sp.Expr) -> Matrix3:
        """About a unit axis of numbers."""
        c, s = self.tape.name(sp.cos(angle)), self.tape.name(sp.sin(angle))
        return self.matrix(_rodrigues(axis, c, s).tolist())


def rotation_about(axis: Vector, angle: sp.Expr) -> sp.ImmutableMatrix:
    """The rotation about a unit axis."""
    return _rodrigues(axis, sp.cos(angle), sp.sin(angle))


def quaternion_rotation(w: sp.Expr, v: Vector) -> sp.ImmutableMatrix:
    """The rotation of the quaternion w + v, of any length but zero."""
    x, y, z = v
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    return sp.ImmutableMatrix(rows) / (w * w + x * x + y * y + z * z)


def _rodrigues(axis: Vector, c: sp.Expr, s: sp.Expr) -> sp.ImmutableMatrix:
    """Rodrigues' formula for a rotation by the angle with that cosine and sine."""
    x, y, z = axis
    skew = sp.Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    column = sp.Matrix(axis)
    return sp.ImmutableMatrix((column * column.T * (1 - c) + c * sp.eye(3) + s * skew).applyfunc(sp.expand))


def rows_of(matrix: sp.ImmutableMatrix) -> Matrix3:
    x, y, z = (tuple(matrix.row(i)) for i in range(3))
    return x, y, z


def transposed(matrix: Matrix3) -> Matrix3:
    x, y, z = zip(*matrix, strict=True)
    return x, y, z
