"""The determinant of a Jacobian, factored."""

from __future__ import annotations

import sympy as sp

from closedform.algebra.circles import factored_on_circles, shortest_on_circles
from closedform.algebra.factoring import factored
from closedform.algebra.normal_form import determinant
from closedform.algebra.operations import operations
from closedform.mechanics.frames import merge_angles


def factored_determinant(J: sp.Matrix) -> sp.Expr:
    """A determinant as a polynomial in sines and cosines, reduced on their circles and factored."""
    reduced = determinant(J)
    whole = factored(reduced)
    split = factored_on_circles(whole)
    merged = sp.Mul(*map(_shortest, sp.Mul.make_args(split)))
    forms = (whole, factored(merge_angles(reduced)), split, merged)
    return _in_decimals(min(forms, key=operations))


def _shortest(factor: sp.Expr) -> sp.Expr:
    base, power = factor.as_base_exp()
    merged: sp.Expr = factored(merge_angles(shortest_on_circles(base))) ** power
    return merged


def _in_decimals(product: sp.Expr) -> sp.Expr:
    """Sums that factoring gave integer coefficients, divided by a power of ten again.

    A factor then has the size of the lengths in it, not a million times that.
    """
    number, others = product.as_coeff_Mul()
    whole, rest = [], []
    for factor in sp.Mul.make_args(others):
        base, power = factor.as_base_exp()
        terms = base.as_coefficients_dict() if base.is_Add else {}
        digits = len(str(max((abs(int(c)) for c in terms.values()), default=0)))
        if digits > 1:
            number *= 10 ** (digits * power)
            whole.append(sp.Add(*(c * t / 10**digits for t, c in terms.items())) ** power)
        else:
            rest.append(factor)
    if len(whole) == 1 and whole[0].is_Add:
        whole = [sp.Add(*(number * t for t in whole[0].args))]
        number = sp.S.One
    return number * sp.Mul(*whole, *rest)


__all__ = ["factored_determinant"]
