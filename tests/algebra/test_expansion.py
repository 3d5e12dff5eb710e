"""Products of matrices by polynomial arithmetic, against SymPy's own."""

import pytest
import sympy as sp

from closedform.algebra.expansion import Expansion

a, b, t, u = sp.symbols("a b t u", real=True)
c, s = sp.cos(t + u), sp.sin(t + u)
ROOTS = sp.Matrix(
    [[sp.sqrt(2) * c, -sp.sqrt(6) * s, a], [s, c / 3, sp.sqrt(3)], [0, a + b, (a - b) ** 2]]
)
QUOTIENT = sp.Matrix([[1 / a, b, 0], [c, s / b, 1], [0, 0, sp.Abs(b)]])
ANGLE = sp.Matrix([[sp.cos(t + sp.atan2(a, b)), sp.sin(2 * t), 1], [0, sp.pi * a, b], [a, b, c]])


@pytest.mark.parametrize(
    ("matrix", "polynomial"), [(ROOTS, True), (ANGLE, True), (QUOTIENT, False)]
)
def test_products_are_those_of_sympy(matrix: sp.Matrix, polynomial: bool) -> None:
    column = sp.Matrix([a, s, sp.sqrt(2)])
    found = Expansion([matrix, column])
    M, p = found.read(matrix), found.read(column)
    assert found._polynomial == polynomial
    cube = found.times(M, found.times(M, M))
    assert found.written(cube) == (matrix**3).applyfunc(sp.expand)
    moved = found.plus(found.times(M, p), found.cross(p, found.times(M, p)), -1)
    expected = matrix * column - column.cross(matrix * column)
    assert found.written(moved) == expected.applyfunc(sp.expand)


def test_roots_are_those_of_primes() -> None:
    """Else the root of 2 times that of 6 is not twice that of 3, and nothing cancels."""
    row, column = sp.Matrix([[sp.sqrt(2), -sp.sqrt(3)]]), sp.Matrix([sp.sqrt(6), 2])
    found = Expansion([row, column])
    ((zero,),) = found.times(found.read(row), found.read(column))
    assert zero == 0
