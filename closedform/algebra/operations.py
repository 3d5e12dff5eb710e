"""The number of operations of an expression: that of ``sp.count_ops``, in a tenth of the time."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import sympy as sp

REMEMBERED = 100_000
"""Terms whose operations are remembered; the entries of a matrix share many."""


def operations(value: Any) -> int:
    """The operations of an expression, or of all entries of a matrix."""
    if isinstance(value, sp.MatrixBase):
        return sum(map(_count, value.flat()))
    return _count(sp.sympify(value, strict=True))


@lru_cache(REMEMBERED)
def _count(e: Any) -> int:
    """SymPy counts an operation for each node, whatever is around it; only signs move."""
    if e.is_Symbol or e is sp.pi:
        return 0
    if e.is_Rational:
        return int(e.p < 0) + int(e.q != 1)
    if e.is_Add and not any(_is_unspread(t) for t in e.args):
        negative = sum(_is_negative(t) for t in e.args)
        # a minus of a term is the subtraction; if all have one, the first keeps its own
        return sum(map(_count, e.args)) - negative + len(e.args) - 1 + (negative == len(e.args))
    if e.is_Mul and not _is_unspread(e):
        number, *others = e.args
        if not number.is_Rational:
            number, others = sp.S.One, list(e.args)
        if not any(map(_may_divide, others)):
            size = len(others) + int(abs(number.p) != 1)
            return int(_count(number) + size - 1 + sum(map(_count, others)))
    if isinstance(e, sp.sin | sp.cos):
        return 1 + _count(e.args[0])
    if e.is_Pow and e.exp.is_Rational and e.exp != -1 and e.base != sp.E:
        return 1 + _count(e.base) + _count(e.exp)
    return int(sp.count_ops(e))


def _is_negative(term: Any) -> bool:
    number = term.args[0] if term.is_Mul else term
    return bool(number.is_Rational and number.p < 0)


def _is_unspread(e: Any) -> bool:
    """Whether a number stands before a sum, which SymPy would multiply out when it negates it."""
    return bool(e.is_Mul and len(e.args) == 2 and e.args[0].is_Number and e.args[1].is_Add)


def _may_divide(factor: Any) -> bool:
    """Whether SymPy may count a factor of a product as a division."""
    if factor.is_Pow:
        return not (factor.exp.is_Rational and factor.exp.is_positive)
    return not (factor.is_Symbol or factor.is_Add or isinstance(factor, sp.sin | sp.cos))


__all__ = ["operations"]
