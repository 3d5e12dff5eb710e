"""Factors: the same form as SymPy's, sign by sign."""

import pytest
import sympy as sp

from closedform.algebra.factoring import factored

a, b, c, t = sp.symbols("a b c t", real=True)


@pytest.mark.parametrize(
    "value",
    [
        a**2 - b**2,
        b - a,
        -2 * a - 4 * b,
        a / 2 - b / 3,
        sp.Rational(3, 4) * (a - b) ** 3 * (b - c),
        a * (b + c) - a * b - a * c,
        (a + b) ** 2 - a**2 - 2 * a * b,
        a * sp.cos(t) - b * sp.cos(t),
        a**2 * sp.sin(t) ** 2 - sp.cos(a + t) ** 2,
        1 - sp.sin(a * (b + c)) ** 2,
        sp.S(7),
        -a,
        sp.sqrt(2) * a**2 / 3 - sp.sqrt(3) * a * b + sp.sqrt(6) * b**2,
        sp.expand((sp.sqrt(2) * a - b) * (sp.sqrt(6) * sp.sin(t) / 4 + sp.Rational(1, 2))),
        # quotients
        (a**2 - b**2) / (a + b) - c / (a + b) ** 2,
        1 / (a * b) - 1 / (c * b),
        (a - b) / (b - a) ** 2,
        sp.sqrt(2) * a / b + sp.sqrt(2) * a / c,
        (6 * a + 6) / (4 * b - 4),
        (2 * a**2 * b**2 * sp.sin(t) ** 2 - 2 * a**2 * sp.sin(t) ** 2)
        / (2 * b**2 * sp.sin(t) ** 2),
        2 / (sp.sqrt(3) * a + a),
        # what is not a polynomial of symbols, sines, cosines and roots of numbers
        a / c - b / c,
        sp.sqrt(2) * a - sp.sqrt(2) * b,
        sp.pi * a - sp.pi * b,
        a * sp.Abs(b) - sp.Abs(b) ** 2,
    ],
    ids=str,
)
def test_a_value_is_factored_as_sympy_does(value: sp.Expr) -> None:
    assert sp.srepr(factored(value)) == sp.srepr(sp.factor(value))
