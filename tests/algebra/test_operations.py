"""The number of operations, against SymPy's own count."""

import random

import pytest
import sympy as sp

from closedform.algebra.operations import operations

x, y = sp.symbols("x y", real=True)
LEAVES = (x, y, -x, 1 / x, sp.pi, sp.sqrt(2), sp.sqrt(3) / 2, sp.Integer(-1), sp.Rational(-2, 3))
FUNCTIONS = (sp.sin, sp.cos, sp.Abs, sp.atan, lambda e: e**2, sp.factor_terms)


def drawn(draw: random.Random, depth: int) -> sp.Expr:
    if not depth:
        return draw.choice(LEAVES)
    parts = [drawn(draw, depth - 1) for _ in range(draw.randint(2, 3))]
    joined = draw.choice((sp.Add, sp.Mul))(*parts)
    return draw.choice(FUNCTIONS)(joined) if draw.random() < 0.4 else joined


@pytest.mark.parametrize("seed", range(3))
def test_the_count_is_that_of_sympy(seed: int) -> None:
    draw = random.Random(seed)
    for _ in range(20):
        e = drawn(draw, 2)
        for form in (e, sp.expand(e), sp.factor_terms(e)):
            assert operations(form) == sp.count_ops(form), form


@pytest.mark.parametrize(
    "e",
    [-x, -x - y, -x + y, 2 * (x + 1) / 3, 2 * x + 2, sp.Mul(-2, x + 1, evaluate=False), 1 / x**2],
)
def test_signs_and_divisions_are_those_of_sympy(e: sp.Expr) -> None:
    assert operations(e) == sp.count_ops(e)
    assert operations(sp.Matrix([e, x * e])) == sp.count_ops(sp.Matrix([e, x * e]))
